//! Law files: read, resolved, their laws bound to the fields of the model.

use super::Law;
use super::context::Context;
use super::mistake::twice;
use super::scope::{Names, Resolved, Scope};
use crate::diagnostic::{Diagnostic, nearest};
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

/// Reads the files that `imports` name into scopes of their own, and what they import in turn.
pub(super) fn load_imports(
    imports: &[Import],
    importer: usize,
    sources: &Sources,
    names: &mut Names,
    known: &mut BTreeMap<String, usize>,
    mistakes: &mut Vec<Diagnostic>,
) -> Vec<Imported> {
    let mut found = Vec::new();
    for import in imports {
        let Some(scope) = load_file(&import.file, sources, names, known, mistakes) else {
            continue;
        };
        for item in &import.items {
            let Some(definition) = names.scopes[scope].definitions.get(&item.law.text) else {
                let defined: Vec<&str> = names.scopes[scope]
                    .definitions
                    .keys()
                    .map(String::as_str)
                    .collect();
                let near = nearest(&item.law.text, defined);
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
            found.push(Imported {
                alias,
                scope,
                law,
                arguments,
            });
        }
    }
    found
}

fn load_file(
    name: &Name,
    sources: &Sources,
    names: &mut Names,
    known: &mut BTreeMap<String, usize>,
    mistakes: &mut Vec<Diagnostic>,
) -> Option<usize> {
    if let Some(&scope) = known.get(&name.text) {
        return Some(scope);
    }
    if let Some(reason) = sources.unreadable.get(&name.text) {
        mistakes.push(Diagnostic::new(
            name.location.clone(),
            format!("the law file `{}` cannot be read: {reason}", name.text),
            "a law file of UTF-8 text, at most 1 MiB",
        ));
        return None;
    }
    let Some(source) = sources.laws.get(&name.text) else {
        let near = nearest(&name.text, sources.laws.keys().map(String::as_str));
        let available: Vec<_> = sources.laws.keys().map(|n| format!("`{n}`")).collect();
        let expected = match available.len() {
            0 => "no law files were found beside the models".to_owned(),
            _ => format!("one of {}", available.join(", ")),
        };
        mistakes.push(
            Diagnostic::new(
                name.location.clone(),
                format!("there is no law file `{}`", name.text),
                expected,
            )
            .maybe_hint(near.map(|n| format!("did you mean `{n}`?"))),
        );
        return None;
    };
    let file = names.files.len();
    names.files.push(source.clone());
    let (tree, found) = parse_laws(file, &source.text);
    let broken = !found.is_empty();
    mistakes.extend(found);
    let scope = names.scopes.len();
    names.scopes.push(Scope::default());
    known.insert(name.text.clone(), scope);
    if broken {
        return None;
    }
    let target = &mut names.scopes[scope];
    for item in &tree.parameters {
        target
            .parameters
            .insert(item.name.text.clone(), item.clone());
    }
    for definition in &tree.definitions {
        let previous = target
            .definitions
            .insert(definition.name.text.clone(), definition.clone());
        if previous.is_some() {
            mistakes.push(twice(&definition.name));
        }
    }
    load_imports(&tree.imports, scope, sources, names, known, mistakes);
    Some(scope)
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
