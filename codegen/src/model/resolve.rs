//! Syntax tree → checked model.

use super::import::load_imports;
use super::scope::{Declared, Names, Scope};
use super::{Model, statement};
use crate::diagnostic::Diagnostics;
use crate::graph::Graph;
use crate::sources::Sources;
use crate::syntax::parse_model;
use std::collections::BTreeMap;

/// Resolves a spec into a model and the graph of its expressions, or reports every mistake that its form shows.
pub fn resolve(sources: &Sources) -> Result<(Graph, Model), Diagnostics> {
    let (mut graph, mut declared) = (Graph::new(), Declared::new());
    declared.files.push(sources.spec.clone());
    declared.scopes.push(Scope::default());
    let (tree, mut mistakes) = parse_model(0, &sources.spec.text);
    let mut names = Names::new(&mut graph, &mut declared);
    let mut law_files = BTreeMap::new();
    let imported = load_imports(
        &tree.imports,
        0,
        sources,
        &mut names,
        &mut law_files,
        &mut mistakes,
    );
    let files = declared.files.clone();
    let model = if mistakes.is_empty() {
        statement::model(&tree, &imported, &mut graph, declared, &mut mistakes)
    } else {
        None
    };
    match model {
        Some(model) if mistakes.is_empty() => Ok((graph, model)),
        _ => Err(Diagnostics {
            files,
            list: mistakes,
        }),
    }
}
