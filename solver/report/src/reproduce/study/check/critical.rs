//! Questions for critical points.

use super::{Checked, Spot};
use crate::reproduce::study::{Asked, Case, Of};

/// A question for a critical point, and whether every case says at which wavenumber.
pub(super) fn asked(spot: &Spot, asked: &Asked, cases: &[Case]) -> Checked {
    question(spot, asked)?;
    let fixed = asked.vary == "k" || asked.minimize.is_some() || asked.k.is_some();
    if fixed {
        return Ok(());
    }
    let missing = cases.iter().position(|case| case.k.is_none());
    spot.key("k").demand(missing.is_none(), || {
        let case = missing.map_or("", |index| cases[index].label.as_str());
        let which = if case.is_empty() {
            "the case".to_owned()
        } else {
            format!("the case `{case}`")
        };
        format!(
            "`k` is missing: the critical point of `{}` is sought along `{}`, which accepts a wavenumber: `k` of the \
             question or of {which}, a positive number, or `minimize`, a range of k",
            asked.name, asked.vary
        )
    })
}

/// What a question says itself, without its cases.
pub(super) fn question(spot: &Spot, asked: &Asked) -> Checked {
    let along_k = asked.vary == "k";
    spot.key("name").demand(!asked.name.is_empty(), || {
        "name = \"\": it accepts what the number is called".to_owned()
    })?;
    spot.range("between", asked.between)?;
    let both = along_k && asked.minimize.is_some();
    spot.key("minimize").demand(!both, || {
        "minimize is a range of k, and vary = `k`: with `minimize` it accepts a parameter"
            .to_owned()
    })?;
    if along_k {
        spot.wavenumber("between", asked.between[0])?;
    }
    if let Some(k) = asked.k {
        spot.wavenumber("k", k)?;
        spot.key("k").demand(!along_k, || {
            format!("k = {k} stands beside vary = `k`: a question accepts one of the two")
        })?;
    }
    let Some(range) = asked.minimize else {
        return Ok(());
    };
    spot.range("minimize", range)?;
    spot.wavenumber("minimize", range[0])?;
    let spot = spot.key("minimize");
    spot.demand(asked.k.is_none(), || {
        "minimize stands beside `k`: a question accepts one of the two".to_owned()
    })?;
    spot.demand(asked.of == Of::Growth, || {
        "minimize is for the growth rate: it accepts no other `of`".to_owned()
    })
}
