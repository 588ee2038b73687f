//! Checked model → operators: expansion, L, L† with its boundary conditions, N2, N3.
//!
//! Each pass is a function from one type to the next; [`derive()`] shows the whole of it.

mod base;
mod base_wall;
mod boundary;
mod case;
mod check;
mod closure;
mod density;
mod expand;
mod invariant;
mod linear;
mod mean;
mod offsets;
mod open;
mod pairing;
mod parity;
mod regular;
mod value;
mod wall;

pub use base::BaseRow;
pub use base_wall::BaseCheck;
pub use boundary::{Combination, Symbol};
pub use case::{AdjointCondition, Case};
pub use closure::CaseClosure;
pub use density::Density;
pub use linear::{AdjointTerm, DirectTerm, Term};
pub use offsets::Offsets;
pub use open::{Dependence, Opener, carry_out, dependence};
pub use parity::Parity;
pub use value::base_value;
pub use wall::{BaseCondition, WallCondition};

use crate::diagnostic::{Diagnostic, Diagnostics, Location};
use crate::form::Form;
use crate::graph::{BalanceId, CaseId, FieldId, Graph, Id, ParameterId, Rational, Table};
use crate::model::Model;
use base::BaseProblem;
use expand::{Expander, Inexpandable};
use landau_contract::{BaseRowId, SolvedId};
use num_traits::One;

/// More cases of structural switches than any model needs.
const MOST_CASES: usize = 256;

/// A model and what follows from it.
pub struct Derivation {
    /// What was derived from.
    pub model: Model,
    /// What was derived.
    pub operators: Operators,
}

/// Everything that follows from a model by symbolic derivation; laws still opaque.
pub struct Operators {
    /// Truncation order of the expansion.
    pub order: usize,
    /// M ∂t X − R of each balance, expanded, not divided.
    pub balances: Table<BalanceId, Form>,
    /// What each balance is divided by (1 where the spec says nothing).
    pub divisors: Table<BalanceId, Id>,
    /// L and M0, divided.
    pub linear: Vec<DirectTerm>,
    /// L† and M0†.
    pub adjoint: Vec<AdjointTerm>,
    /// N2, N3, … : `nonlinear[d − 2][row]`, divided, on the right-hand side.
    pub nonlinear: Vec<Table<BalanceId, Form>>,
    /// Values and points of L's fields and balances.
    pub offsets: Offsets<BalanceId, FieldId>,
    /// Values and points of L†.
    pub adjoint_offsets: Offsets<FieldId, BalanceId>,
    /// The field that each balance determines.
    pub pairing: Table<BalanceId, FieldId>,
    /// Odd fields and balances, where the model has the mirror symmetry.
    pub parity: Option<Parity>,
    /// Balances that determine the base state, or have to hold for it.
    pub base: Table<BaseRowId, BaseRow>,
    /// Points of `base` and values of `solved`.
    pub base_offsets: Offsets<BaseRowId, SolvedId>,
    /// Fields that the base state is solved for, numbers last.
    pub solved: Table<SolvedId, FieldId>,
    /// Integral conditions of the base state: integrand and value.
    pub base_integrals: Vec<(Id, Id)>,
    /// Switches that change boundary conditions.
    pub switches: Vec<ParameterId>,
    /// One for each combination of their choices.
    pub cases: Table<CaseId, Case>,
    /// Output functionals, expanded.
    pub outputs: Vec<Form>,
}

/// Derives all operators to the given order.
///
/// # Errors
/// What the form of the model does not allow, with its place in the spec.
pub fn derive(mut model: Model, order: usize) -> Result<Derivation, Diagnostics> {
    let mut mistakes = Vec::new();
    let mut graph = std::mem::take(&mut model.graph);
    let operators = Deriver::new(&model, &mut graph, order).run(&mut mistakes);
    model.graph = graph;
    match operators {
        Some(operators) if mistakes.is_empty() => Ok(Derivation { model, operators }),
        _ => Err(Diagnostics {
            files: model.sources,
            list: mistakes,
        }),
    }
}

/// The passes' common surroundings.
pub(crate) struct Deriver<'a> {
    pub model: &'a Model,
    pub graph: &'a mut Graph,
    pub order: usize,
    pub uniform: Table<FieldId, bool>,
    pub dependence: Dependence,
}

