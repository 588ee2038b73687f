//! The Landau point: c0, c2 and what belongs to them at one wavenumber, by the derived forms N2 and N3.
//!
//! X' = A X e^{iθ} + c.c. + A² (X[0;2] + X[2;2] e^{2iθ} + c.c.) + …,  dA/dt = a0 A + a2 A³,  dθ/dt = b0 + b2 A²,
//! P (3.13)–(3.16):
//!
//! [2 a0 M0 − L_0] X[0;2] = 2 N2(X, X̄), the closures' rows ∫ D1 X[0;2] dy = −2 ∫ D2(X, X̄) dy
//! [2 c0 M0 − L_2k] X[2;2] = N2(X, X)
//! c2 = ⟨Y, 2 N2(X, X[0;2]) + 2 N2(X̄, X[2;2]) + 3 N3(X, X, X̄)⟩ / ⟨Y, M0 X⟩, P (3.22)

use super::bifurcation::equilibrium;
use super::integrals;
use super::mode::{JetTable, Mode};
use super::response::{Multiplier, Question, Response, RightSide, arithmetic, multiplier_error};
use super::scramble::{Weight, scrambled, turned};
use crate::error::{Error, Result};
use crate::model::{C64, Jet};
use crate::numerics::Applied;
use crate::numerics::dense::{dot, norm};
use crate::problem::{Problem, Turned};
use crate::space::Points;
use crate::spectrum::{self, EigenPair};
use crate::wavevector::WaveVector;
use std::sync::Arc;

/// Below this part of what its terms would sum to were they not to cancel, c2 is rounding.
pub const CANCELLED_SUM: f64 = 1e-13;

/// Which mode is meant.
#[derive(Clone, Copy, Debug)]
pub enum Selection<'a> {
    /// The one of largest growth rate.
    Leading,
    /// The one nearest to an eigenvalue.
    Near(C64),
    /// The continuation of a mode known nearby.
    Like(&'a EigenPair),
}

/// c0 and c2 with the modes up to second order.
pub struct LandauPoint {
    /// The collocated problem.
    pub problem: Arc<Problem>,
    /// The mode.
    pub pair: EigenPair,
    /// Its eigenvalue.
    pub c0: C64,
    /// The first Landau coefficient, P (3.22).
    pub c2: C64,
    /// What c2 is the sum of: 2 N2(X, X[0;2]), 2 N2(X̄, X[2;2]), 3 N3(X, X, X̄), projected.
    pub contributions: [C64; 3],
    /// X[1;1], normalised.
    pub fundamental: Mode,
    /// X[0;2]
    pub mean: Mode,
    /// X[2;2]
    pub second: Mode,
    /// Multipliers of the closures at k = 0.
    pub multipliers: Vec<Multiplier>,
    responses: [Response; 2],
}

/// The Landau point of a selected mode.
///
/// # Errors
/// A mode that is not found, a resonance.
pub fn point(problem: &Arc<Problem>, k: WaveVector, selection: Selection) -> Result<LandauPoint> {
    from_pair(problem, select(problem, k, selection)?)
}

/// The selected mode.
///
/// # Errors
/// A mode that is not found.
pub fn select(problem: &Problem, k: WaveVector, selection: Selection) -> Result<EigenPair> {
    match selection {
        Selection::Leading => spectrum::leading(problem, k),
        Selection::Near(target) => spectrum::nearest(problem, k, target),
        Selection::Like(pair) => spectrum::follow(problem, k, pair),
    }
}

/// The point that continues `near`: three factorisations.
///
/// # Errors
/// As [`point`].
pub fn warm_point(problem: &Arc<Problem>, k: WaveVector, near: &EigenPair) -> Result<LandauPoint> {
    point(problem, k, Selection::Like(near))
}

/// The point of a known mode.
///
/// # Errors
/// A resonance.
pub fn from_pair(problem: &Arc<Problem>, pair: EigenPair) -> Result<LandauPoint> {
    let fundamental = fundamental(problem, &pair)?;
    let third = third_order(problem, &pair, &fundamental, None)?;
    let [mean, second] = &third.responses;
    Ok(LandauPoint {
        problem: problem.clone(),
        c0: pair.c,
        c2: third.contributions.iter().sum(),
        contributions: third.contributions,
        fundamental,
        mean: mean.mode.clone(),
        second: second.mode.clone(),
        multipliers: mean.multipliers.clone(),
        responses: third.responses,
        pair,
    })
}

/// What the fundamental makes at second and third order.
struct ThirdOrder {
    /// X[0;2] and X[2;2].
    responses: [Response; 2],
    /// What c2 is the sum of.
    contributions: [C64; 3],
}

