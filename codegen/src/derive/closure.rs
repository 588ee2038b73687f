//! The closures of the problem at k = 0: conserved integrals, gauges, unknown numbers.
//!
//! An integral is conserved to first order if some ℓ(y) with M0†ℓ = (its linear density) obeys L†ℓ = 0 at k = 0 and
//! makes the boundary form vanish: then d/dt ∫ density = ∫ ℓ M0 ∂t X = ∫ ℓ L X = 0. We look for ℓ and never take a claim
//! of the spec for granted. Balances without mass (continuity) leave components of ℓ open. If ℓ cannot be had with these
//! components zero, the claim goes to the solver, which decides it for the collocated problem. Beyond first order the
//! multiplier decides, which has to vanish.

use super::Case;
use super::density::Density;
use super::deriver::Deriver;
use super::gauge::{check_declared, gauge};
use super::invariant::{Proof, end_rules};
use super::linear::DirectTerm;
use super::mean::{carried, conserved, mean_walls, multiplier};
use super::wall::{BaseRules, CaseProblem, reduced};
use crate::diagnostic::Diagnostic;
use crate::graph::{BalanceId, FieldId, Id, Table};
use crate::model::{Balance, Closure, End, Integral};

/// A bordering of the problem at k = 0. Integrals keep the value that they have in the base state.
#[derive(Clone, Debug)]
pub enum CaseClosure {
    /// ∫ density is kept; the multiplier enters the balances with the weights of `column`.
    Conserved {
        /// What is integrated.
        density: Density,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(BalanceId, Id)>,
    },
    /// An integral that the spec claims to be conserved and that no proof can decide. The solver looks for it in the
    /// collocated problem, and drops it if it is not conserved there.
    Claimed {
        /// What is integrated.
        density: Density,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(BalanceId, Id)>,
    },
    /// The constant of a field is arbitrary: ∫ field = 0.
    Gauge {
        /// The field whose constant is arbitrary.
        field: FieldId,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(BalanceId, Id)>,
    },
    /// The constant of a field with a time derivative is arbitrary, and may drift: ∫ field = 0, and the
    /// multiplier, which enters where the time derivative does, is the rate of the drift.
    Drift {
        /// The field whose constant is arbitrary.
        field: FieldId,
        /// Balances that the multiplier enters, with weights.
        column: Vec<(BalanceId, Id)>,
    },
    /// The number `field` is unknown: ∫ density is kept.
    Unknown {
        /// The number, a field without a profile.
        field: FieldId,
        /// What is integrated.
        density: Density,
    },
}

impl CaseClosure {
    /// What it integrates; `None` for a gauge, which integrates its field.
    pub fn density(&self) -> Option<&Density> {
        match self {
            CaseClosure::Conserved { density, .. }
            | CaseClosure::Claimed { density, .. }
            | CaseClosure::Unknown { density, .. } => Some(density),
            CaseClosure::Gauge { .. } | CaseClosure::Drift { .. } => None,
        }
    }

    /// Whether it keeps an integral with the linear part of `density`.
    fn is_about(&self, density: &Density) -> bool {
        !matches!(self, CaseClosure::Unknown { .. })
            && self.density().is_some_and(|d| d.linear == density.linear)
    }
}

/// The closures of one case.
pub(super) struct Closures {
    pub list: Vec<CaseClosure>,
    /// Positions in the block `mean` of the conserved integrals among them.
    pub conserved: Vec<usize>,
    /// Integrals that are kept and not declared.
    pub undeclared: Vec<String>,
    /// Number of closures at the head of the list that are integrals of the base state and not declared.
    candidates: usize,
}

/// The closures of one case. They need no adjoint boundary conditions: at k = 0 each is closed by itself.
pub(super) fn derive(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    rules: &BaseRules,
    mistakes: &mut Vec<Diagnostic>,
) -> Closures {
    let model = deriver.model;
    // Each block below works at k = 0, where the boundary form has terms without ∂x alone.
    let walls = mean_walls(deriver, problem, rules);
    // At each end the conditions as rules `jet = −Σ coefficient · free jets`, for the products beyond first order.
    let solved = reduced(deriver, problem.walls, rules).ok();
    let ends = End::BOTH.map(|end| {
        let said = end_rules(problem, solved.as_ref(), end);
        (end, deriver.place(end), said)
    });
    let proof = Proof {
        problem,
        walls: &walls,
        rules,
        ends: ends.into(),
    };
    let mut closures = Closures::conserved(deriver, &proof, mistakes);
    for closure in &model.mean {
        match closure {
            Closure::Conserved { .. } => {}
            Closure::Gauge { field, location } => match gauge(deriver, problem, &walls, *field) {
                Ok(closure) => closures.list.push(closure),
                Err((message, expected)) => {
                    mistakes.push(Diagnostic::new(location.clone(), message, expected));
                }
            },
            Closure::Unknown { field, integral } => {
                closures
                    .list
                    .extend(unknown(deriver, *field, integral, mistakes));
            }
        }
    }
    check_declared(deriver, problem, &walls, &closures.list, mistakes);
    closures.undeclared = deriver.aside(|deriver| proof.undeclared(deriver, &closures.list));
    closures
}