impl<'a> Deriver<'a> {
    fn new(model: &'a Model, graph: &'a mut Graph, order: usize) -> Self {
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

    fn run(mut self, mistakes: &mut Vec<Diagnostic>) -> Option<Operators> {
        let model = self.model;
        let profiles = model.profiles().count();
        if !self.check_counts(profiles, mistakes) {
            return None;
        }
        // expansion
        let mut balances: Table<BalanceId, Form> = Table::default();
        for balance in &model.balances {
            balances.extend(self.expand(balance.residual, &balance.location, mistakes));
        }
        if balances.len() < model.balances.len() {
            return None;
        }
        let divisors = self.divisors(mistakes)?;
        let divided: Table<BalanceId, Form> = balances
            .iter()
            .zip(&divisors)
            .map(|(form, &divisor)| {
                let inverse = self.graph.pow(divisor, -Rational::one());
                form.times(self.graph, inverse).collected(self.graph)
            })
            .collect();
        self.check_orders(&divided, mistakes);
        // operators
        let linear = linear::linear_operator(self.graph, &divided);
        let mut adjoint = linear::adjoint_operator(self.graph, &linear);
        // An unknown number has no adjoint equation of its own: its condition is an integral.
        adjoint.retain(|term| !self.uniform[term.row]);
        let nonlinear = (2..=self.order)
            .map(|d| self.nonlinear(&divided, d))
            .collect();
        let given = model.balances.map(|b| b.paired_field);
        let Some(pairing) = pairing::pair(&linear, profiles, &given) else {
            let place = model.balances[BalanceId(0)].location.clone();
            let message = "the balances cannot be paired with the fields";
            mistakes.push(Diagnostic::new(
                place,
                message,
                "one balance for each field",
            ));
            return None;
        };
        self.check_determined(&linear, mistakes);
        let (offsets, adjoint_offsets) = self.offsets(&linear, &adjoint, profiles, mistakes)?;
        // base state
        let problem = self.base_problem(&balances, mistakes)?;
        let BaseProblem {
            rows: base,
            solved,
            offsets: base_offsets,
            integrals: base_integrals,
            conditions,
        } = problem;
        // boundary conditions, adjoint conditions, closures: one set for each case of the switches
        let switches = self.switches();
        let mut cases: Table<CaseId, Case> = Table::default();
        for choices in self.choices(&switches, mistakes)? {
            let problem = wall::CaseProblem {
                balances: &balances,
                walls: &[],
                linear: &linear,
                adjoint: &adjoint,
                divisors: &divisors,
                needed: offsets.conditions,
                pairing: &pairing,
                solved: &solved,
                switches: &switches,
                base_conditions: conditions,
            };
            cases.extend(case::derive(&mut self, problem, choices, mistakes));
        }
        closure::drop_refuted(&mut cases);
        case::check_conserved(&self, &cases, mistakes);
        let integrals = cases.iter().flat_map(|c| &c.closures);
        let integrals = integrals.filter_map(CaseClosure::density);
        let integrals: Vec<Form> = integrals.map(Density::averaged).collect();
        let walls = cases.iter().flat_map(|c| &c.conditions);
        let conditions = walls
            .map(|wall| &wall.form)
            .chain(&integrals)
            .collect::<Vec<_>>();
        let parity = parity::parity(&balances, &conditions, self.uniform.len());
        let outputs: Vec<Form> = model
            .outputs
            .iter()
            .filter_map(|o| self.expand(o.body, &o.location, mistakes))
            .collect();
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
            base,
            base_offsets,
            solved,
            base_integrals,
            switches,
            cases,
            outputs,
        })
    }

    /// How L and L† are collocated.
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
        let found = direct.zip(mirrored);
        if found.is_none() {
            let message = "the balances do not determine the fields";
            let expected = "balances that can be solved for one field each";
            let place = self.model.balances[BalanceId(0)].location.clone();
            mistakes.push(Diagnostic::new(place, message, expected));
        }
        found
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

    /// The form, if all its coefficients have values once the laws are put in.
    ///
    /// The expansion keeps laws opaque, so it does not see that the slope of √n is infinite where n⁰ = 0.
    fn with_values(&mut self, form: Form) -> Result<Form, Inexpandable> {
        let coefficients: Vec<Id> = form.terms.values().copied().collect();
        let is_undefined = self.aside(|deriver| {
            let (laws, closed) = (&deriver.model.laws, &deriver.model.base.closed);
            let mut opener = Opener::new(laws, closed, &deriver.uniform);
            coefficients.into_iter().any(|id| {
                let opened = opener.at_base(deriver.graph, id);
                deriver.graph.is_undefined(opened)
            })
        });
        if is_undefined {
            return Err(Inexpandable {
                reason: "a law has no value or no derivative there".to_owned(),
                remedy: Some(
                    "the law holds a root, a quotient, a logarithm or a power with a parameter in its exponent of something that vanishes in the base state",
                ),
            });
        }
        Ok(form)
    }

    /// The result of an analysis that leaves no expression behind: what is derived later does not depend on it.
    pub(super) fn aside<R>(&mut self, analysis: impl FnOnce(&mut Self) -> R) -> R {
        let graph = self.graph.clone();
        let result = analysis(self);
        *self.graph = graph;
        result
    }

    /// Whether an expression of the base state vanishes, with its laws opaque or, where the base state is given
    /// in closed form, by what they are.
    pub fn vanishes_opened(&mut self, id: Id) -> bool {
        if self.graph.vanishes(id) {
            return true;
        }
        let (laws, closed) = (&self.model.laws, &self.model.base.closed);
        let opened = Opener::new(laws, closed, &self.uniform).at_base(self.graph, id);
        self.graph.vanishes(opened)
    }

    /// What each balance is divided by: 1 if the spec says nothing.
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
