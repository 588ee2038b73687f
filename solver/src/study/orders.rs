//! Which orders of an expansion can be asked for.

use crate::error::{Error, Result};

/// The highest order that is offered: coefficients beyond it are rounding.
pub const HIGHEST: usize = 15;

/// Refuses an order that one mode has no coefficient of.
///
/// # Errors
/// An even order, or one out of range.
pub fn check_order(order: usize) -> Result<()> {
    if !order.is_multiple_of(2) && (3..=HIGHEST).contains(&order) {
        return Ok(());
    }
    Err(Error::input(format!(
        "--order {order} is not available: it accepts odd numbers from 3 to {HIGHEST}"
    )))
}
