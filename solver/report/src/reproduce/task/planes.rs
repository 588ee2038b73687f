//! Fields over the plane: patterns, circulation around a vortex.

use super::super::outcome::{Number, Outcome, Picture};
use super::super::study::{Axis, Case, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::each;
use crate::data::plane::{attributes, dataset};
use crate::figure::{Panel, Part, Style, View, pattern_pair};
use crate::library::expression;
use landau_solver::error::{Error, Result};
use landau_solver::model::Expression;
use landau_solver::study::accuracy::Converged;
use landau_solver::study::{self, Setup};
use landau_solver::weakly::{Pattern, PlaneField, Selection, Window, pattern as expand};
use nalgebra::{Matrix2, Vector2};

/// Points along x and y of pictures, and of the field that a vortex is measured in.
const DRAWN: [usize; 2] = [161, 81];
const MEASURED: [usize; 2] = [401, 401];

/// The pattern at the equilibrium amplitude.
fn at_equilibrium(
    setup: &Setup,
    k: f64,
    points: [usize; 2],
    wavelengths: f64,
    expressions: &[Expression],
) -> Result<Pattern> {
    let base = setup.base(None)?;
    let converged = Converged::new(setup, &base, k, Selection::Leading)?;
    let amplitude = converged.amplitude().map_err(Error::computation)?.value;
    let [columns, rows] = points;
    let window = Window {
        columns,
        rows,
        wavelengths,
    };
    expand(&converged.point, amplitude, window, expressions)
}

fn quantity<'p>(found: &'p Pattern, name: &str) -> Result<&'p PlaneField> {
    let names = || {
        let names = found.fields.iter().map(|field| field.name.as_str());
        names.collect::<Vec<_>>().join(", ")
    };
    let missing = || {
        Error::input(format!(
            "the model has no profile `{name}`: it has {}",
            names()
        ))
    };
    found.quantity(name).ok_or_else(missing)
}

/// The parameters that a case sets, and its wavenumber.
fn facts(case: &Case, k: f64) -> String {
    let set = case.set.iter().map(|set| set.replace('=', " = "));
    let all: Vec<String> = set.chain([format!("k = {k}")]).collect();
    all.join(", ")
}

/// What a picture of a pattern is to show, and where it belongs.
pub(super) struct Wanted<'a> {
    pub figure: &'a str,
    /// How the names of its files begin.
    pub stem: &'a str,
    pub shade: &'a str,
    pub arrows: Option<&'a [String; 2]>,
    pub wavelengths: f64,
}

pub(super) fn pattern(shop: &Workshop, cases: &[Case], wanted: &Wanted) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let found = each(cases, &mut outcome.failures, |case| {
        let missing = || Error::input(format!("the case `{}` needs a wavenumber k", case.label));
        let k = case.k.ok_or_else(missing)?;
        let setup = shop.setup(case)?;
        let structure = setup.model.structure();
        // A field by name, or any expression of the spec language.
        let is_field = structure.field(wanted.shade).is_some();
        let expressions = match is_field {
            true => Vec::new(),
            false => vec![expression(setup.model.as_ref(), wanted.shade)?],
        };
        let found = at_equilibrium(&setup, k, DRAWN, wanted.wavelengths, &expressions)?;
        let shade = quantity(&found, wanted.shade)?;
        let arrows = wanted
            .arrows
            .map(|[u, v]| Ok::<_, Error>([quantity(&found, u)?, quantity(&found, v)?]))
            .transpose()?;
        let title = format!("{}, A_e = {:.4}", facts(case, k), found.amplitude);
        let view = View {
            title: shop.written(&title),
            shade,
            part: Part::Total,
            arrows,
            written: &|name| shop.written(name),
        };
        let drawing = pattern_pair(structure, &found, &view);
        let parameters = setup.base(None)?.parameters.json(structure);
        let facts = attributes(&setup, &parameters, Some(k), Some(found.amplitude));
        let vector = wanted.arrows.map(|[u, v]| [u.as_str(), v.as_str()]);
        let data = dataset(&setup, &found, facts, vector);
        let seen = Seen {
            amplitude: found.amplitude,
            wavelength: 2.0 * std::f64::consts::PI / k,
            height: peak(&largest(shade), &found.y),
            least: [&shade.linear, &shade.nonlinear].map(|values| least(values)),
        };
        Ok((drawing, seen, data))
    })?;
    for (index, (drawing, seen, data)) in found {
        let case = &cases[index];
        let mut files = Vec::new();
        for extension in ["npz", "nc"] {
            let name = format!("figure{}-{}.{extension}", wanted.stem, index + 1);
            data.write(&shop.shelf.path(&name)?)?;
            files.push(name);
        }
        outcome.pictures.push(Picture {
            caption: case.label.clone(),
            says: drawing.says.clone(),
            svg: Some(drawing.svg()),
            table: None,
            files,
        });
        let shade = wanted.shade;
        for (quantity, value) in [
            ("A_e".to_owned(), seen.amplitude),
            ("wavelength".to_owned(), seen.wavelength),
            (format!("height of the largest {shade}"), seen.height),
            (
                format!("smallest {shade}, fundamental alone"),
                seen.least[0],
            ),
            (format!("smallest {shade}"), seen.least[1]),
        ] {
            let number = Number::new(wanted.figure, case, &quantity, named(case, &quantity));
            outcome.numbers.push(number.answered(value, None));
        }
    }
    Ok(outcome)
}

