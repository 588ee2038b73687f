//! A pattern as arrays over (y, x), with what it was computed from.

use super::{Array, Dataset};
use landau_solver::model::C64;
use landau_solver::parameters::Parameters;
use landau_solver::study::Setup;
use landau_solver::study::modes::Modes;
use landau_solver::weakly::Pattern;

/// Real or imaginary part.
type Side = fn(&C64) -> f64;

/// What the numbers were computed from.
pub fn attributes(
    setup: &Setup,
    parameters: &Parameters,
    k: f64,
    amplitude: Option<f64>,
) -> Vec<(String, String)> {
    let structure = setup.model.structure();
    let mut list = vec![
        ("title".to_owned(), structure.title.clone()),
        ("model".to_owned(), structure.name.clone()),
        ("model_hash".to_owned(), setup.hash()),
    ];
    let parameter = structure.parameters.pairs();
    let values: Vec<String> = parameter
        .map(|(id, info)| format!("{}={}", info.name, parameters.shown(structure, id)))
        .collect();
    list.push(("parameters".to_owned(), values.join(" ")));
    list.push(("k".to_owned(), k.to_string()));
    if let Some(amplitude) = amplitude {
        list.push(("amplitude".to_owned(), amplitude.to_string()));
    }
    list.push(("resolution".to_owned(), setup.resolution.to_string()));
    let normalisation = structure.amplitude.description.clone();
    list.push(("normalization".to_owned(), normalisation));
    let version = env!("CARGO_PKG_VERSION").to_owned();
    list.push(("landau_version".to_owned(), version));
    list
}

/// Real and imaginary part of every mode over the cross-stream coordinate.
pub fn modes(setup: &Setup, found: &Modes, attributes: Vec<(String, String)>) -> Dataset {
    let vertical = setup.model.structure().coordinate.as_deref().unwrap_or("y");
    let mut arrays = Vec::new();
    for profile in &found.profiles {
        let name = match profile.name.as_str() {
            "X†" => "adjoint".to_owned(),
            name => plain(name),
        };
        for (part, values) in profile.parts.iter().zip(&profile.values) {
            let sides: [(&str, Side); 2] = [("re", |v| v.re), ("im", |v| v.im)];
            for (side, of) in sides {
                arrays.push(Array {
                    name: format!("{name}_{part}_{side}"),
                    axes: vec![0],
                    values: values.iter().map(of).collect(),
                });
            }
        }
    }
    Dataset {
        attributes,
        axes: vec![(vertical.to_owned(), found.heights.clone())],
        arrays,
    }
}

/// A name that other programs take for one: X13 for X[1;3], theta1y for theta + 1 - y.
fn plain(name: &str) -> String {
    let kept = |c: &char| c.is_ascii_alphanumeric() || *c == '_';
    name.chars().filter(kept).collect()
}

/// X⁰, P (4.5) and P (4.4) of every field over (y, x).
pub fn dataset(setup: &Setup, found: &Pattern, attributes: Vec<(String, String)>) -> Dataset {
    let structure = setup.model.structure();
    let vertical = structure.coordinate.as_deref().unwrap_or("y");
    let mut arrays = Vec::new();
    for field in found.fields.iter().chain(&found.derived) {
        let name = plain(&field.name);
        let flat = |values: &[Vec<f64>]| values.iter().flatten().copied().collect();
        for (kind, values) in [
            ("linear", flat(&field.linear)),
            ("nonlinear", flat(&field.nonlinear)),
        ] {
            arrays.push(Array {
                name: format!("{name}_{kind}"),
                axes: vec![0, 1],
                values,
            });
        }
        arrays.push(Array {
            name: format!("{name}_base"),
            axes: vec![0],
            values: field.base.clone(),
        });
    }
    Dataset {
        attributes,
        axes: vec![
            (vertical.to_owned(), found.y.clone()),
            (structure.periodic.clone(), found.x.clone()),
        ],
        arrays,
    }
}
