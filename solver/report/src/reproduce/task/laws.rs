//! Constitutive laws, or any expression, over the value of one field.

use super::super::needs::Needs;
use super::super::outcome::Outcome;
use super::super::study::kinds::Law;
use super::super::table::Table;
use super::super::workshop::Workshop;
use super::draw::picture;
use super::{Place, Work, each};
use crate::figure::{Panel, Style};
use crate::library::expression;
use landau_solver::error::{Error, Result};
use landau_solver::model::{End, Expression, Jet};
use landau_solver::study::Setup;
use std::collections::BTreeMap;

fn compiled(setup: &Setup, expressions: &[String]) -> Result<Vec<Expression>> {
    let texts = expressions.iter();
    texts
        .map(|text| expression(setup.model.as_ref(), text))
        .collect()
}

/// The values that an expression is evaluated with: of the field along the axis, and of each field that is held.
fn jets(
    setup: &Setup,
    expression: &Expression,
    over: &str,
    at: &BTreeMap<String, f64>,
    x: f64,
) -> Result<Vec<f64>> {
    let structure = setup.model.structure();
    let jet = |jet: &Jet| match (&structure.fields[jet.of].name, jet) {
        (_, jet) if jet.x + jet.y + jet.t + jet.absx > 0 => Ok(0.0),
        (name, _) if name == over => Ok(x),
        (name, _) => at.get(name).copied().ok_or_else(|| {
            let text = &expression.written;
            Error::input(format!(
                "`{text}` depends on {name}: `at` accepts a value for it"
            ))
        }),
    };
    expression.jets.iter().map(jet).collect()
}

impl Work for Law {
    fn needs(&self, of: &mut Needs) -> Result<()> {
        of.demand(self.fits(of.setup))
    }

    /// Each expression over one field, the others held at `at`; one panel an expression, one curve a case.
    fn run(&self, shop: &Workshop, _: &Place) -> Result<Outcome> {
        let Law {
            expressions,
            over,
            at,
            ..
        } = self;
        let mut outcome = Outcome::default();
        let columns_of_cases = each(&self.case, &mut outcome.failures, |case| {
            let setup = shop.setup(case)?;
            let base = setup.base(None)?;
            let point = base.at_end(End::Lower);
            let mut columns = Vec::new();
            for expression in &compiled(&setup, expressions)? {
                let value = |x: f64| -> Result<f64> {
                    let jets: Vec<f64> = jets(&setup, expression, &over.name, at, x)?;
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
        for (index, columns) in &columns_of_cases {
            let label = &self.case[*index].label;
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
}

impl Law {
    /// Whether a model has the fields that the law is drawn over, and they are all that it depends on.
    ///
    /// # Errors
    /// A field that is none, an expression that is none or depends on another field.
    fn fits(&self, setup: &Setup) -> Result<()> {
        let structure = setup.model.structure();
        for name in self.at.keys().chain([&self.over.name]) {
            if structure.field(name).is_none() {
                let fields = structure.fields.iter().map(|f| f.name.as_str());
                let fields = fields.collect::<Vec<_>>().join(", ");
                return Err(Error::input(format!(
                    "there is no field `{name}`: the fields are {fields}"
                )));
            }
        }
        for expression in &compiled(setup, &self.expressions)? {
            jets(setup, expression, &self.over.name, &self.at, self.over.from)?;
        }
        Ok(())
    }
}
