//! The Landau point: c0, c2 and what belongs to them at one wavenumber, by the derived forms N2 and N3.
//!
//! With X = X[1;1], P (3.13)–(3.16):
//!
//! X' = A X e^{iθ} + c.c. + A² (X[0;2] + X[2;2] e^{2iθ} + c.c.) + …,  dA/dt = a0 A + a2 A³,  dθ/dt = b0 + b2 A²
//!
//! The equations for X[0;2], X[2;2] and c2 stand in `third_order`, each above the line that computes it.

use super::bifurcation::equilibrium;
use super::integrals;
use super::mode::{JetTable, Mode};
use super::response::{
    ForcedProblem, Multiplier, Response, RightSide, arithmetic, multiplier_error, out_of_range,
};
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

/// Below this part of [`LandauPoint::uncancelled`] c2 is rounding. Some 450 times the machine's precision: the sum holds
/// the rounding errors of two solved problems and of a product at every point.
pub const CANCELLED_SUM: f64 = 1e-13;

/// Which mode is meant.
#[derive(Clone, Copy, Debug)]
pub enum Selection<'a> {
    /// The mode of largest growth rate.
    Leading,
    /// The mode whose eigenvalue lies nearest to this one.
    Near(C64),
    /// The mode whose shape continues that of a mode at a neighbouring wavenumber or base state.
    Like(&'a EigenPair),
}

/// c0 and c2 with the modes up to second order.
pub struct LandauPoint {
    /// The collocated problem around the base state.
    pub problem: Arc<Problem>,
    /// The mode: wavenumber, eigenvalue, right and left vector.
    pub pair: EigenPair,
    /// Eigenvalue of L at k, a0 + i b0.
    pub c0: C64,
    /// The first Landau coefficient, P (3.22).
    pub c2: C64,
    /// The three terms of c2: the projections of 2 N2(X, X[0;2]), 2 N2(X̄, X[2;2]) and 3 N3(X, X, X̄).
    pub contributions: [C64; 3],
    /// X[1;1], normalised as the spec's block `amplitude` says.
    pub fundamental: Mode,
    /// X[0;2]
    pub mean: Mode,
    /// X[2;2]
    pub second: Mode,
    /// Multipliers of the closures in the problem of X[0;2], those of unknown numbers left out.
    pub multipliers: Vec<Multiplier>,
    /// The solved problems of X[0;2] and X[2;2].
    responses: [Response; 2],
}

/// The Landau point of a selected mode.
///
/// # Errors
/// There is no such mode, or the problem of X[0;2] or X[2;2] is singular (a resonance).
pub fn point(problem: &Arc<Problem>, k: WaveVector, selection: Selection) -> Result<LandauPoint> {
    from_pair(problem, select(problem, k, selection)?)
}

/// The selected mode with its eigenvalue and both vectors.
///
/// # Errors
/// There is no such mode, or its eigenvalue is not simple.
pub fn select(problem: &Problem, k: WaveVector, selection: Selection) -> Result<EigenPair> {
    match selection {
        Selection::Leading => spectrum::leading(problem, k),
        Selection::Near(target) => spectrum::nearest(problem, k, target),
        Selection::Like(pair) => spectrum::follow(problem, k, pair),
    }
}

/// The Landau point of the mode that continues `near`. Where inverse iteration finds it at once, this costs three
/// factorisations and no spectrum.
///
/// # Errors
/// As [`point`].
pub fn warm_point(problem: &Arc<Problem>, k: WaveVector, near: &EigenPair) -> Result<LandauPoint> {
    point(problem, k, Selection::Like(near))
}

/// The Landau point of a mode that has been solved for.
///
/// # Errors
/// The mode cannot be normalised, or the problem of X[0;2] or X[2;2] is singular (a resonance).
pub fn from_pair(problem: &Arc<Problem>, pair: EigenPair) -> Result<LandauPoint> {
    let fundamental = fundamental(problem, &pair)?;
    let third = third_order(problem, &pair, &fundamental, None)?;
    let [x02, x22] = &third.responses;
    Ok(LandauPoint {
        problem: problem.clone(),
        c0: pair.c,
        c2: third.contributions.iter().sum(),
        contributions: third.contributions,
        fundamental,
        mean: x02.mode.clone(),
        second: x22.mode.clone(),
        multipliers: x02.multipliers.clone(),
        responses: third.responses,
        pair,
    })
}

