//! All kernels of a model, and the structure that says what their inputs and outputs mean.

use super::ModelKernels;
use super::polarise::form_tables;
use super::program::{Programs, operations, residual_jets};
use super::structure::{Parts, offsets};
use crate::derive::{BaseCheck, Case, CaseClosure, Derivation, Opener, base_value};
use crate::graph::{Graph, Id, Jet, Node, Variable};
use crate::model::Amplitude;
use landau_contract::*;
use std::collections::BTreeSet;

/// Derivatives of the base fields that the point state always holds: those of the balances.
const LEAST_BASE_ORDER: usize = 2;

/// Opens the laws and lowers every operator.
pub fn kernels(derivation: &mut Derivation) -> ModelKernels {
    let Derivation {
        graph,
        model,
        operators,
    } = derivation;
    let uniform = model.fields.map(|f| f.uniform);
    let assembler = Assembler {
        graph,
        opener: Opener::new(&model.laws, &model.base.closed, &uniform),
        model,
        operators,
        expressions: Vec::new(),
        base_order: LEAST_BASE_ORDER,
    };
    assembler.run()
}

pub(super) struct Assembler<'a> {
    pub(super) graph: &'a mut Graph,
    pub(super) opener: Opener<'a>,
    pub(super) model: &'a crate::model::Model,
    pub(super) operators: &'a crate::derive::Operators,
    /// Opened outputs of each real kernel.
    pub(super) expressions: Vec<(KernelId, Vec<Id>)>,
    pub(super) base_order: usize,
}

