//! One Fourier mode of the expansion, and its derivatives where nonlinear terms need them.

use crate::model::{C64, FieldId, Jet};
use crate::problem::{Problem, Profile, symbol};
use crate::space::{Place, Points};
use crate::wavevector::WaveVector;

/// One Fourier mode e^{iqx} of the expansion, in physical values at the points of the unknowns.
#[derive(Clone, Debug)]
pub struct Mode {
    /// Wavenumber: ∂x is multiplication by i q.
    pub q: WaveVector,
    /// X_α: the values of one field after another, by the layout of the direct problem.
    pub values: Profile,
    /// The coefficient of the same monomial in ∂t X, with the layout of `values`.
    pub rate: Profile,
    /// The part of `rate` in which constants drift, such as the constant of a pressure; only at q = 0.
    pub drift: Option<Profile>,
    /// Unknown numbers of the model, such as a mean pressure gradient; only at q = 0.
    pub numbers: Vec<(FieldId, C64)>,
}

impl Mode {
    /// A mode without drift and unknown numbers.
    pub fn new(q: WaveVector, values: Profile, rate: Profile) -> Self {
        Mode {
            q,
            values,
            rate,
            drift: None,
            numbers: Vec::new(),
        }
    }

    /// The complex conjugate, a mode of −q.
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

    /// Jets at the points of a family, `[jet][point]`. Jets that differ in ∂x alone share one derivative of the profile.
    pub fn columns(&self, problem: &Problem, jets: &[Jet], points: Points) -> Vec<Vec<C64>> {
        let mut profiles: Vec<(Jet, Vec<C64>)> = Vec::new();
        let column = |&jet: &Jet| {
            let without_x = jet.profile();
            let computed = profiles.iter().position(|(jet, _)| *jet == without_x);
            let position = computed.unwrap_or_else(|| {
                profiles.push((without_x, self.profile(problem, without_x, points)));
                profiles.len() - 1
            });
            let factor = symbol(&jet, self.q);
            let profile = &profiles[position].1;
            let mut values: Vec<C64> = profile.iter().map(|v| factor * v).collect();
            problem.disturb_jet(jet, &mut values);
            values
        };
        jets.iter().map(column).collect()
    }

    /// Jets at the points of a family, point by point.
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

    /// Bounds of the rounding errors of jets, `[point][jet]`, in units of the machine's precision times the jet:
    /// Σ_j |D_ij| max |value| in place of Σ_j D_ij value_j.
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

    /// One jet at the points of a family, `[point]`.
    pub fn jet(&self, problem: &Problem, jet: Jet, points: Points) -> Vec<C64> {
        let factor = symbol(&jet, self.q);
        let values = self.profile(problem, jet, points).into_iter();
        values.map(|v| factor * v).collect()
    }

    /// One jet at any places of the interval, `[place]`.
    pub fn at(&self, problem: &Problem, jet: Jet, places: &[Place]) -> Vec<C64> {
        match problem.direct.layout.columns.find(jet.of) {
            None => vec![self.number(jet.of); places.len()],
            Some(block) => {
                let values = self.jet(problem, jet, block.points);
                problem.space().interpolated(block.points, &values, places)
            }
        }
    }

    /// An unknown number; zero where the mode has none.
    fn number(&self, field: FieldId) -> C64 {
        let number = self.numbers.iter().find(|(id, _)| *id == field);
        number.map_or(C64::new(0.0, 0.0), |(_, value)| *value)
    }

    /// A jet without its x-derivatives, at the points of a family.
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

/// Jets at the points of a family, point by point.
#[derive(Clone, Debug)]
pub struct JetTable {
    jets: usize,
    values: Vec<C64>,
}

impl JetTable {
    /// All jets at one point, `[jet]`.
    pub fn at(&self, point: usize) -> &[C64] {
        &self.values[point * self.jets..][..self.jets]
    }

    /// Multiplies every jet by `factor(position of the jet)`.
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
