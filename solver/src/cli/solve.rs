//! Commands that compute.

use super::arguments::{Common, CriticalOptions, Of, SweepOptions, range};
use super::{picture, report};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::spectrum as spectra;
use crate::study::critical::{Quantity, Question};
use crate::study::sweep::{Range, Sweep, write_whole};
use crate::study::verify::judge;
use crate::study::{
    Axis, Setup, accuracy, check_wavenumber, critical as criticality, sensitivity,
    verify as certificate,
};
use crate::weakly::{Selection, outputs};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::{Map, Value, json};

/// Coefficients whose error is a larger fraction than this are called unconverged.
const UNCONVERGED: f64 = 0.05;

pub fn selection(common: &Common) -> Selection<'static> {
    common.near.map_or(Selection::Leading, Selection::Near)
}

pub fn progress(what: &str) -> ProgressBar {
    let bar = ProgressBar::new(0);
    let style = ProgressStyle::with_template("{prefix} [{bar:40}] {pos}/{len} {eta}");
    bar.set_style(
        style
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .progress_chars("=> "),
    );
    bar.set_prefix(what.to_owned());
    bar
}

pub fn base(setup: &Setup, points: usize, common: &Common) -> Result<()> {
    if !(2..=100_000).contains(&points) {
        return Err(Error::input(format!(
            "--points {points} is out of range: it accepts 2 to 100000"
        )));
    }
    let state = setup.base(None)?;
    let structure = setup.model.structure();
    let coordinate = structure.coordinate.clone().unwrap_or_else(|| "y".into());
    let count = if structure.coordinate.is_some() {
        points
    } else {
        1
    };
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); structure.fields.len() + 1];
    for i in 0..count {
        let xi = if count == 1 {
            0.0
        } else {
            -1.0 + 2.0 * i as f64 / (count - 1) as f64
        };
        let point = state.point(setup.model, xi, 0.0);
        columns[0].push(point[0]);
        for field in 0..structure.fields.len() {
            columns[field + 1].push(point[structure.base_position(field, 0)]);
        }
    }
    if common.json {
        let mut profiles = Map::new();
        for (field, info) in structure.fields.iter().enumerate() {
            profiles.insert(
                info.name.clone(),
                columns[field + 1]
                    .iter()
                    .map(|&v| report::number(v))
                    .collect(),
            );
        }
        let object = json!({
            "model": structure.name,
            "parameters": report::parameters(setup, &state.parameters),
            "degree": state.degree,
            "tail": report::number(state.tail()),
            "residual": report::number(state.residual),
            (coordinate): columns[0],
            "profiles": profiles,
        });
        say!("{object}");
        return Ok(());
    }
    say!(
        "{} — base state, {} Chebyshev polynomials, tail {:.1e}",
        structure.title,
        state.degree + 1,
        state.tail()
    );
    let names = structure.fields.iter().map(|f| f.name.as_str());
    let header: Vec<String> = std::iter::once(coordinate.as_str())
        .chain(names)
        .map(|n| format!("{n:>16}"))
        .collect();
    say!("{}", header.join(""));
    for i in 0..count {
        let row: Vec<String> = columns.iter().map(|c| format!("{:>16.9}", c[i])).collect();
        say!("{}", row.join(""));
    }
    Ok(())
}

