//! Tasks, one kind after another.

use super::critical::{asked, question};
use super::{Checked, Spot, along_k, axis, claims, each_has_k, free, not_set, points};
use crate::reproduce::study::{Asked, Axis, Case, Reference, Tail, Task, Together};
use landau_solver::study::orders::HIGHEST;

/// Wavelengths that a picture shows at most.
const WAVELENGTHS: f64 = 100.0;
/// Distances from a critical point.
const DISTANCES: std::ops::RangeInclusive<usize> = 3..=1000;

/// Every key of a task.
pub(super) fn check(spot: &Spot, task: &Task) -> Checked {
    let cases = task.cases();
    match task {
        Task::Profiles { .. } | Task::Law { .. } => of_the_state(spot, task),
        Task::Convergence { .. } | Task::Spectrum { .. } => by_resolution(spot, task),
        Task::Sweep { .. } | Task::Resonance { .. } => rows(spot, task),
        Task::Orders { .. } | Task::SecondHarmonic { .. } => beyond_cubic(spot, task),
        Task::Pattern { .. } | Task::Circulation { .. } => planes(spot, task),
        Task::Critical { asked, against, .. } => critical(spot, cases, asked, against.as_ref()),
        Task::Claims { claim, .. } => {
            spot.not_empty("claim", claim, "statements")?;
            for (index, statement) in claim.iter().enumerate() {
                claims::statement(spot, index, statement, cases)?;
            }
            Ok(())
        }
        Task::Values { .. } => each_has_k(spot, cases, "values are those of a Landau point"),
        Task::PowerLaw {
            critical,
            distances,
            count,
            ..
        } => {
            asked(&spot.key("critical"), critical, cases)?;
            not_set(spot, cases, &critical.vary)?;
            power_law(spot, critical, *distances, *count)?;
            points(spot, cases, &[*count])
        }
    }
}

/// Profiles of base states, and laws over a field.
fn of_the_state(spot: &Spot, task: &Task) -> Checked {
    match task {
        Task::Profiles {
            fields, tail, mark, ..
        } => {
            spot.not_empty("fields", fields, "fields or expressions")?;
            for (index, mark) in mark.iter().enumerate() {
                let spot = spot.entry("mark", index, format!("mark {}", index + 1));
                spot.finite("at", mark.at)?;
            }
            tail.as_ref().map_or(Ok(()), |tail| of_tail(spot, tail))
        }
        Task::Law {
            case,
            expressions,
            over,
            at,
        } => {
            spot.not_empty("expressions", expressions, "expressions")?;
            axis(spot, "over", over)?;
            for (name, value) in at {
                spot.key("at").finite(name, *value)?;
            }
            points(spot, case, &[over.count])
        }
        _ => Ok(()),
    }
}

/// Tasks at several numbers of collocation points.
fn by_resolution(spot: &Spot, task: &Task) -> Checked {
    match task {
        Task::Convergence {
            case,
            over,
            resolutions,
        } => {
            axis(spot, "over", over)?;
            each_along(spot, case, over)?;
            spot.key("resolutions").demand(resolutions.len() > 1, || {
                "resolutions: it accepts two or more, for each is compared with the last".to_owned()
            })?;
            of_resolutions(spot, resolutions)?;
            points(spot, case, &[over.count, resolutions.len()])
        }
        Task::Spectrum {
            case,
            over,
            resolutions,
        } => {
            along_k(spot, over)?;
            free(spot, case, over)?;
            of_resolutions(spot, resolutions)?;
            points(spot, case, &[over.count, resolutions.len()])
        }
        _ => Ok(()),
    }
}

