//! The command `pattern`: pictures and data of the fields over the plane.

use super::arguments::{Common, PatternOptions};
use super::report;
use super::solve::selection;
use crate::data::{Array, Dataset, FORMATS};
use crate::error::{Error, Result};
use crate::figure::{Plane, planes};
use crate::study::sweep::write_whole;
use crate::study::{Setup, check_wavenumber};
use crate::weakly::{Pattern, Window, pattern as expand};
use serde_json::json;

pub fn pattern(setup: &Setup, options: &PatternOptions, common: &Common) -> Result<()> {
    check_wavenumber(options.k)?;
    let window = window(options)?;
    for path in &options.out {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or("");
        if extension != "svg" && !FORMATS.contains(&extension) {
            return Err(Error::input(format!(
                "--out {}: it accepts .svg, .{}",
                path.display(),
                FORMATS.join(", .")
            )));
        }
    }
    let state = setup.base(None)?;
    setup.with_point(&state, options.k, selection(common), |point| {
        let amplitude = match (options.amplitude, point.amplitude()) {
            (Some(given), _) if given.is_finite() => given,
            (Some(given), _) => {
                return Err(Error::input(format!(
                    "--amplitude {given}: it accepts a number"
                )));
            }
            (None, Some(equilibrium)) => equilibrium,
            (None, None) => {
                return Err(Error::computation(
                    "there is no equilibrium amplitude at cubic order (a0 and a2 have one sign); \
                     give one with --amplitude",
                ));
            }
        };
        let found = expand(point, amplitude, window)?;
        let attributes = attributes(setup, &state.parameters, options.k, amplitude);
        for path in &options.out {
            if path.extension().is_some_and(|e| e == "svg") {
                write_whole(path, picture(setup, options, &found)?.as_bytes())?;
            } else {
                dataset(setup, &found, attributes.clone()).write(path)?;
            }
        }
        if common.json {
            let files: Vec<String> = options
                .out
                .iter()
                .map(|p| p.display().to_string())
                .collect();
            say!(
                "{}",
                json!({"k": options.k, "amplitude": amplitude, "out": files})
            );
        } else {
            say!(
                "{} at k = {}, A = {amplitude:.8}",
                setup.model.structure().title,
                options.k
            );
            for path in &options.out {
                say!("  {}", path.display());
            }
        }
        Ok(())
    })
}

fn window(options: &PatternOptions) -> Result<Window> {
    let wrong = || {
        let text = &options.points;
        Error::input(format!(
            "--points {text}: it accepts NXxNY, each from 2 to 4000"
        ))
    };
    let (columns, rows) = options.points.split_once('x').ok_or_else(wrong)?;
    let count = |text: &str| {
        let number = text.trim().parse().map_err(|_| wrong())?;
        if (2..=4000).contains(&number) {
            Ok(number)
        } else {
            Err(wrong())
        }
    };
    let wavelengths = options.wavelengths;
    if !(wavelengths > 0.0 && wavelengths <= 100.0) {
        return Err(Error::input(format!(
            "--wavelengths {wavelengths}: it accepts a number up to 100"
        )));
    }
    Ok(Window {
        columns: count(columns)?,
        rows: count(rows)?,
        wavelengths,
    })
}

/// What the numbers were computed from.
pub fn attributes(
    setup: &Setup,
    parameters: &crate::parameters::Parameters,
    k: f64,
    amplitude: f64,
) -> Vec<(String, String)> {
    let structure = setup.model.structure();
    let mut list = vec![
        ("title".to_owned(), structure.title.clone()),
        ("model".to_owned(), structure.name.clone()),
        ("model_hash".to_owned(), setup.hash()),
    ];
    let values = report::parameters(setup, parameters);
    list.push(("parameters".to_owned(), values.to_string()));
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

fn picture(setup: &Setup, options: &PatternOptions, found: &Pattern) -> Result<String> {
    let field = |name: &str| {
        found.field(name).ok_or_else(|| {
            let names = found.names.join(", ");
            Error::input(format!(
                "there is no field `{name}`: the profiles are {names}"
            ))
        })
    };
    if found.y.len() < 2 {
        return Err(Error::input(
            "a model without a cross-stream coordinate has no plane to draw: write .npz or .nc",
        ));
    }
    let shade = options.shade.as_deref().map_or(Ok(0), field)?;
    let arrows = match &options.arrows {
        Some(text) => {
            let (along, across) = text
                .split_once(',')
                .ok_or_else(|| Error::input(format!("--arrows {text}: it accepts FIELD,FIELD")))?;
            Some([field(along.trim())?, field(across.trim())?])
        }
        None => velocity(found),
    };
    Ok(draw(setup, found, shade, arrows))
}

/// The fields that are a velocity by their customary names.
pub fn velocity(found: &Pattern) -> Option<[usize; 2]> {
    let across = found.field("v").or_else(|| found.field("w"))?;
    Some([found.field("u")?, across])
}

/// Linear beside nonlinear.
pub fn draw(setup: &Setup, found: &Pattern, shade: usize, arrows: Option<[usize; 2]>) -> String {
    let structure = setup.model.structure();
    let vertical = structure.coordinate.clone().unwrap_or_default();
    let labels = [structure.periodic.clone(), vertical];
    let panel = |title, fields| one(found, title, fields, shade, arrows, labels.clone());
    let title = format!("{}, A = {:.4}", structure.title, found.amplitude);
    planes(
        &title,
        &[
            panel("fundamental alone", &found.linear),
            panel("through third order", &found.nonlinear),
        ],
    )
}

fn one<'a>(
    found: &'a Pattern,
    title: &str,
    fields: &'a [Vec<Vec<f64>>],
    shade: usize,
    arrows: Option<[usize; 2]>,
    labels: [String; 2],
) -> Plane<'a> {
    Plane {
        title: title.to_owned(),
        labels,
        x: &found.x,
        y: &found.y,
        shade: (&found.names[shade], &fields[shade]),
        arrows: arrows.map(|pair| pair.map(|f| fields[f].as_slice())),
    }
}
