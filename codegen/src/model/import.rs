//! Law files: read, resolved, their laws bound to the fields of the model.

use super::Law;
use super::context::Context;
use super::mistake::twice;
use super::scope::{Names, Resolved, Scope};
use super::statement::keep;
use crate::diagnostic::{Diagnostic, SourceFile, nearest};
use crate::graph::{Jet, LawId, Table};
use crate::sources::Sources;
use crate::syntax::parse_laws;
use crate::syntax::tree::*;
use std::collections::BTreeMap;

/// A law of another file under the name the model gives it.
pub(super) struct Imported {
    pub alias: Name,
    pub scope: usize,
    pub law: Name,
    pub arguments: Option<Vec<Name>>,
}

/// Reads the files that `imports` name, each into a scope of its names, and the files that these import in turn.
/// `scopes` holds the scope of every file read so far, by the name of the file.
pub(super) fn load_imports(
    imports: &[Import],
    importer: usize,
    sources: &Sources,
    names: &mut Names,
    scopes: &mut BTreeMap<String, usize>,
    mistakes: &mut Vec<Diagnostic>,
) -> Vec<Imported> {
    let mut imported = Vec::new();
    for import in imports {
        let Some(scope) = load_file(&import.file, sources, names, scopes, mistakes) else {
            continue;
        };
        for item in &import.items {
            let definitions = &names.scopes[scope].definitions;
            let Some(definition) = definitions.get(&item.law.text) else {
                let near = nearest(&item.law.text, definitions.keys().map(String::as_str));
                let message = format!("`{}` has no law `{}`", import.file.text, item.law.text);
                let expected = "the name of a law in that file";
                mistakes.push(
                    Diagnostic::new(item.law.location.clone(), message, expected)
                        .maybe_hint(near.map(|n| format!("did you mean `{n}`?"))),
                );
                continue;
            };
            let law = definition.name.clone();
            if importer != 0 {
                let imports = &mut names.scopes[importer].imports;
                imports.insert(item.alias.text.clone(), (scope, law.text.clone()));
            }
            let (alias, arguments) = (item.alias.clone(), item.arguments.clone());
            imported.push(Imported {
                alias,
                scope,
                law,
                arguments,
            });
        }
    }
    imported
}

/// The scope of a law file, which is read if it has not been; `None` if it cannot be.
fn load_file(
    name: &Name,
    sources: &Sources,
    names: &mut Names,
    scopes: &mut BTreeMap<String, usize>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<usize> {
    if let Some(&scope) = scopes.get(&name.text) {
        return Some(scope);
    }
    let source = keep(law_file(name, sources), mistakes)?;
    let file = names.files.len();
    names.files.push(source.clone());
    let (tree, mut syntax_mistakes) = parse_laws(file, &source.text);
    let scope = names.scopes.len();
    names.scopes.push(Scope::default());
    scopes.insert(name.text.clone(), scope);
    if !syntax_mistakes.is_empty() {
        mistakes.append(&mut syntax_mistakes);
        return None;
    }
    let target = &mut names.scopes[scope];
    for item in tree.parameters {
        target.parameters.insert(item.name.text.clone(), item);
    }
    for definition in tree.definitions {
        let name = definition.name.clone();
        let previous = target.definitions.insert(name.text.clone(), definition);
        if previous.is_some() {
            mistakes.push(twice(&name));
        }
    }
    load_imports(&tree.imports, scope, sources, names, scopes, mistakes);
    Some(scope)
}

/// The text of a law file.
fn law_file<'s>(name: &Name, sources: &'s Sources) -> Resolved<&'s SourceFile> {
    if let Some(reason) = sources.unreadable.get(&name.text) {
        return Err(Diagnostic::new(
            name.location.clone(),
            format!("the law file `{}` cannot be read: {reason}", name.text),
            "a law file of UTF-8 text, at most 1 MiB",
        ));
    }
    sources.laws.get(&name.text).ok_or_else(|| {
        let near = nearest(&name.text, sources.laws.keys().map(String::as_str));
        let available: Vec<_> = sources.laws.keys().map(|n| format!("`{n}`")).collect();
        let expected = if available.is_empty() {
            "no law files were found beside the models".to_owned()
        } else {
            format!("one of {}", available.join(", "))
        };
        let message = format!("there is no law file `{}`", name.text);
        Diagnostic::new(name.location.clone(), message, expected)
            .maybe_hint(near.map(|n| format!("did you mean `{n}`?")))
    })
}

/// Binds the imported laws to fields and makes them atoms of the model.
pub(super) fn bind_imports(
    imported: &[Imported],
    names: &mut Names,
    mistakes: &mut Vec<Diagnostic>,
) -> Table<LawId, Law> {
    let mut laws = Table::default();
    for item in imported {
        let law = bind(item, names).unwrap_or_else(|mistake| {
            mistakes.push(mistake);
            // Kept by name, so that its uses are not reported too.
            Law {
                name: item.alias.text.clone(),
                doc: String::new(),
                body: names.graph.zero(),
            }
        });
        names.graph.declare_law(law.body);
        names.laws.insert(item.alias.text.clone(), laws.push(law));
    }
    laws
}

fn bind(item: &Imported, names: &mut Names) -> Resolved<Law> {
    let definition = names.scopes[item.scope].definitions[&item.law.text].clone();
    let formal = definition.arguments.clone().unwrap_or_default();
    let actual = item.arguments.clone().unwrap_or_else(|| {
        // By default a law is applied to the fields named like its arguments.
        formal
            .iter()
            .map(|n| Name {
                text: n.text.clone(),
                location: item.alias.location.clone(),
            })
            .collect()
    });
    if actual.len() != formal.len() {
        let message = format!(
            "`{}` takes {} argument(s), {} given",
            item.law.text,
            formal.len(),
            actual.len()
        );
        return Err(Diagnostic::new(
            item.alias.location.clone(),
            message,
            format!("{} field(s)", formal.len()),
        ));
    }
    let mut values = Vec::with_capacity(actual.len());
    for argument in &actual {
        let Some(&field) = names.fields.get(&argument.text) else {
            let message = format!(
                "the law `{}` takes `{}`, which is not a field here",
                item.law.text, argument.text
            );
            let fields: Vec<&str> = names.fields.keys().map(String::as_str).collect();
            let near = nearest(&argument.text, fields.iter().copied());
            return Err(
                Diagnostic::new(argument.location.clone(), message, "the name of a field").hint(
                    match near {
                        Some(near) => format!("did you mean `{near}`?"),
                        None => format!(
                            "apply it to fields: `{}(…) as {}`",
                            item.law.text, item.alias.text
                        ),
                    },
                ),
            );
        };
        values.push(names.graph.jet(Jet::value(field)));
    }
    let place = item.alias.location.clone();
    let body = names.expand(item.scope, &definition, &values, &place, Context::Law)?;
    Ok(Law {
        name: item.alias.text.clone(),
        doc: definition.doc.clone(),
        body,
    })
}
