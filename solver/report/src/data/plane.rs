//! A pattern as arrays over (y, x), with what it was computed from.

use super::{Array, Dataset};
use landau_solver::parameters::Parameters;
use landau_solver::study::Setup;
use landau_solver::weakly::Pattern;

/// What the numbers were computed from.
pub fn attributes(
    setup: &Setup,
    parameters: &Parameters,
    k: f64,
    amplitude: f64,
) -> Vec<(String, String)> {
    let structure = setup.model.structure();
    let mut list = vec![
        ("title".to_owned(), structure.title.clone()),
        ("model".to_owned(), structure.name.clone()),
        ("model_hash".to_owned(), setup.hash()),
    ];
    let values: Vec<String> = (0..structure.parameters.len())
        .map(|i| {
            let name = &structure.parameters[i].name;
            format!("{name}={}", parameters.shown(structure, i))
        })
        .collect();
    list.push(("parameters".to_owned(), values.join(" ")));
    list.push(("k".to_owned(), k.to_string()));
    list.push(("amplitude".to_owned(), amplitude.to_string()));
    list.push(("resolution".to_owned(), setup.resolution.to_string()));
    let normalisation = structure.amplitude.description.clone();
    list.push(("normalization".to_owned(), normalisation));
    let version = env!("CARGO_PKG_VERSION").to_owned();
    list.push(("landau_version".to_owned(), version));
    list
}

/// X⁰, P (4.5) and P (4.4) of every field over (y, x).
pub fn dataset(setup: &Setup, found: &Pattern, attributes: Vec<(String, String)>) -> Dataset {
    let structure = setup.model.structure();
    let vertical = structure.coordinate.as_deref().unwrap_or("y");
    let mut arrays = Vec::new();
    for (field, name) in found.names.iter().enumerate() {
        let flat = |values: &[Vec<f64>]| values.iter().flatten().copied().collect();
        for (kind, values) in [
            ("linear", flat(&found.linear[field])),
            ("nonlinear", flat(&found.nonlinear[field])),
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
            values: found.base[field].clone(),
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
