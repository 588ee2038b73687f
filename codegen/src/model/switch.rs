//! Choices by switch parameters.

use super::scope::{Names, Resolved, View};
use crate::diagnostic::{Diagnostic, Location, nearest};
use crate::graph::{Id, ParameterId};
use crate::syntax::tree::{Expression, Name};

impl Names {
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

    /// The switch, and for each of its choices the branch that belongs to it.
    pub fn branches<T>(
        &mut self,
        switch: &Name,
        branches: &[(Name, T)],
        scope: usize,
        place: &Location,
    ) -> Resolved<(ParameterId, Vec<usize>)> {
        let parameter = self.find_parameter(&switch.text, scope).ok_or_else(|| {
            let message = format!("`{}` is not a switch", switch.text);
            Diagnostic::new(
                switch.location.clone(),
                message,
                "a parameter declared as `name = a in {a, b}`",
            )
        })?;
        self.used[parameter] = true;
        let choices = self.parameters[parameter].choices.clone();
        if choices.is_empty() {
            let message = format!("`{}` is a number, not a switch", switch.text);
            return Err(Diagnostic::new(
                switch.location.clone(),
                message,
                "a parameter declared as `name = a in {a, b}`",
            ));
        }
        for (i, (name, _)) in branches.iter().enumerate() {
            if !choices.contains(&name.text) {
                let message = format!("`{}` has no choice `{}`", switch.text, name.text);
                let near = nearest(&name.text, choices.iter().map(String::as_str));
                return Err(Diagnostic::new(
                    name.location.clone(),
                    message,
                    format!("one of {}", choices.join(", ")),
                )
                .maybe_hint(near.map(|n| format!("did you mean `{n}`?"))));
            }
            if branches[..i]
                .iter()
                .any(|(other, _)| other.text == name.text)
            {
                let message = format!("the choice `{}` stands twice", name.text);
                return Err(Diagnostic::new(
                    name.location.clone(),
                    message,
                    "each choice once",
                ));
            }
        }
        let mut order = Vec::with_capacity(choices.len());
        for choice in &choices {
            match branches.iter().position(|(name, _)| &name.text == choice) {
                Some(branch) => order.push(branch),
                None => {
                    let message = format!("the choice `{choice}` of `{}` is missing", switch.text);
                    return Err(Diagnostic::new(
                        place.clone(),
                        message,
                        format!("a branch for each of {}", choices.join(", ")),
                    ));
                }
            }
        }
        Ok((parameter, order))
    }
}
