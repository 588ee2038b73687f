//! Fields over the plane: patterns.

use super::super::needs::Needs;
use super::super::outcome::{Number, Outcome, Picture};
use super::super::study::{Case, kinds, named};
use super::super::workshop::Workshop;
use super::{Place, Work, each};
use crate::data::Dataset;
use crate::data::plane::{attributes, dataset};
use crate::figure::{Drawing, Part, View, pattern_pair};
use crate::library::expression;
use landau_solver::error::{Error, Result};
use landau_solver::model::Expression;
use landau_solver::study::Setup;
use landau_solver::study::accuracy::Converged;
use landau_solver::weakly::{Pattern, PlaneField, Selection, Window, pattern as expand};

/// Points along x and y of pictures.
const DRAWN: [usize; 2] = [161, 81];

/// The pattern at the equilibrium amplitude.
pub(super) fn at_equilibrium(
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

/// A field of a pattern by name.
///
/// # Errors
/// A name that is none.
pub(super) fn quantity<'p>(plane: &'p Pattern, name: &str) -> Result<&'p PlaneField> {
    let names = || {
        let names = plane.fields.iter().map(|field| field.name.as_str());
        names.collect::<Vec<_>>().join(", ")
    };
    let missing = || {
        Error::input(format!(
            "the model has no profile `{name}`: it has {}",
            names()
        ))
    };
    plane.quantity(name).ok_or_else(missing)
}

/// The parameters that a case sets, and its wavenumber.
fn facts(case: &Case, k: f64) -> String {
    let set = case.set.iter().map(|set| set.replace('=', " = "));
    let all: Vec<String> = set.chain([format!("k = {k}")]).collect();
    all.join(", ")
}

impl Work for kinds::Pattern {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        of.shade(&self.shade)?;
        self.arrows.as_ref().map_or(Ok(()), |pair| of.arrows(pair))
    }

    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        let answers = each(&self.case, &mut outcome.failures, |case| {
            self.answer(shop, case)
        })?;
        for (index, (drawing, seen, data)) in answers {
            let case = &self.case[index];
            let mut files = Vec::new();
            for extension in ["npz", "nc"] {
                let name = format!("figure{}-{}.{extension}", place.stem, index + 1);
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
            for (quantity, value) in seen.named(&self.shade) {
                let number = Number::new(place.figure, case, &quantity, named(case, &quantity));
                outcome.numbers.push(number.answered(value, None));
            }
        }
        Ok(outcome)
    }
}

impl kinds::Pattern {
    /// The picture of a case, what is read off it, and its data.
    fn answer(&self, shop: &Workshop, case: &Case) -> Result<(Drawing, Seen, Dataset)> {
        let missing = || Error::input(format!("the case `{}` needs a wavenumber k", case.label));
        let k = case.k.ok_or_else(missing)?;
        let setup = shop.setup(case)?;
        let structure = setup.model.structure();
        // A field by name, or any expression of the spec language.
        let expressions = if structure.field(&self.shade).is_some() {
            Vec::new()
        } else {
            vec![expression(setup.model.as_ref(), &self.shade)?]
        };
        let plane = at_equilibrium(&setup, k, DRAWN, self.wavelengths, &expressions)?;
        let shade = quantity(&plane, &self.shade)?;
        let arrows = self.arrows.as_ref();
        let components = arrows
            .map(|[u, v]| Ok::<_, Error>([quantity(&plane, u)?, quantity(&plane, v)?]))
            .transpose()?;
        let title = format!("{}, A_e = {:.4}", facts(case, k), plane.amplitude);
        let view = View {
            title: shop.written(&title),
            shade,
            part: Part::Total,
            arrows: components,
            written: &|name| shop.written(name),
        };
        let drawing = pattern_pair(structure, &plane, &view);
        let parameters = setup.base(None)?.parameters.json(structure);
        let facts = attributes(&setup, &parameters, Some(k), Some(plane.amplitude));
        let vector = arrows.map(|[u, v]| [u.as_str(), v.as_str()]);
        let data = dataset(&setup, &plane, facts, vector);
        let seen = Seen {
            amplitude: plane.amplitude,
            wavelength: 2.0 * std::f64::consts::PI / k,
            height: peak(&largest(shade), &plane.y),
            least: [&shade.linear, &shade.nonlinear].map(|values| least(values)),
        };
        Ok((drawing, seen, data))
    }
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

impl Seen {
    /// Its numbers by name.
    fn named(&self, shade: &str) -> [(String, f64); 5] {
        let [fundamental, third_order] = self.least;
        [
            ("A_e".to_owned(), self.amplitude),
            ("wavelength".to_owned(), self.wavelength),
            (format!("height of the largest {shade}"), self.height),
            (format!("smallest {shade}, fundamental alone"), fundamental),
            (format!("smallest {shade}"), third_order),
        ]
    }
}

/// The largest value at each height.
pub(super) fn largest(field: &PlaneField) -> Vec<f64> {
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

/// The height of the largest of a field's values.
pub(super) fn peak(largest: &[f64], y: &[f64]) -> f64 {
    let highest = largest.iter().zip(y).max_by(|a, b| a.0.total_cmp(b.0));
    let on_grid = highest.map_or(f64::NAN, |(_, y)| *y);
    crest(largest, y).map_or(on_grid, |[place, _]| place)
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
