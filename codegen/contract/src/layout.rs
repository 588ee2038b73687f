//! The order of the outputs of kernels. The generator writes and the solver reads those that are more than a list of
//! numbers by the functions of this file. The plain lists are described at [`KernelId`].

use crate::ids::{BalanceId, BaseRowId, Id, Table};
use crate::jet::{End, Jet};
use crate::structure::{
    AdjointConditionInfo, AmplitudeInfo, BaseJet, BaseRowInfo, CaseInfo, ClosureInfo,
    ConditionInfo, KernelId, OutputInfo, Structure, TermInfo,
};

/// A value with its derivative by each of some base jets.
#[derive(Clone, Debug)]
pub struct Linearised<T> {
    /// The value.
    pub value: T,
    /// Its derivatives, in the order of the jets.
    pub slopes: Vec<T>,
}

impl<T> Linearised<T> {
    fn write(self, out: &mut Vec<T>) {
        out.push(self.value);
        out.extend(self.slopes);
    }
}

/// Reads outputs from the first to the last, one shape after another.
struct Reader<'a> {
    unread: &'a [f64],
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> &'a [f64] {
        let (taken, unread) = self.unread.split_at(count);
        self.unread = unread;
        taken
    }

    fn number(&mut self) -> f64 {
        self.take(1)[0]
    }

    fn linearised(&mut self, jets: &[BaseJet]) -> Linearised<f64> {
        Linearised {
            value: self.number(),
            slopes: self.take(jets.len()).to_vec(),
        }
    }
}

/// Outputs of [`KernelId::Base`] and [`KernelId::BaseConditions`]: each residual, then its derivatives.
pub fn write_linearised<T>(rows: Vec<Linearised<T>>) -> Vec<T> {
    let mut out = Vec::new();
    rows.into_iter().for_each(|row| row.write(&mut out));
    out
}

/// One row of the base problem, from the outputs of [`KernelId::Base`].
pub fn read_base_row(
    rows: &Table<BaseRowId, BaseRowInfo>,
    row: BaseRowId,
    out: &[f64],
) -> Linearised<f64> {
    let mut reader = Reader { unread: out };
    let before = rows.iter().take(row.index());
    before.for_each(|row| {
        reader.linearised(&row.jets);
    });
    reader.linearised(&rows[row].jets)
}

/// The conditions of the base state at one end, each with its jets, from the outputs of [`KernelId::BaseConditions`] at
/// that end.
pub fn read_base_conditions<'a>(
    case: &'a CaseInfo,
    end: End,
    out: &[f64],
) -> Vec<(&'a [BaseJet], Linearised<f64>)> {
    let mut reader = Reader { unread: out };
    let read = case.base_conditions.iter().map(|condition| {
        let value = reader.linearised(&condition.jets);
        (condition, value)
    });
    let read: Vec<_> = read.collect();
    read.into_iter()
        .filter(|(c, _)| c.end == end)
        .map(|(c, value)| (c.jets.as_slice(), value))
        .collect()
}

/// Outputs of [`KernelId::BaseIntegrals`]: each integrand, its derivatives, the prescribed value of its integral.
pub fn write_integrals<T>(integrals: Vec<(Linearised<T>, T)>) -> Vec<T> {
    let mut out = Vec::new();
    for (integrand, prescribed) in integrals {
        integrand.write(&mut out);
        out.push(prescribed);
    }
    out
}

/// Integrand and prescribed value of the integral at `index`, from the outputs of [`KernelId::BaseIntegrals`] at one
/// point.
pub fn read_integral(
    integrals: &[Vec<BaseJet>],
    index: usize,
    out: &[f64],
) -> (Linearised<f64>, f64) {
    let mut reader = Reader { unread: out };
    for jets in &integrals[..index] {
        reader.linearised(jets);
        reader.number();
    }
    (reader.linearised(&integrals[index]), reader.number())
}

/// Outputs of [`KernelId::Conditions`] and [`KernelId::AdjointConditions`]: the coefficients of each condition.
pub fn write_conditions<T>(conditions: Vec<Vec<T>>) -> Vec<T> {
    conditions.into_iter().flatten().collect()
}