/// The second-order modes, and the terms of c2 that they give.
struct ThirdOrder {
    /// X[0;2] and X[2;2].
    responses: [Response; 2],
    /// The three terms of c2.
    contributions: [C64; 3],
}

/// X[0;2], X[2;2] and the terms of c2. With weights every jet in a product is multiplied by its weight.
fn third_order(
    problem: &Problem,
    pair: &EigenPair,
    fundamental: &Mode,
    weight: Option<Weight>,
) -> Result<ThirdOrder> {
    let (k, c0) = (pair.k, pair.c);
    let arithmetic = arithmetic(problem, &[c0]);
    let uncancelled = || Some(mean_forcing(problem, fundamental, Some(turned)));
    // Solves [σ M0 − L_q] X = G.
    let respond = |q: WaveVector, sigma: C64, forcing: RightSide| {
        forcing.check_range()?;
        let forced = ForcedProblem {
            q,
            sigma,
            forcing,
            arithmetic,
            order: 2,
            is_real: q.is_mean(),
            borders: &[],
            uncancelled: &uncancelled,
        };
        forced
            .solve(problem)
            .ok_or_else(|| singular(k, q.is_mean()))
    };
    let factor = |mode: &Mode| Factor::new(problem, mode.clone(), weight);
    let n2 = |times: f64, a: &Factor, b: &Factor| product(problem, &[a, b], times);
    let n3 = |times: f64, factors: [&Factor; 3]| product(problem, &factors, times);

    // [2 a0 M0 − L_0] X[0;2] = 2 N2(X, X̄), and for each closure ∫ D1 X[0;2] dy = −2 ∫ D2(X, X̄) dy
    let forcing = RightSide {
        equations: mean_forcing(problem, fundamental, weight),
        closures: integrals::second_order(problem, fundamental, arithmetic, weight),
    };
    let mean = respond(WaveVector::MEAN, C64::new(2.0 * c0.re, 0.0), forcing)?;

    // [2 c0 M0 − L_2k] X[2;2] = N2(X, X)
    let x = factor(fundamental);
    let second = respond(2.0 * k, 2.0 * c0, RightSide::of_balances(n2(1.0, &x, &x)))?;

    // G[1;3] = 2 N2(X, X[0;2]) + 2 N2(X̄, X[2;2]) + 3 N3(X, X, X̄)
    let (x_bar, x02, x22) = (x.conjugate(), factor(&mean.mode), factor(&second.mode));
    let g13 = [
        n2(2.0, &x, &x02),
        n2(2.0, &x_bar, &x22),
        n3(3.0, [&x, &x, &x_bar]),
    ];
    if !g13.iter().all(|term| norm(term).is_finite()) {
        return Err(out_of_range());
    }

    // c2 = ⟨Y, G[1;3]⟩ / ⟨Y, M0 X⟩, P (3.22)
    let y = &pair.left;
    let mass = problem.direct.mass::<C64>(k);
    let y_mass_x = dot(y, &mass.apply(&problem.direct.turned(&fundamental.values)));
    Ok(ThirdOrder {
        contributions: g13.map(|term| dot(y, &term) / y_mass_x),
        responses: [mean, second],
    })
}

/// 2 N2(X, X̄)
fn mean_forcing(problem: &Problem, fundamental: &Mode, weight: Option<Weight>) -> Turned {
    let x = Factor::new(problem, fundamental.clone(), weight);
    product(problem, &[&x, &x.conjugate()], 2.0)
}

/// X[1;1]: the eigenvector times the factor that the spec's block `amplitude` asks for. Its time derivative is c X.
///
/// # Errors
/// The quantity that is to be normalised vanishes in this mode.
pub fn fundamental(problem: &Problem, pair: &EigenPair) -> Result<Mode> {
    let values = problem.direct.physical(&pair.right);
    let values = values.times(super::normalise(problem, pair.k, &values)?);
    let rate = values.times(pair.c);
    Ok(Mode::new(pair.k, values, rate))
}

