//! What a derivation starts from.

use crate::diagnostic::SourceFile;
use std::collections::BTreeMap;

/// Bytes that a spec or a law file may have.
pub(crate) const LARGEST_FILE: usize = 1 << 20;

/// A spec and the law files it may import.
#[derive(Clone, Debug)]
pub struct Sources {
    /// The text of the model.
    pub spec: SourceFile,
    /// Law files by name.
    pub laws: BTreeMap<String, SourceFile>,
    /// Law files that cannot be read, by name, and why: a mistake of a spec that imports one.
    pub unreadable: BTreeMap<String, String>,
}