/// The closure of an unknown number by its integral condition.
fn unknown(
    deriver: &mut Deriver,
    field: FieldId,
    integral: &Integral,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<CaseClosure> {
    let place = &integral.location;
    let density = deriver.density(integral.integrand, place, mistakes)?;
    if density.linear.is_empty() {
        let name = &deriver.model.fields[field].name;
        let message = format!(
            "the condition of `{name}` has no linear part at the base state: to first order it says nothing"
        );
        let expected = "an integrand whose linear part has a mean";
        mistakes.push(Diagnostic::new(place.clone(), message, expected));
        return None;
    }
    Some(CaseClosure::Unknown { field, density })
}

impl Closures {
    /// The conserved integrals: those that the block `mean` declares, and those that fix the base state.
    fn conserved(deriver: &mut Deriver, proof: &Proof, mistakes: &mut Vec<Diagnostic>) -> Self {
        let model = deriver.model;
        let mut closures = Closures {
            list: Vec::new(),
            conserved: Vec::new(),
            undeclared: Vec::new(),
            candidates: 0,
        };
        // An integral that fixes the base state may be conserved, though the spec does not declare it.
        let candidates = model
            .base
            .integrals
            .iter()
            .map(|i| (i.integrand, &i.location, None));
        let declared = model.mean.iter().enumerate();
        let declared = declared.filter_map(|(index, closure)| match closure {
            Closure::Conserved {
                integrand,
                location,
            } => Some((*integrand, location, Some(index))),
            _ => None,
        });
        for (integrand, location, index) in candidates.chain(declared) {
            if let Some(density) = deriver.density(integrand, location, mistakes) {
                closures.conserve(deriver, proof, density, index);
            }
        }
        closures
    }

    /// Adds an integral if it is conserved, or if it stands in the block `mean` (at position `declared`) and no proof
    /// can decide.
    fn conserve(
        &mut self,
        deriver: &mut Deriver,
        proof: &Proof,
        density: Density,
        declared: Option<usize>,
    ) {
        let (problem, walls) = (proof.problem, proof.walls);
        let same = self.list.iter().position(|c| c.is_about(&density));
        if let Some(position) = same {
            self.unite(position, density, declared);
            return;
        }
        if declared.is_none() && density.is_nonlinear {
            return;
        }
        // M0†ℓ = linear density
        let column = multiplier(deriver, problem.linear, &density.linear);
        // L†ℓ = 0 at k = 0, and the boundary form of ℓ vanishes at both ends.
        let proved = column.filter(|column| {
            let linear = &density.linear;
            deriver.aside(|deriver| walls.carries(deriver, problem, column, linear))
                && conserved(deriver, problem, walls, column, &self.list)
        });
        if let Some(column) = proved {
            // An integral that fixes the base state, but that the products of the balances change, is not kept.
            let refuted = |deriver: &mut Deriver| matches!(proof.kept(deriver, &column), Ok(None));
            if declared.is_none() && deriver.aside(refuted) {
                return;
            }
            self.list.push(CaseClosure::Conserved { density, column });
            self.conserved.extend(declared);
            self.candidates += usize::from(declared.is_none());
        } else if let Some(index) = declared
            && is_undecided(problem.linear, &deriver.model.balances)
        {
            let column = carried(deriver, problem.linear, &density.linear);
            if !column.is_empty() {
                self.list.push(CaseClosure::Claimed { density, column });
                self.conserved.push(index);
            }
        }
    }

    /// Merges two closures that agree to first order. An integral of the base state that the spec also declares as
    /// conserved takes the declared density; two declared integrals have to agree.
    fn unite(&mut self, position: usize, density: Density, declared: Option<usize>) {
        let is_candidate = position < self.candidates;
        if let CaseClosure::Conserved {
            density: present, ..
        }
        | CaseClosure::Claimed {
            density: present, ..
        } = &mut self.list[position]
            && let Some(index) = declared
            && (is_candidate || present.integrand == density.integrand)
        {
            *present = density;
            self.conserved.push(index);
        }
    }
}

/// Drops a claim in the cases where it is not proved, if some case proves it.
pub(super) fn drop_refuted(cases: &mut [Case]) {
    let proved: Vec<CaseClosure> = cases
        .iter()
        .flat_map(|case| &case.closures)
        .filter(|closure| matches!(closure, CaseClosure::Conserved { .. }))
        .cloned()
        .collect();
    for case in cases {
        case.closures.retain(|closure| match closure {
            CaseClosure::Claimed { density, .. } => !proved.iter().any(|c| c.is_about(density)),
            _ => true,
        });
    }
}

/// Whether a proof may fail for an integral that is conserved. If some balance holds no time derivative, or one under
/// ∂y, then M0†ℓ = (linear density) does not determine ℓ.
fn is_undecided(linear: &[DirectTerm], balances: &Table<BalanceId, Balance>) -> bool {
    let massless = |row| !linear.iter().any(|t| t.row == row && t.jet.t > 0);
    balances.ids().any(massless) || linear.iter().any(|t| t.jet.t > 0 && t.jet.y > 0)
}