/// The error of a singular problem: that of X[0;2] at k = 0, or that of X[2;2] at 2k.
fn singular(k: WaveVector, is_mean: bool) -> Error {
    let distance = None;
    if is_mean {
        Error::OpenMean {
            of: "X[0;2]".to_owned(),
            distance,
        }
    } else {
        Error::Resonance {
            of: "X[2;2]".to_owned(),
            q: 2.0 * k.k(),
            modes: vec![k.k()],
            distance,
        }
    }
}

/// The largest relative size ([`Multiplier::relative`]) of a multiplier that counts as truncation error where the error
/// of c2 has not been measured. It is coarse: a mean that is not conserved gives a relative size of order one.
const TRUNCATION: f64 = 1e-3;

impl LandauPoint {
    /// The point itself, if its conserved means are conserved at second order to within truncation error.
    ///
    /// # Errors
    /// A multiplier that has to vanish is larger than a truncation error.
    pub fn conserving(self) -> Result<Self> {
        multiplier_error(&self.multipliers, TRUNCATION).map_or(Ok(self), Err)
    }

    /// The error of a multiplier that has to vanish and exceeds the relative error of c2; `error` is the absolute error
    /// of c2. `None` where all vanish.
    pub fn multiplier_error(&self, error: f64) -> Option<Error> {
        multiplier_error(&self.multipliers, error / self.size())
    }

    /// The wavenumber.
    pub fn k(&self) -> f64 {
        self.pair.k.k()
    }

    /// Distances of 2 a0 from the spectrum of L at k = 0, and of 2 c0 from that at 2k, in units of c0.
    pub fn distances(&self) -> [f64; 2] {
        [0, 1].map(|i| self.responses[i].distance(&self.problem))
    }

    /// Σ |contribution to c2|, in units of c2: rounding errors of c2 are relative to it.
    pub fn size(&self) -> f64 {
        self.contributions.iter().map(|c| c.norm()).sum()
    }

    /// Size of c2's terms before cancellation. A mode that solves the nonlinear equations exactly has products that
    /// cancel identically, and [`LandauPoint::size`] is then zero. Here every derivative is multiplied by a factor
    /// between 1/2 and 3/2, each by another, which destroys the cancellation. Costs one more Landau point.
    pub fn uncancelled(&self) -> f64 {
        let scrambled = third_order(
            &self.problem,
            &self.pair,
            &self.fundamental,
            Some(scrambled),
        );
        let size = |third: ThirdOrder| third.contributions.iter().map(|c| c.norm()).sum();
        self.size().max(scrambled.map_or(0.0, size))
    }

    /// A_e = √(−a0/a2), P (4.1); `None` where −a0/a2 is not positive, or a0 or a2 is rounding.
    pub fn amplitude(&self) -> Option<f64> {
        let [c0, _] = self.rounding();
        equilibrium((self.c0, c0), (self.c2, CANCELLED_SUM * self.uncancelled()))
    }

    /// Lower bounds of the rounding errors of c0 and c2, in their units: 10⁻¹⁴, some 45 times the machine's precision,
    /// of the size of their terms. They hold where no products cancel; [`LandauPoint::uncancelled`] is for where they do.
    pub fn rounding(&self) -> [f64; 2] {
        let scale = self.pair.scale.max(self.c0.norm());
        [1e-14 * scale, 1e-14 * self.size()]
    }
}

/// A mode as a factor of products, with its jets at the points of all balances.
struct Factor {
    mode: Mode,
    /// One table of jets for each family of points.
    tables: Vec<(Points, JetTable)>,
    weight: Option<Weight>,
    /// Whether the mode is a conjugate: its jets then take the conjugate weights.
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

    /// The value of one jet at one end, times its weight.
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
        let entry = self.tables.iter().find(|(at, _)| *at == points);
        entry.map(|(_, table)| table)
    }
}

/// `multiplicity` · N_d of d modes, in the solver's basis: the products in the balances at their points, then those in
/// the boundary conditions. Zero where d exceeds the order to which the model was derived.
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
