//! Names of a spec as Rust accepts them.

use proc_macro2::Ident;
use std::collections::BTreeSet;

/// Names that a module of the crate root would hide from the generated code or from the crate around it, or
/// that later editions of Rust keep for themselves.
const HIDING: [&str; 13] = [
    "std", "core", "alloc", "test", "gen", "models", "str", "bool", "char", "Vec", "String",
    "Option", "Result",
];

/// Hands out identifiers, each once: the name itself where Rust takes it, with underscores appended otherwise.
#[derive(Default)]
pub struct Identifiers {
    /// In lower case: two files whose names differ in case alone are one file on some systems.
    taken: BTreeSet<String>,
}

impl Identifiers {
    /// The module of a model.
    pub fn module(&mut self, name: &str) -> String {
        let is_number = |name: &str| {
            let size = name.strip_prefix(['i', 'u', 'f']).unwrap_or_default();
            size == "size" || size.parse::<u8>().is_ok()
        };
        let hides = HIDING.contains(&name) || name.starts_with("landau_") || is_number(name);
        self.unused(name, hides || !is_identifier(name))
    }

    /// The ending of the name of a balance's function, in lower case.
    pub fn balance(&mut self, name: &str) -> String {
        let lower = name.to_lowercase();
        let is_refused = !is_identifier(&lower);
        self.unused(&lower, is_refused)
    }

    fn unused(&mut self, name: &str, is_refused: bool) -> String {
        let mut identifier = name.to_owned();
        if is_refused {
            identifier.push('_');
        }
        while !self.taken.insert(identifier.to_lowercase()) {
            identifier.push('_');
        }
        identifier
    }
}

fn is_identifier(name: &str) -> bool {
    syn::parse_str::<Ident>(name).is_ok()
}
