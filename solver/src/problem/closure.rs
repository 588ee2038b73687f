//! Bordering of the problems at k = 0 by the closures of the model.
//!
//! [σ M0 − L  c; r  d] [X; λ] = [G; −∫ F dy]
//!
//! The row r is the linear part of ∫ density dy. The column c carries the multiplier λ into the balances. The corner d
//! holds the weights of unknown numbers in the density. In the adjoint problem rows and columns change places: the
//! condition is ∫ c·Y dy = 0, and the density stands in the column, in the rows of the fields.

use super::basis::Turn;
use crate::base::BaseState;
use crate::error::{Error, Result};
use crate::model::layout::{ClosureWeights, read_closure, read_terms};
use crate::model::{
    BalanceId, C64, ClosureInfo, ClosureKind, FieldId, Id, Jet, KernelId, Table, evaluate,
};
use crate::space::{Derivative, Layout, Place, Space};
use crate::wavevector::WaveVector;
use std::ops::Range;

/// One border: a row that closes the problem, and the column of its multiplier.
#[derive(Clone, Debug)]
pub struct Border {
    /// Conserved integral, gauge, drift or unknown number.
    pub kind: ClosureKind,
    /// Position among the closures of the case.
    pub closure: usize,
    /// What is closed, in words: `conserved n`, `gauge p`, `unknown G`.
    pub name: String,
    /// The field of a gauge, or the unknown number; `None` for a conserved integral.
    pub field: Option<FieldId>,
    /// r: coefficients of the unknowns of the collocated problem.
    pub row: Vec<f64>,
    /// Unknown numbers in the density, each with the integral of its weight: entries of the corner.
    pub numbers: Vec<(FieldId, f64)>,
    /// Whether the density is odd in the mirror x → −x.
    pub is_odd: bool,
    /// c: `unit` times the weights in the collocated equations, which are then as large as the terms there.
    pub column: Vec<f64>,
    /// The multiplier λ is `unit` times the unknown of the column.
    pub unit: f64,
}

impl Border {
    /// The entry d of the corner in the row of this border and the column of `column`.
    pub fn corner(&self, column: &Border) -> f64 {
        if column.kind != ClosureKind::Unknown {
            return 0.0;
        }
        let numbers = self.numbers.iter();
        let numbers = numbers.filter(|(field, _)| Some(*field) == column.field);
        numbers.map(|(_, weight)| weight * column.unit).sum()
    }

    /// The factor that takes ∫ density dy into the solver's basis.
    pub fn factor(&self) -> C64 {
        (-Turn::of(self.is_odd)).factor()
    }

    /// Scales the column to the size of the balances that it enters, `sizes` being the sizes of their terms.
    pub fn balance(&mut self, layout: &Layout<BalanceId, FieldId>, sizes: &Table<BalanceId, f64>) {
        let touched = layout.rows.iter().zip(sizes.iter()).filter(|(block, _)| {
            let weights = block.of(&self.column);
            weights.iter().any(|c| *c != 0.0)
        });
        let weights = self.column.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        let unit = touched.map(|(_, size)| size / weights).fold(0.0, f64::max);
        if unit > 0.0 && unit.is_finite() {
            self.column.iter_mut().for_each(|c| *c *= unit);
            self.unit *= unit;
        }
    }
}

/// The closures of a case, whose weights can be evaluated at any place.
struct Closures<'a> {
    base: &'a BaseState,
    space: &'a Space,
}

/// The borders of the direct problem, in the order of the closures of the case.
pub fn direct(base: &BaseState, space: &Space, layout: &Layout<BalanceId, FieldId>) -> Vec<Border> {
    let closures = Closures { base, space };
    let infos = closures.infos().iter().enumerate();
    let border = |(index, info): (usize, &ClosureInfo)| {
        let density = |place| closures.at(index, place).density;
        let column = match info.kind {
            ClosureKind::Unknown => closures.unknown_column(layout, info.field),
            _ => closures.column(layout, &info.column, |place| {
                closures.at(index, place).column
            }),
        };
        Border {
            row: closures.integral(layout, &info.density, density),
            numbers: closures.numbers(layout, &info.density, density),
            column,
            ..closures.border(index, info)
        }
    };
    infos.map(border).collect()
}

/// The borders of the adjoint problem for the closures with the positions `kept`.
///
/// # Errors
/// An integral condition holds a derivative, which has no density to stand in a column.
pub fn adjoint(
    base: &BaseState,
    space: &Space,
    layout: &Layout<FieldId, BalanceId>,
    kept: &[usize],
) -> Result<Vec<Border>> {
    let closures = Closures { base, space };
    let infos = closures.infos().iter().enumerate();
    let infos = infos.filter(|(index, _)| kept.contains(index));
    let values = |balances: &[BalanceId]| -> Vec<Jet<BalanceId>> {
        balances
            .iter()
            .map(|&balance| Jet::value(balance))
            .collect()
    };
    let border = |(index, info): (usize, &ClosureInfo)| {
        if info.density.iter().any(|jet| jet.y > 0) {
            return Err(Error::computation(
                "the adjoint problem at k = 0 has no closure: an integral condition holds a derivative",
            ));
        }
        let fields: Vec<FieldId> = info.density.iter().map(|jet| jet.of).collect();
        let column = closures.column(layout, &fields, |place| closures.at(index, place).density);
        let row = match info.kind {
            ClosureKind::Unknown => {
                let balances: Vec<BalanceId> = layout.columns.ids().collect();
                closures.integral(layout, &values(&balances), |place| {
                    closures.unknown_weights(info.field, place).to_vec()
                })
            }
            _ => closures.integral(layout, &values(&info.column), |place| {
                closures.at(index, place).column
            }),
        };
        Ok(Border {
            row,
            column,
            ..closures.border(index, info)
        })
    };
    infos.map(border).collect()
}

