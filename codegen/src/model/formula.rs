//! Formulas that are read after the model: what somebody printed, in the model's own names.
//!
//! Beside the names of the spec (fields, laws, parameters, definitions) a formula may use those of
//! the base state: n0 for n⁰, n0_yy for n⁰_yy, p0_nT for p⁰_nT, k for the wavenumber. A symbol of
//! that form which the model cannot have, such as kappa0_my, is read as a symbol of its own.

use super::Model;
use super::context::Context;
use super::scope::View;
use crate::diagnostic::{Diagnostics, SourceFile};
use crate::graph::{FieldId, Graph, Id, LawAtom, Node, Table};
use crate::syntax::parse_formula;
use crate::syntax::tree::{Expression, ExpressionKind};

impl Model {
    /// The expression, or left − right of the equation, that `source` holds; `definitions` are
    /// names that it may use besides.
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
        let mut names = Vec::new();
        sides
            .iter()
            .for_each(|side| collect_names(side, &mut names));
        for name in names {
            if let Some(id) = self.base_symbol(graph, &name) {
                arguments.push((name, id));
            }
        }
        let view = View {
            scope: 0,
            context: Context::State,
            arguments: &arguments,
        };
        std::mem::swap(graph, &mut self.names.graph);
        self.names.work_before = self.names.graph.work();
        let read: Vec<_> = sides
            .iter()
            .map(|side| self.names.expression(side, &view))
            .collect();
        std::mem::swap(graph, &mut self.names.graph);
        let mut list = std::mem::take(&mut self.names.further);
        let mut values = Vec::new();
        for side in read {
            match side {
                Ok(value) => values.push(value),
                Err(mistake) => list.push(mistake),
            }
        }
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
        let mut rest = marks;
        while !rest.is_empty() {
            let fields = self.fields.pairs();
            let longest = fields
                .filter(|(_, f)| rest.starts_with(f.name.as_str()))
                .max_by_key(|(_, f)| f.name.len());
            rest = match (longest, rest.strip_prefix(self.coordinate())) {
                (Some((field, f)), _) => {
                    index[field] += 1;
                    &rest[f.name.len()..]
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
