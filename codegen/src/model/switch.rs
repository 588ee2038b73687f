//! `select`: expressions that depend on a switch.

use super::scope::{Names, Resolved, View};
use crate::diagnostic::{Diagnostic, Location, nearest};
use crate::graph::{Id, ParameterId};
use crate::syntax::tree::{Expression, Name};

impl Names<'_> {
    pub(super) fn select(
        &mut self,
        switch: &Name,
        branches: &[(Name, Expression)],
        view: &View,
        place: &Location,
    ) -> Resolved<Id> {
        let (parameter, order) = self.branches(switch, branches, view.scope, place)?;
        let mut values = Vec::with_capacity(order.len());
        for branch in order {
            values.push(self.expression(&branches[branch].1, view)?);
        }
        Ok(self.graph.select(parameter, values))
    }

    /// The parameter that a `select` names, and for each of its choices the position of the branch for it.
    pub fn branches<T>(
        &mut self,
        switch: &Name,
        branches: &[(Name, T)],
        scope: usize,
        place: &Location,
    ) -> Resolved<(ParameterId, Vec<usize>)> {
        let not_a_switch = |message: String| {
            let expected = "a parameter declared as `name = a in {a, b}`";
            Diagnostic::new(switch.location.clone(), message, expected)
        };
        let parameter = self
            .find_parameter(&switch.text, scope)
            .ok_or_else(|| not_a_switch(format!("`{}` is not a switch", switch.text)))?;
        self.used[parameter] = true;
        let choices = &self.parameters[parameter].choices;
        if choices.is_empty() {
            let message = format!("`{}` is a number, not a switch", switch.text);
            return Err(not_a_switch(message));
        }
        let labels: Vec<&Name> = branches.iter().map(|(label, _)| label).collect();
        check_labels(switch, choices, &labels)?;
        let branch_of = |choice: &String| {
            let branch = labels.iter().position(|label| label.text == *choice);
            branch.ok_or_else(|| {
                let message = format!("the choice `{choice}` of `{}` is missing", switch.text);
                let expected = format!("a branch for each of {}", choices.join(", "));
                Diagnostic::new(place.clone(), message, expected)
            })
        };
        let order = choices.iter().map(branch_of).collect::<Resolved<_>>()?;
        Ok((parameter, order))
    }
}

/// Checks that every branch is for a choice of the switch, and no two for the same one.
fn check_labels(switch: &Name, choices: &[String], labels: &[&Name]) -> Resolved<()> {
    for (position, label) in labels.iter().enumerate() {
        if !choices.contains(&label.text) {
            let message = format!("`{}` has no choice `{}`", switch.text, label.text);
            let near = nearest(&label.text, choices.iter().map(String::as_str));
            let expected = format!("one of {}", choices.join(", "));
            return Err(Diagnostic::new(label.location.clone(), message, expected)
                .maybe_hint(near.map(|n| format!("did you mean `{n}`?"))));
        }
        if labels[..position].iter().any(|l| l.text == label.text) {
            let message = format!("the choice `{}` stands twice", label.text);
            let place = label.location.clone();
            return Err(Diagnostic::new(place, message, "each choice once"));
        }
    }
    Ok(())
}
