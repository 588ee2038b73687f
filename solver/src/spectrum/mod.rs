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
use crate::numerics::{arbitrary, beside};
use crate::pencil::{Mode, Reduced};
use crate::problem::{Problem, Turned};
use crate::wavevector::WaveVector;
use iteration::refine;

/// |Cosine| of the angle between a mode and its continuation below which that counts as another mode. Neighbouring
/// wavenumbers or collocations give nearly one, different modes mostly far less.
const SAME_SHAPE: f64 = 0.6;
/// Eigenvalues below this part of the rates of the terms in L are zero. It is 4500 times the machine's precision, for high
/// derivatives amplify rounding.
const ZERO: f64 = 1e-12;
/// Two eigenvalues nearer than this, relative to themselves or to the scale of the slow ones, are a single one that is not
/// simple: rounding splits a defective eigenvalue by the root of the machine's precision, 1.5 · 10⁻⁸, times a constant.
const SIMPLE: f64 = 1e-7;

/// An eigenvalue with right and left eigenvectors, in the solver's basis.
#[derive(Clone, Debug)]
pub struct EigenPair {
    /// Wavenumber.
    pub k: WaveVector,
    /// Eigenvalue c0: the mode grows like e^{ct}.
    pub c: C64,
    /// x with L x = c M0 x, of norm 1. One value an unknown of the direct problem, without multipliers of closures.
    pub right: Turned,
    /// y with yᴴ L = c yᴴ M0, of norm 1. One value an equation of the direct problem, boundary conditions included.
    pub left: Turned,
    /// Size of the slow eigenvalues in the spectrum around c, in units of c, see [`unit_of_time`].
    pub scale: f64,
}

/// All finite eigenvalues of L at k, by decreasing real part.
///
/// # Errors
/// The pencil is singular for every c (a gauge that the spec does not name), or the iteration does not converge.
pub fn eigenvalues(problem: &Problem, k: WaveVector) -> Result<Spectrum> {
    if k.is_mean() {
        Reduced::<f64>::new(problem.bordered_pencil())?.eigenvalues()
    } else if problem.is_real() {
        Reduced::<f64>::new(problem.direct.pencil(k))?.eigenvalues()
    } else {
        Reduced::<C64>::new(problem.direct.pencil(k))?.eigenvalues()
    }
}

/// All finite eigenvalues of the separately discretised L† at k, by decreasing real part.
///
/// # Errors
/// As [`eigenvalues`], or the model has no adjoint boundary conditions.
pub fn adjoint_eigenvalues(problem: &Problem, k: WaveVector) -> Result<Spectrum> {
    let adjoint = problem.adjoint()?;
    if k.is_mean() {
        Reduced::<f64>::new(problem.bordered_adjoint_pencil()?)?.eigenvalues()
    } else if problem.is_real() {
        Reduced::<f64>::new(adjoint.pencil(k))?.eigenvalues()
    } else {
        Reduced::<C64>::new(adjoint.pencil(k))?.eigenvalues()
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

/// The leading mode, whose growth rate is largest.
///
/// # Errors
/// The spectrum cannot be computed, the eigenvalue is not simple, or inverse iteration does not converge to it.
pub fn leading(problem: &Problem, k: WaveVector) -> Result<EigenPair> {
    let spectrum = eigenvalues(problem, k)?;
    let c = *spectrum.values.first().ok_or_else(no_modes)?;
    let start = arbitrary(problem.direct.layout.size);
    confirm(problem, k, &spectrum, (c, Turned(start)))
}

/// The mode nearest to a given eigenvalue.
///
/// # Errors
/// As [`leading`].
pub fn nearest(problem: &Problem, k: WaveVector, target: C64) -> Result<EigenPair> {
    nearest_in(problem, k, &eigenvalues(problem, k)?, target)
}

/// The mode nearest to a given eigenvalue; `spectrum` holds all eigenvalues at k.
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
    let start = arbitrary(problem.direct.layout.size);
    confirm(problem, k, spectrum, (c, Turned(start)))
}

/// The continuation of a mode to another wavenumber or base state, by its shape.
///
/// # Errors
/// No mode has a similar shape, or the one that has is not simple or not confirmed, as in [`leading`].
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

/// The mode of the collocation `to` that is the mode `pair` of the collocation `from`: by its interpolated shape, or else
/// by its eigenvalue.
///
/// # Errors
/// As [`nearest`].
pub fn transferred(from: &Problem, pair: &EigenPair, to: &Problem) -> Result<EigenPair> {
    let shape = interpolated(from, &pair.right, to);
    let start = Turned(arbitrary(shape.len()));
    let shift = beside(pair.c, pair.scale);
    match refine(to, pair.k, shift, pair.scale, &shape, &start) {
        Some(refined) if likeness(&shape, &refined.right) > SAME_SHAPE => Ok(refined),
        _ => nearest(to, pair.k, pair.c),
    }
}

/// Values of the unknowns of one collocation, interpolated to the points of another.
pub fn interpolated(from: &Problem, values: &Turned, to: &Problem) -> Turned {
    let (old, new) = (&from.direct.layout, &to.direct.layout);
    let mut shape = Turned(vec![C64::new(0.0, 0.0); new.size]);
    for (a, b) in old.columns.iter().zip(new.columns.iter()) {
        let between = to.space().derivative(a.points, b.points, 0);
        shape[b.range()].copy_from_slice(&between.of(a.of(values)));
    }
    shape
}

/// The mode at −k that is the mirror image of a mode at k, in a model with the mirror symmetry.
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

fn no_modes() -> Error {
    Error::computation("the linear problem has no finite eigenvalue")
}

/// The size of the slow eigenvalues of a spectrum, in units of these: [`Spectrum::scale`], or the rate of the slowest
/// balance where the eigenvalues are zero to rounding beside it.
pub fn unit_of_time(problem: &Problem, k: WaveVector, spectrum: &Spectrum) -> f64 {
    let (scale, rate) = (spectrum.scale(), problem.rate(k));
    if rate.is_finite() && scale <= ZERO * rate {
        rate
    } else {
        scale
    }
}

/// The mode of the eigenvalue c, by inverse iteration from `right`.
///
/// # Errors
/// The eigenvalue is not simple, or the iteration does not converge to it.
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
    let start = Turned(arbitrary(right.len()));
    refine(problem, k, beside(c, scale), scale, &right, &start).ok_or_else(|| {
        // A gap below 10⁻³ of the eigenvalue marks a cluster: discrete modes lie further apart.
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