/// What is read off a pattern.
struct Seen {
    amplitude: f64,
    wavelength: f64,
    /// Where what is shaded is largest.
    height: f64,
    /// The smallest value of it, of the fundamental alone and through third order.
    least: [f64; 2],
}

/// The largest value at each height.
fn largest(field: &PlaneField) -> Vec<f64> {
    let rows = field.nonlinear.iter();
    rows.map(|row| row.iter().copied().fold(f64::NEG_INFINITY, f64::max))
        .collect()
}

/// The smallest value of all.
fn least(values: &[Vec<f64>]) -> f64 {
    values
        .iter()
        .flatten()
        .copied()
        .fold(f64::INFINITY, f64::min)
}

/// What is measured of a vortex.
struct Vortex {
    circulation: f64,
    centre: f64,
    peak: f64,
}

#[allow(clippy::too_many_arguments)]
pub(super) fn circulation(
    shop: &Workshop,
    figure: &str,
    cases: &[Case],
    over: &Axis,
    k: f64,
    arrows: &[String; 2],
    side: f64,
    shade: &str,
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let moved: Vec<Case> = cases
        .iter()
        .flat_map(|case| {
            over.values().into_iter().map(|value| {
                let mut moved = case.moved(&format!("{} = {value}", over.name));
                moved.set.push(format!("{}={value}", over.name));
                moved
            })
        })
        .collect();
    let found = each(&moved, &mut outcome.failures, |case| {
        study::check_wavenumber(k)?;
        let found = at_equilibrium(&shop.setup(case)?, k, MEASURED, 1.0, &[])?;
        let [u, v] = [quantity(&found, &arrows[0])?, quantity(&found, &arrows[1])?];
        let length = side * 2.0 * std::f64::consts::PI / k;
        vortex(&found, [u, v], quantity(&found, shade)?, length)
    })?;
    let values = over.values();
    for (number, case) in cases.iter().enumerate() {
        let mut table = Table::new(&[
            &over.name,
            "circulation",
            "vortex centre",
            &format!("largest {shade}"),
        ]);
        for (index, vortex) in &found {
            if index / values.len() == number {
                let place = values[index % values.len()];
                let row = vec![place, vortex.circulation, vortex.centre, vortex.peak];
                table.rows.push(row);
            }
        }
        let of = |column: usize| -> Vec<(f64, f64)> {
            table.rows.iter().map(|row| (row[0], row[column])).collect()
        };
        let mut strength = Panel::new("circulation", &over.name, "C");
        let mut height = Panel::new("height", &over.name, "y");
        strength.curve("", Style::Line, of(1));
        height.curve("vortex centre", Style::Line, of(2));
        height.curve(&format!("largest {shade}"), Style::Dashed, of(3));
        let (places, strengths): (Vec<f64>, Vec<f64>) = of(1).into_iter().unzip();
        // A largest value at the end of the range says nothing of a maximum.
        if let Some([place, value]) = crest(&strengths, &places) {
            for (what, ours) in [
                ("largest circulation", value),
                ("where it is reached", place),
            ] {
                let number = Number::new(figure, case, what, named(case, what));
                outcome.numbers.push(number.answered(ours, None));
            }
        }
        picture(shop, &mut outcome, &case.label, &[strength, height], table);
    }
    Ok(outcome)
}

