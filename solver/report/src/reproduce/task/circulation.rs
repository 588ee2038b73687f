//! Circulation around a vortex.

use super::super::needs::Needs;
use super::super::outcome::{Number, Outcome};
use super::super::study::kinds::Circulation;
use super::super::study::{Case, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::planes::{at_equilibrium, crest, largest, peak, quantity};
use super::{Named, Place, Work, each};
use crate::figure::{Panel, Style};
use landau_solver::error::{Error, Result};
use landau_solver::wavevector::WaveVector;
use landau_solver::weakly::{Pattern, PlaneField};
use nalgebra::{Matrix2, Vector2};

/// Points along x and y of the field that a vortex is measured in.
const MEASURED: [usize; 2] = [401, 401];

/// What is measured of a vortex.
struct Vortex {
    circulation: f64,
    centre: f64,
    peak: f64,
}

/// A case at one place of the axis.
struct Moved {
    /// The position of the case.
    origin: usize,
    place: f64,
    case: Case,
}

impl Named for Moved {
    fn label(&self) -> &str {
        &self.case.label
    }
}

impl Work for Circulation {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        of.bounded("a circulation")?;
        of.axis("over", &self.over)?;
        of.field("shade", &self.shade)?;
        of.arrows(&self.arrows)
    }

    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        let moved = self.moved();
        let vortices = each(&moved, &mut outcome.failures, |moved| {
            self.measured(shop, &moved.case)
        })?;
        for (origin, case) in self.case.iter().enumerate() {
            let along_axis = vortices.iter().map(|(index, v)| (&moved[*index], v));
            let of_case = along_axis.filter(|(moved, _)| moved.origin == origin);
            let line: Vec<(f64, &Vortex)> = of_case.map(|(m, v)| (m.place, v)).collect();
            outcome.numbers.extend(numbers(place.figure, case, &line));
            let (panels, table) = (self.panels(&line), self.table(&line));
            picture(shop, &mut outcome, &case.label, &panels, table);
        }
        Ok(outcome)
    }
}

impl Circulation {
    /// Every case at every place of the axis.
    fn moved(&self) -> Vec<Moved> {
        let name = &self.over.name;
        let cases = self.case.iter().enumerate();
        let moved = cases.flat_map(|(origin, case)| {
            self.over.values().into_iter().map(move |place| {
                let mut case = case.moved(&format!("{name} = {place}"));
                case.set.push(format!("{name}={place}"));
                Moved {
                    origin,
                    place,
                    case,
                }
            })
        });
        moved.collect()
    }

    fn measured(&self, shop: &Workshop, case: &Case) -> Result<Vortex> {
        WaveVector::wave(self.k)?;
        let plane = at_equilibrium(&shop.setup(case)?, self.k, MEASURED, 1.0, &[])?;
        let [u, v] = &self.arrows;
        let components = [quantity(&plane, u)?, quantity(&plane, v)?];
        let length = self.side * 2.0 * std::f64::consts::PI / self.k;
        vortex(&plane, components, quantity(&plane, &self.shade)?, length)
    }

    fn table(&self, line: &[(f64, &Vortex)]) -> Table {
        let largest = format!("largest {}", self.shade);
        let header = [&self.over.name, "circulation", "vortex centre", &largest];
        let mut table = Table::new(&header);
        let row = |(place, v): &(f64, &Vortex)| vec![*place, v.circulation, v.centre, v.peak];
        table.rows = line.iter().map(row).collect();
        table
    }

    fn panels(&self, line: &[(f64, &Vortex)]) -> [Panel; 2] {
        let curve = |of: fn(&Vortex) -> f64| line.iter().map(|(x, v)| (*x, of(v))).collect();
        let mut strength = Panel::new("circulation", &self.over.name, "C");
        let mut height = Panel::new("height", &self.over.name, "y");
        strength.curve("", Style::Line, curve(|v| v.circulation));
        height.curve("vortex centre", Style::Line, curve(|v| v.centre));
        let largest = format!("largest {}", self.shade);
        height.curve(&largest, Style::Dashed, curve(|v| v.peak));
        [strength, height]
    }
}

/// The largest circulation along the axis. A largest value at the end of the range says nothing of a maximum.
fn numbers(figure: &str, case: &Case, line: &[(f64, &Vortex)]) -> Vec<Number> {
    let (places, strengths): (Vec<f64>, Vec<f64>) =
        line.iter().map(|(x, v)| (*x, v.circulation)).unzip();
    let Some([place, value]) = crest(&strengths, &places) else {
        return Vec::new();
    };
    let named_values = [
        ("largest circulation", value),
        ("where it is reached", place),
    ];
    let number = |(what, ours): (&str, f64)| {
        Number::new(figure, case, what, named(case, what)).answered(ours, None)
    };
    named_values.map(number).into()
}

/// Circulation over a square around the strongest vortex of half a wavelength.
fn vortex(
    plane: &Pattern,
    [u, v]: [&PlaneField; 2],
    shade: &PlaneField,
    side: f64,
) -> Result<Vortex> {
    let (x, y) = (&plane.x, &plane.y);
    let [u, v] = [&u.nonlinear, &v.nonlinear].map(Vec::as_slice);
    let [cx, cy] = centre([u, v], x, y)?;
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

/// The centre of the strongest vortex of half a wavelength: where both components vanish, and the curl is largest.
///
/// # Errors
/// None at all.
fn centre([u, v]: [&[Vec<f64>]; 2], x: &[f64], y: &[f64]) -> Result<[f64; 2]> {
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
                    let [a, b] = stagnation(corners(u, i, j), corners(v, i, j));
                    let centre = [x[i] + a * (x[i + 1] - x[i]), y[j] + b * (y[j + 1] - y[j])];
                    best = Some((strength, centre));
                }
            }
        }
    }
    let missing = || Error::computation("no vortex centre was found");
    best.map(|(_, centre)| centre).ok_or_else(missing)
}

/// Where in a cell both components vanish, in parts of the cell: Newton on the bilinear interpolants.
fn stagnation(u: [f64; 4], v: [f64; 4]) -> [f64; 2] {
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
