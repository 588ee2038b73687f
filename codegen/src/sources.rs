//! What a derivation starts from.

use crate::diagnostic::SourceFile;
use std::collections::BTreeMap;

/// A spec and the law files it may import.
#[derive(Clone, Debug)]
pub struct Sources {
    /// The text of the model.
    pub spec: SourceFile,
    /// Law files by name.
    pub laws: BTreeMap<String, SourceFile>,
}