/// Circulation over a square around the strongest vortex of half a wavelength.
fn vortex(
    found: &Pattern,
    [u, v]: [&PlaneField; 2],
    shade: &PlaneField,
    side: f64,
) -> Result<Vortex> {
    let (x, y) = (&found.x, &found.y);
    let (u, v) = (&u.nonlinear, &v.nonlinear);
    let corners =
        |f: &[Vec<f64>], i: usize, j: usize| [f[j][i], f[j][i + 1], f[j + 1][i], f[j + 1][i + 1]];
    let changes =
        |values: [f64; 4]| values.iter().any(|v| *v > 0.0) && values.iter().any(|v| *v < 0.0);
    let curl = |i: usize, j: usize| {
        (v[j][i + 1] - v[j][i]) / (x[i + 1] - x[i]) - (u[j + 1][i] - u[j][i]) / (y[j + 1] - y[j])
    };
    let mut best: Option<(f64, [f64; 2])> = None;
    for j in 1..y.len() - 2 {
        for i in 1..x.len() / 2 {
            if changes(corners(u, i, j)) && changes(corners(v, i, j)) {
                let strength = curl(i, j).abs();
                if best.is_none_or(|(most, _)| strength > most) {
                    let [a, b] = rest(corners(u, i, j), corners(v, i, j));
                    let centre = [x[i] + a * (x[i + 1] - x[i]), y[j] + b * (y[j + 1] - y[j])];
                    best = Some((strength, centre));
                }
            }
        }
    }
    let missing = || Error::computation("no vortex centre was found");
    let (_, [cx, cy]) = best.ok_or_else(missing)?;
    // The square is cut at the walls.
    let inside = |t: f64, values: &[f64]| t.clamp(values[0], values[values.len() - 1]);
    let [left, right] = [cx - 0.5 * side, cx + 0.5 * side];
    let [low, high] = [inside(cy - 0.5 * side, y), inside(cy + 0.5 * side, y)];
    let sample = |f: &[Vec<f64>], px: f64, py: f64| bilinear(f, x, y, px, py);
    let integral = |from: f64, to: f64, value: &dyn Fn(f64) -> f64| {
        let steps = 400;
        let step = (to - from) / f64::from(steps);
        let sum: f64 = (0..steps)
            .map(|i| value(from + (f64::from(i) + 0.5) * step))
            .sum();
        sum * step
    };
    let circulation = integral(left, right, &|t| sample(u, t, low))
        + integral(low, high, &|t| sample(v, right, t))
        - integral(left, right, &|t| sample(u, t, high))
        - integral(low, high, &|t| sample(v, left, t));
    Ok(Vortex {
        circulation: circulation.abs(),
        centre: cy,
        peak: peak(&largest(shade), y),
    })
}

/// The height of the largest of a field's values.
fn peak(largest: &[f64], y: &[f64]) -> f64 {
    let highest = largest.iter().zip(y).max_by(|a, b| a.0.total_cmp(b.0));
    let on_grid = highest.map_or(f64::NAN, |(_, y)| *y);
    crest(largest, y).map_or(on_grid, |[place, _]| place)
}

/// Where in a cell both components vanish, in parts of the cell: Newton on the bilinear interpolants.
fn rest(u: [f64; 4], v: [f64; 4]) -> [f64; 2] {
    let mut place = Vector2::new(0.5, 0.5);
    for _ in 0..20 {
        let (a, b) = (place[0], place[1]);
        // f = f00 + (f10 − f00) a + (f01 − f00) b + (f11 − f10 − f01 + f00) a b
        let value = |[f00, f10, f01, f11]: [f64; 4]| {
            f00 + (f10 - f00) * a + (f01 - f00) * b + (f11 - f10 - f01 + f00) * a * b
        };
        let slope = |[f00, f10, f01, f11]: [f64; 4]| {
            let twist = f11 - f10 - f01 + f00;
            [f10 - f00 + twist * b, f01 - f00 + twist * a]
        };
        let ([ua, ub], [va, vb]) = (slope(u), slope(v));
        let Some(inverse) = Matrix2::new(ua, ub, va, vb).try_inverse() else {
            break;
        };
        place -= inverse * Vector2::new(value(u), value(v));
        place = place.map(|t| t.clamp(0.0, 1.0));
    }
    [place[0], place[1]]
}

/// Where evenly spaced values have a maximum between the ends, and its value: the crest of the
/// parabola through three of them.
pub(super) fn crest(values: &[f64], places: &[f64]) -> Option<[f64; 2]> {
    let highest = values.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
    let (j, &at) = highest.filter(|(j, _)| (1..values.len() - 1).contains(j))?;
    let (before, after) = (values[j - 1], values[j + 1]);
    let (tilt, bend) = (after - before, before - 2.0 * at + after);
    let (back, step) = (places[j] - places[j - 1], places[j + 1] - places[j]);
    // A place that failed leaves a gap.
    if bend == 0.0 || (back - step).abs() > 1e-9 * step.abs() {
        return Some([places[j], at]);
    }
    Some([
        places[j] - 0.5 * tilt / bend * step,
        at - tilt * tilt / (8.0 * bend),
    ])
}

/// Interpolation on the uniform grid, periodic in x.
fn bilinear(f: &[Vec<f64>], x: &[f64], y: &[f64], px: f64, py: f64) -> f64 {
    let length = x[x.len() - 1] - x[0];
    let place = |t: f64, values: &[f64]| {
        let step = (values[values.len() - 1] - values[0]) / (values.len() - 1) as f64;
        let position = ((t - values[0]) / step).clamp(0.0, (values.len() - 1) as f64);
        let cell = (position.floor() as usize).min(values.len() - 2);
        (cell, position - cell as f64)
    };
    let (i, a) = place(x[0] + (px - x[0]).rem_euclid(length), x);
    let (j, b) = place(py, y);
    let along = |row: &[f64]| row[i] * (1.0 - a) + row[i + 1] * a;
    along(&f[j]) * (1.0 - b) + along(&f[j + 1]) * b
}
