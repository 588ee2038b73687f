//! Spectra of matrix pencils L x = c M0 x with singular M0, and modes refined or followed.
//!
//! Boundary conditions, continuity and closures make M0 singular; the infinite eigenvalues are
//! deflated exactly before anything is computed.

mod iteration;
mod scout;

pub use crate::pencil::Spectrum;
pub use iteration::likeness;
pub use scout::{Ground, Leader, Scout};

use crate::error::{Error, Result};
use crate::model::C64;
use crate::numerics::beside;
use crate::pencil::{Mode, Reduced};
use crate::problem::{Problem, Turned};
use crate::wavevector::WaveVector;
use iteration::refine;

/// Cosine between a mode and its continuation below which it counts as another mode.
const SAME_SHAPE: f64 = 0.6;
/// Eigenvalues below this part of the rates that their terms have are zero.
const ZERO: f64 = 1e-12;
/// Two eigenvalues nearer than this, relative to themselves or the scale of the slow ones, are one that is
/// not simple: rounding splits a defective one by the root of the machine's precision.
const SIMPLE: f64 = 1e-7;

/// An eigenvalue with right and left eigenvectors, in the solver's basis.
#[derive(Clone, Debug)]
pub struct EigenPair {
    /// Its wavenumber.
    pub k: WaveVector,
    /// The eigenvalue, e^{ct}.
    pub c: C64,
    /// L x = c M0 x, boundary rows included.
    pub right: Turned,
    /// yᴴ L = c yᴴ M0, boundary rows included.
    pub left: Turned,
    /// The unit of time of the spectrum around it.
    pub scale: f64,
}

/// All finite eigenvalues by decreasing real part.
///
/// # Errors
/// A pencil that is singular for every c (a gauge that the spec does not name).
pub fn eigenvalues(problem: &Problem, k: WaveVector) -> Result<Spectrum> {
    match (k.is_mean(), problem.is_real()) {
        (true, _) => Reduced::<f64>::new(problem.bordered_pencil())?.eigenvalues(),
        (false, true) => Reduced::<f64>::new(problem.direct.pencil(k))?.eigenvalues(),
        (false, false) => Reduced::<C64>::new(problem.direct.pencil(k))?.eigenvalues(),
    }
}

/// Finite eigenvalues of the separately discretised adjoint, by decreasing real part.
///
/// # Errors
/// As [`eigenvalues`], and where the model has no adjoint boundary conditions.
pub fn adjoint_eigenvalues(problem: &Problem, k: WaveVector) -> Result<Spectrum> {
    let adjoint = problem.adjoint()?;
    match (k.is_mean(), problem.is_real()) {
        (true, _) => Reduced::<f64>::new(problem.bordered_adjoint_pencil()?)?.eigenvalues(),
        (false, true) => Reduced::<f64>::new(adjoint.pencil(k))?.eigenvalues(),
        (false, false) => Reduced::<C64>::new(adjoint.pencil(k))?.eigenvalues(),
    }
}

/// Eigenvalues with right eigenvectors in the solver's basis, by decreasing real part.
fn eigenvectors(problem: &Problem, k: WaveVector) -> Result<(Spectrum, Vec<Mode>)> {
    if problem.is_real() {
        Reduced::<f64>::new(problem.direct.pencil(k))?.eigenvectors()
    } else {
        Reduced::<C64>::new(problem.direct.pencil(k))?.eigenvectors()
    }
}

/// The leading mode.
///
/// # Errors
/// A spectrum that cannot be computed, an eigenvalue that is not simple, or a mode that inverse iteration
/// does not confirm.
pub fn leading(problem: &Problem, k: WaveVector) -> Result<EigenPair> {
    let spectrum = eigenvalues(problem, k)?;
    let c = *spectrum.values.first().ok_or_else(no_modes)?;
    confirm(
        problem,
        k,
        &spectrum,
        (c, arbitrary(problem.direct.layout.size)),
    )
}

/// The mode nearest to a given eigenvalue.
///
/// # Errors
/// As [`leading`].
pub fn nearest(problem: &Problem, k: WaveVector, target: C64) -> Result<EigenPair> {
    nearest_in(problem, k, &eigenvalues(problem, k)?, target)
}

/// The mode nearest to a given eigenvalue, of a spectrum that is at hand.
///
/// # Errors
/// As [`leading`].
pub fn nearest_in(
    problem: &Problem,
    k: WaveVector,
    spectrum: &Spectrum,
    target: C64,
) -> Result<EigenPair> {
    let c = *spectrum
        .values
        .iter()
        .min_by(|a, b| (*a - target).norm().total_cmp(&(*b - target).norm()))
        .ok_or_else(no_modes)?;
    confirm(
        problem,
        k,
        spectrum,
        (c, arbitrary(problem.direct.layout.size)),
    )
}