/// Rows of Landau points along an axis.
fn rows(spot: &Spot, task: &Task) -> Checked {
    match task {
        Task::Sweep {
            case,
            over,
            columns,
            mark,
            reference,
            logarithmic,
            ..
        } => {
            axis(spot, "over", over)?;
            each_along(spot, case, over)?;
            panels(spot, columns, reference)?;
            marks(spot, mark, &over.name, case)?;
            let so = !logarithmic[0] || over.from > 0.0;
            spot.key("logarithmic").demand(so, || {
                format!(
                    "a logarithmic axis accepts numbers above zero: `{}` begins at {}",
                    over.name, over.from
                )
            })?;
            points(spot, case, &[over.count])
        }
        Task::Resonance { case, over, mark } => {
            along_k(spot, over)?;
            free(spot, case, over)?;
            marks(spot, mark, "k", case)?;
            points(spot, case, &[over.count, 2])
        }
        _ => Ok(()),
    }
}

/// Panels of a sweep, and the points of others that are drawn in them.
fn panels(spot: &Spot, columns: &[Together], reference: &[Reference]) -> Checked {
    spot.not_empty("columns", columns, "columns")?;
    for (index, together) in columns.iter().enumerate() {
        let spot = spot.entry("columns", index, format!("column {}", index + 1));
        spot.demand(!together.drawn().is_empty(), || {
            "a panel without columns: brackets accept one or more".to_owned()
        })?;
    }
    for (index, reference) in reference.iter().enumerate() {
        let spot = spot.entry("reference", index, format!("reference {}", index + 1));
        let (panel, count) = (reference.panel, columns.len());
        spot.key("panel").demand((1..=count).contains(&panel), || {
            format!("panel = {panel}: it accepts 1 to {count}")
        })?;
    }
    Ok(())
}

/// Expansions beyond cubic order of one mode.
fn beyond_cubic(spot: &Spot, task: &Task) -> Checked {
    match task {
        Task::Orders {
            case,
            over,
            highest,
            reference,
        } => {
            along_k(spot, over)?;
            free(spot, case, over)?;
            let so = !highest.is_multiple_of(2) && (5..=HIGHEST).contains(highest);
            spot.key("highest").demand(so, || {
                format!(
                    "highest = {highest} is no order: it accepts odd numbers from 5 to {HIGHEST}"
                )
            })?;
            for (index, [k, amplitude]) in reference.iter().enumerate() {
                let spot = spot.entry("reference", index, format!("reference {}", index + 1));
                let so = k.is_finite() && amplitude.is_finite() && *k > 0.0;
                spot.demand(so, || {
                    format!("[{k}, {amplitude}]: it accepts a wavenumber and an amplitude")
                })?;
            }
            points(spot, case, &[over.count, *highest])
        }
        Task::SecondHarmonic { case, over } => {
            along_k(spot, over)?;
            free(spot, case, over)?;
            points(spot, case, &[over.count])
        }
        _ => Ok(()),
    }
}

/// Fields over the plane.
fn planes(spot: &Spot, task: &Task) -> Checked {
    match task {
        Task::Pattern {
            case, wavelengths, ..
        } => {
            each_has_k(spot, case, "a pattern is that of a Landau point")?;
            let so = *wavelengths > 0.0 && *wavelengths <= WAVELENGTHS;
            spot.key("wavelengths").demand(so, || {
                format!(
                    "wavelengths = {wavelengths}: it accepts a number above 0, up to {WAVELENGTHS}"
                )
            })
        }
        Task::Circulation {
            case,
            over,
            k,
            side,
            ..
        } => {
            axis(spot, "over", over)?;
            spot.key("over").key("name").demand(over.name != "k", || {
                "name = `k`: a circulation goes along a parameter, at one `k`".to_owned()
            })?;
            free(spot, case, over)?;
            spot.wavenumber("k", *k)?;
            let so = *side > 0.0 && *side <= 1.0;
            spot.key("side").demand(so, || {
                format!("side = {side}: it accepts a part of the wavelength, above 0 up to 1")
            })?;
            points(spot, case, &[over.count])
        }
        _ => Ok(()),
    }
}

