//! Bordering of the problems at k = 0.
//!
//! [L c; r 0]: the row r closes the problem (∫ density = 0), the column c carries its multiplier into the
//! balances. The adjoint problem is bordered by the same two, exchanged: ∫ c·Y = 0, and the density in the
//! rows of the fields.

use crate::base::BaseState;
use crate::collocation::{Block, Discretisation, Grid, GridKind, Layout, clenshaw_curtis};
use crate::error::{Error, Result};
use crate::model::layout::{ClosureWeights, read_closure, read_terms};
use crate::model::{ClosureInfo, ClosureKind, Jet, KernelId, Model, evaluate};

/// One border: a row that closes the problem, and the column of its multiplier.
#[derive(Clone, Debug)]
pub struct Border {
    /// Which kind of closure.
    pub kind: ClosureKind,
    /// Its position among the closures of the case.
    pub closure: usize,
    /// What is closed, in words: `conserved n`, `gauge p`, `unknown G`.
    pub name: String,
    /// The gauge or the unknown number.
    pub field: Option<usize>,
    /// Coefficients of the unknowns.
    pub row: Vec<f64>,
    /// Entries in the collocated equations, brought to the size of these: `unit` times the weights.
    pub column: Vec<f64>,
    /// The multiplier is `unit` times the unknown that goes with the column.
    pub unit: f64,
}

impl Border {
    /// Brings the column to the size of the equations that it enters, `sizes` being theirs.
    pub fn balance(&mut self, layout: &Layout, sizes: &[f64]) {
        let touched = layout.rows.iter().zip(sizes).filter(|(block, _)| {
            let own = &self.column[block.offset..][..block.len];
            own.iter().any(|c| *c != 0.0)
        });
        let weights = self.column.iter().fold(0.0_f64, |m, c| m.max(c.abs()));
        let unit = touched.map(|(_, size)| size / weights).fold(0.0, f64::max);
        if unit > 0.0 && unit.is_finite() {
            self.column.iter_mut().for_each(|c| *c *= unit);
            self.unit *= unit;
        }
    }
}

/// What closes a case, with its weights at any place.
struct Closures<'a> {
    model: &'a dyn Model,
    base: &'a BaseState,
    discretisation: &'a Discretisation,
}

/// The borders of the direct problem.
pub fn direct(
    model: &dyn Model,
    base: &BaseState,
    layout: &Layout,
    discretisation: &Discretisation,
) -> Vec<Border> {
    let closures = Closures {
        model,
        base,
        discretisation,
    };
    let infos = closures.infos().iter().enumerate();
    let border = |(index, info): (usize, &ClosureInfo)| {
        let jets: Vec<Jet> = info.density.clone();
        let row = closures.integral(layout, &jets, |xi| closures.at(index, xi).density);
        let column = match info.kind {
            ClosureKind::Unknown => closures.unknown_column(layout, info.field),
            _ => closures.column(layout, &info.column, |xi| closures.at(index, xi).column),
        };
        closures.border(index, info, row, column)
    };
    infos.map(border).collect()
}

/// The borders of the adjoint problem, whose columns are balances and whose rows are fields, for the closures
/// that the direct problem has kept.
///
/// # Errors
/// An integral of a derivative, which has no density.
pub fn adjoint(
    model: &dyn Model,
    base: &BaseState,
    layout: &Layout,
    discretisation: &Discretisation,
    kept: &[usize],
) -> Result<Vec<Border>> {
    let closures = Closures {
        model,
        base,
        discretisation,
    };
    let infos = closures.infos().iter().enumerate();
    let infos = infos.filter(|(index, _)| kept.contains(index));
    let border = |(index, info): (usize, &ClosureInfo)| {
        if info.density.iter().any(|jet| jet.y > 0) {
            return Err(Error::computation(
                "the adjoint problem at k = 0 has no closure: an integral condition holds a derivative",
            ));
        }
        let fields: Vec<usize> = info.density.iter().map(|j| usize::from(j.field)).collect();
        let column = closures.column(layout, &fields, |xi| closures.at(index, xi).density);
        let row = match info.kind {
            ClosureKind::Unknown => {
                let balances: Vec<usize> = (0..layout.columns.len()).collect();
                closures.integral(layout, &values(&balances), |xi| {
                    closures.unknown_weights(info.field, xi)
                })
            }
            _ => closures.integral(layout, &values(&info.column), |xi| {
                closures.at(index, xi).column
            }),
        };
        Ok(closures.border(index, info, row, column))
    };
    infos.map(border).collect()
}

fn values(columns: &[usize]) -> Vec<Jet> {
    columns.iter().map(|&c| Jet::value(c)).collect()
}

