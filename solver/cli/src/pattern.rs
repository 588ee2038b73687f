//! The command `pattern`: pictures and data of the fields over the plane.

use crate::arguments::{Common, OfMode, PatternOptions};
use crate::asked::asked;
use crate::outputs;
use landau_report::data::plane::{attributes, dataset};
use landau_report::figure::{Drawing, Part, View, is_picture, pattern_lines, pattern_pair};
use landau_report::library::expression;
use landau_solver::error::{Error, Result};
use landau_solver::file::Overwrite;
use landau_solver::measured::Measured;
use landau_solver::model::{Expression, FieldId};
use landau_solver::study::Setup;
use landau_solver::study::accuracy::Converged;
use landau_solver::wavevector::WaveVector;
use landau_solver::weakly::{Pattern, PlaneField, Window, pattern as expand};
use landau_solver::words;
use landau_solver::words::shown_path;
use serde_json::json;
use std::path::PathBuf;

pub fn pattern(
    setup: &Setup,
    options: &PatternOptions,
    of_mode: &OfMode,
    common: &Common,
) -> Result<()> {
    let (k, selection) = asked(setup, options.k, of_mode.near)?;
    WaveVector::wave(k)?;
    let window = window(options)?;
    outputs::check_data(&options.out, &outputs::plane_formats())?;
    let paths = options.out.iter().map(PathBuf::as_path);
    outputs::check(paths, Overwrite::forced(options.force))?;
    let state = setup.base(None)?;
    let converged = Converged::new(setup, &state, k, selection)?;
    let amplitude = match options.amplitude {
        Some(given) if given.is_finite() => Measured::new(given, 0.0),
        Some(given) => {
            return Err(Error::input(format!(
                "--amplitude {given}: it accepts a number"
            )));
        }
        None => converged.amplitude().map_err(|reason| {
            Error::computation(format!("{reason}; give an amplitude with --amplitude"))
        })?,
    };
    let expressions = shaded(setup, options)?;
    let plane = expand(&converged.point, amplitude.value, window, &expressions)?;
    let vector = options.arrows.as_deref().map(components).transpose()?;
    let parameters = state.parameters.json(state.structure());
    let attributes = attributes(setup, &parameters, Some(k), Some(amplitude.value));
    for name in vector.iter().flatten() {
        named(&plane, name)?;
    }
    for path in &options.out {
        if is_picture(path) {
            picture(setup, options, k, &plane)?.write(path)?;
        } else {
            dataset(setup, &plane, attributes.clone(), vector).write(path)?;
        }
    }
    if common.json {
        let files: Vec<String> = options
            .out
            .iter()
            .map(|p| p.display().to_string())
            .collect();
        let error = words::number(amplitude.error);
        say!(
            "{}",
            json!({"k": k, "amplitude": amplitude.value, "error": {"amplitude": error}, "out": files})
        );
    } else {
        let (title, k) = (&setup.model.structure().title, words::brief(k));
        match options.amplitude {
            Some(given) => say!("{title} at k = {k}, A = {}", words::brief(given)),
            None => say!("{title} at k = {k}, A = {amplitude}"),
        }
        for path in &options.out {
            say!("  {}", shown_path(path));
        }
    }
    Ok(())
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
            "--wavelengths {}: it accepts a number above 0, up to 100",
            words::brief(wavelengths)
        )));
    }
    Ok(Window {
        columns: count(columns)?,
        rows: count(rows)?,
        wavelengths,
    })
}

/// A quantity of the pattern by its name.
fn named<'p>(plane: &'p Pattern, name: &str) -> Result<&'p PlaneField> {
    plane.quantity(name.trim()).ok_or_else(|| {
        let names: Vec<&str> = plane.fields.iter().map(|f| f.name.as_str()).collect();
        Error::input(format!(
            "there is no field `{name}`: the profiles are {}",
            names.join(", ")
        ))
    })
}

/// The two fields of `--arrows`.
fn components(text: &str) -> Result<[&str; 2]> {
    let (along, across) = text
        .split_once(',')
        .ok_or_else(|| Error::input(format!("--arrows {text}: it accepts FIELD,FIELD")))?;
    Ok([along.trim(), across.trim()])
}

/// What is shaded, where it is no field: compiled.
fn shaded(setup: &Setup, options: &PatternOptions) -> Result<Vec<Expression>> {
    let model = setup.model.as_ref();
    let wanted = options.shade.iter();
    let wanted = wanted.filter(|text| model.structure().field(text).is_none());
    wanted.map(|text| expression(model, text)).collect()
}

fn picture(setup: &Setup, options: &PatternOptions, k: f64, plane: &Pattern) -> Result<Drawing> {
    let field = |name: &str| named(plane, name);
    let part = match options.perturbation {
        true => Part::Perturbation,
        false => Part::Total,
    };
    let structure = setup.model.structure();
    let mut facts = vec![structure.title.clone()];
    facts.extend(setup.parameters.changed(structure));
    facts.push(format!("k = {}", words::short(k)));
    facts.push(format!("A = {:.4}", plane.amplitude));
    let title = facts.join(", ");
    if plane.y.len() < 2 {
        let drawn = pattern_lines(structure, plane, &title, part);
        return drawn.ok_or_else(|| Error::computation("the pattern has no finite value"));
    }
    let first = &plane.fields[FieldId(0)];
    let shade = options.shade.as_deref().map_or(Ok(first), field)?;
    let arrows = match &options.arrows {
        Some(text) => {
            let [along, across] = components(text)?;
            Some([field(along)?, field(across)?])
        }
        None => None,
    };
    let view = View {
        title,
        shade,
        part,
        arrows,
        written: &str::to_owned,
    };
    Ok(pattern_pair(structure, plane, &view))
}
