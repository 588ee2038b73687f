//! The problem of the base state: its balances, the fields that they are solved for, its integrals.

use super::Opener;
use super::deriver::Deriver;
use super::offsets::{Offsets, Orders, offsets};
use crate::diagnostic::Diagnostic;
use crate::form::Form;
use crate::graph::{BalanceId, FieldId, Id, Node, Table};
use landau_contract::{BaseRowId, SolvedId};

/// A balance restricted to the base state.
#[derive(Clone, Debug)]
pub struct BaseRow {
    /// Which balance.
    pub balance: BalanceId,
    /// With laws opaque.
    pub residual: Id,
}

/// Balances and integrals of the base state, and the number of its conditions.
pub(super) struct BaseProblem {
    pub rows: Table<BaseRowId, BaseRow>,
    pub solved: Table<SolvedId, FieldId>,
    /// Points of the rows and values of the solved profiles; none of either where the base is in closed form
    /// and the rows are there to be checked.
    pub offsets: Offsets<BaseRowId, SolvedId>,
    /// Integrands and values.
    pub integrals: Vec<(Id, Id)>,
    /// Number of conditions (at walls and integrals) that determine the base state.
    pub conditions: usize,
}

/// The balances that the base state has to obey, and the derivatives of the solved profiles in each.
struct BaseRows {
    rows: Table<BaseRowId, BaseRow>,
    orders: Orders<BaseRowId, SolvedId>,
}

impl Deriver<'_> {
    /// The problem of the base state, or a mistake if balances and unknown fields do not match.
    pub(super) fn base_problem(
        &mut self,
        balances: &Table<BalanceId, Form>,
        mistakes: &mut Vec<Diagnostic>,
    ) -> Option<BaseProblem> {
        let closed = &self.model.base.closed;
        let mut solved: Table<SolvedId, FieldId> =
            closed.ids().filter(|&f| closed[f].is_none()).collect();
        solved.sort_by_key(|&f| self.uniform[f]);
        let profiles: Table<SolvedId, FieldId> = solved
            .iter()
            .copied()
            .filter(|&f| !self.uniform[f])
            .collect();
        let BaseRows { rows, orders } = self.base_rows(balances, &profiles);
        if profiles.is_empty() {
            // A closed base that does not satisfy a balance shows when it is evaluated, where a
            // symbolic test could not see through a root.
            let integrals = self.base_integrals(mistakes);
            let offsets = Offsets {
                rows: rows.map(|_| 0),
                columns: Table::default(),
                conditions: 0,
            };
            return Some(BaseProblem {
                rows,
                solved,
                offsets,
                integrals,
                conditions: 0,
            });
        }
        if rows.len() != profiles.len() {
            mistakes.push(self.miscounted(&profiles, &rows));
            return None;
        }
        let Some(offsets) = offsets(&orders) else {
            mistakes.push(Diagnostic::new(
                self.model.base.location.clone(),
                "the base balances cannot be paired with the base fields",
                "one balance for each field that is solved for",
            ));
            return None;
        };
        let numbers = solved.len() - profiles.len();
        let conditions = offsets.conditions + numbers;
        let integrals = self.base_integrals(mistakes);
        Some(BaseProblem {
            rows,
            solved,
            offsets,
            integrals,
            conditions,
        })
    }

    /// The balances that do not vanish identically in the base state, with their laws opaque or opened.
    fn base_rows(
        &mut self,
        balances: &Table<BalanceId, Form>,
        profiles: &Table<SolvedId, FieldId>,
    ) -> BaseRows {
        let model = self.model;
        let mut opener = Opener::new(&model.laws, &model.base.closed, &self.uniform);
        let mut rows = Table::default();
        let mut orders: Orders<BaseRowId, SolvedId> = Table::default();
        for (balance, form) in balances.pairs() {
            let residual = form.base(self.graph);
            if self.graph.vanishes(residual) {
                continue;
            }
            let opened = opener.at_base(self.graph, residual);
            if self.graph.vanishes(opened) {
                continue;
            }
            let mut highest = profiles.map(|_| None);
            for node in self.graph.topological(&[opened]) {
                if let Node::Base(field, order) = self.graph.node(node)
                    && let Some(column) = profiles.position(|f| f == field)
                {
                    let entry: &mut Option<u8> = &mut highest[column];
                    *entry = Some(entry.unwrap_or(0).max(*order));
                }
            }
            rows.push(BaseRow { balance, residual });
            orders.push(highest);
        }
        BaseRows { rows, orders }
    }

    /// The mistake of more or fewer balances than unknown profiles.
    fn miscounted(
        &self,
        profiles: &Table<SolvedId, FieldId>,
        rows: &Table<BaseRowId, BaseRow>,
    ) -> Diagnostic {
        let model = self.model;
        let fields = profiles.iter().map(|&f| model.fields[f].name.as_str());
        let balances = rows
            .iter()
            .map(|row| model.balances[row.balance].name.as_str());
        let message = format!(
            "the base state has {} unknown field(s) ({}) for {} balance(s)",
            profiles.len(),
            quoted(fields),
            rows.len()
        );
        let held = if rows.is_empty() {
            "none".to_owned()
        } else {
            quoted(balances)
        };
        let expected = "as many as there are balances that do not vanish identically";
        Diagnostic::new(model.base.location.clone(), message, expected)
            .hint(format!("balances left in the base state: {held}"))
    }

    fn base_integrals(&mut self, mistakes: &mut Vec<Diagnostic>) -> Vec<(Id, Id)> {
        let model = self.model;
        let mut integrals = Vec::new();
        let declared = model.base.integrals.iter();
        let unknowns = model.mean.iter().filter_map(|closure| match closure {
            crate::model::Closure::Unknown { field, integral }
                if model.base.closed[*field].is_none() =>
            {
                Some(integral)
            }
            _ => None,
        });
        for integral in declared.chain(unknowns) {
            let integrand = self.base_part(integral.integrand, &integral.location, mistakes);
            integrals.extend(integrand.map(|integrand| (integrand, integral.value)));
        }
        integrals
    }
}

/// `a`, `b`, `c`
fn quoted<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let quoted: Vec<String> = names.map(|name| format!("`{name}`")).collect();
    quoted.join(", ")
}
