//! A pattern as arrays over (y, x), with what it was computed from.

use super::names::{distinct, plain};
use super::{Array, Axis, Dataset, Fact, Facts};
use landau_solver::model::{C64, Structure};
use landau_solver::study::Setup;
use landau_solver::study::modes::Modes;
use landau_solver::weakly::Pattern;
use serde_json::Value;

/// Real or imaginary part.
pub(super) type Side = fn(&C64) -> f64;

/// What the numbers were computed from; `parameters` by name as a report has them, a switch by its choice.
pub fn attributes(
    setup: &Setup,
    parameters: &Value,
    k: Option<f64>,
    amplitude: Option<f64>,
) -> Facts {
    let structure = setup.model.structure();
    let text = |name: &str, value: &str| (name.to_owned(), Fact::Text(value.to_owned()));
    let number = |name: &str, value: f64| (name.to_owned(), Fact::Number(value));
    let mut list = vec![
        text("title", &structure.title),
        text("source", &format!("Landau {}", env!("CARGO_PKG_VERSION"))),
        text("model", &structure.name),
        text("model_hash", &setup.hash()),
        number("resolution", setup.resolution() as f64),
        text("normalization", &structure.amplitude.description),
        text("landau_version", env!("CARGO_PKG_VERSION")),
        text("landau_build", &setup.build()),
    ];
    list.extend(k.map(|k| number("k", k)));
    list.extend(amplitude.map(|amplitude| number("amplitude", amplitude)));
    // In the order of the spec.
    let infos = structure.parameters.iter();
    let known = infos.filter_map(|info| Some((info.name.as_str(), parameters.get(&info.name)?)));
    let known: Vec<(&str, &Value)> = known.collect();
    let shown = |(name, value): &(&str, &Value)| match value {
        Value::String(choice) => format!("{name}={choice}"),
        value => format!("{name}={}", value.as_f64().unwrap_or(f64::NAN)),
    };
    let all: Vec<String> = known.iter().map(shown).collect();
    list.push(text("parameters", &all.join(" ")));
    let names = distinct(known.iter().map(|(name, _)| *name));
    for ((_, value), name) in known.iter().zip(names) {
        let name = format!("parameter_{name}");
        list.push(match value {
            Value::String(choice) => text(&name, choice),
            value => number(&name, value.as_f64().unwrap_or(f64::NAN)),
        });
    }
    list
}

/// A field in words, by the spec's own where it has some.
pub(super) fn words(structure: &Structure, name: &str) -> String {
    let doc = structure
        .field(name)
        .map(|id| structure.fields[id].doc.clone());
    doc.filter(|doc| !doc.is_empty())
        .unwrap_or_else(|| name.to_owned())
}

/// Real and imaginary part of every mode over the cross-stream coordinate.
pub fn modes(setup: &Setup, found: &Modes, attributes: Facts) -> Dataset {
    let structure = setup.model.structure();
    let vertical = structure.coordinate.as_deref().unwrap_or("y");
    let mut arrays = Vec::new();
    for profile in &found.profiles {
        let name = match profile.name.as_str() {
            "X†" => "adjoint".to_owned(),
            name => plain(name),
        };
        let parts = distinct(profile.parts.iter().map(String::as_str));
        let parts = parts.iter().zip(&profile.parts).zip(&profile.values);
        for ((part, written), values) in parts {
            let sides: [(&str, Side); 2] = [("re", |v| v.re), ("im", |v| v.im)];
            for (side, of) in sides {
                arrays.push(Array {
                    name: format!("{name}_{part}_{side}"),
                    long_name: format!("{} of {}, {side}", words(structure, written), profile.name),
                    axes: vec![0],
                    values: values.iter().map(of).collect(),
                });
            }
        }
    }
    Dataset {
        attributes,
        axes: vec![Axis {
            name: plain(vertical),
            long_name: "cross-stream coordinate".to_owned(),
            values: found.heights.clone(),
        }],
        arrays,
        vectors: Vec::new(),
    }
}

/// X⁰, P (4.5) and P (4.4) of every field over (y, x); `vector` names the two fields that are one.
pub fn dataset(
    setup: &Setup,
    found: &Pattern,
    attributes: Facts,
    vector: Option<[&str; 2]>,
) -> Dataset {
    let structure = setup.model.structure();
    let vertical = structure.coordinate.as_deref().unwrap_or("y");
    let all = || found.fields.iter().chain(&found.derived);
    let names = distinct(all().map(|field| field.name.as_str()));
    let mut arrays = Vec::new();
    for (field, name) in all().zip(&names) {
        let flat = |values: &[Vec<f64>]| values.iter().flatten().copied().collect();
        let said = words(structure, &field.name);
        for (kind, what, values) in [
            ("linear", "base and fundamental", flat(&field.linear)),
            ("nonlinear", "through third order", flat(&field.nonlinear)),
        ] {
            arrays.push(Array {
                name: format!("{name}_{kind}"),
                long_name: format!("{said}, {what}"),
                axes: vec![0, 1],
                values,
            });
        }
        arrays.push(Array {
            name: format!("{name}_base"),
            long_name: format!("{said}, base state"),
            axes: vec![0],
            values: field.base.clone(),
        });
    }
    Dataset {
        attributes,
        axes: vec![
            Axis {
                name: plain(vertical),
                long_name: "cross-stream coordinate".to_owned(),
                values: found.y.clone(),
            },
            Axis {
                name: plain(&structure.periodic),
                long_name: "periodic coordinate".to_owned(),
                values: found.x.clone(),
            },
        ],
        arrays,
        vectors: vector.map_or(Vec::new(), |pair| {
            vectors(pair.map(|component| {
                let position = all().position(|field| field.name == component);
                position.map_or_else(|| plain(component), |i| names[i].clone())
            }))
        }),
    }
}

/// The vector of two fields, linear and nonlinear.
fn vectors(fields: [String; 2]) -> Vec<(String, [String; 2])> {
    let of = |kind: &str| {
        let components = fields.each_ref().map(|field| format!("{field}_{kind}"));
        (format!("vector_{kind}"), components)
    };
    vec![of("linear"), of("nonlinear")]
}
