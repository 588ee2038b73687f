//! Checks a base state in closed form against its balances, and every base state against its conditions.

use super::BaseState;
use crate::error::{Error, Result};
use crate::model::{End, Model, ResidualId, WithRounding};
use crate::space::Place;
use crate::wavevector::WaveVector;

/// Places at which a closed base state is checked against its balances.
const CHECKS: usize = 7;

/// Up to here a residual is rounding. This bound and the next two are relative to the terms of the balance or condition,
/// taken before they cancel.
const ROUNDED: f64 = 1e-9;

/// Up to here the residual of a balance is due to numbers that are written with six or more digits.
const NEARLY_BALANCED: f64 = 1e-6;

/// Up to here the residual of a condition is due to the tail of a profile that decays towards an end: e^{−7} is 9 · 10⁻⁴.
const NEARLY_MET: f64 = 1e-3;

/// The residual of a balance or of a condition at the base state.
struct Leftover {
    /// Line of the spec.
    line: usize,
    /// Which balance or condition, in words.
    name: String,
    residual: WithRounding,
    /// The place, as ` at y = 1`.
    place: String,
    /// Relative size up to which the residual is a note, and beyond which it is an error.
    noted: f64,
    /// What to do where it is an error.
    remedy: String,
}

impl Leftover {
    /// Size relative to the terms before they cancel.
    fn relative(&self) -> f64 {
        if self.residual.value == 0.0 {
            0.0
        } else {
            (self.residual.value / self.residual.size).abs()
        }
    }

    /// Whether the relative size is at most `bound`; never for NaN.
    fn is_within(&self, bound: f64) -> bool {
        self.relative() <= bound
    }
}

/// `file:line` of a line of the spec.
pub(super) fn spec_line(model: &dyn Model, line: usize) -> String {
    let files = model.sources();
    let path = files.first().map_or("the spec", |(path, _)| path.as_str());
    match line {
        0 => path.to_owned(),
        line => format!("{path}:{line}"),
    }
}

impl BaseState {
    /// A base in closed form has to satisfy the balances, and what is given of it its wall conditions; notes what it
    /// satisfies but nearly.
    ///
    /// # Errors
    /// Names the worst of those that do not hold, its place in the spec, and what to do.
    pub(super) fn checked(mut self) -> Result<Self> {
        let leftovers = self.leftovers();
        let larger = |a: &&Leftover, b: &&Leftover| {
            // NaN is the largest.
            let size = |l: &Leftover| {
                if l.relative().is_nan() {
                    f64::INFINITY
                } else {
                    l.relative()
                }
            };
            (size(a) / a.noted).total_cmp(&(size(b) / b.noted))
        };
        let refused = leftovers
            .iter()
            .filter(|l| !l.is_within(l.noted))
            .max_by(larger);
        if let Some(worst) = refused {
            return Err(Error::computation(self.refusal(worst)));
        }
        let noted = leftovers.iter().filter(|l| !l.is_within(ROUNDED));
        self.notes = noted
            .map(|l| {
                format!(
                    "{}: the base state satisfies {}{} but for {:.1e}, {:.0e} of its terms: results are uncertain by a like \
                     fraction",
                    spec_line(self.model.as_ref(), l.line),
                    l.name,
                    l.place,
                    l.residual.value.abs(),
                    l.relative()
                )
            })
            .collect();
        Ok(self)
    }

    fn refusal(&self, worst: &Leftover) -> String {
        let spec = spec_line(self.model.as_ref(), worst.line);
        let Leftover {
            name,
            place,
            remedy,
            ..
        } = worst;
        if !worst.residual.value.is_finite() {
            return format!(
                "{spec}: the base state has no value in {name}{place}; try other parameters, or another closed form"
            );
        }
        format!(
            "{spec}: the base state does not satisfy {name}: residual {:.3e}{place}, {:.1e} of its terms; {remedy}",
            worst.residual.value,
            worst.relative()
        )
    }

