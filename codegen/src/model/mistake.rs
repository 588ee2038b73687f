//! Mistakes that several blocks share.

use super::context::Context;
use super::scope::{Names, Resolved, View};
use crate::diagnostic::{Diagnostic, Location, nearest};
use crate::graph::Function;
use crate::syntax::tree::{Expression, Name};

/// Words that name something in the language or on the command line, beside the elementary functions and
/// the differential operators.
const RESERVED: [&str; 8] = ["t", "k", "pi", "sqrt", "select", "integral", "at", "auto"];

/// The mistake of a name that is declared twice.
pub(super) fn twice(name: &Name) -> Diagnostic {
    let message = format!("`{}` is defined twice", name.text);
    Diagnostic::new(name.location.clone(), message, "a name not used yet")
}

/// The view of the model file.
pub(super) fn view(context: Context) -> View<'static> {
    View {
        scope: 0,
        context,
        arguments: &[],
    }
}

/// The place of an item that is missing altogether: the start of the file.
pub(super) fn beginning() -> Location {
    Location {
        file: 0,
        range: 0..0,
    }
}

impl Names<'_> {
    /// Refuses a name that the language reserves.
    pub(super) fn check_name(&self, name: &Name) -> Resolved<()> {
        let word = name.text.as_str();
        let what = match word {
            "k" => "the wavenumber".to_owned(),
            "t" => "time".to_owned(),
            _ if self.operator(word).is_some() => "a differential operator".to_owned(),
            _ if Function::ALL.iter().any(|f| f.name() == word) => "a function".to_owned(),
            _ if RESERVED.contains(&word) => "a word of the language".to_owned(),
            _ => return Ok(()),
        };
        Err(Diagnostic::new(
            name.location.clone(),
            format!("`{word}` is reserved: it is {what}"),
            "another name",
        ))
    }

    /// An expression as the user wrote it.
    pub(super) fn written(&self, expression: &Expression) -> String {
        let place = &expression.location;
        let text = &self.files[place.file].text;
        text.get(place.range.clone()).unwrap_or_default().to_owned()
    }

    /// The mistake of an undeclared name, with the nearest name that is declared.
    pub(super) fn unknown(&self, name: &str, place: &Location, view: &View) -> Diagnostic {
        let scope = &self.scopes[view.scope];
        let mut candidates: Vec<&str> = view.arguments.iter().map(|(n, _)| n.as_str()).collect();
        candidates.extend(scope.definitions.keys().map(String::as_str));
        candidates.extend(scope.imports.keys().map(String::as_str));
        candidates.extend(scope.parameters.keys().map(String::as_str));
        let operators = [
            format!("d{}", self.periodic),
            format!("absd{}", self.periodic),
            self.coordinate
                .as_ref()
                .map_or(String::new(), |c| format!("d{c}")),
        ];
        if view.scope == 0 {
            candidates.extend(self.fields.keys().map(String::as_str));
            candidates.extend(self.laws.keys().map(String::as_str));
            candidates.extend(self.parameters.iter().map(|p| p.name.as_str()));
            candidates.extend(operators.iter().map(String::as_str));
            candidates.push("dt");
        }
        candidates.extend(Function::ALL.iter().map(|f| f.name()));
        candidates.push("sqrt");
        candidates.sort_unstable();
        let mut hint = nearest(name, candidates).map(|n| format!("did you mean `{n}`?"));
        if name == "k" || name == format!("k_{}", self.periodic) || name == "kx" {
            hint = Some(format!(
                "a wavenumber may not be used here: write d{0}(q) or absd{0}(q)",
                self.periodic
            ));
        }
        let habit = match name {
            "inf" | "infinity" => Some("leave the end of a range open, as in `0..`"),
            "abs" => Some("a modulus is not smooth: sqrt(q^2) is one where q keeps its sign"),
            "t" => Some("a model does not depend on time; a time derivative is dt(q)"),
            "i" => Some("balances are real: give the real and the imaginary part a field each"),
            "max" | "min" | "sign" => Some("a law has to be smooth: tanh makes a step"),
            "e" => Some("the exponential function is exp(q)"),
            "ln" => Some("the natural logarithm is log(q)"),
            _ => None,
        };
        hint = habit.map(str::to_owned).or(hint);
        let hint = self.coordinate_meant(name).or(hint);
        let expected = "a field, a parameter, a law or a definition";
        Diagnostic::new(place.clone(), format!("`{name}` is not known"), expected)
            .about_unknown(name)
            .maybe_hint(hint)
    }

    /// What to write for x, y, z, or a derivative along one of them, in a model that names its coordinates otherwise.
    fn coordinate_meant(&self, name: &str) -> Option<String> {
        let coordinate = name.strip_prefix('d').unwrap_or(name);
        if !["x", "y", "z", "r"].contains(&coordinate) {
            return None;
        }
        let bounded = self.coordinate.as_deref();
        let named = match bounded {
            Some(bounded) => format!("the coordinates are `{}` and `{bounded}`", self.periodic),
            None => format!("the periodic coordinate is `{}`", self.periodic),
        };
        if coordinate == name {
            return Some(named);
        }
        let derivatives = match bounded {
            Some(bounded) => format!("d{}(q) or d{bounded}(q)", self.periodic),
            None => format!("d{}(q)", self.periodic),
        };
        Some(format!("{named}: write {derivatives}"))
    }
}