impl Assembler<'_> {
    fn open(&mut self, id: Id) -> Id {
        self.opener.at_base(self.graph, id)
    }

    fn kernel(&mut self, id: KernelId, outputs: Vec<Id>) {
        for node in self.graph.topological(&outputs) {
            if let Node::Base(_, order) = self.graph.node(node) {
                self.base_order = self.base_order.max(usize::from(*order));
            }
        }
        self.expressions.push((id, outputs));
    }

    /// Opens `ids` and makes them the outputs of a kernel.
    fn opened(&mut self, id: KernelId, ids: Vec<Id>) {
        let outputs = ids.into_iter().map(|id| self.open(id)).collect();
        self.kernel(id, outputs);
    }

    /// A residual and its derivative by each base jet it holds.
    fn with_jacobian(&mut self, residual: Id) -> (Vec<BaseJet>, Linearised<Id>) {
        let value = self.open(residual);
        let mut atoms = BTreeSet::new();
        for node in self.graph.topological(&[value]) {
            if let Node::Base(field, order) = self.graph.node(node) {
                atoms.insert((*field, *order));
            }
        }
        let slope = |&(field, order): &(FieldId, u8)| {
            self.graph
                .differentiate(value, Variable::Base(field, order))
        };
        let slopes = atoms.iter().map(slope).collect();
        let jet = |(field, order): (FieldId, u8)| BaseJet {
            field,
            order: usize::from(order),
        };
        let jets = atoms.into_iter().map(jet).collect();
        (jets, Linearised { value, slopes })
    }

    fn run(mut self) -> ModelKernels {
        let ends = match &self.model.interval {
            Some(interval) => vec![interval.lower, interval.upper],
            None => vec![self.graph.zero(), self.graph.one()],
        };
        self.kernel(KernelId::Interval, ends);
        let base = self.base();
        let operators = self.operators;
        self.opened(KernelId::Divisors, operators.divisors.to_vec());
        let linear = operators.linear.iter().map(|t| t.coefficient);
        self.opened(KernelId::Linear, linear.collect());
        let adjoint = operators.adjoint.iter().map(|t| t.coefficient);
        self.opened(KernelId::Adjoint, adjoint.collect());
        let (form_jets, form_coefficients) = self.nonlinear();
        let cases = operators.cases.ids().map(|case| self.case(case)).collect();
        let amplitude = self.amplitude();
        let outputs = self.outputs();
        self.closed();
        let residual_outputs = self.residuals();
        let residual_jets = residual_jets(self.graph, &residual_outputs);
        let forms = self.forms();
        let Programs { kernels, residuals } = self.lowered(&residual_outputs, &residual_jets);
        let structure = self.structure(Parts {
            base,
            form_jets,
            form_coefficients,
            cases,
            amplitude,
            outputs,
            residual_jets,
            operations: operations(&kernels, &forms),
        });
        let undeclared = operators.cases.pairs();
        let undeclared = undeclared.filter(|(_, case)| !case.undeclared.is_empty());
        ModelKernels {
            structure,
            kernels,
            forms,
            residuals,
            undeclared: undeclared
                .map(|(id, case)| (id, case.undeclared.clone()))
                .collect(),
        }
    }

    fn base(&mut self) -> BaseInfo {
        let (model, operators) = (self.model, self.operators);
        let mut outputs = Vec::new();
        let mut rows = Table::default();
        for row in &operators.base {
            let (jets, linearised) = self.with_jacobian(row.residual);
            let balance = row.balance;
            rows.push(BaseRowInfo { balance, jets });
            outputs.push(linearised);
        }
        self.kernel(KernelId::Base, layout::write_linearised(outputs));
        let mut outputs = Vec::new();
        let mut integrals = Vec::new();
        for &(integrand, value) in &operators.base_integrals {
            let (jets, linearised) = self.with_jacobian(integrand);
            integrals.push(jets);
            outputs.push((linearised, value));
        }
        self.kernel(KernelId::BaseIntegrals, layout::write_integrals(outputs));
        let mut guesses = Vec::new();
        for &field in &operators.solved {
            guesses.push(model.base.guesses[field].unwrap_or_else(|| self.graph.zero()));
        }
        self.kernel(KernelId::Guess, guesses);
        let mut conditions = Vec::new();
        let mut automatic = Vec::new();
        for (parameter, condition) in &model.base.automatic {
            let closed = &model.base.closed;
            let state = self.opener.at_state(self.graph, condition.residual);
            let value = self.graph.substitute(state, &mut |graph, node| match node {
                Node::Jet(jet) if jet.is_base() => Some(base_value(graph, closed, jet.of, jet.y)),
                Node::Jet(_) => Some(graph.zero()),
                _ => None,
            });
            conditions.push(value);
            automatic.push(AutomaticInfo {
                parameter: *parameter,
                end: condition.end,
            });
        }
        self.kernel(KernelId::Automatic, conditions);
        BaseInfo {
            solved: operators.solved.clone(),
            closed: model.base.closed.map(Option::is_some),
            rows,
            offsets: offsets(&operators.base_offsets),
            integrals,
            automatic,
        }
    }

    /// The distinct coefficients of N2, N3 and the jets they multiply.
    fn nonlinear(&mut self) -> (Vec<Jet>, usize) {
        let (jets, coefficients) = form_tables(&self.operators.nonlinear);
        let count = coefficients.len();
        self.opened(KernelId::Nonlinear, coefficients);
        (jets, count)
    }

    fn case(&mut self, id: CaseId) -> CaseInfo {
        let case = &self.operators.cases[id];
        let model = self.model;
        let base_check = |check: &BaseCheck| BaseCheckInfo {
            end: check.end,
            written: model.written(&check.location),
            line: model.line(&check.location),
        };
        CaseInfo {
            choices: case.choices.clone(),
            base_conditions: self.base_conditions(id, case),
            base_checks: case.base_checks.iter().map(base_check).collect(),
            conditions: self.conditions(id, case),
            adjoint: self.adjoint_conditions(id, case),
            closures: self.closures(id, case),
        }
    }

    fn base_conditions(&mut self, id: CaseId, case: &Case) -> Vec<BaseConditionInfo> {
        let (mut infos, mut outputs) = (Vec::new(), Vec::new());
        for condition in &case.base_conditions {
            let (jets, linearised) = self.with_jacobian(condition.residual);
            let end = condition.end;
            infos.push(BaseConditionInfo { end, jets });
            outputs.push(linearised);
        }
        let outputs = layout::write_linearised(outputs);
        self.kernel(KernelId::BaseConditions(id), outputs);
        infos
    }

    fn conditions(&mut self, id: CaseId, case: &Case) -> Vec<ConditionInfo> {
        let (mut infos, mut coefficients) = (Vec::new(), Vec::new());
        for condition in &case.conditions {
            coefficients.push(condition.form.terms.values().copied().collect());
            let monomials = condition.form.terms.keys().cloned().collect();
            infos.push(ConditionInfo {
                end: condition.end,
                monomials,
            });
        }
        let coefficients = layout::write_conditions(coefficients);
        self.opened(KernelId::Conditions(id), coefficients);
        infos
    }

    fn adjoint_conditions(
        &mut self,
        id: CaseId,
        case: &Case,
    ) -> Result<Vec<AdjointConditionInfo>, String> {
        let mut coefficients = Vec::new();
        let infos = case.adjoint.clone().map(|conditions| {
            let mut infos = Vec::new();
            for condition in conditions {
                let (mut jets, mut weights) = (Vec::new(), Vec::new());
                for (jet, symbol) in condition.combination {
                    for ((x, absx), weight) in symbol {
                        jets.push(Jet { x, absx, ..jet });
                        weights.push(weight);
                    }
                }
                coefficients.push(weights);
                infos.push(AdjointConditionInfo {
                    end: condition.end,
                    jets,
                });
            }
            infos
        });
        let coefficients = layout::write_conditions(coefficients);
        self.opened(KernelId::AdjointConditions(id), coefficients);
        infos
    }

    fn closures(&mut self, id: CaseId, case: &Case) -> Vec<ClosureInfo> {
        let (mut infos, mut coefficients) = (Vec::new(), Vec::new());
        for closure in &case.closures {
            let one = self.graph.one();
            let mean = |field: FieldId| vec![(Jet::value(field), one)];
            let (kind, field, density, column) = match closure.clone() {
                CaseClosure::Conserved { density, column } => {
                    (ClosureKind::Conserved, None, density.linear, column)
                }
                CaseClosure::Claimed { density, column } => {
                    (ClosureKind::Claimed, None, density.linear, column)
                }
                CaseClosure::Gauge { field, column } => {
                    (ClosureKind::Gauge, Some(field), mean(field), column)
                }
                CaseClosure::Drift { field, column } => {
                    (ClosureKind::Drift, Some(field), mean(field), column)
                }
                CaseClosure::Unknown { field, density } => {
                    let column = Vec::new();
                    (ClosureKind::Unknown, Some(field), density.linear, column)
                }
            };
            coefficients.push(layout::ClosureWeights {
                density: density.iter().map(|(_, id)| *id).collect(),
                column: column.iter().map(|(_, id)| *id).collect(),
            });
            infos.push(ClosureInfo {
                kind,
                field,
                density: density.into_iter().map(|(jet, _)| jet).collect(),
                column: column.into_iter().map(|(row, _)| row).collect(),
            });
        }
        let coefficients = layout::write_closures(coefficients);
        self.opened(KernelId::Closures(id), coefficients);
        infos
    }

    fn amplitude(&mut self) -> AmplitudeInfo {
        let (measure, weighted, field) = match &self.model.amplitude {
            Amplitude::Integral { weights, value, .. } => {
                let measure = Measure::Integral {
                    weights: weights.iter().map(|w| w.weight).collect(),
                    value: *value,
                };
                (measure, weights.iter().map(|w| w.field).collect(), None)
            }
            Amplitude::Point {
                field,
                place,
                value,
                ..
            } => {
                let measure = Measure::Point {
                    value: *value,
                    place: place.unwrap_or_else(|| self.graph.zero()),
                };
                (measure, Vec::new(), Some(*field))
            }
        };
        self.kernel(KernelId::Amplitude, layout::write_measure(measure));
        AmplitudeInfo {
            weighted,
            field,
            description: self.describe_amplitude(),
        }
    }

    fn describe_amplitude(&self) -> String {
        let (fields, coordinate) = (self.model.field_names(), self.model.coordinate());
        match &self.model.amplitude {
            Amplitude::Integral {
                weights, written, ..
            } => {
                let terms = weights.iter().map(|weight| {
                    let square = format!("|{}|²", fields[weight.field]);
                    match weight.written.as_str() {
                        "" => square,
                        factor => format!("{factor} {square}"),
                    }
                });
                let sum = terms.collect::<Vec<_>>().join(" + ");
                if self.model.interval.is_some() {
                    format!("∫ ({sum}) d{coordinate} = {written}")
                } else {
                    format!("{sum} = {written}")
                }
            }
            Amplitude::Point {
                field,
                place,
                written: [at, value],
                ..
            } => match (place, &self.model.interval) {
                (Some(_), Some(_)) => format!("|{}({at})| = {value}", fields[*field]),
                _ => format!("|{}| = {value}", fields[*field]),
            },
        }
    }

    fn outputs(&mut self) -> Vec<OutputInfo> {
        let mut coefficients = Vec::new();
        let mut infos = Vec::new();
        for (output, form) in self.model.outputs.iter().zip(&self.operators.outputs) {
            coefficients.push(layout::OutputTerms {
                place: output.place.unwrap_or_else(|| self.graph.zero()),
                coefficients: form.terms.values().copied().collect(),
            });
            infos.push(OutputInfo {
                name: output.name.clone(),
                doc: output.doc.clone(),
                at_point: output.place.is_some(),
                monomials: form.terms.keys().cloned().collect(),
            });
        }
        self.opened(KernelId::Outputs, layout::write_outputs(coefficients));
        infos
    }
}
