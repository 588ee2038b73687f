//! What closes the problem at k = 0: conserved integrals, gauges, unknown numbers.
//!
//! An integral is conserved to first order if some ℓ(y) with M0†ℓ = (its linear density) obeys L†ℓ = 0 at k = 0 and
//! makes the boundary form vanish: then d/dt ∫ density = 0. The tool finds ℓ, it does not believe. Balances without
//! mass (continuity) leave components of ℓ open; where zero does not do for them, the claim is handed on, and
//! the collocated problem decides. Beyond first order the multiplier decides, which has to vanish.

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
    /// The same, claimed by the spec: to be recognised in the collocated problem.
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
    /// What it integrates; nothing for a gauge, which integrates its field.
    pub fn density(&self) -> Option<&Density> {
        match self {
            CaseClosure::Conserved { density, .. }
            | CaseClosure::Claimed { density, .. }
            | CaseClosure::Unknown { density, .. } => Some(density),
            CaseClosure::Gauge { .. } | CaseClosure::Drift { .. } => None,
        }
    }

    /// Whether it says of a conserved integral what `density` says, to first order.
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
    /// How many, the first of the list, are integrals of the base state that nothing declares.
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
    let walls = mean_walls(deriver, problem, rules);
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
        // An integral that fixes the base is a candidate for a conserved one.
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

    /// Takes in an integral if it is conserved, or if it stands in the block `mean` (at `declared`) and no proof can
    /// decide.
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
        let column = multiplier(deriver, problem.linear, &density.linear);
        let proved = column.filter(|column| {
            let linear = &density.linear;
            deriver.aside(|deriver| walls.carries(deriver, problem, column, linear))
                && conserved(deriver, problem, walls, column, &self.list)
        });
        if let Some(column) = proved {
            // An integral of the base that only the linear balances keep is none to be kept.
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

    /// Makes one closure of two that agree to first order: an integral of the base that is declared as conserved too
    /// keeps what is declared. Two that are declared have to agree.
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

/// A claim that is proved for other choices of the switches does not hold where it is not.
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

/// Whether a proof may fail for an integral that is conserved: where some balance holds no time derivative, or one
/// under ∂y, ℓ is not what the mass matrix alone says.
fn is_undecided(linear: &[DirectTerm], balances: &Table<BalanceId, Balance>) -> bool {
    let massless = |row| !linear.iter().any(|t| t.row == row && t.jet.t > 0);
    balances.ids().any(massless) || linear.iter().any(|t| t.jet.t > 0 && t.jet.y > 0)
}
