//! The passes in their order, and the state that they share.

use super::expand::{Expander, Inexpandable};
use super::open::{self, Dependence, Opener};
use super::{AdjointTerm, Case, CaseClosure, Density, DirectTerm, Offsets, Operators, Parity};
use super::{case, closure, linear, offsets, pairing, parity, wall};
use crate::diagnostic::{Diagnostic, Location};
use crate::form::Form;
use crate::graph::{BalanceId, CaseId, FieldId, Graph, Id, Node, ParameterId, Rational, Table};
use crate::model::Model;
use num_traits::One;

/// Limit on the cases of structural switches; no model comes near it.
const MOST_CASES: usize = 256;

/// What a law must not hold.
const LAW_REMEDY: &str = "the law may hold no root, quotient, logarithm or power with a parameter in its exponent of something that vanishes in the base state";

/// The model, its graph, and tables that all passes read.
pub(crate) struct Deriver<'a> {
    pub model: &'a Model,
    pub graph: &'a mut Graph,
    pub order: usize,
    pub uniform: Table<FieldId, bool>,
    pub dependence: Dependence,
}

impl<'a> Deriver<'a> {
    pub(super) fn new(model: &'a Model, graph: &'a mut Graph, order: usize) -> Self {
        let uniform = model.fields.map(|f| f.uniform);
        let dependence = open::dependence(graph, &model.laws, uniform.len());
        Deriver {
            model,
            graph,
            order,
            uniform,
            dependence,
        }
    }

    pub(super) fn run(mut self, mistakes: &mut Vec<Diagnostic>) -> Option<Operators> {
        let model = self.model;
        let profiles = model.profiles().count();
        if !self.check_counts(profiles, mistakes) {
            return None;
        }
        let balances = self.balances(mistakes)?;
        let divisors = self.divisors(mistakes)?;
        let divided = self.divided(&balances, &divisors);
        self.check_orders(&divided, mistakes);
        let linear = linear::linear_operator(self.graph, &divided);
        let mut adjoint = linear::adjoint_operator(self.graph, &linear);
        // An unknown number has no adjoint equation: its condition is an integral.
        adjoint.retain(|term| !self.uniform[term.row]);
        let nonlinear = (2..=self.order)
            .map(|d| self.nonlinear(&divided, d))
            .collect();
        let pairing = self.pairing(&linear, profiles, mistakes)?;
        self.check_determined(&linear, mistakes);
        let (offsets, adjoint_offsets) = self.offsets(&linear, &adjoint, profiles, mistakes)?;
        let base = self.base_problem(&balances, mistakes)?;
        let switches = self.switches();
        let problem = wall::CaseProblem {
            balances: &balances,
            walls: &[],
            linear: &linear,
            adjoint: &adjoint,
            divisors: &divisors,
            needed: offsets.conditions,
            pairing: &pairing,
            solved: &base.solved,
            switches: &switches,
            base_conditions: base.conditions,
        };
        let cases = self.cases(problem, mistakes)?;
        let parity = self.parity(&balances, &cases);
        let outputs = self.outputs(mistakes);
        Some(Operators {
            order: self.order,
            balances,
            divisors,
            linear,
            adjoint,
            nonlinear,
            offsets,
            adjoint_offsets,
            pairing,
            parity,
            base: base.rows,
            base_offsets: base.offsets,
            solved: base.solved,
            base_integrals: base.integrals,
            switches,
            cases,
            outputs,
        })
    }

    /// Every balance expanded around the base state.
    fn balances(&mut self, mistakes: &mut Vec<Diagnostic>) -> Option<Table<BalanceId, Form>> {
        let model = self.model;
        let mut balances: Table<BalanceId, Form> = Table::default();
        for balance in &model.balances {
            balances.extend(self.expand(balance.residual, &balance.location, mistakes));
        }
        (balances.len() == model.balances.len()).then_some(balances)
    }

    fn divided(
        &mut self,
        balances: &Table<BalanceId, Form>,
        divisors: &Table<BalanceId, Id>,
    ) -> Table<BalanceId, Form> {
        let pairs = balances.iter().zip(divisors);
        pairs
            .map(|(form, &divisor)| {
                let inverse = self.graph.pow(divisor, -Rational::one());
                form.times(self.graph, inverse).collected(self.graph)
            })
            .collect()
    }

