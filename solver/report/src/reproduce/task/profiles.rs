//! Base states over the cross-stream coordinate.

use super::super::needs::Needs;
use super::super::outcome::{Number, Outcome};
use super::super::study::kinds::Profiles;
use super::super::study::{Case, PanelOf, Tail, named};
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::{Place, Work, each};
use crate::figure::{Panel, Style};
use crate::library::expression;
use landau_solver::base::BaseState;
use landau_solver::error::{Error, Result};
use landau_solver::model::{End, Expression};
use landau_solver::study::Setup;
use landau_solver::wavevector::WaveVector;

/// Points of a profile.
const POINTS: usize = 401;

/// The profiles of a case.
struct Profile {
    /// The position of the case.
    index: usize,
    /// The coordinate, then the fields.
    columns: Vec<Vec<f64>>,
    heights: Option<Heights>,
}

impl Work for Profiles {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        of.bounded("profiles")?;
        for (index, text) in self.fields.iter().enumerate() {
            let spot = of.spot.entry("fields", index, "fields".to_owned());
            of.expression(&spot, text)?;
        }
        match self.tail.as_ref().and_then(|tail| tail.predicted.as_ref()) {
            Some(text) => of.expression(&of.spot.key("tail").key("predicted"), text),
            None => Ok(()),
        }
    }

    fn run(&self, shop: &Workshop, place: &Place) -> Result<Outcome> {
        let mut outcome = Outcome::default();
        let answers = each(&self.case, &mut outcome.failures, |case| {
            self.columns(shop, case)
        })?;
        let profile = |(index, (columns, heights))| Profile {
            index,
            columns,
            heights,
        };
        let profiles: Vec<Profile> = answers.into_iter().map(profile).collect();
        let first = shop.setup(&self.case[0])?;
        let vertical = first.model.structure().coordinate.clone();
        let vertical = vertical.unwrap_or_default();
        for profile in &profiles {
            let numbers = numbers(place.figure, &self.case[profile.index], profile);
            outcome.numbers.extend(numbers);
        }
        let panels = self.panels(&vertical, &profiles);
        let table = self.table(&vertical, &profiles);
        picture(shop, &mut outcome, "", &panels, table);
        Ok(outcome)
    }
}

impl Profiles {
    /// The coordinate and the fields of a case, with the scale heights that are asked for.
    fn columns(&self, shop: &Workshop, case: &Case) -> Result<(Vec<Vec<f64>>, Option<Heights>)> {
        let setup = shop.setup(case)?;
        let model = setup.model.as_ref();
        let base = setup.base(None)?;
        // A field is an expression too.
        let expressions = self.fields.iter().map(|text| expression(model, text));
        let expressions: Vec<Expression> = expressions.collect::<Result<_>>()?;
        let mut columns = vec![Vec::new(); self.fields.len() + 1];
        for place in base.space.evenly(POINTS) {
            let point = base.at(place, WaveVector::MEAN);
            columns[0].push(base.space.y(place));
            for (column, expression) in columns[1..].iter_mut().zip(&expressions) {
                column.push(expression.at_base(model.structure(), &point));
            }
        }
        let tail = self.tail.as_ref();
        let heights = tail.map(|tail| scale_heights(&setup, &base, &columns, tail));
        Ok((columns, heights.transpose()?))
    }

    /// A panel a field, or a panel a case.
    fn panels(&self, vertical: &str, profiles: &[Profile]) -> Vec<Panel> {
        let panel = |title: &str, y: &str| {
            let mut panel = Panel::new(title, vertical, y);
            panel.logarithmic[1] = self.logarithmic;
            let marks = self.mark.iter();
            panel.marks = marks.map(|mark| (mark.at, mark.name.clone())).collect();
            panel
        };
        let mut panels: Vec<Panel> = match self.panel {
            PanelOf::Field => self.fields.iter().map(|name| panel("", name)).collect(),
            PanelOf::Case => {
                let title = |p: &Profile| panel(&self.case[p.index].label, &self.fields.join(", "));
                profiles.iter().map(title).collect()
            }
        };
        for (position, profile) in profiles.iter().enumerate() {
            for (field, values) in profile.columns[1..].iter().enumerate() {
                let places = profile.columns[0].iter().copied();
                let points = places.zip(values.iter().copied());
                let (panel, label, style) = match (self.panel, field) {
                    (PanelOf::Field, _) => (field, &self.case[profile.index].label, Style::Line),
                    (PanelOf::Case, 0) => (position, &self.fields[field], Style::Line),
                    (PanelOf::Case, _) => (position, &self.fields[field], Style::Dashed),
                };
                panels[panel].curve(label, style, points.collect());
            }
        }
        panels
    }

    fn table(&self, vertical: &str, profiles: &[Profile]) -> Table {
        let mut header = vec!["case", vertical];
        header.extend(self.fields.iter().map(String::as_str));
        let mut table = Table::new(&header).with_words(&["label"]);
        for profile in profiles {
            for i in 0..POINTS {
                let mut row = vec![(profile.index + 1) as f64];
                row.extend(profile.columns.iter().map(|column| column[i]));
                table.push(row, &[&self.case[profile.index].label]);
            }
        }
        table
    }
}

/// The scale heights of a case, where they are asked for.
fn numbers(figure: &str, case: &Case, profile: &Profile) -> Vec<Number> {
    let Some(heights) = &profile.heights else {
        return Vec::new();
    };
    let values = [
        ("scale height of the tail, fitted", Some(heights.fitted)),
        ("predicted", heights.predicted),
    ];
    let number = |(quantity, value): (&str, Option<f64>)| {
        let number = Number::new(figure, case, quantity, named(case, quantity));
        value.map(|value| number.answered(value, None))
    };
    values.into_iter().filter_map(number).collect()
}

/// Scale heights of the tail.
struct Heights {
    fitted: f64,
    predicted: Option<f64>,
}

/// h of exp(−y/h), fitted, and what it ought to be.
fn scale_heights(
    setup: &Setup,
    base: &BaseState,
    columns: &[Vec<f64>],
    tail: &Tail,
) -> Result<Heights> {
    let place = |fraction: f64| ((POINTS - 1) as f64 * fraction).round() as usize;
    let [a, b] = tail.between.map(|fraction| place(fraction.clamp(0.0, 1.0)));
    let fall = (columns[1][a] / columns[1][b]).ln();
    let predicted = tail.predicted.as_ref().map(|text| {
        let expression = expression(setup.model.as_ref(), text)?;
        let top = base.at_end(End::Upper);
        Ok::<f64, Error>(expression.at_base(base.structure(), &top))
    });
    Ok(Heights {
        fitted: (columns[0][b] - columns[0][a]) / fall,
        predicted: predicted.transpose()?,
    })
}