/// Each condition with its monomials and their coefficients, from the outputs of [`KernelId::Conditions`] at the lower and
/// at the upper end.
pub fn read_conditions<'a>(
    conditions: &'a [ConditionInfo],
    out: [&'a [f64]; 2],
) -> impl Iterator<Item = (End, Vec<(&'a [Jet], f64)>)> {
    let mut ends = EndsReader::new(out);
    conditions.iter().map(move |condition| {
        let values = ends.take(condition.end, condition.monomials.len());
        let monomials = condition.monomials.iter().map(Vec::as_slice);
        (condition.end, monomials.zip(values).collect())
    })
}

/// Each adjoint condition with its jets and their coefficients, from the outputs of [`KernelId::AdjointConditions`] at the
/// lower and at the upper end.
pub fn read_adjoint_conditions<'a>(
    conditions: &'a [AdjointConditionInfo],
    out: [&'a [f64]; 2],
) -> impl Iterator<Item = (End, Vec<(Jet<BalanceId>, f64)>)> {
    let mut ends = EndsReader::new(out);
    conditions.iter().map(move |condition| {
        let values = ends.take(condition.end, condition.jets.len());
        let jets = condition.jets.iter().copied();
        (condition.end, jets.zip(values).collect())
    })
}

/// Reads the outputs of one kernel at both ends. Every condition has outputs at both, and means one of them.
struct EndsReader<'a> {
    lower: Reader<'a>,
    upper: Reader<'a>,
}

impl<'a> EndsReader<'a> {
    fn new([lower, upper]: [&'a [f64]; 2]) -> Self {
        EndsReader {
            lower: Reader { unread: lower },
            upper: Reader { unread: upper },
        }
    }

    /// The next `count` outputs at `end`.
    fn take(&mut self, end: End, count: usize) -> impl Iterator<Item = f64> + use<'a> {
        let (lower, upper) = (self.lower.take(count), self.upper.take(count));
        let values = match end {
            End::Lower => lower,
            End::Upper => upper,
        };
        values.iter().copied()
    }
}

/// The weights of a closure of the problems at k = 0.
#[derive(Clone, Debug)]
pub struct ClosureWeights<T> {
    /// Weights of the jets in ∫ density dy = 0.
    pub density: Vec<T>,
    /// Weights with which the multiplier enters balances.
    pub column: Vec<T>,
}

/// Outputs of [`KernelId::Closures`]: of each closure its density, then its column.
pub fn write_closures<T>(closures: Vec<ClosureWeights<T>>) -> Vec<T> {
    let weights = closures.into_iter();
    weights
        .flat_map(|c| c.density.into_iter().chain(c.column))
        .collect()
}

/// The weights of the closure at `index`, from the outputs of [`KernelId::Closures`] at one point.
pub fn read_closure(closures: &[ClosureInfo], index: usize, out: &[f64]) -> ClosureWeights<f64> {
    let mut reader = Reader { unread: out };
    let mut weights = |info: &ClosureInfo| ClosureWeights {
        density: reader.take(info.density.len()).to_vec(),
        column: reader.take(info.column.len()).to_vec(),
    };
    closures[..index].iter().for_each(|info| {
        weights(info);
    });
    weights(&closures[index])
}

/// The quantity that the amplitude measures, which fixes the size of a mode.
#[derive(Clone, Debug)]
pub enum Measure<T> {
    /// ∫ Σ w|q|² dy = value
    Integral {
        /// w, by weighted field.
        weights: Vec<T>,
        /// The value.
        value: T,
    },
    /// |q(place)| = value
    Point {
        /// The value.
        value: T,
        /// y; zero without a cross-stream coordinate.
        place: T,
    },
}

/// Outputs of [`KernelId::Amplitude`]: weights and value, or value and place.
pub fn write_measure<T>(measure: Measure<T>) -> Vec<T> {
    match measure {
        Measure::Integral { mut weights, value } => {
            weights.push(value);
            weights
        }
        Measure::Point { value, place } => vec![value, place],
    }
}

/// The measure of the amplitude, from the outputs of [`KernelId::Amplitude`] at one point.
pub fn read_measure(info: &AmplitudeInfo, out: &[f64]) -> Measure<f64> {
    let mut reader = Reader { unread: out };
    match info.field {
        None => Measure::Integral {
            weights: reader.take(info.weighted.len()).to_vec(),
            value: reader.number(),
        },
        Some(_) => Measure::Point {
            value: reader.number(),
            place: reader.number(),
        },
    }
}

/// An output functional at one point.
#[derive(Clone, Debug)]
pub struct OutputTerms<T> {
    /// y of an output at a place; zero for an integral.
    pub place: T,
    /// One coefficient for each monomial of [`OutputInfo::monomials`].
    pub coefficients: Vec<T>,
}

/// Outputs of [`KernelId::Outputs`]: of each output functional its place, then its coefficients.
pub fn write_outputs<T>(outputs: Vec<OutputTerms<T>>) -> Vec<T> {
    let terms = outputs.into_iter();
    terms
        .flat_map(|o| std::iter::once(o.place).chain(o.coefficients))
        .collect()
}

