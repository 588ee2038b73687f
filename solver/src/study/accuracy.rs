//! How far a Landau point can be trusted: M against 3M/2, and one route against the other.

use super::quadrature::{adjoint_mode, second_landau};
use super::{Setup, distance};
use crate::base::BaseState;
use crate::error::Result;
use crate::model::C64;
use crate::spectrum;
use crate::weakly::{LandauPoint, Selection};

/// Absolute errors of c0 and c2.
#[derive(Clone, Copy, Debug)]
pub struct Accuracy {
    pub c0: f64,
    pub c2: f64,
}

/// Distances of the second-order problems from singularity.
#[derive(Clone, Copy, Debug)]
pub struct Resonance {
    /// min |2 a0 − λ(L_0)|, conserved directions set aside, P (5.5).
    pub mean_flow: f64,
    /// min |2 c0 − λ(L_2)|, P (5.6).
    pub second_harmonic: f64,
}

/// Differences between resolutions and between routes; infinite where the finer problem has no
/// answer.
///
/// # Errors
/// A c2 by quadrature that cannot be formed.
pub fn accuracy(setup: &Setup, base: &BaseState, point: &LandauPoint) -> Result<Accuracy> {
    let mut found = Accuracy {
        c0: 1e-15 * point.c0.norm(),
        c2: 1e-14 * point.c2.norm(),
    };
    let k = point.expansion.k;
    if setup.effective_resolution() > 0 {
        let mut finer = setup.clone();
        finer.resolution = setup.resolution + setup.resolution.div_ceil(2);
        let near = Selection::Near(point.c0);
        let (c0, c2) = finer
            .with_point(base, k, near, |finer| Ok((finer.c0, finer.c2)))
            .unwrap_or((C64::new(f64::INFINITY, 0.0), C64::new(f64::INFINITY, 0.0)));
        found.c0 = found.c0.max((c0 - point.c0).norm());
        found.c2 = found.c2.max((c2 - point.c2).norm());
    }
    let problem = point.expansion.problem;
    // Without adjoint conditions, or where the adjoint mode hides in a cluster, one route remains.
    if let Ok(adjoint) = adjoint_mode(problem, k, point.c0) {
        found.c0 = found.c0.max((adjoint.c.conj() - point.c0).norm());
        if let Some(c2) = second_landau(point, &adjoint)? {
            found.c2 = found.c2.max((c2 - point.c2).norm());
        }
    }
    Ok(found)
}

/// How near the second-order problems are to resonance.
///
/// # Errors
/// Spectra that cannot be computed.
pub fn resonance(point: &LandauPoint) -> Result<Resonance> {
    let problem = point.expansion.problem;
    let mean = spectrum::eigenvalues(problem, 0.0);
    let second = spectrum::eigenvalues(problem, 2.0 * point.expansion.k)?;
    // A model whose mean modes are all closed by integrals has no mean spectrum to meet.
    let mean_flow = mean.map_or(f64::INFINITY, |mean| {
        distance(C64::new(2.0 * point.c0.re, 0.0), &mean)
    });
    Ok(Resonance {
        mean_flow,
        second_harmonic: distance(2.0 * point.c0, &second),
    })
}
