//! Syntax tree → checked model.

use super::import::load_imports;
use super::scope::{Names, Scope};
use super::{Model, statement};
use crate::diagnostic::Diagnostics;
use crate::graph::Graph;
use crate::sources::Sources;
use crate::syntax::parse_model;
use std::collections::BTreeMap;

/// Resolves a spec into a model and the graph of its expressions, or reports every mistake that its form shows.
pub fn resolve(sources: &Sources) -> Result<(Graph, Model), Diagnostics> {
    let mut names = Names::new();
    names.files.push(sources.spec.clone());
    let (tree, mut mistakes) = parse_model(0, &sources.spec.text);
    names.scopes.push(Scope::default());
    let mut law_files = BTreeMap::new();
    let imported = load_imports(
        &tree.imports,
        0,
        sources,
        &mut names,
        &mut law_files,
        &mut mistakes,
    );
    let model = if mistakes.is_empty() {
        statement::model(&tree, &imported, &mut names, &mut mistakes)
    } else {
        None
    };
    match model {
        Some((graph, model)) if mistakes.is_empty() => Ok((graph, model)),
        Some((_, model)) => Err(Diagnostics {
            files: model.sources,
            list: mistakes,
        }),
        None => Err(Diagnostics {
            files: names.files,
            list: mistakes,
        }),
    }
}
