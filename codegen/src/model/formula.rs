//! Formulas that are read after the model: what somebody printed, in the names of the model.
//!
//! Beside the names of the spec (fields, laws, parameters, definitions) a formula may use those of
//! the base state: n0 for n⁰, n0_yy for n⁰_yy, p0_nT for p⁰_nT, k for the wavenumber. A symbol of
//! that form which the model cannot have, such as kappa0_my, is read as a symbol that stands for itself.

use super::Model;
use super::context::Context;
use super::scope::{Names, View};
use super::statement::keep;
use crate::diagnostic::{Diagnostics, SourceFile};
use crate::graph::{FieldId, Graph, Id, LawAtom, Node, Table};
use crate::syntax::parse_formula;
use crate::syntax::tree::{Expression, ExpressionKind};

impl Model {
    /// Reads the formula that `source` holds into `graph`, the graph of the model: an expression, or left − right of an
    /// equation. It may also use the names in `definitions`, which stand for nodes of the same graph.
    ///
    /// # Errors
    /// Every mistake of its form.
    pub fn read(
        &mut self,
        graph: &mut Graph,
        source: &SourceFile,
        definitions: &[(String, Id)],
    ) -> Result<Id, Diagnostics> {
        let (formula, list) = parse_formula(&source.text);
        let mistaken = |list| Diagnostics {
            files: vec![source.clone()],
            list,
        };
        let Some(formula) = formula.filter(|_| list.is_empty()) else {
            return Err(mistaken(list));
        };
        let sides: Vec<&Expression> = [Some(&formula.left), formula.right.as_ref()]
            .into_iter()
            .flatten()
            .collect();
        let mut arguments = definitions.to_vec();
        arguments.push(("k".to_owned(), graph.wavenumber()));
        let mut words = Vec::new();
        for side in &sides {
            collect_names(side, &mut words);
        }
        for name in words {
            if let Some(id) = self.base_symbol(graph, &name) {
                arguments.push((name, id));
            }
        }
        let view = View {
            scope: 0,
            context: Context::State,
            arguments: &arguments,
        };
        let mut names = Names::new(graph, &mut self.declared);
        let (mut values, mut mistakes) = (Vec::new(), Vec::new());
        for side in sides {
            values.extend(keep(names.expression(side, &view), &mut mistakes));
        }
        let mut list = names.further;
        list.append(&mut mistakes);
        match values.as_slice() {
            _ if !list.is_empty() => Err(mistaken(list)),
            [left, right] => Ok(graph.sub(*left, *right)),
            _ => Ok(values[0]),
        }
    }

    /// n0, n0_y, p0_nT, …: a name, a nought, subscripts.
    fn base_symbol(&self, graph: &mut Graph, name: &str) -> Option<Id> {
        for (nought, _) in name.match_indices('0') {
            let (stem, below) = (&name[..nought], &name[nought + 1..]);
            let below = match below.strip_prefix('_') {
                Some(marks) if !marks.is_empty() => marks,
                None if below.is_empty() => "",
                _ => continue,
            };
            let field = self.fields.position(|f| f.name == stem);
            let law = self.laws.position(|l| l.name == stem);
            if field.is_none() && law.is_none() {
                continue;
            }
            let marks = self.subscripts(below);
            return Some(match (field, law, marks) {
                (Some(field), _, Some((index, y))) if index.iter().all(|&i| i == 0) => {
                    graph.base(field, y)
                }
                (None, Some(law), Some((index, y))) => graph.base_law(LawAtom { law, index, y }),
                _ => symbol(graph, stem, below),
            });
        }
        None
    }

    /// Derivatives by each field, and along the coordinate, that subscripts such as `nTy` ask for.
    fn subscripts(&self, marks: &str) -> Option<(Table<FieldId, u8>, u8)> {
        let (mut index, mut y) = (self.fields.map(|_| 0), 0);
        let mut unread = marks;
        while !unread.is_empty() {
            let fields = self.fields.pairs();
            let longest = fields
                .filter(|(_, f)| unread.starts_with(f.name.as_str()))
                .max_by_key(|(_, f)| f.name.len());
            unread = match (longest, unread.strip_prefix(self.coordinate())) {
                (Some((field, f)), _) => {
                    index[field] += 1;
                    &unread[f.name.len()..]
                }
                (None, Some(after)) => {
                    y += 1;
                    after
                }
                (None, None) => return None,
            };
        }
        Some((index, y))
    }
}

fn symbol(graph: &mut Graph, name: &str, below: &str) -> Id {
    graph.intern(Node::Symbol(name.to_owned(), below.to_owned()))
}

fn collect_names(expression: &Expression, names: &mut Vec<String>) {
    match &expression.kind {
        ExpressionKind::Number(_) => {}
        ExpressionKind::Name(name) => names.push(name.clone()),
        ExpressionKind::Call(_, arguments) => {
            arguments.iter().for_each(|a| collect_names(a, names));
        }
        ExpressionKind::Negative(inner) | ExpressionKind::Modulus(inner) => {
            collect_names(inner, names);
        }
        ExpressionKind::Binary(_, left, right) => {
            collect_names(left, names);
            collect_names(right, names);
        }
        ExpressionKind::Select(_, branches) => {
            branches.iter().for_each(|(_, b)| collect_names(b, names));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::diagnostic::SourceFile;
    use crate::sources::Sources;
    use std::collections::BTreeMap;

    const TEXT: &str = "model one \"one field\";
        coordinates { x: periodic; }
        parameters { r = 1; }
        fields { u; }
        let square(a) = a^2;
        balance { evolution: dt(u) = r*u + dx(dx(u)) - square(u); }
        base { u = 0; }
        amplitude { u = 1; }";

    /// Every formula is read with a limit on expansions that counts from zero: a long list of formulas that all use one
    /// definition is no model that expands without end. What was read is the same node every time.
    #[test]
    fn many_formulas() {
        let sources = Sources {
            spec: SourceFile {
                path: "model".into(),
                text: TEXT.into(),
            },
            laws: BTreeMap::new(),
            unreadable: BTreeMap::new(),
        };
        let (mut graph, mut model) = super::super::resolve(&sources).expect("a model");
        let formula = |text: &str| SourceFile {
            path: "formula".into(),
            text: text.into(),
        };
        let expected = model
            .read(&mut graph, &formula("3*u^2"), &[])
            .expect("a formula");
        for _ in 0..6000 {
            let id = model.read(&mut graph, &formula("3*square(u)"), &[]);
            assert_eq!(id.ok(), Some(expected));
        }
    }
}
