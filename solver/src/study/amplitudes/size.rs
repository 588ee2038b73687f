//! How large an expansion is, before it is computed.

use crate::error::{Error, Result};

/// Monomials of an expansion at most. Without a cross-stream coordinate 3000 take a minute; the time grows with the square.
const MOST_MONOMIALS: u64 = 5000;

/// Refuses expansions that take longer than minutes.
pub(super) fn check(modes: usize, order: usize) -> Result<()> {
    let count = monomials(modes, order + 1);
    if count <= MOST_MONOMIALS {
        return Ok(());
    }
    Err(Error::input(format!(
        "{modes} modes to order {order} have {count} monomials z^p z̄^s up to degree {}, one more than the order: at most \
         {MOST_MONOMIALS} are computed; ask for fewer modes, or for a lower --order",
        order + 1
    )))
}

/// The number of monomials in `modes` amplitudes and their conjugates up to a degree: (2 modes + degree choose degree),
/// without the constant one. It ends at the largest number of the type.
fn monomials(modes: usize, degree: usize) -> u64 {
    let count = (1..=degree as u128).try_fold(1_u128, |count, d| {
        Some(count.checked_mul(2 * modes as u128 + d)? / d)
    });
    count.map_or(u64::MAX, |count| {
        u64::try_from(count - 1).unwrap_or(u64::MAX)
    })
}

#[cfg(test)]
mod tests {
    use super::monomials;

    /// One mode to degree 2: z, z̄, z², |z|², z̄².
    #[test]
    fn monomials_are_counted() {
        assert_eq!(monomials(1, 2), 5);
        assert_eq!(monomials(2, 6), 209);
        assert_eq!(monomials(3, 8), 3002);
        assert_eq!(monomials(1_000_000, 16), u64::MAX);
    }
}