/// Where a parameter varies, every case says at which wavenumber; no case fixes what varies.
fn each_along(spot: &Spot, cases: &[Case], over: &Axis) -> Checked {
    free(spot, cases, over)?;
    if over.name == "k" {
        return Ok(());
    }
    let why = format!(
        "the axis is `{}`, and a row is a Landau point at a wavenumber",
        over.name
    );
    each_has_k(spot, cases, &why)
}

/// Marks are verticals on the axis.
fn marks(spot: &Spot, marks: &[Asked], over: &str, cases: &[Case]) -> Checked {
    for (index, mark) in marks.iter().enumerate() {
        let spot = spot.entry("mark", index, format!("mark {}", index + 1));
        asked(&spot, mark, cases)?;
        spot.key("vary").demand(mark.vary == over, || {
            format!(
                "vary = `{}`: a mark is a vertical on the axis, and accepts `{over}`",
                mark.vary
            )
        })?;
    }
    Ok(())
}

fn critical(spot: &Spot, cases: &[Case], list: &[Asked], against: Option<&Axis>) -> Checked {
    spot.not_empty("asked", list, "questions")?;
    for (index, one) in list.iter().enumerate() {
        let spot = spot.entry("asked", index, format!("question {}", index + 1));
        let earlier = list[..index].iter().any(|other| other.name == one.name);
        spot.key("name").demand(!earlier, || {
            format!(
                "two questions are called `{}`: numbers are found by their names",
                one.name
            )
        })?;
        match against {
            // The axis says at which wavenumber.
            Some(axis) if axis.name == "k" => {
                spot.key("vary").demand(one.vary != "k", || {
                    "vary = `k` against an axis of `k`: it accepts a parameter".to_owned()
                })?;
                question(&spot, one)?;
                spot.key("k").demand(one.k.is_none() && one.minimize.is_none(), || {
                    "`k` or `minimize` stands beside an axis of `k`: a question accepts one wavenumber"
                        .to_owned()
                })?;
            }
            _ => asked(&spot, one, cases)?,
        }
        let same = against.is_some_and(|axis| axis.name == one.vary);
        spot.key("vary").demand(!same, || {
            format!(
                "vary = `{}` is the axis too: it accepts another name",
                one.vary
            )
        })?;
    }
    if let Some(over) = against {
        axis(spot, "against", over)?;
        free(spot, cases, over)?;
    }
    let values = against.map_or(1, |axis| axis.count);
    points(spot, cases, &[values, list.len()])
}

fn power_law(spot: &Spot, critical: &Asked, distances: [f64; 2], count: usize) -> Checked {
    spot.key("count").demand(DISTANCES.contains(&count), || {
        let (least, most) = (DISTANCES.start(), DISTANCES.end());
        format!("count = {count}: it accepts whole numbers from {least} to {most}")
    })?;
    let [near, far] = distances;
    let one_side = near.signum() == far.signum();
    let so = one_side && near != 0.0 && near.abs() < far.abs() && far.is_finite() && far > -1.0;
    spot.key("distances").demand(so, || {
        format!(
            "distances = [{near}, {far}]: it accepts two relative distances of one sign, the nearer first, above −1"
        )
    })?;
    // The law is that of one axis; an extremum over k moves along another.
    spot.key("critical")
        .key("minimize")
        .demand(critical.minimize.is_none(), || {
            "minimize: a power law is taken at one `k`".to_owned()
        })
}

fn of_resolutions(spot: &Spot, resolutions: &[usize]) -> Checked {
    spot.not_empty("resolutions", resolutions, "numbers of collocation points")?;
    resolutions
        .iter()
        .try_for_each(|&resolution| spot.resolution("resolutions", resolution))
}

fn of_tail(spot: &Spot, tail: &Tail) -> Checked {
    let spot = spot.key("tail");
    spot.range("between", tail.between)?;
    let [from, to] = tail.between;
    spot.key("between").demand(from >= 0.0 && to <= 1.0, || {
        format!("between = [{from}, {to}]: it accepts parts of the interval, from 0 to 1")
    })
}
