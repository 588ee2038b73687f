//! Characters that can be shown.

/// What stands for a character that cannot be shown.
const REPLACEMENT: char = '\u{fffd}';

/// Whether a character can stand in a picture, a page and a table, and shows what it is.
pub(crate) fn is_shown(c: char) -> bool {
    let turns = matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{200e}' | '\u{200f}' | '\u{61c}');
    let ends = matches!(
        c,
        '\u{2028}' | '\u{2029}' | '\u{feff}' | '\u{fffe}' | '\u{ffff}'
    );
    !c.is_control() && !turns && !ends
}

/// A text on one line, with a sign in the place of each character that cannot be shown; lines are joined by a space.
pub(crate) fn shown(text: &str) -> String {
    let sign = |c: char| match c {
        '\n' | '\r' | '\t' => ' ',
        c if is_shown(c) => c,
        _ => REPLACEMENT,
    };
    text.chars().map(sign).collect()
}

/// The same of a text with lines.
pub(crate) fn shown_lines(text: String) -> String {
    let kept = |c: char| is_shown(c) || matches!(c, '\n' | '\t');
    if text.chars().all(kept) {
        return text;
    }
    let sign = |c: char| if kept(c) { c } else { REPLACEMENT };
    text.chars().map(sign).collect()
}

#[cfg(test)]
mod tests {
    use super::{shown, shown_lines};

    #[test]
    fn signs_stand_for_what_cannot_be_shown() {
        assert_eq!(shown("a\u{7}b\nc\u{202e}"), "a\u{fffd}b c\u{fffd}");
        assert_eq!(shown_lines("a\u{0}\nb".to_owned()), "a\u{fffd}\nb");
        assert_eq!(shown("κ, −1 ⟨X⟩"), "κ, −1 ⟨X⟩");
    }
}