/// The mode's products with itself, each jet times its weight where there are weights.
fn third_order(
    problem: &Problem,
    pair: &EigenPair,
    fundamental: &Mode,
    weight: Option<Weight>,
) -> Result<ThirdOrder> {
    let arithmetic = arithmetic(problem, &[pair.c]);
    let uncancelled = || Some(mean_forcing(problem, fundamental, Some(turned)));
    let respond = |q: WaveVector, shift: C64, forcing: RightSide| {
        forcing.check_range()?;
        let question = Question {
            q,
            shift,
            forcing,
            arithmetic,
            order: 2,
            is_real: q.is_mean(),
            borders: &[],
            uncancelled: &uncancelled,
        };
        question
            .answer(problem)
            .ok_or_else(|| singular(pair.k, q.is_mean()))
    };
    let x = Factor::new(problem, fundamental.clone(), weight);
    let conjugate = x.conjugate();
    let forcing = RightSide {
        equations: mean_forcing(problem, fundamental, weight),
        closures: integrals::second_order(problem, fundamental, arithmetic, weight),
    };
    let mean = respond(WaveVector::MEAN, C64::new(2.0 * pair.c.re, 0.0), forcing)?;
    let forcing = RightSide {
        equations: product(problem, &[&x, &x], 1.0),
        closures: Vec::new(),
    };
    let second = respond(2.0 * pair.k, 2.0 * pair.c, forcing)?;
    let x02 = Factor::new(problem, mean.mode.clone(), weight);
    let x22 = Factor::new(problem, second.mode.clone(), weight);
    let third = [
        product(problem, &[&x, &x02], 2.0),
        product(problem, &[&conjugate, &x22], 2.0),
        product(problem, &[&x, &x, &conjugate], 3.0),
    ];
    if !third.iter().all(|forcing| norm(forcing).is_finite()) {
        return Err(super::response::out_of_range());
    }
    let mass = problem.direct.mass::<C64>(pair.k);
    let mass_x = mass.apply(&problem.direct.turned(&fundamental.values));
    let below = dot(&pair.left, &mass_x);
    Ok(ThirdOrder {
        contributions: third.map(|forcing| dot(&pair.left, &forcing) / below),
        responses: [mean, second],
    })
}

/// 2 N2(X, X̄)
fn mean_forcing(problem: &Problem, fundamental: &Mode, weight: Option<Weight>) -> Turned {
    let x = Factor::new(problem, fundamental.clone(), weight);
    product(problem, &[&x, &x.conjugate()], 2.0)
}

/// The eigenvector as the spec normalises it, with its rate c X.
///
/// # Errors
/// A mode that the spec's normalisation does not fit.
pub fn fundamental(problem: &Problem, pair: &EigenPair) -> Result<Mode> {
    let values = problem.direct.physical(&pair.right);
    let values = values.times(super::normalise(problem, pair.k, &values)?);
    let rate = values.times(pair.c);
    Ok(Mode::new(pair.k, values, rate))
}

fn singular(k: WaveVector, mean: bool) -> Error {
    let distance = None;
    match mean {
        true => Error::OpenMean {
            of: "X[0;2]".to_owned(),
            distance,
        },
        false => Error::Resonance {
            of: "X[2;2]".to_owned(),
            q: 2.0 * k.k(),
            modes: vec![k.k()],
            distance,
        },
    }
}

/// The largest part of the terms beside it that truncation may leave of a multiplier.
const TRUNCATION: f64 = 1e-3;

impl LandauPoint {
    /// The point, if the means that its model claims to keep are kept at second order, as far as any collocation shows.
    ///
    /// # Errors
    /// A multiplier that has to vanish and is no error of truncation.
    pub fn conserving(self) -> Result<Self> {
        match multiplier_error(&self.multipliers, TRUNCATION) {
            None => Ok(self),
            Some(error) => Err(error),
        }
    }

    /// What is wrong with the means of a c2 that is known to `error`: a multiplier that has to vanish and does not.
    pub fn multiplier_error(&self, error: f64) -> Option<Error> {
        multiplier_error(&self.multipliers, error / self.size())
    }

    /// The wavenumber.
    pub fn k(&self) -> f64 {
        self.pair.k.k()
    }

    /// How far the problems of X[0;2] and X[2;2] are from singularity.
    pub fn distances(&self) -> [f64; 2] {
        [0, 1].map(|i| self.responses[i].distance(&self.problem))
    }

    /// Σ |contribution to c2|: what its rounding errors are relative to.
    pub fn size(&self) -> f64 {
        self.contributions.iter().map(|c| c.norm()).sum()
    }

    /// The same where products cancel before they are summed, as those of a mode that solves the nonlinear equations by
    /// itself do: of the size that they have with every jet at another weight. It costs as much as the point.
    pub fn uncancelled(&self) -> f64 {
        let scrambled = third_order(
            &self.problem,
            &self.pair,
            &self.fundamental,
            Some(scrambled),
        );
        let sum = |found: ThirdOrder| found.contributions.iter().map(|c| c.norm()).sum();
        self.size().max(scrambled.map_or(0.0, sum))
    }

