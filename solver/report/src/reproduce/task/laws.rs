//! Constitutive laws, or any expression, over the value of one field.

use super::super::outcome::{Outcome, Table};
use super::super::study::{Axis, Case};
use super::super::workshop::Workshop;
use super::draw::picture;
use super::each;
use crate::figure::{Panel, Style};
use crate::library::expression;
use landau_solver::error::{Error, Result};
use landau_solver::model::{Expression, Jet};
use std::collections::BTreeMap;

/// Each expression over one field, the others held at `at`; one panel an expression, one curve a case.
pub(super) fn law(
    shop: &Workshop,
    cases: &[Case],
    expressions: &[String],
    over: &Axis,
    at: &BTreeMap<String, f64>,
) -> Result<Outcome> {
    let mut outcome = Outcome::default();
    let found = each(cases, &mut outcome.failures, |case| {
        let setup = shop.setup(case)?;
        let (model, structure) = (setup.model.as_ref(), setup.model.structure());
        let known = |name: &str| structure.field(name).is_some();
        for name in at.keys().chain([&over.name]) {
            if !known(name) {
                let fields = structure.fields.iter().map(|f| f.name.as_str());
                let fields = fields.collect::<Vec<_>>().join(", ");
                return Err(Error::input(format!(
                    "there is no field `{name}`: the fields are {fields}"
                )));
            }
        }
        let base = setup.base(None)?;
        let point = base.at_end(landau_solver::model::End::Lower);
        let compiled = expressions.iter().map(|text| expression(model, text));
        let compiled: Vec<Expression> = compiled.collect::<Result<_>>()?;
        let mut columns = Vec::new();
        for expression in &compiled {
            let value = |x: f64| -> Result<f64> {
                let jet = |jet: &Jet| match (&structure.fields[jet.of].name, jet) {
                    (_, jet) if jet.x + jet.y + jet.t + jet.absx > 0 => Ok(0.0),
                    (name, _) if *name == over.name => Ok(x),
                    (name, _) => at.get(name).copied().ok_or_else(|| {
                        let text = &expression.written;
                        Error::input(format!(
                            "`{text}` depends on {name}, which `at` gives no value"
                        ))
                    }),
                };
                let jets: Vec<f64> = expression.jets.iter().map(jet).collect::<Result<_>>()?;
                Ok(expression.evaluate(&point, &jets))
            };
            let values = over.values().into_iter().map(value);
            columns.push(values.collect::<Result<Vec<f64>>>()?);
        }
        Ok(columns)
    })?;
    let panel = |text: &String| Panel::new(text, &over.name, text);
    let mut drawn: Vec<Panel> = expressions.iter().map(panel).collect();
    let header = ["case", &over.name].into_iter();
    let header: Vec<&str> = header
        .chain(expressions.iter().map(String::as_str))
        .collect();
    let mut table = Table::new(&header).with_words(&["label"]);
    let places = over.values();
    for (index, columns) in &found {
        let label = &cases[*index].label;
        for (panel, values) in drawn.iter_mut().zip(columns) {
            let points = places.iter().copied().zip(values.iter().copied());
            panel.curve(label, Style::Line, points.collect());
        }
        for (i, x) in places.iter().enumerate() {
            let values = columns.iter().map(|column| column[i]);
            let row = [(index + 1) as f64, *x].into_iter().chain(values);
            table.push(row.collect(), &[label]);
        }
    }
    picture(shop, &mut outcome, "", &drawn, table);
    Ok(outcome)
}
