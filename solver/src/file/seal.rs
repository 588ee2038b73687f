//! A seal: a hash of a file inside the file, by which a file that Landau wrote and nobody changed is recognised.
//!
//! A format puts [`BLANK`] where it has room for words: a comment, an attribute, a chunk of text. [`sealed`] then writes
//! the hash of the remaining bytes in place of the zeros.

use super::hash;

/// Begins every seal.
const MARK: &[u8] = b"landau-seal:";
/// Hexadecimal digits of a seal.
const DIGITS: usize = 16;
/// Begins every PNG, where the four bytes after the digits are the checksum of their chunk.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";
const CHECKSUM: usize = 4;

/// A seal that is still to be filled in.
pub const BLANK: &str = "landau-seal:0000000000000000";

/// Where the digits of the first seal begin.
fn place(bytes: &[u8]) -> Option<usize> {
    let start = bytes
        .windows(MARK.len())
        .position(|window| window == MARK)?
        + MARK.len();
    (start + DIGITS <= bytes.len()).then_some(start)
}

/// The digits that belong to a file, whose seal may have been filled in or not; `None` where it has none.
pub fn digits(bytes: &[u8]) -> Option<String> {
    let start = place(bytes)?;
    let checksum = if bytes.starts_with(PNG) { CHECKSUM } else { 0 };
    let after = bytes.iter().skip(start + DIGITS + checksum);
    let hash = hash(bytes[..start].iter().chain(after).copied());
    Some(format!("{hash:016x}"))
}

/// The file with its seal filled in; as it is where it has no place for one.
pub fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    if let (Some(start), Some(digits)) = (place(&bytes), digits(&bytes)) {
        bytes[start..start + DIGITS].copy_from_slice(digits.as_bytes());
    }
    bytes
}

/// Whether Landau wrote these bytes, and nobody changed them.
pub fn is_sealed(bytes: &[u8]) -> bool {
    match (place(bytes), digits(bytes)) {
        (Some(start), Some(digits)) => bytes[start..start + DIGITS] == *digits.as_bytes(),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::{BLANK, is_sealed, sealed};

    #[test]
    fn a_changed_byte_breaks_the_seal() {
        let whole = sealed(format!("before <!-- {BLANK} --> after").into_bytes());
        assert!(is_sealed(&whole));
        for place in [0, 4, whole.len() - 1] {
            let mut changed = whole.clone();
            changed[place] ^= 1;
            assert!(!is_sealed(&changed), "byte {place}");
        }
        let longer = [whole.as_slice(), b"\n"].concat();
        assert!(!is_sealed(&longer));
        let at_end = sealed(BLANK.as_bytes().to_vec());
        assert!(is_sealed(&at_end) && !is_sealed(&[at_end.as_slice(), b"\n"].concat()));
        assert!(!is_sealed(b"something else"));
        assert!(!is_sealed(b"landau-seal:00"));
        assert_eq!(sealed(b"no place".to_vec()), b"no place");
    }
}