    /// A_e² = −a0/a2 where that is positive, P (4.1).
    pub fn amplitude(&self) -> Option<f64> {
        let [c0, _] = self.rounding();
        equilibrium((self.c0, c0), (self.c2, CANCELLED_SUM * self.uncancelled()))
    }

    /// What rounding leaves undecided of c0 and c2 at least, where products do not cancel.
    pub fn rounding(&self) -> [f64; 2] {
        let scale = self.pair.scale.max(self.c0.norm());
        [1e-14 * scale, 1e-14 * self.size()]
    }
}

/// A mode that takes part in products, with its jets at the points of all balances.
struct Factor {
    mode: Mode,
    tables: Vec<(Points, JetTable)>,
    weight: Option<Weight>,
    /// Whether it is the conjugate of a weighted mode.
    is_conjugate: bool,
}

impl Factor {
    fn new(problem: &Problem, mode: Mode, weight: Option<Weight>) -> Self {
        let jets = &problem.structure().form_jets;
        let groups = problem.direct.layout.groups().into_iter();
        let table = |points| {
            let mut table = mode.jets(problem, jets, points);
            if let Some(weight) = weight {
                table.weigh(|position| weight(jets[position]));
            }
            (points, table)
        };
        Factor {
            tables: groups.map(|(points, _)| table(points)).collect(),
            mode,
            weight,
            is_conjugate: false,
        }
    }

    /// One jet at one end.
    fn at_end(&self, problem: &Problem, jet: Jet, end: Points) -> C64 {
        let value = self.mode.jet(problem, jet, end)[0];
        let weight = self.weight.map_or(C64::new(1.0, 0.0), |weight| weight(jet));
        if self.is_conjugate {
            value * weight.conj()
        } else {
            value * weight
        }
    }

    fn conjugate(&self) -> Self {
        let tables = self.tables.iter();
        Factor {
            mode: self.mode.conjugate(),
            tables: tables.map(|(at, t)| (*at, t.conjugate())).collect(),
            weight: self.weight,
            is_conjugate: !self.is_conjugate,
        }
    }

    fn on(&self, points: Points) -> Option<&JetTable> {
        let own = self.tables.iter().find(|(at, _)| *at == points);
        own.map(|(_, table)| table)
    }
}

/// `multiplicity` · N_d of d modes, in the balances and in the data of the boundary conditions, in the solver's basis.
fn product(problem: &Problem, factors: &[&Factor], multiplicity: f64) -> Turned {
    let degree = factors.len();
    let structure = problem.structure();
    let mut right = Turned(vec![C64::new(0.0, 0.0); problem.direct.layout.size]);
    if degree > structure.order {
        return right;
    }
    for (row, block) in problem.direct.layout.rows.pairs() {
        if !structure.forms[degree - 2][row] {
            continue;
        }
        let tables: Vec<&JetTable> = factors.iter().filter_map(|f| f.on(block.points)).collect();
        let turn = problem.direct.row_factor(row) * multiplicity;
        for (i, c) in problem.nonlinear[row].iter().enumerate() {
            let arguments: [&[C64]; 3] =
                std::array::from_fn(|a| tables.get(a).map_or(&[][..], |t| t.at(i)));
            let value = problem.model().form(degree, row, c, &arguments[..degree]);
            right[block.offset + i] += turn * value;
        }
    }
    for (index, wall) in problem.direct.walls.iter().enumerate() {
        let terms = wall.nonlinear.iter().filter(|(m, _)| m.len() == degree);
        let end = Points::end(wall.end);
        // 0 = W x + N(x): a row of L, and its data beside those of the balances.
        for (monomial, coefficient) in terms {
            let value = symmetric_product(problem, factors, monomial, end) * *coefficient;
            let position = problem.direct.layout.walls + index;
            right[position] += problem.direct.wall_factor(wall) * value * multiplicity;
        }
    }
    right
}

/// 1/d! Σ over permutations of Π jets at one end.
fn symmetric_product(problem: &Problem, factors: &[&Factor], monomial: &[Jet], end: Points) -> C64 {
    fn sum(values: &[Vec<C64>], position: usize, used: u32) -> C64 {
        if position == values.len() {
            return C64::new(1.0, 0.0);
        }
        let open = (0..values.len()).filter(|i| used >> i & 1 == 0);
        open.map(|i| values[position][i] * sum(values, position + 1, used | 1 << i))
            .sum()
    }
    let at_end = |jet: Jet| factors.iter().map(move |f| f.at_end(problem, jet, end));
    let values: Vec<Vec<C64>> = monomial.iter().map(|&jet| at_end(jet).collect()).collect();
    let factorial: f64 = (1..=factors.len()).map(|i| i as f64).product();
    sum(&values, 0, 0) / factorial
}
