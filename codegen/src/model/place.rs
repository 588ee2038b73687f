//! Places of the cross-stream coordinate: the ends of its interval, and points inside.

use super::Interval;
use super::context::Context;
use super::scope::{Names, Resolved};
use crate::diagnostic::Diagnostic;
use crate::graph::{Id, Node};
use crate::syntax::tree::Expression;
use landau_contract::End;

/// A place this close to an end, in units of the interval's length, is that end: `0.1*10` is 1.
const ROUNDING: f64 = 1e-12;

/// The end of the interval that `place` names.
pub(super) fn end(place: &Expression, ends: Option<(Id, Id)>, names: &mut Names) -> Resolved<End> {
    let Some((lower, upper)) = ends else {
        let message = "the model has no cross-stream coordinate";
        return Err(
            Diagnostic::new(place.location.clone(), message, "no conditions at walls")
                .hint("declare one: `coordinates { x: periodic; y: 0..H; }`"),
        );
    };
    let id = names.resolve(place, Context::Constant)?;
    if id == lower {
        Ok(End::Lower)
    } else if id == upper {
        Ok(End::Upper)
    } else {
        let message = "this is not an end of the interval";
        Err(Diagnostic::new(
            place.location.clone(),
            message,
            "an end as `coordinates` gives it",
        ))
    }
}

/// A place of the interval, at the default values of the parameters.
pub(super) fn place_inside(
    place: &Expression,
    interval: Option<&Interval>,
    names: &mut Names,
) -> Resolved<Id> {
    let id = names.resolve(place, Context::Constant)?;
    let Some(interval) = interval else {
        return Ok(id);
    };
    let ends = [interval.lower, interval.upper];
    let [Some(low), Some(high), Some(value)] =
        [ends[0], ends[1], id].map(|id| names.default_value(id))
    else {
        return Ok(id);
    };
    let margin = ROUNDING * (high - low).abs();
    if (low - margin..=high + margin).contains(&value) {
        return Ok(id);
    }
    let holds_parameter = |id: Id| names.graph.any(id, |n| matches!(n, Node::Parameter(_)));
    let at = if [ends[0], ends[1], id].into_iter().any(holds_parameter) {
        " at the default parameters"
    } else {
        ""
    };
    let message = format!("the place {value} lies outside of the interval {low}..{high}{at}");
    let [lower, upper] = &interval.written;
    Err(Diagnostic::new(
        place.location.clone(),
        message,
        format!("a place from {lower} to {upper}"),
    ))
}