pub fn spectrum(setup: &Setup, k: f64, common: &Common) -> Result<()> {
    if !(k.is_finite() && k >= 0.0) {
        return Err(Error::input(format!(
            "--k {k}: a wavenumber is a number from 0 on"
        )));
    }
    let state = setup.base(None)?;
    setup.with_problem(&state, |problem| {
        let direct = spectra::eigenvalues(problem, k)?;
        let adjoint = spectra::adjoint_eigenvalues(problem, k);
        let structure = setup.model.structure();
        if common.json {
            let list =
                |values: &[C64]| -> Value { values.iter().map(|&c| report::complex(c)).collect() };
            let mut object = json!({
                "model": structure.name,
                "parameters": report::parameters(setup, &state.parameters),
                "k": k,
                "M": setup.resolution,
                "direct": list(&direct),
            });
            match &adjoint {
                Ok(values) => {
                    object["adjoint"] = list(values);
                    let differences = direct.iter().map(|&c| nearest(c, values));
                    object["difference"] = differences.collect();
                }
                Err(reason) => {
                    object["adjoint"] = Value::Null;
                    object["adjoint_missing"] = Value::String(reason.to_string());
                }
            }
            say!("{object}");
            return Ok(());
        }
        say!(
            "{} at k = {k}, M = {}: leading eigenvalues",
            structure.title,
            setup.resolution
        );
        let empty = Vec::new();
        let others = adjoint.as_ref().unwrap_or(&empty);
        say!("{:>44}   {:>44}   {:>10}", "L", "L†", "difference");
        for (i, &c) in direct.iter().take(20).enumerate() {
            let other = others.get(i).map_or(String::new(), |&a| report::shown(a));
            let difference = match others.is_empty() {
                true => String::new(),
                false => format!("{:.1e}", nearest(c, others)),
            };
            say!("{:>44}   {other:>44}   {difference:>10}", report::shown(c));
        }
        if let Err(reason) = adjoint {
            say!("L†: {reason}");
        }
        Ok(())
    })
}

/// Distance from an eigenvalue of L to the nearest conjugate of one of L†: zero without truncation.
fn nearest(c: C64, adjoint: &[C64]) -> f64 {
    let distances = adjoint.iter().map(|a| (a.conj() - c).norm());
    distances.fold(f64::INFINITY, f64::min)
}

pub fn point(setup: &Setup, k: f64, order: usize, common: &Common) -> Result<()> {
    check_wavenumber(k)?;
    if order != 3 {
        return Err(Error::input(format!(
            "--order {order} is not available: it accepts 3"
        )));
    }
    let state = setup.base(None)?;
    let structure = setup.model.structure();
    setup.with_point(&state, k, selection(common), |point| {
        let error = accuracy::accuracy(setup, &state, point)?;
        let resonance = accuracy::resonance(point)?;
        let slopes = sensitivity::parameters(setup, &state, &point.expansion.pair);
        let values = outputs(point);
        if error.c2 > UNCONVERGED * point.c2.norm()
            || error.c0 > UNCONVERGED * point.c0.norm().max(1e-9)
        {
            eprintln!(
                "warning: not converged at M = {}: c0 ± {:.1e}, c2 ± {:.1e}; try a larger M",
                setup.resolution, error.c0, error.c2
            );
        }
        if common.json {
            let mut named = Map::new();
            for (info, value) in structure.outputs.iter().zip(&values) {
                named.insert(
                    info.name.clone(),
                    json!([report::number(value[0]), report::number(value[1])]),
                );
            }
            let mut derivatives = Map::new();
            for (index, slope) in &slopes {
                derivatives.insert(
                    structure.parameters[*index].name.clone(),
                    slope.map_or(Value::Null, report::complex),
                );
            }
            say!(
                "{}",
                json!({
                    "model": structure.name,
                    "parameters": report::parameters(setup, &state.parameters),
                    "k": k,
                    "M": setup.resolution,
                    "c0": report::complex(point.c0),
                    "c2": report::complex(point.c2),
                    "amplitude": point.amplitude().map_or(Value::Null, report::number),
                    "bifurcation": point.bifurcation(),
                    "normalization": structure.amplitude.description,
                    "error": {"c0": report::number(error.c0), "c2": report::number(error.c2)},
                    "resonance": {
                        "mean_flow": report::number(resonance.mean_flow),
                        "second_harmonic": report::number(resonance.second_harmonic),
                    },
                    "outputs": named,
                    "dc0": derivatives,
                })
            );
            return Ok(());
        }
        say!("{} at k = {k}, M = {}", structure.title, setup.resolution);
        say!("  {}", report::amplitude_equation(point.c0, point.c2));
        say!("  c0 = {}   ± {:.1e}", report::shown(point.c0), error.c0);
        say!("  c2 = {}   ± {:.1e}", report::shown(point.c2), error.c2);
        say!("  {}", point.bifurcation());
        match point.amplitude() {
            Some(amplitude) => say!(
                "  A_e = {amplitude:.8}, normalised by {}",
                structure.amplitude.description
            ),
            None => say!(
                "  no equilibrium at cubic order; normalised by {}",
                structure.amplitude.description
            ),
        }
        say!(
            "  distance to resonance: mean flow {:.3e}, 2:1 {:.3e}",
            resonance.mean_flow,
            resonance.second_harmonic
        );
        for (info, value) in structure.outputs.iter().zip(&values) {
            say!("  {} = {:.8} + {:.8} A²", info.name, value[0], value[1]);
        }
        for (index, slope) in &slopes {
            say!(
                "  dc0/d{} = {}",
                structure.parameters[*index].name,
                slope.map_or("unknown".into(), report::shown)
            );
        }
        Ok(())
    })
}