/// The output functional at `index`, from the outputs of [`KernelId::Outputs`] at one point.
pub fn read_output(outputs: &[OutputInfo], index: usize, out: &[f64]) -> OutputTerms<f64> {
    let mut reader = Reader { unread: out };
    let mut terms = |info: &OutputInfo| OutputTerms {
        place: reader.number(),
        coefficients: reader.take(info.monomials.len()).to_vec(),
    };
    outputs[..index].iter().for_each(|info| {
        terms(info);
    });
    terms(&outputs[index])
}

/// The terms of an operator with their coefficients, from the outputs of [`KernelId::Linear`] or [`KernelId::Adjoint`] at
/// one point.
pub fn read_terms<'a, Row, Column>(
    terms: &'a [TermInfo<Row, Column>],
    out: &'a [f64],
) -> impl Iterator<Item = (&'a TermInfo<Row, Column>, f64)> {
    terms.iter().zip(out.iter().copied())
}

/// Number of outputs of a real kernel.
pub fn output_length(structure: &Structure, kernel: KernelId) -> usize {
    let jets = |list: &Vec<BaseJet>| 1 + list.len();
    match kernel {
        KernelId::Interval => 2,
        KernelId::Closed => structure.fields.len() * (structure.base_order + 1),
        KernelId::Guess => structure.base.solved.len(),
        KernelId::Base => structure.base.rows.iter().map(|r| jets(&r.jets)).sum(),
        KernelId::BaseIntegrals => structure.base.integrals.iter().map(|i| jets(i) + 1).sum(),
        KernelId::Automatic => structure.base.automatic.len(),
        KernelId::BaseConditions(case) => {
            let conditions = structure.cases[case].base_conditions.iter();
            conditions.map(|c| jets(&c.jets)).sum()
        }
        KernelId::Divisors => structure.balances.len(),
        KernelId::Linear => structure.linear.len(),
        KernelId::Adjoint => structure.adjoint.len(),
        KernelId::Nonlinear => structure.form_coefficients,
        KernelId::Conditions(case) => {
            let conditions = structure.cases[case].conditions.iter();
            conditions.map(|c| c.monomials.len()).sum()
        }
        KernelId::AdjointConditions(case) => match &structure.cases[case].adjoint {
            Ok(conditions) => conditions.iter().map(|c| c.jets.len()).sum(),
            Err(_) => 0,
        },
        KernelId::Closures(case) => {
            let closures = structure.cases[case].closures.iter();
            closures.map(|c| c.density.len() + c.column.len()).sum()
        }
        KernelId::Amplitude => match structure.amplitude.field {
            Some(_) => 2,
            None => structure.amplitude.weighted.len() + 1,
        },
        KernelId::Outputs => {
            let outputs = structure.outputs.iter();
            outputs.map(|o| 1 + o.monomials.len()).sum()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ids::FieldId;

    /// Every shape is read as it was written.
    #[test]
    fn written_and_read() {
        let jet = |field, order| BaseJet {
            field: FieldId(field),
            order,
        };
        let rows = [vec![jet(0, 0), jet(1, 2)], vec![], vec![jet(1, 0)]];
        let value = |start: f64, count: usize| Linearised {
            value: start,
            slopes: (1..=count).map(|i| start + i as f64).collect(),
        };
        let out = write_linearised(vec![value(10.0, 2), value(20.0, 0), value(30.0, 1)]);
        let row = |jets| BaseRowInfo {
            balance: BalanceId(0),
            jets,
        };
        let rows = rows.map(row).into_iter().collect();
        let read = read_base_row(&rows, BaseRowId(2), &out);
        assert_eq!((read.value, read.slopes), (30.0, vec![31.0]));

        let integrals = [vec![jet(0, 0)], vec![jet(0, 0), jet(0, 1)]];
        let out = write_integrals(vec![(value(1.0, 1), 7.0), (value(4.0, 2), 8.0)]);
        let (integrand, prescribed) = read_integral(&integrals, 1, &out);
        assert_eq!((integrand.value, prescribed), (4.0, 8.0));

        let measure = write_measure(Measure::Point {
            value: 2.0,
            place: 0.5,
        });
        let info = AmplitudeInfo {
            weighted: Vec::new(),
            field: Some(FieldId(0)),
            description: String::new(),
        };
        assert!(matches!(
            read_measure(&info, &measure),
            Measure::Point { value, place } if (value, place) == (2.0, 0.5)
        ));
    }
}