impl Closures<'_> {
    fn infos(&self) -> &[ClosureInfo] {
        &self.model.structure().cases[self.base.case].closures
    }

    /// The border of a closure before it is balanced against the equations.
    fn border(&self, index: usize, info: &ClosureInfo, row: Vec<f64>, column: Vec<f64>) -> Border {
        Border {
            kind: info.kind,
            closure: index,
            name: self.name(info),
            field: info.field,
            row,
            column,
            unit: 1.0,
        }
    }

    fn name(&self, info: &ClosureInfo) -> String {
        let fields = &self.model.structure().fields;
        let name = |field: usize| fields[field].name.as_str();
        let named: Vec<&str> = match info.field {
            Some(field) => vec![name(field)],
            None => info
                .density
                .iter()
                .map(|j| name(usize::from(j.field)))
                .collect(),
        };
        let kind = match info.kind {
            ClosureKind::Conserved | ClosureKind::Claimed => "conserved",
            ClosureKind::Gauge => "gauge",
            ClosureKind::Drift => "drifting",
            ClosureKind::Unknown => "unknown",
        };
        format!("{kind} {}", named.join(" + "))
    }

    /// The weights of one closure at ξ.
    fn at(&self, index: usize, xi: f64) -> ClosureWeights<f64> {
        let kernel = KernelId::Closures(self.base.case);
        let all = evaluate(self.model, kernel, &self.base.point(self.model, xi, 0.0));
        read_closure(self.infos(), index, &all)
    }

    /// Σ ∫ weight · jet dy as a row over the unknowns, by spectral quadrature.
    fn integral(
        &self,
        layout: &Layout,
        jets: &[Jet],
        weights: impl Fn(f64) -> Vec<f64>,
    ) -> Vec<f64> {
        let point = self.model.structure().coordinate.is_none();
        let (half, scale) = if point {
            (0.5, 1.0)
        } else {
            (1.0 / self.base.scale(), self.base.scale())
        };
        let longest = layout.columns.iter().map(|b| b.len).max().unwrap_or(1);
        let quadrature = match point {
            true => GridKind::Point,
            false => GridKind::Lobatto(2 * longest + 1),
        };
        let nodes = Grid::new(quadrature).nodes;
        let mut row = vec![0.0; layout.size];
        for ((q, &xi), quadrature_weight) in
            nodes.iter().enumerate().zip(clenshaw_curtis(nodes.len()))
        {
            for (jet, weight) in jets.iter().zip(weights(xi)) {
                let Some(block) = layout.columns.get(usize::from(jet.field)) else {
                    continue;
                };
                let order = usize::from(jet.y);
                let matrix = self.discretisation.matrix(block.grid, quadrature, order);
                let factor = quadrature_weight * half * weight * scale.powi(order as i32);
                for j in 0..block.len {
                    row[block.offset + j] += factor * matrix[(q, j)];
                }
            }
        }
        row
    }

    /// Weights at the points of the rows that they belong to.
    fn column(
        &self,
        layout: &Layout,
        rows: &[usize],
        weights: impl Fn(f64) -> Vec<f64>,
    ) -> Vec<f64> {
        let mut column = vec![0.0; layout.size];
        for (offset, &row) in rows.iter().enumerate() {
            let Some(block) = layout.rows.get(row) else {
                continue;
            };
            for_points(block, |i, xi| column[i] += weights(xi)[offset]);
        }
        column
    }

    /// An unknown number enters the balances with its own coefficients: −L in its column.
    fn unknown_column(&self, layout: &Layout, field: Option<usize>) -> Vec<f64> {
        let mut column = vec![0.0; layout.size];
        for (balance, block) in layout.rows.iter().enumerate() {
            for_points(block, |i, xi| {
                column[i] += self.unknown_weights(field, xi)[balance];
            });
        }
        column
    }

    /// −L of an unknown number, balance by balance.
    fn unknown_weights(&self, field: Option<usize>, xi: f64) -> Vec<f64> {
        let structure = self.model.structure();
        let point = self.base.point(self.model, xi, 0.0);
        let coefficients = evaluate(self.model, KernelId::Linear, &point);
        let mut weights = vec![0.0; structure.balances.len()];
        for (term, coefficient) in read_terms(&structure.linear, &coefficients) {
            if term.jet.t == 0 && Some(usize::from(term.jet.field)) == field {
                weights[term.row] -= coefficient;
            }
        }
        weights
    }
}

/// Calls `action` with the position and ξ of every point of a block.
fn for_points(block: &Block, mut action: impl FnMut(usize, f64)) {
    for (i, &xi) in Grid::new(block.grid).nodes.iter().enumerate() {
        action(block.offset + i, xi);
    }
}
