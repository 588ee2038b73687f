//! The last pass: opened outputs, residuals and polarised forms → straight-line kernels.

use super::Lowering;
use super::assemble::Assembler;
use super::polarise::{form_tables, polarise};
use crate::derive::{CaseClosure, base_value};
use crate::graph::{Graph, Id, Node};
use landau_contract::*;
use std::collections::{BTreeSet, HashMap};

/// Straight-line programs, each with the name by which the solver asks for it.
pub(super) struct Programs {
    /// Of the operators, over the point state.
    pub kernels: Vec<(KernelId, Kernel)>,
    /// Of the unexpanded residuals, over the point state and the jets of the full state.
    pub residuals: Vec<(ResidualId, Kernel)>,
}

impl Assembler<'_> {
    /// The base fields that the spec gives in closed form, to the same order as those that are solved for.
    pub(super) fn closed(&mut self) {
        let zero = self.graph.zero();
        let mut closed = Vec::new();
        for field in self.model.fields.ids() {
            for order in 0..=self.base_order {
                closed.push(match self.model.base.closed[field] {
                    Some(_) => base_value(self.graph, &self.model.base.closed, field, order as u8),
                    None => zero,
                });
            }
        }
        self.expressions.push((KernelId::Closed, closed));
    }

    /// Lowers the operators and the residuals.
    pub(super) fn lowered(
        &self,
        residuals: &[(ResidualId, Vec<Id>)],
        residual_jets: &[Jet],
    ) -> Programs {
        let (parameters, fields) = (self.model.parameters.len(), self.model.fields.len());
        let state = StateLayout::new(parameters, fields, self.base_order);
        let at_base = |node: &Node| match node {
            Node::Coordinate => Some((0, state.coordinate())),
            Node::Wavenumber => Some((0, state.wavenumber())),
            Node::Parameter(index) => Some((0, state.parameter(*index))),
            Node::Base(field, order) => Some((0, state.base(*field, usize::from(*order)))),
            _ => None,
        };
        let at_state = |node: &Node| match node {
            Node::Base(..) => None,
            Node::Jet(jet) => residual_jets.iter().position(|j| j == jet).map(|p| (1, p)),
            leaf => at_base(leaf),
        };
        let lower =
            |inputs: &[Array], locate: &dyn Fn(&Node) -> Option<(usize, usize)>, ids: &[Id]| {
                let inputs = inputs.to_vec();
                Lowering { inputs, locate }.lower(self.graph, ids)
            };
        let kernels = self.expressions.iter();
        let kernels = kernels.map(|(id, ids)| (*id, lower(&RESIDUAL_INPUTS[..1], &at_base, ids)));
        let residuals = residuals.iter();
        let residuals = residuals.map(|(id, ids)| (*id, lower(&RESIDUAL_INPUTS, &at_state, ids)));
        Programs {
            kernels: kernels.collect(),
            residuals: residuals.collect(),
        }
    }

    /// The unexpanded residuals in the fields' derivatives, laws opened.
    pub(super) fn residuals(&mut self) -> Vec<(ResidualId, Vec<Id>)> {
        let mut residuals = Vec::new();
        let balances: Vec<Id> = self.model.balances.iter().map(|b| b.residual).collect();
        let opened = balances
            .into_iter()
            .map(|id| self.opener.at_state(self.graph, id))
            .collect();
        residuals.push((ResidualId::Balances, opened));
        for (id, case) in self.operators.cases.pairs() {
            let mut opened = Vec::new();
            for condition in &case.conditions {
                opened.push(self.opener.at_state(self.graph, condition.residual));
            }
            residuals.push((ResidualId::Conditions(id), opened));
            let mut opened = Vec::new();
            for check in &case.base_checks {
                opened.push(self.opener.at_state(self.graph, check.residual));
            }
            residuals.push((ResidualId::BaseChecks(id), opened));
            if let Some(densities) = self.densities(id) {
                residuals.push((ResidualId::Integrals(id), densities));
            }
        }
        residuals
    }

    /// The densities of a case's closures, laws opened. `None` if all are linear in the perturbation: the weights of
    /// [`KernelId::Closures`] hold them then.
    fn densities(&mut self, case: CaseId) -> Option<Vec<Id>> {
        let closures = &self.operators.cases[case].closures;
        let mut densities = closures.iter().filter_map(CaseClosure::density);
        if !densities.any(|density| density.is_nonlinear) {
            return None;
        }
        let integrands = closures.iter().map(|closure| match closure {
            CaseClosure::Gauge { field, .. } | CaseClosure::Drift { field, .. } => {
                self.graph.jet(Jet::value(*field))
            }
            CaseClosure::Conserved { density, .. }
            | CaseClosure::Claimed { density, .. }
            | CaseClosure::Unknown { density, .. } => {
                self.opener.at_state(self.graph, density.integrand)
            }
        });
        Some(integrands.collect())
    }

    pub(super) fn forms(&mut self) -> Vec<Table<BalanceId, Option<Kernel>>> {
        let (jets, coefficients) = form_tables(&self.operators.nonlinear);
        let position: HashMap<Id, usize> = coefficients
            .iter()
            .enumerate()
            .map(|(i, id)| (*id, i))
            .collect();
        const NAMES: [&str; 8] = ["x", "y", "z", "w", "v", "u", "s", "r"];
        let mut kernels = Vec::new();
        for (index, rows) in self.operators.nonlinear.iter().enumerate() {
            let degree = index + 2;
            let mut line = Table::default();
            for form in rows {
                if form.terms.is_empty() {
                    line.push(None);
                    continue;
                }
                let polar = polarise(self.graph, form, degree, &jets, &position);
                let mut inputs = vec![Array {
                    name: "c",
                    real: true,
                }];
                inputs.extend(
                    NAMES[..degree]
                        .iter()
                        .map(|&name| Array { name, real: false }),
                );
                let locate = |node: &Node| match node {
                    Node::Slot(array, position) => Some((*array, *position)),
                    _ => None,
                };
                line.push(Some(
                    Lowering {
                        inputs,
                        locate: &locate,
                    }
                    .lower(self.graph, &[polar]),
                ));
            }
            kernels.push(line);
        }
        kernels
    }
}

pub(super) fn residual_jets(graph: &Graph, residuals: &[(ResidualId, Vec<Id>)]) -> Vec<Jet> {
    let roots = residuals.iter().flat_map(|(_, ids)| ids.iter().copied());
    jets(graph, &roots.collect::<Vec<Id>>())
}

/// The derivatives of fields that expressions hold.
pub(crate) fn jets(graph: &Graph, roots: &[Id]) -> Vec<Jet> {
    let nodes = graph.topological(roots).into_iter();
    let jets = nodes.filter_map(|node| match graph.node(node) {
        Node::Jet(jet) => Some(*jet),
        _ => None,
    });
    jets.collect::<BTreeSet<Jet>>().into_iter().collect()
}

/// Operations of the kernels of the operators: as written, and after sharing.
pub(super) fn operations(
    kernels: &[(KernelId, Kernel)],
    forms: &[Table<BalanceId, Option<Kernel>>],
) -> [usize; 2] {
    let count = |of: fn(&Kernel) -> usize| -> usize {
        let real = kernels.iter().map(|(_, kernel)| of(kernel));
        let real = real.fold(0, usize::saturating_add);
        real.saturating_add(forms.iter().flatten().flatten().map(of).sum())
    };
    [count(|kernel| kernel.unshared), count(Kernel::shared)]
}