pub fn critical(setup: &Setup, options: &CriticalOptions, common: &Common) -> Result<()> {
    let axis = Axis::named(setup.model, &options.vary)?;
    if !(options.from.is_finite() && options.to.is_finite()) || options.from == options.to {
        return Err(Error::input("--from and --to accept two different numbers"));
    }
    for value in [options.from, options.to] {
        if axis == Axis::Wavenumber {
            check_wavenumber(value)?;
        }
        setup.moved(axis, value)?;
    }
    let minimise = match &options.minimize {
        Some(text) => {
            let (name, bounds) = range("--minimize", text, 2).map_err(Error::Input)?;
            if name != "k" || axis == Axis::Wavenumber || bounds[0] >= bounds[1] {
                return Err(Error::input(format!(
                    "--minimize {text}: it accepts k=A:B with A < B, for a parameter that varies"
                )));
            }
            check_wavenumber(bounds[0])?;
            Some((bounds[0], bounds[1]))
        }
        None => None,
    };
    if axis != Axis::Wavenumber && options.k.is_none() && minimise.is_none() {
        return Err(Error::input(format!(
            "--vary {}: give the wavenumber with --k, or a range with --minimize k=A:B",
            options.vary
        )));
    }
    if minimise.is_some() && options.of != Of::Growth {
        return Err(Error::input("--minimize goes with --of growth"));
    }
    if let Some(k) = options.k {
        check_wavenumber(k)?;
    }
    let (quantity, name) = match options.of {
        Of::Growth => (Quantity::Growth, "growth"),
        Of::C2 => (Quantity::C2, "c2"),
        Of::Resonance => (Quantity::Resonance, "resonance"),
    };
    let (from, to, k) = (options.from, options.to, options.k.unwrap_or(0.0));
    let question = Question {
        axis,
        from,
        to,
        quantity,
        k,
        near: common.near,
    };
    let bar = progress("scanning");
    let found = match minimise {
        Some(bounds) => vec![criticality::minimise(setup, question, bounds, &bar)?],
        None => criticality::critical(setup, question, &bar)?,
    };
    let first = &found[0];
    if found.len() > 1 {
        let others: Vec<String> = found[1..]
            .iter()
            .map(|c| format!("{:.8}", c.value))
            .collect();
        eprintln!(
            "note: further points in the interval: {}",
            others.join(", ")
        );
    }
    if common.json {
        say!(
            "{}",
            json!({
                "parameter": options.vary,
                "of": name,
                "value": report::number(first.value),
                "k": report::number(first.k),
                "c0": report::complex(first.c0),
            })
        );
    } else {
        say!(
            "{} = {:.10} (of {name}) at k = {:.10}, c0 = {}",
            options.vary,
            first.value,
            first.k,
            report::shown(first.c0)
        );
    }
    Ok(())
}