    /// What is left of every condition, and of every balance where it is largest.
    fn leftovers(&self) -> Vec<Leftover> {
        let structure = self.structure();
        let place = |check: usize| Place::at((check as f64 + 0.5) / CHECKS as f64);
        let points: Vec<_> = (0..CHECKS)
            .map(|check| self.at(place(check), WaveVector::MEAN))
            .collect();
        // What a closed form cancels does not show in its value: each jet is as uncertain as at its largest.
        let sizes: Vec<f64> = structure
            .residual_jets
            .iter()
            .map(|jet| {
                let values = points.iter().map(|p| structure.base_jet(*jet, p).abs());
                values.fold(0.0, f64::max)
            })
            .collect();
        let mut leftovers = Vec::new();
        if structure.base.solved.is_empty() {
            for point in &points {
                leftovers.extend(self.balances(point, &sizes));
            }
        }
        for end in End::BOTH {
            leftovers.extend(self.conditions(end, &sizes));
        }
        // Of each balance keep the largest.
        leftovers.sort_by(|a, b| {
            (a.line, &a.name)
                .cmp(&(b.line, &b.name))
                .then(b.relative().total_cmp(&a.relative()))
        });
        leftovers.dedup_by(|a, b| (a.line, &a.name) == (b.line, &b.name));
        leftovers
    }

    fn balances(&self, point: &[f64], sizes: &[f64]) -> Vec<Leftover> {
        let structure = self.structure();
        let residuals = self.residual(ResidualId::Balances, point, sizes);
        let names = structure.balances.iter().zip(&structure.lines.balances);
        let all = names.zip(residuals).map(|((name, &line), residual)| Leftover {
            line,
            name: format!("the balance `{name}`"),
            residual,
            place: self.place(point),
            noted: NEARLY_BALANCED,
            remedy: "the closed forms in `base` have to solve it: correct them, or leave out a field to have it solved for"
                .to_owned(),
        });
        all.collect()
    }

    fn conditions(&self, end: End, sizes: &[f64]) -> Vec<Leftover> {
        let structure = self.structure();
        let point = self.at_end(end);
        let checks = &structure.cases[self.case].base_checks;
        let residuals = self.residual(ResidualId::BaseChecks(self.case), &point, sizes);
        let here = checks
            .iter()
            .zip(residuals)
            .filter(|(check, _)| check.end == end);
        let coordinate = structure.coordinate.as_deref().unwrap_or("y");
        let all = here.map(|(check, residual)| Leftover {
            line: check.line,
            name: format!("its own condition `{}`", check.written),
            residual,
            place: self.place(&point),
            noted: NEARLY_MET,
            remedy: format!(
                "where the base state is meant to have a value of its own there, say so in `base`, as in `at {coordinate} = \
                 … {{ … }}`, and the condition in `boundary` is one of the perturbation alone; where a decaying profile is \
                 cut off, move that end outwards"
            ),
        });
        all.collect()
    }

    /// ` at y = 1`
    fn place(&self, point: &[f64]) -> String {
        let structure = self.structure();
        let name = structure.coordinate.as_ref();
        name.map_or(String::new(), |name| {
            format!(" at {name} = {}", point[structure.state().coordinate()])
        })
    }

    /// The unexpanded residuals at the base state, whose jets are as large as `sizes` somewhere.
    fn residual(&self, id: ResidualId, point: &[f64], sizes: &[f64]) -> Vec<WithRounding> {
        let structure = self.structure();
        let jets = structure.residual_jets.iter().zip(sizes);
        let jets: Vec<WithRounding> = jets
            .map(|(jet, &size)| {
                let value = structure.base_jet(*jet, point);
                let size = size.max(value.abs());
                WithRounding { value, size }
            })
            .collect();
        let kernel = self.model.residual(id);
        kernel.map_or_else(Vec::new, |kernel| kernel.evaluate(point, &jets))
    }
}
