//! A base state over the cross-stream coordinate, and a spectrum over the number of the mode.

use super::names::{distinct, plain};
use super::plane::{Side, words};
use super::{Array, Axis, Dataset, Facts};
use landau_solver::model::{C64, Structure};
use landau_solver::study::profiles::BaseReport;
use landau_solver::study::spectrum::SpectrumReport;

/// Every field over the cross-stream coordinate.
pub fn base(structure: &Structure, found: &BaseReport, attributes: Facts) -> Dataset {
    let names = distinct(found.profiles.iter().map(|(name, _)| name.as_str()));
    let array = |(name, (written, values)): (String, &(String, Vec<f64>))| Array {
        name,
        long_name: format!("{}, base state", words(structure, written)),
        axes: vec![0],
        values: values.clone(),
    };
    Dataset {
        attributes,
        axes: vec![Axis {
            name: plain(found.vertical()),
            long_name: "cross-stream coordinate".to_owned(),
            values: found.heights.clone(),
        }],
        arrays: names.into_iter().zip(&found.profiles).map(array).collect(),
        vectors: Vec::new(),
    }
}

/// Eigenvalues of L and, where the model has its conditions, of L†, by decreasing growth rate.
pub fn spectrum(found: &SpectrumReport, attributes: Facts) -> Dataset {
    let direct = &found.direct.values;
    let mut arrays = Vec::new();
    let mut add = |name: &str, of: &str, values: &[C64]| {
        let sides: [(&str, &str, Side); 2] = [
            ("re", "growth rate", |c| c.re),
            ("im", "frequency", |c| c.im),
        ];
        for (side, what, part) in sides {
            // Discretised apart, the two may differ in how many eigenvalues they have.
            let missing = std::iter::repeat(f64::NAN);
            let values = values.iter().map(part).chain(missing);
            arrays.push(Array {
                name: format!("{name}_{side}"),
                long_name: format!("{what} of the eigenvalues of {of}"),
                axes: vec![0],
                values: values.take(direct.len()).collect(),
            });
        }
    };
    add("direct", "L", direct);
    if let Ok(adjoint) = &found.adjoint {
        add("adjoint", "the adjoint of L", &adjoint.values);
    }
    Dataset {
        attributes,
        axes: vec![Axis {
            name: "mode".to_owned(),
            long_name: "number of the mode, by decreasing growth rate".to_owned(),
            values: (0..direct.len()).map(|i| i as f64).collect(),
        }],
        arrays,
        vectors: Vec::new(),
    }
}
