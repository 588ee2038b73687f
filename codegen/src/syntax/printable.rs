//! Characters that no text of a spec may hold: titles and notes pass into pictures, pages and terminals.

use super::lexical::MOST_MISTAKES;
use crate::diagnostic::{Diagnostic, Location};

/// Whether a character is shown as nothing, moves the cursor or turns the direction of the text.
pub(super) fn is_unprintable(character: char) -> bool {
    let turns = matches!(
        character,
        '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}'
    );
    turns || character.is_control()
}

/// The mistake of a character that no text may hold.
pub(super) fn not_printable(location: Location, character: char) -> Diagnostic {
    let code = u32::from(character);
    let message = format!("the control character U+{code:04X} stands here");
    Diagnostic::new(location, message, "characters that are printed")
}

/// The characters of a file, comments and texts included, that are not printed; line breaks and tabs may be.
pub(super) fn unprintable(file: usize, text: &str) -> Vec<Diagnostic> {
    let layout = ['\n', '\r', '\t'];
    let characters = text.char_indices();
    let refused = characters.filter(|(_, c)| is_unprintable(*c) && !layout.contains(c));
    let mistake = |(start, character): (usize, char)| {
        let range = start..start + character.len_utf8();
        not_printable(Location { file, range }, character)
    };
    refused.take(MOST_MISTAKES).map(mistake).collect()
}