impl Closures<'_> {
    fn infos(&self) -> &[ClosureInfo] {
        &self.base.structure().cases[self.base.case].closures
    }

    /// The border of a closure without its entries, before it is balanced against the equations.
    fn border(&self, index: usize, info: &ClosureInfo) -> Border {
        let parity = self.base.structure().parity.as_ref();
        let first = info.density.first();
        Border {
            kind: info.kind,
            closure: index,
            name: self.name(info),
            field: info.field,
            row: Vec::new(),
            numbers: Vec::new(),
            is_odd: parity
                .zip(first)
                .is_some_and(|(parity, jet)| parity.fields[jet.of]),
            column: Vec::new(),
            unit: 1.0,
        }
    }

    fn name(&self, info: &ClosureInfo) -> String {
        let fields = &self.base.structure().fields;
        let name = |field: FieldId| fields[field].name.as_str();
        let named: Vec<&str> = match info.field {
            Some(field) => vec![name(field)],
            None => info.density.iter().map(|jet| name(jet.of)).collect(),
        };
        let kind = match info.kind {
            ClosureKind::Conserved | ClosureKind::Claimed => "conserved",
            ClosureKind::Gauge => "gauge",
            ClosureKind::Drift => "drifting",
            ClosureKind::Unknown => "unknown",
        };
        format!("{kind} {}", named.join(" + "))
    }

    /// The weights of one closure at a place.
    fn at(&self, index: usize, place: Place) -> ClosureWeights<f64> {
        let kernel = KernelId::Closures(self.base.case);
        let all = evaluate(
            self.base.model.as_ref(),
            kernel,
            &self.base.at(place, WaveVector::MEAN),
        );
        read_closure(self.infos(), index, &all)
    }

    /// Σ ∫ weight · jet dy as a row over the unknowns, by spectral quadrature.
    fn integral<Row: Id, Column: Id>(
        &self,
        layout: &Layout<Row, Column>,
        jets: &[Jet<Column>],
        weights: impl Fn(Place) -> Vec<f64>,
    ) -> Vec<f64> {
        let longest = layout.columns.iter().map(|b| b.len).max().unwrap_or(1);
        let quadrature = self.space.quadrature(2 * longest + 1);
        let derivatives: Vec<Option<(Range<usize>, Derivative)>> = jets
            .iter()
            .map(|jet| {
                let (block, order) = (layout.columns.find(jet.of)?, usize::from(jet.y));
                let derivative = self
                    .space
                    .derivative(block.points, quadrature.points, order);
                Some((block.range(), derivative))
            })
            .collect();
        let mut row = vec![0.0; layout.size];
        for (q, &(place, measure)) in quadrature.nodes.iter().enumerate() {
            for (derivative, weight) in derivatives.iter().zip(weights(place)) {
                if let Some((range, derivative)) = derivative {
                    derivative.add_row(q, measure * weight, &mut row[range.clone()]);
                }
            }
        }
        row
    }

    /// ∫ weight dy of the numbers among the jets of a density.
    fn numbers(
        &self,
        layout: &Layout<BalanceId, FieldId>,
        jets: &[Jet],
        weights: impl Fn(Place) -> Vec<f64>,
    ) -> Vec<(FieldId, f64)> {
        let longest = layout.columns.iter().map(|b| b.len).max().unwrap_or(1);
        let nodes = self.space.quadrature(2 * longest + 1).nodes;
        let numbers = jets.iter().enumerate();
        let numbers = numbers.filter(|(_, jet)| layout.columns.find(jet.of).is_none());
        let integral = |(position, jet): (usize, &Jet)| {
            let parts = nodes.iter();
            let parts = parts.map(|&(place, measure)| measure * weights(place)[position]);
            (jet.of, parts.sum())
        };
        numbers.map(integral).collect()
    }

    /// Weights at the points of the rows that they belong to.
    fn column<Row: Id, Column: Id>(
        &self,
        layout: &Layout<Row, Column>,
        rows: &[Row],
        weights: impl Fn(Place) -> Vec<f64>,
    ) -> Vec<f64> {
        let mut column = vec![0.0; layout.size];
        for (position, &row) in rows.iter().enumerate() {
            let Some(block) = layout.rows.find(row) else {
                continue;
            };
            let places = self.space.places(block.points);
            for (entry, place) in column[block.range()].iter_mut().zip(places) {
                *entry += weights(place)[position];
            }
        }
        column
    }

    /// The column of an unknown number: −L in its coefficients, balance by balance.
    fn unknown_column(
        &self,
        layout: &Layout<BalanceId, FieldId>,
        field: Option<FieldId>,
    ) -> Vec<f64> {
        let mut column = vec![0.0; layout.size];
        for (balance, block) in layout.rows.pairs() {
            let places = self.space.places(block.points);
            for (entry, place) in column[block.range()].iter_mut().zip(places) {
                *entry += self.unknown_weights(field, place)[balance];
            }
        }
        column
    }

    /// −L of an unknown number, balance by balance.
    fn unknown_weights(&self, field: Option<FieldId>, place: Place) -> Table<BalanceId, f64> {
        let (model, structure) = (self.base.model.as_ref(), self.base.structure());
        let coefficients = evaluate(
            model,
            KernelId::Linear,
            &self.base.at(place, WaveVector::MEAN),
        );
        let mut weights = structure.balances.map(|_| 0.0);
        for (term, coefficient) in read_terms(&structure.linear, &coefficients) {
            if term.jet.t == 0 && Some(term.jet.of) == field {
                weights[term.row] -= coefficient;
            }
        }
        weights
    }
}
