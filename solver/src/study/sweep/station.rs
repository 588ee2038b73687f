//! One place of a sweep: its collocations, and the row that a mode has there.

use super::Sweep;
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::model::C64;
use crate::problem::Problem;
use crate::spectrum::{self, EigenPair, Ground, Scout};
use crate::study::accuracy::{landau_error, stands};
use crate::study::derived::Derived;
use crate::study::row::Row;
use crate::study::{Axis, Setup};
use crate::wavevector::WaveVector;
use crate::weakly::{self, Bifurcation, LandauPoint, equilibrium};
use std::sync::Arc;

/// A second-order problem nearer to singularity than this, relative to the slow rates, makes a row no `ok`.
const RESONANT: f64 = 1e-3;
/// Weight of the difference to the coarser collocation. It covers an error that falls as 1/M, of which that difference is a fifth, and
/// a rounding error, which two collocations show by chance.
const SAFETY: f64 = 5.0;

/// The problems of one base state.
pub(super) struct Collocations {
    /// At M.
    pub problem: Arc<Problem>,
    /// At M − M/6: the difference is the error of a row.
    coarser: Option<Arc<Problem>>,
    /// At the resolution of the scout.
    scouting: Option<Arc<Problem>>,
}

impl Collocations {
    pub fn new(setup: &Setup, base: &Arc<BaseState>) -> Result<Self> {
        let at = |m: usize| Problem::new(base, Some(m)).map(Arc::new);
        let problem = setup.problem(base)?;
        let size = problem.direct.layout.size;
        let resolution = setup.effective_resolution();
        let scouting = resolution.and_then(|m| Scout::resolution(m, size));
        Ok(Collocations {
            coarser: resolution.map(|m| at(m - m.div_ceil(6))).transpose()?,
            scouting: scouting.map(at).transpose()?,
            problem,
        })
    }

    /// What a scout needs.
    pub fn ground(&self) -> Ground<'_> {
        Ground {
            fine: &self.problem,
            coarse: self.scouting.as_deref(),
        }
    }

    /// Absolute errors of c0 and c2: the difference from a coarser collocation, and rounding.
    fn errors(&self, point: &LandauPoint) -> [f64; 2] {
        let floor = point.rounding();
        let Some(coarser) = &self.coarser else {
            return floor;
        };
        let point_on_coarser = spectrum::transferred(&self.problem, &point.pair, coarser)
            .and_then(|pair| weakly::from_pair(coarser, pair));
        match point_on_coarser {
            Ok(coarse) => [
                floor[0].max(SAFETY * (coarse.c0 - point.c0).norm()),
                floor[1].max(SAFETY * (coarse.c2 - point.c2).norm()),
            ],
            Err(_) => [f64::INFINITY; 2],
        }
    }
}

/// A place with its problems.
pub(super) struct Station {
    /// One value per axis.
    pub place: Vec<f64>,
    /// The wavevector.
    pub k: WaveVector,
    /// Shared by all places of a line along k.
    pub collocations: Arc<Collocations>,
}

impl Station {
    /// The same place once more; the collocations are shared.
    pub fn again(&self) -> Self {
        Station {
            place: self.place.clone(),
            k: self.k,
            collocations: self.collocations.clone(),
        }
    }
}

impl Sweep<'_> {
    /// The station of a place: with the collocations of its line along k, with a base state of its own otherwise.
    ///
    /// The base state is the one that a single point has. Only where none is found is one tried from a neighbour.
    pub(super) fn station(
        &self,
        place: &[f64],
        line: Option<&Arc<Collocations>>,
        neighbour: Option<&Station>,
    ) -> Result<Station> {
        let (setup, k) = self.at(place)?;
        let collocations = match line {
            Some(collocations) => collocations.clone(),
            None => {
                let near = neighbour.map(|n| n.collocations.problem.base.clone());
                let base = setup.base(None).or_else(|error| match &near {
                    Some(near) => setup.base(Some(near)),
                    None => Err(error),
                })?;
                Arc::new(Collocations::new(&setup, &base)?)
            }
        };
        Ok(Station {
            place: place.to_vec(),
            k,
            collocations,
        })
    }

    /// The setup and the wavevector of a place.
    pub(super) fn at(&self, place: &[f64]) -> Result<(Setup, WaveVector)> {
        let mut setup = self.setup.clone();
        let mut k = self.k;
        for (range, &value) in self.ranges.iter().zip(place) {
            match range.axis {
                Axis::Wavenumber => k = Some(value),
                axis => setup = setup.moved(axis, value)?,
            }
        }
        let k = k.ok_or_else(|| Error::input("no axis is k: give the wavenumber, with --k"))?;
        Ok((setup, WaveVector::wave(k)?))
    }

    /// The row of a mode; `leading` is the growth rate of the leading one.
    pub(super) fn row_of(
        &self,
        station: &Station,
        pair: Result<EigenPair>,
        leading: Option<f64>,
    ) -> Row {
        let derived = self.derived.len();
        let failed = |error: &Error| Row {
            leading,
            ..Row::failed(station.place.clone(), error, derived)
        };
        let pair = match pair {
            Ok(pair) => pair,
            Err(error) => return failed(&error),
        };
        let c0 = [pair.c.re, pair.c.im];
        // Where c2 has no answer, c0 still has one.
        let point = match weakly::from_pair(&station.collocations.problem, pair) {
            Ok(point) => point,
            Err(error) => {
                return Row {
                    c0: Some(c0),
                    ..failed(&error)
                };
            }
        };
        let row = row(&station.collocations, &station.place, &point);
        let value = |column: &Derived| column.value(&point, row.amplitude);
        Row {
            derived: self.derived.iter().map(value).collect(),
            leading,
            ..row
        }
    }
}

/// The row of a point with its errors and distances.
fn row(collocations: &Collocations, place: &[f64], point: &LandauPoint) -> Row {
    let [error0, error2] = collocations.errors(point);
    let scale = point.pair.scale.max(point.c0.norm());
    let [mean_flow, second_harmonic] = point.distances().map(|d| Some(d).filter(|d| d.is_finite()));
    let standing = landau_error(point, error2);
    let (good0, good2) = (stands(error0, point.c0.norm(), scale), standing.is_some());
    let error2 = standing.unwrap_or(error2);
    let near = |d: Option<f64>| d.is_some_and(|d| d <= RESONANT * scale);
    let not_kept = point.multiplier_error(error2);
    let status = if !good0 {
        "c0 is not converged: a larger M".to_owned()
    } else if !good2 {
        "c2 is not converged: a larger M".to_owned()
    } else if let Some(error) = &not_kept {
        error.to_string()
    } else if near(second_harmonic) {
        "near a 2:1 resonance".to_owned()
    } else if near(mean_flow) {
        "near a mean-flow resonance".to_owned()
    } else {
        "ok".to_owned()
    };
    let pair = |c: C64| [c.re, c.im];
    let finite = |error: f64| Some(error).filter(|e| e.is_finite());
    let known = good0 && good2 && not_kept.is_none();
    let (c0, c2) = ((point.c0, error0), (point.c2, error2));
    Row {
        coordinates: place.to_vec(),
        c0: good0.then(|| pair(point.c0)),
        c0_error: finite(error0),
        c2: known.then(|| pair(point.c2)),
        c2_error: finite(error2),
        amplitude: equilibrium(c0, c2).filter(|_| known),
        bifurcation: if known {
            Bifurcation::new(c0, c2).to_string()
        } else {
            String::new()
        },
        mean_flow,
        second_harmonic,
        leading: None,
        derived: Vec::new(),
        status,
    }
}