    /// The field that each balance determines.
    fn pairing(
        &self,
        linear: &[DirectTerm],
        profiles: usize,
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<Table<BalanceId, FieldId>> {
        let given = self.model.balances.map(|b| b.paired_field);
        let pairing = pairing::pair(linear, profiles, &given);
        if pairing.is_none() {
            mistakes.push(Diagnostic::new(
                self.model.balances[BalanceId(0)].location.clone(),
                "the balances cannot be paired with the fields",
                "one balance for each field",
            ));
        }
        pairing
    }

    /// Boundary conditions, adjoint conditions and closures: one set for each choice of the switches.
    fn cases(
        &mut self,
        problem: wall::CaseProblem,
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<Table<CaseId, Case>> {
        let mut cases: Table<CaseId, Case> = Table::default();
        for choices in self.choices(problem.switches, mistakes)? {
            cases.extend(case::derive(self, problem, choices, mistakes));
        }
        closure::drop_refuted(&mut cases);
        if mistakes.is_empty() {
            case::check_conserved(self, &cases, mistakes);
        }
        Some(cases)
    }

    fn parity(&self, balances: &Table<BalanceId, Form>, cases: &[Case]) -> Option<Parity> {
        let closures = cases.iter().flat_map(|case| &case.closures);
        let integrals: Vec<Form> = closures
            .filter_map(CaseClosure::density)
            .map(Density::averaged)
            .collect();
        let walls = cases.iter().flat_map(|case| &case.conditions);
        let conditions: Vec<&Form> = walls.map(|wall| &wall.form).chain(&integrals).collect();
        parity::parity(balances, &conditions, self.uniform.len())
    }

    fn outputs(&mut self, mistakes: &mut Vec<Diagnostic>) -> Vec<Form> {
        let outputs = self.model.outputs.iter();
        outputs
            .filter_map(|output| self.expand(output.body, &output.location, mistakes))
            .collect()
    }

    /// The numbers of points and values of L and L†.
    fn offsets(
        &self,
        linear: &[DirectTerm],
        adjoint: &[AdjointTerm],
        profiles: usize,
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<(Offsets<BalanceId, FieldId>, Offsets<FieldId, BalanceId>)> {
        let balances = self.model.balances.len();
        let direct = offsets::offsets(&offsets::orders(linear, balances, profiles));
        let mirrored = offsets::offsets(&offsets::orders(adjoint, profiles, balances));
        let both = direct.zip(mirrored);
        if both.is_none() {
            let message = "the balances do not determine the fields";
            let expected = "balances that can be solved for one field each";
            let place = self.model.balances[BalanceId(0)].location.clone();
            mistakes.push(Diagnostic::new(place, message, expected));
        }
        both
    }

    /// The expansion of an expression, or a mistake at `place`.
    pub fn expand(
        &mut self,
        id: Id,
        place: &Location,
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<Form> {
        let mut expander = Expander::new(
            self.order,
            &self.model.base.closed,
            &self.uniform,
            &self.dependence,
        );
        let expansion = expander
            .expand(self.graph, id)
            .and_then(|form| self.with_values(form));
        match expansion {
            Ok(form) => Some(form),
            Err(Inexpandable { reason, remedy }) => {
                let message = format!("there is no expansion around the base state: {reason}");
                let expected = "an expression that is smooth at the base state";
                mistakes.push(
                    Diagnostic::new(place.clone(), message, expected)
                        .maybe_hint(remedy.map(str::to_owned)),
                );
                None
            }
        }
    }

    /// The base-state value of an expression of the full state, or a mistake at `place`.
    pub fn base_part(
        &mut self,
        id: Id,
        place: &Location,
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<Id> {
        let mut expander =
            Expander::new(0, &self.model.base.closed, &self.uniform, &self.dependence);
        let expansion = expander
            .expand(self.graph, id)
            .and_then(|form| self.with_values(form));
        match expansion {
            Ok(form) => Some(form.base(self.graph)),
            Err(Inexpandable { reason, remedy }) => {
                let message = format!("this has no value in the base state: {reason}");
                let expected = "an expression that is finite at the base state";
                mistakes.push(
                    Diagnostic::new(place.clone(), message, expected)
                        .maybe_hint(remedy.map(str::to_owned)),
                );
                None
            }
        }
    }

    /// The form, if all its coefficients are defined once the laws are opened: none holds 1/0 or ln 0.
    ///
    /// The expansion keeps laws opaque, so it does not see that the slope of √n is infinite where n⁰ = 0.
    fn with_values(&mut self, form: Form) -> Result<Form, Inexpandable> {
        let coefficients: Vec<Id> = form.terms.values().copied().collect();
        match self.aside(|deriver| deriver.without_value(&coefficients)) {
            Some(trouble) => Err(trouble),
            None => Ok(form),
        }
    }

    /// Why some coefficient is undefined once the laws are opened; `None` if all are defined.
    fn without_value(&mut self, coefficients: &[Id]) -> Option<Inexpandable> {
        let (laws, closed) = (&self.model.laws, &self.model.base.closed);
        let mut opener = Opener::new(laws, closed, &self.uniform);
        let coefficient = coefficients.iter().copied().find(|&id| {
            let opened = opener.at_base(self.graph, id);
            self.graph.is_undefined(opened)
        })?;
        let mut trouble = Inexpandable::from("a coefficient is infinite there");
        for node in self.graph.topological(&[coefficient]) {
            if let Node::BaseLaw(atom) = self.graph.node(node).clone() {
                let name = &laws[atom.law].name;
                let opened = opener.at_base(self.graph, node);
                if self.graph.is_undefined(opened) {
                    return Some(Inexpandable {
                        reason: format!("the law `{name}` has no value or no derivative there"),
                        remedy: Some(LAW_REMEDY),
                    });
                }
                if self.graph.vanishes(opened) {
                    trouble.reason =
                        format!("it divides by the law `{name}`, which vanishes there");
                }
            }
        }
        Some(trouble)
    }

    /// Runs an analysis whose expressions are dropped, so that operators derived later do not depend on it.
    pub(super) fn aside<R>(&mut self, analysis: impl FnOnce(&mut Self) -> R) -> R {
        let graph = self.graph.clone();
        let result = analysis(self);
        *self.graph = graph;
        result
    }

    /// Whether an expression of the base state vanishes: with opaque laws or, if the base state has a closed form, with
    /// opened laws.
    pub fn vanishes_opened(&mut self, id: Id) -> bool {
        if self.graph.vanishes(id) {
            return true;
        }
        let (laws, closed) = (&self.model.laws, &self.model.base.closed);
        let opened = Opener::new(laws, closed, &self.uniform).at_base(self.graph, id);
        self.graph.vanishes(opened)
    }

    /// The divisor of each balance; 1 if the spec gives none.
    fn divisors(&mut self, mistakes: &mut Vec<Diagnostic>) -> Option<Table<BalanceId, Id>> {
        let mut divisors = Table::default();
        for balance in &self.model.balances {
            let divisor = match balance.divisor {
                Some(divisor) => self.base_part(divisor, &balance.location, mistakes)?,
                None => self.graph.one(),
            };
            if self.aside(|deriver| deriver.vanishes_opened(divisor)) {
                let message = format!("`{}` is divided by zero", balance.name);
                let expected = "a divisor that does not vanish in the base state";
                mistakes.push(Diagnostic::new(balance.location.clone(), message, expected));
                return None;
            }
            divisors.push(divisor);
        }
        Some(divisors)
    }

    fn nonlinear(
        &mut self,
        divided: &Table<BalanceId, Form>,
        degree: usize,
    ) -> Table<BalanceId, Form> {
        let minus = -Rational::one();
        divided
            .iter()
            .map(|form| {
                let mut negated = Form::default();
                negated.add(self.graph, &form.degree(degree), &minus);
                negated
            })
            .collect()
    }

    /// Switches that guard boundary conditions.
    fn switches(&self) -> Vec<ParameterId> {
        let conditions = self
            .model
            .boundary
            .iter()
            .chain(&self.model.base.conditions);
        let mut switches: Vec<ParameterId> = conditions
            .flat_map(|c| c.guard.iter().map(|(switch, _)| *switch))
            .collect();
        switches.sort_unstable();
        switches.dedup();
        switches
    }

    fn choices(
        &self,
        switches: &[ParameterId],
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<Vec<Vec<usize>>> {
        let mut all = vec![Vec::new()];
        for &switch in switches {
            let count = self.model.parameters[switch].choices.len();
            all = all
                .into_iter()
                .flat_map(|head: Vec<usize>| {
                    (0..count).map(move |choice| [head.as_slice(), &[choice]].concat())
                })
                .collect();
            if all.len() > MOST_CASES {
                let place = self.model.parameters[switch].location.clone();
                let message = "the switches make too many combinations of boundary conditions";
                mistakes.push(Diagnostic::new(
                    place,
                    message,
                    format!("at most {MOST_CASES}"),
                ));
                return None;
            }
        }
        Some(all)
    }
}
