//! Discretisations of one problem, which show how far a result can be trusted.

use super::super::Setup;
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::problem::Problem;
use std::sync::Arc;

/// Safety factor of the difference to 3M/2: it covers an error that falls as M^-2.
const TRUNCATION: f64 = 2.0;
/// Safety factor of a difference that shows rounding, which is as good as random.
const SAFETY: f64 = 5.0;

/// A collocation, and the degree of its base state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::study) struct Grid {
    resolution: Option<usize>,
    degree: Degree,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Degree {
    /// At which the base state is resolved.
    Settled,
    /// The next higher one.
    Next,
}

/// Another grid, and the factor by which a difference from it counts as an error.
#[derive(Clone, Copy, Debug)]
pub(in crate::study) struct Beside {
    pub grid: Grid,
    pub factor: f64,
}

/// A base state and the problem around it.
#[derive(Clone)]
pub(in crate::study) struct Site {
    pub base: Arc<BaseState>,
    pub problem: Arc<Problem>,
}

impl Grid {
    /// That of a setup.
    pub fn of(setup: &Setup) -> Self {
        Grid {
            resolution: setup.effective_resolution(),
            degree: Degree::Settled,
        }
    }

    /// That of a setup at 3M/2; nothing without a cross-stream coordinate.
    pub fn finer(setup: &Setup) -> Option<Self> {
        let resolution = setup.finer_resolution()?;
        Some(Grid {
            resolution: Some(resolution),
            degree: Degree::Settled,
        })
    }

    /// Those beside that of a setup: 3M/2; M + 1, which rounds differently; the base state at the next degree.
    pub fn beside(setup: &Setup, base: &BaseState) -> Vec<Beside> {
        let own = Grid::of(setup);
        let mut grids = Vec::new();
        if let Some((m, finer)) = own.resolution.zip(Grid::finer(setup)) {
            let next = Grid {
                resolution: Some(m + 1),
                ..own
            };
            grids.push(Beside {
                grid: finer,
                factor: TRUNCATION,
            });
            grids.push(Beside {
                grid: next,
                factor: SAFETY,
            });
        }
        if base.refined().is_some() {
            let grid = Grid {
                degree: Degree::Next,
                ..own
            };
            grids.push(Beside {
                grid,
                factor: SAFETY,
            });
        }
        grids
    }

    /// Whether its base states have the degree at which they are resolved, so that one is found from another.
    pub fn keeps_degree(self) -> bool {
        self.degree == Degree::Settled
    }

    /// The problem of a setup on this grid; its base state from a neighbouring one where that is given.
    ///
    /// # Errors
    /// A base state that is not found, a coefficient that is not finite.
    pub fn site(self, setup: &Setup, near: Option<&BaseState>) -> Result<Site> {
        let mut base = setup.base(near)?;
        if self.degree == Degree::Next {
            let refined = base.refined();
            let missing = || Error::computation("the base state has no higher degree");
            base = Arc::new(refined.ok_or_else(missing)?);
        }
        let problem = Arc::new(Problem::new(&base, self.resolution)?);
        Ok(Site { base, problem })
    }
}
