//! The one place where errors of computed quantities come from.
//!
//! A quantity is computed again on companions of the problem, and the differences are its error bar:
//!
//! | companion | shows | weight |
//! |---|---|---|
//! | 3M/2 | truncation of the perturbation | [`TRUNCATION`] |
//! | M + 1 | truncation, and rounding: the same size, other digits | [`SAFETY`] |
//! | base state at the next degree | the error of the base state | [`SAFETY`] |
//! | data and k with relative noise η, several draws | rounding, amplified by whatever is nearly singular or cancels | [`ROUNDINGS`] ε/η |
//!
//! What follows from such quantities by a formula has the error that the formula makes of theirs ([`Measured`]).

use super::Setup;
use crate::error::Result;
use crate::measured::Measured;
use crate::model::C64;
use crate::numerics::Noise;
use crate::problem::Problem;
use crate::spectrum::{self, EigenPair};
use rayon::prelude::*;
use std::sync::Arc;

/// Weight of the difference to 3M/2: it covers an error that falls as M^-2, of which that difference is five ninths.
pub const TRUNCATION: f64 = 2.0;
/// Weight of differences that show a rounding error by another one of the same size.
pub const SAFETY: f64 = 5.0;
/// Rounding errors of the data that a result is allowed to be wrong by, in units of the machine's precision.
pub const ROUNDINGS: f64 = 32.0;
/// Draws of noise.
const DRAWS: u64 = 3;
/// The stream of the noise in k.
const WAVENUMBER: u64 = 5;

/// The modes of a computation on another collocation, another base state, or with other rounding.
pub struct Companion {
    /// The collocated problem.
    pub problem: Arc<Problem>,
    /// The modes there, in the order of those that they are compared with.
    pub pairs: Vec<EigenPair>,
    /// By how much a difference to it is multiplied.
    pub weight: f64,
}

/// The companions of some modes of a problem; an error where the modes are not found there.
pub struct Companions {
    all: Vec<Result<Companion>>,
}

impl Companions {
    /// All companions of some modes.
    pub fn of(setup: &Setup, problem: &Arc<Problem>, pairs: &[EigenPair]) -> Self {
        let m = setup.effective_resolution();
        let mut kinds: Vec<Kind> = (0..DRAWS).map(Kind::Noise).collect();
        if let Some((m, finer)) = m.zip(setup.finer_resolution()) {
            kinds.push(Kind::Resolution(m + 1, SAFETY));
            kinds.push(Kind::Resolution(finer, TRUNCATION));
        }
        kinds.push(Kind::Base);
        let made = kinds.into_par_iter();
        let made = made.filter_map(|kind| kind.companion(problem, pairs).transpose());
        Companions {
            all: made.collect(),
        }
    }

    /// Absolute errors of some quantities; infinite where a companion does not have them.
    ///
    /// `quantities` are those of the problem itself, `on` computes them on a companion. A quantity that is no number
    /// there counts as not found.
    pub fn errors(
        &self,
        quantities: &[C64],
        on: impl Fn(&Companion) -> Result<Vec<C64>> + Sync,
    ) -> Vec<f64> {
        let differences = |companion: &Result<Companion>| -> Vec<f64> {
            let known = companion.as_ref().ok().and_then(|c| {
                let values = on(c).ok()?;
                Some((values, c.weight))
            });
            let Some((values, weight)) = known else {
                return vec![f64::INFINITY; quantities.len()];
            };
            let difference = |(index, here): (usize, &C64)| {
                let there = values.get(index).copied();
                let size = there.map_or(f64::INFINITY, |there| weight * (there - here).norm());
                if size.is_nan() { f64::INFINITY } else { size }
            };
            quantities.iter().enumerate().map(difference).collect()
        };
        let columns: Vec<Vec<f64>> = self.all.par_iter().map(differences).collect();
        let largest = |index| columns.iter().map(|c| c[index]).fold(0.0, f64::max);
        (0..quantities.len()).map(largest).collect()
    }

    /// The quantities with their errors, see [`Companions::errors`].
    pub fn measured(
        &self,
        quantities: &[C64],
        on: impl Fn(&Companion) -> Result<Vec<C64>> + Sync,
    ) -> Vec<Measured<C64>> {
        let errors = self.errors(quantities, on).into_iter();
        let values = quantities.iter().copied().zip(errors);
        values
            .map(|(value, error)| Measured::new(value, error))
            .collect()
    }

    /// The companions one by one.
    pub fn iter(&self) -> impl Iterator<Item = &Result<Companion>> {
        self.all.iter()
    }
}

/// What a companion differs in.
#[derive(Clone, Copy)]
enum Kind {
    Noise(u64),
    /// M and the weight.
    Resolution(usize, f64),
    Base,
}

impl Kind {
    /// The companion; nothing where the base state has no next degree.
    fn companion(self, problem: &Arc<Problem>, pairs: &[EigenPair]) -> Result<Option<Companion>> {
        let (base, m) = (&problem.base, problem.resolution);
        let (companion, weight) = match self {
            Kind::Noise(draw) => {
                let noise = Noise::new(draw);
                let disturbed = Arc::new(problem.disturbed(noise));
                let stretch = noise.stream(WAVENUMBER).factor(0);
                let followed = pairs
                    .iter()
                    .map(|pair| spectrum::follow(&disturbed, stretch * pair.k, pair));
                return Ok(Some(Companion {
                    pairs: followed.collect::<Result<_>>()?,
                    problem: disturbed,
                    weight: ROUNDINGS * f64::EPSILON / Noise::SIZE,
                }));
            }
            Kind::Resolution(m, weight) => (Problem::new(base, Some(m))?, weight),
            Kind::Base => match base.refined() {
                Some(refined) => (Problem::new(&Arc::new(refined), m)?, SAFETY),
                None => return Ok(None),
            },
        };
        let transferred = pairs
            .iter()
            .map(|pair| spectrum::transferred(problem, pair, &companion));
        Ok(Some(Companion {
            pairs: transferred.collect::<Result<_>>()?,
            problem: Arc::new(companion),
            weight,
        }))
    }
}
