//! What is asked of the tokens of a file before they are read: how deeply they nest, where each ends.

use crate::diagnostic::{Diagnostic, Location};
use proc_macro2::{TokenStream, TokenTree};

/// Brackets, bars and expressions inside one another.
pub(super) const DEEPEST_NESTING: usize = 64;

/// The mistake of brackets, bars or expressions that are nested too deeply.
pub(super) fn too_deep(location: Location) -> Diagnostic {
    let message = "brackets are nested too deeply";
    let expected = format!("at most {DEEPEST_NESTING} levels");
    Diagnostic::new(location, message, expected).hint("name the inner parts with `let`")
}

/// Where each token ends, in the order of the text (a bracket is a token); `None` where brackets nest too
/// deeply, which the check of the text overlooks inside what it takes for a part of a raw string.
pub(super) fn token_ends(tokens: TokenStream) -> Option<Vec<usize>> {
    let (mut ends, mut open) = (Vec::new(), vec![(tokens.into_iter(), None)]);
    while let Some((tokens, closing)) = open.last_mut() {
        match tokens.next() {
            Some(TokenTree::Group(group)) => {
                ends.push(group.span_open().byte_range().end);
                let closing = group.span_close().byte_range().end;
                open.push((group.stream().into_iter(), Some(closing)));
            }
            Some(token) => ends.push(token.span().byte_range().end),
            None => {
                ends.extend(*closing);
                open.pop();
            }
        }
        if open.len() > DEEPEST_NESTING + 1 {
            return None;
        }
    }
    Some(ends)
}
