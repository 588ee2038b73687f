//! One Fourier mode of the expansion, and its derivatives where nonlinear terms need them.

use crate::model::{C64, FieldId, Jet};
use crate::problem::{Problem, Profile, symbol};
use crate::space::{Place, Points};
use crate::wavevector::WaveVector;

/// Values of a mode and of its time derivative, at the unknowns' points.
#[derive(Clone, Debug)]
pub struct Mode {
    /// Its wavenumber: ∂x → i q.
    pub q: WaveVector,
    /// X
    pub values: Profile,
    /// What stands beside the same amplitudes in ∂t X.
    pub rate: Profile,
    /// The part of it that is no multiple of a mode: constants that drift (mean modes alone).
    pub drift: Option<Profile>,
    /// Unknown numbers (mean modes alone).
    pub numbers: Vec<(FieldId, C64)>,
}

impl Mode {
    /// A mode that moves as `rate` says.
    pub fn new(q: WaveVector, values: Profile, rate: Profile) -> Self {
        Mode {
            q,
            values,
            rate,
            drift: None,
            numbers: Vec::new(),
        }
    }

    /// The mode of −q: complex conjugate.
    pub fn conjugate(&self) -> Mode {
        let numbers = self.numbers.iter();
        Mode {
            q: -self.q,
            values: self.values.conjugate(),
            rate: self.rate.conjugate(),
            drift: self.drift.as_ref().map(Profile::conjugate),
            numbers: numbers.map(|(field, v)| (*field, v.conj())).collect(),
        }
    }

    /// Jets at some points, one after another; those that differ in ∂x alone share one derivative of the profile.
    pub fn columns(&self, problem: &Problem, jets: &[Jet], points: Points) -> Vec<Vec<C64>> {
        let mut derived: Vec<(Jet, Vec<C64>)> = Vec::new();
        let column = |&jet: &Jet| {
            let profile = jet.profile();
            let known = derived.iter().position(|(other, _)| *other == profile);
            let known = known.unwrap_or_else(|| {
                derived.push((profile, self.profile(problem, profile, points)));
                derived.len() - 1
            });
            let factor = symbol(&jet, self.q);
            let mut values: Vec<C64> = derived[known].1.iter().map(|v| factor * v).collect();
            problem.disturb_jet(jet, &mut values);
            values
        };
        jets.iter().map(column).collect()
    }

    /// Jets at some points, point by point.
    pub fn jets(&self, problem: &Problem, jets: &[Jet], points: Points) -> JetTable {
        let mut values = vec![C64::new(0.0, 0.0); points.count() * jets.len()];
        let columns = self.columns(problem, jets, points);
        for (position, column) in columns.into_iter().enumerate() {
            let entries = values.iter_mut().skip(position).step_by(jets.len());
            entries
                .zip(column)
                .for_each(|(entry, value)| *entry = value);
        }
        JetTable {
            jets: jets.len(),
            values,
        }
    }

    /// What rounding can make of the jets, point by point, in units of the machine's precision:
    /// Σ |D| max |value| in place of D value.
    pub fn rounding(&self, problem: &Problem, jets: &[Jet], points: Points) -> Vec<Vec<f64>> {
        let mut table = vec![vec![0.0; jets.len()]; points.count()];
        for (position, jet) in jets.iter().enumerate() {
            let Some(block) = problem.direct.layout.columns.find(jet.of) else {
                continue;
            };
            let source = if jet.t == 0 { &self.values } else { &self.rate };
            // Every value was solved for, to the precision of the largest.
            let values = block.of(source).iter();
            let largest = values.map(|v| v.norm()).fold(0.0, f64::max);
            let size = symbol(jet, self.q).norm() * largest;
            let derivative = problem
                .space()
                .derivative(block.points, points, jet.y.into());
            for (row, sum) in table.iter_mut().zip(derivative.amplification()) {
                row[position] = size * sum;
            }
        }
        table
    }

    /// One jet at some points.
    pub fn jet(&self, problem: &Problem, jet: Jet, points: Points) -> Vec<C64> {
        let factor = symbol(&jet, self.q);
        let values = self.profile(problem, jet, points).into_iter();
        values.map(|v| factor * v).collect()
    }

    /// One jet at any places.
    pub fn at(&self, problem: &Problem, jet: Jet, places: &[Place]) -> Vec<C64> {
        match problem.direct.layout.columns.find(jet.of) {
            None => vec![self.number(jet.of); places.len()],
            Some(block) => {
                let own = self.jet(problem, jet, block.points);
                problem.space().interpolated(block.points, &own, places)
            }
        }
    }

    /// An unknown number; zero where the mode has none.
    fn number(&self, field: FieldId) -> C64 {
        let found = self.numbers.iter().find(|(other, _)| *other == field);
        found.map_or(C64::new(0.0, 0.0), |(_, value)| *value)
    }

    /// ∂t and ∂y of a jet at some points, its x-derivatives left out.
    fn profile(&self, problem: &Problem, jet: Jet, points: Points) -> Vec<C64> {
        let Some(block) = problem.direct.layout.columns.find(jet.of) else {
            return vec![self.number(jet.of); points.count()];
        };
        let source = if jet.t == 0 { &self.values } else { &self.rate };
        let derivative = problem
            .space()
            .derivative(block.points, points, jet.y.into());
        derivative.of(block.of(source))
    }
}

/// Jets at some points, point by point.
#[derive(Clone, Debug)]
pub struct JetTable {
    jets: usize,
    values: Vec<C64>,
}

impl JetTable {
    /// All jets at one point.
    pub fn at(&self, point: usize) -> &[C64] {
        &self.values[point * self.jets..][..self.jets]
    }

    /// Multiplies each jet, by its position, by a factor of its own.
    pub fn weigh(&mut self, factor: impl Fn(usize) -> C64) {
        for (position, value) in self.values.iter_mut().enumerate() {
            *value *= factor(position % self.jets);
        }
    }

    /// The jets of the conjugate mode.
    pub fn conjugate(&self) -> JetTable {
        JetTable {
            jets: self.jets,
            values: self.values.iter().map(|v| v.conj()).collect(),
        }
    }
}
