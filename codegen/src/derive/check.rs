//! Checks of a model before its operators are derived.

use super::deriver::Deriver;
use super::linear::DirectTerm;
use crate::diagnostic::{Diagnostic, Location};
use crate::form::Form;
use crate::graph::{BalanceId, Table};

impl Deriver<'_> {
    pub(super) fn check_counts(&self, profiles: usize, mistakes: &mut Vec<Diagnostic>) -> bool {
        let (balances, fields) = (self.model.balances.len(), profiles);
        if balances == fields {
            return true;
        }
        let place = match self.model.balances.last() {
            Some(balance) if balances > fields => balance.location.clone(),
            _ => self.model.fields.last().map_or(
                Location {
                    file: 0,
                    range: 0..0,
                },
                |f| f.location.clone(),
            ),
        };
        let message = format!("{balances} balance(s) for {fields} field(s)");
        let what = if balances > fields {
            "a surplus balance"
        } else {
            "a field without a balance"
        };
        mistakes.push(
            Diagnostic::new(place, message, "as many balances as fields")
                .hint(format!("there is {what}")),
        );
        false
    }

    pub(super) fn check_orders(
        &self,
        forms: &Table<BalanceId, Form>,
        mistakes: &mut Vec<Diagnostic>,
    ) {
        let coordinate = self.model.coordinate();
        for (form, balance) in forms.iter().zip(&self.model.balances) {
            let jets = || form.terms.keys().flatten();
            let place = balance.location.clone();
            if let Some(jet) = jets().find(|j| j.t > 1) {
                let name = &self.model.fields[jet.of].name;
                let message = format!(
                    "`{}` holds a second time derivative of `{name}`",
                    balance.name
                );
                mistakes.push(
                    Diagnostic::new(place, message, "balances of first order in time")
                        .hint("introduce a field for the first time derivative"),
                );
            } else if let Some(jet) = jets().find(|j| j.y > 2) {
                let name = &self.model.fields[jet.of].name;
                let message = format!(
                    "`{}` holds a {}-fold {coordinate}-derivative of `{name}`",
                    balance.name, jet.y
                );
                mistakes.push(
                    Diagnostic::new(
                        place,
                        message,
                        format!("{coordinate}-derivatives of second order at most"),
                    )
                    .hint("introduce an auxiliary field for the second derivative"),
                );
            } else if self.model.interval.is_none() && jets().any(|j| j.y > 0) {
                let message = format!("`{}` holds a cross-stream derivative", balance.name);
                mistakes.push(Diagnostic::new(
                    place,
                    message,
                    "no such derivative, for want of the coordinate",
                ));
            }
        }
    }

    /// Every field must occur linearly in some balance.
    pub(super) fn check_determined(&self, linear: &[DirectTerm], mistakes: &mut Vec<Diagnostic>) {
        for field in self.model.profiles() {
            if !linear.iter().any(|t| t.jet.of == field) {
                let info = &self.model.fields[field];
                let message = format!("no balance determines the field `{}`", info.name);
                let expected = "a field that occurs linearly in some balance";
                mistakes.push(Diagnostic::new(info.location.clone(), message, expected));
            }
        }
        for (row, balance) in self.model.balances.pairs() {
            if !linear.iter().any(|t| t.row == row) {
                let message = format!("the balance `{}` has no linear part", balance.name);
                let expected = "a balance that is linear in some field to lowest order";
                mistakes.push(Diagnostic::new(balance.location.clone(), message, expected));
            }
        }
    }
}
