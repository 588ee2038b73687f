//! The names that an expression may use, by its place in the spec.

use crate::diagnostic::{Diagnostic, Location};

/// What names an expression may use.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Context {
    /// Balances, conditions, outputs: everything.
    State,
    /// Law bodies: fields, but none of their derivatives.
    Law,
    /// Base profiles: parameters and the coordinate.
    Profile,
    /// Numbers: parameters alone.
    Constant,
    /// The right-hand side of the amplitude: parameters and k.
    Amplitude,
}

impl Context {
    /// Why a name of a kind that the context does not take cannot stand there.
    pub fn refusal(self, place: &Location, name: &str, what: &str) -> Diagnostic {
        let expected = match self {
            Context::Profile => "parameters and the cross-stream coordinate",
            Context::Amplitude => "parameters and k",
            _ => "parameters and numbers",
        };
        Diagnostic::new(
            place.clone(),
            format!("`{name}` is {what}, which has no place here"),
            expected,
        )
    }
}