/// The continuation of a mode to another wavenumber or base state, by its shape.
///
/// # Errors
/// Where no mode has a similar shape.
pub fn follow(problem: &Problem, k: WaveVector, near: &EigenPair) -> Result<EigenPair> {
    if near.right.len() == problem.direct.layout.size
        && let Some(pair) = iteration::continued(problem, k, near)
        && likeness(&near.right, &pair.right) > SAME_SHAPE
    {
        return Ok(pair);
    }
    let (spectrum, modes) = eigenvectors(problem, k)?;
    let mode = modes
        .into_iter()
        .max_by(|a, b| likeness(&near.right, &a.1).total_cmp(&likeness(&near.right, &b.1)))
        .ok_or_else(no_modes)?;
    let overlap = likeness(&near.right, &mode.1);
    if overlap < SAME_SHAPE {
        return Err(Error::Lost { k: k.k(), overlap });
    }
    confirm(problem, k, &spectrum, (mode.0, Turned(mode.1)))
}

/// The mode `pair` of one collocation found again on another, from its interpolated shape.
///
/// # Errors
/// Where the other collocation has no such mode.
pub fn transferred(from: &Problem, pair: &EigenPair, to: &Problem) -> Result<EigenPair> {
    let shape = interpolated(from, &pair.right, to);
    let start = arbitrary(shape.len());
    let shift = beside(pair.c, pair.scale);
    match refine(to, pair.k, shift, pair.scale, &shape, &start) {
        Some(found) if likeness(&shape, &found.right) > SAME_SHAPE => Ok(found),
        _ => nearest(to, pair.k, pair.c),
    }
}

/// A vector of one collocation at the points of another.
pub fn interpolated(from: &Problem, values: &Turned, to: &Problem) -> Turned {
    let (old, new) = (&from.direct.layout, &to.direct.layout);
    let mut shape = Turned(vec![C64::new(0.0, 0.0); new.size]);
    for (a, b) in old.columns.iter().zip(new.columns.iter()) {
        let between = to.space().derivative(a.points, b.points, 0);
        shape[b.range()].copy_from_slice(&between.of(a.of(values)));
    }
    shape
}

/// The mode at −k that is the mirror image of one at k, in a model with the symmetry.
pub fn mirror_image(problem: &Problem, pair: &EigenPair) -> EigenPair {
    let mut image = EigenPair {
        k: -pair.k,
        ..pair.clone()
    };
    let (unknowns, equations) = problem.odd_positions();
    unknowns
        .into_iter()
        .for_each(|i| image.right[i] = -image.right[i]);
    equations
        .into_iter()
        .for_each(|i| image.left[i] = -image.left[i]);
    image
}

/// A vector that is orthogonal to none that matters.
fn arbitrary(size: usize) -> Turned {
    let entry = |i: usize| C64::new(1.0 + 0.37 * ((i * i) as f64).sin(), 0.0);
    Turned((0..size).map(entry).collect())
}

fn no_modes() -> Error {
    Error::computation("the linear problem has no finite eigenvalue")
}

/// The scale of the slow part of a spectrum, or the rate of the slowest balance where the eigenvalues are zero to
/// rounding beside it.
pub fn unit_of_time(problem: &Problem, k: WaveVector, spectrum: &Spectrum) -> f64 {
    let (scale, rate) = (spectrum.scale(), problem.rate(k));
    if rate.is_finite() && scale <= ZERO * rate {
        rate
    } else {
        scale
    }
}

/// The mode after inverse iteration, where its eigenvalue is simple.
fn confirm(
    problem: &Problem,
    k: WaveVector,
    spectrum: &Spectrum,
    (c, right): (C64, Turned),
) -> Result<EigenPair> {
    let scale = unit_of_time(problem, k, spectrum);
    let gap = spectrum.gap(c);
    // A single eigenvalue is simple.
    if gap.is_finite() && gap <= SIMPLE * c.norm().max(scale) {
        return Err(Error::NotSimple { c, k: k.k(), gap });
    }
    // The left vector comes from the iteration itself; any start that is not orthogonal will do.
    let start = arbitrary(right.len());
    refine(problem, k, beside(c, scale), scale, &right, &start).ok_or_else(|| {
        let advice = if gap < 1e-3 * c.norm().max(scale) {
            "it lies in a cluster of others, as those of a continuous spectrum do: another mode (--near) or a larger M"
        } else {
            "it is not resolved: a larger M"
        };
        Error::Unconfirmed {
            c,
            k: k.k(),
            gap,
            advice,
        }
    })
}
