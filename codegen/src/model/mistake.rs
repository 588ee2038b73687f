//! Mistakes that several blocks share.

use super::scope::{Context, Resolved, View};
use crate::diagnostic::{Diagnostic, Location};
use crate::syntax::tree::Name;

/// Words that name something in the language or on the command line.
const RESERVED: [&str; 12] = [
    "t", "k", "pi", "dt", "sqrt", "exp", "log", "sin", "cos", "select", "integral", "at",
];

/// A name that stands for two things.
pub(super) fn twice(name: &Name) -> Diagnostic {
    let message = format!("`{}` is defined twice", name.text);
    Diagnostic::new(name.location.clone(), message, "a name not used yet")
}

/// A name that the language keeps for itself.
pub(super) fn check_name(name: &Name) -> Resolved<()> {
    if RESERVED.contains(&name.text.as_str()) {
        let message = format!("`{}` is a word of the language", name.text);
        return Err(Diagnostic::new(
            name.location.clone(),
            message,
            "another name",
        ));
    }
    Ok(())
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