pub fn sweep(setup: &Setup, options: &SweepOptions, common: &Common) -> Result<()> {
    let mut ranges: Vec<Range> = Vec::new();
    for text in &options.over {
        let (name, numbers) = range("--over", text, 3).map_err(Error::Input)?;
        let count = numbers[2];
        if count < 1.0 || count.fract() != 0.0 || count > 1e6 {
            return Err(Error::input(format!(
                "--over {text}: COUNT is a whole number from 1 to 1000000"
            )));
        }
        let axis = Axis::named(setup.model, &name)?;
        if ranges.iter().any(|r| r.axis == axis) {
            return Err(Error::input(format!(
                "--over {text}: `{name}` varies already"
            )));
        }
        let count = count as usize;
        let step = if count > 1 {
            (numbers[1] - numbers[0]) / (count - 1) as f64
        } else {
            0.0
        };
        let values: Vec<f64> = (0..count)
            .map(|i| {
                if i > 0 && i + 1 == count {
                    numbers[1]
                } else {
                    numbers[0] + step * i as f64
                }
            })
            .collect();
        for &value in [values.first(), values.last()].into_iter().flatten() {
            if axis == Axis::Wavenumber {
                check_wavenumber(value)?;
            }
            setup.moved(axis, value)?;
        }
        ranges.push(Range { name, axis, values });
    }
    if !ranges.iter().any(|r| r.axis == Axis::Wavenumber) {
        check_wavenumber(
            options
                .k
                .ok_or_else(|| Error::input("no range varies k: give it with --k"))?,
        )?;
    }
    let sweep = Sweep {
        setup,
        ranges,
        near: common.near,
        k: options.k,
    };
    let rows = sweep.run_to(&options.out, &progress("sweeping"))?;
    if let Some(path) = &options.plot
        && let Some(drawn) = picture::sweep(setup, &sweep, &rows)
    {
        write_whole(path, drawn.as_bytes())?;
    }
    let good = rows.iter().filter(|r| r.status == "ok").count();
    let unstable = rows
        .iter()
        .filter(|r| r.c0.is_some_and(|c| c[0] > 0.0))
        .count();
    if common.json {
        say!(
            "{}",
            json!({"out": options.out.display().to_string(), "rows": rows.len(), "ok": good, "unstable": unstable})
        );
    } else {
        picture::table(&sweep, &rows);
        say!(
            "{} rows, {good} with a number, {unstable} unstable: {}",
            rows.len(),
            options.out.display()
        );
    }
    if good == 0 {
        return Err(Error::computation(format!(
            "no point of the sweep has a number: {}",
            rows[0].status
        )));
    }
    Ok(())
}

pub fn verify(setup: &Setup, k: f64, common: &Common) -> Result<()> {
    let checks = certificate::verify(setup, k, selection(common))?;
    if common.json {
        let list: Vec<Value> = checks
            .iter()
            .map(|c| {
                json!({"part": c.part, "name": c.name, "value": report::number(c.value),
                       "bound": report::number(c.bound), "passed": c.passed, "detail": c.detail})
            })
            .collect();
        say!(
            "{}",
            json!({"model": setup.model.structure().name, "k": k, "M": setup.resolution, "checks": list})
        );
    } else {
        say!(
            "{} at k = {k}, M = {}",
            setup.model.structure().title,
            setup.resolution
        );
        let mut part = 0;
        for check in &checks {
            if check.part != part {
                part = check.part;
                let titles = [
                    "residual order",
                    "duality",
                    "two routes",
                    "nonlinear forms",
                    "convergence",
                ];
                say!("{part}. {}", titles[part - 1]);
            }
            let mark = if check.passed { "  ok  " } else { "FAILED" };
            say!(
                "  {mark} {:<48} {:>12.4e}   {}",
                check.name,
                check.value,
                check.detail
            );
        }
    }
    judge(&checks)
}
