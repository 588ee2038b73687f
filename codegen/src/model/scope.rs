//! Names and what they stand for: one scope a file, definitions expanded where they are used.

use super::Parameter;
use super::context::Context;
use crate::diagnostic::{Diagnostic, Location, SourceFile};
use crate::graph::{
    FieldId, Function, Graph, Id, Jet, LawAtom, LawId, Node, Operator, ParameterId, Rational, Table,
};
use crate::syntax::tree::*;
use num_traits::One;
use std::collections::BTreeMap;
use std::ops::{Deref, DerefMut};

/// More expansions than any model needs: definitions that double at every step end here.
const MOST_EXPANSIONS: usize = 5_000;
/// Terms handled while names are resolved.
const MOST_WORK: usize = 300_000;
/// Deeper than any definition needs.
const DEEPEST_EXPRESSION: usize = 256;
/// Functions, sums and products inside one another, those of definitions and laws included.
const DEEPEST_MEANING: usize = 128;

pub(super) type Resolved<T> = Result<T, Diagnostic>;

/// The names of one file.
#[derive(Default)]
pub(super) struct Scope {
    pub definitions: BTreeMap<String, Definition>,
    /// Alias → (scope of the law file, name there).
    pub imports: BTreeMap<String, (usize, String)>,
    pub parameters: BTreeMap<String, ParameterItem>,
}

/// What the names of a model stand for. The model keeps it, so that formulas can be read later.
pub(super) struct Declared {
    pub files: Vec<SourceFile>,
    /// The names of each file; those of the spec come first.
    pub scopes: Vec<Scope>,
    pub parameters: Table<ParameterId, Parameter>,
    pub fields: BTreeMap<String, FieldId>,
    pub field_count: usize,
    /// Opaque laws of the model by name.
    pub laws: BTreeMap<String, LawId>,
    /// Whether some expression holds the parameter.
    pub used: Table<ParameterId, bool>,
    pub periodic: String,
    pub coordinate: Option<String>,
    /// Expressions of definitions without arguments, by scope and name: nodes of the model's graph.
    memo: BTreeMap<(usize, String), Id>,
}

impl Declared {
    pub fn new() -> Self {
        Declared {
            files: Vec::new(),
            scopes: Vec::new(),
            parameters: Table::default(),
            fields: BTreeMap::new(),
            field_count: 0,
            laws: BTreeMap::new(),
            used: Table::default(),
            periodic: "x".into(),
            coordinate: None,
            memo: BTreeMap::new(),
        }
    }
}

/// The declared names, and the graph that takes the expressions written with them.
///
/// Limits of work and of expansions count from where it is made.
pub(super) struct Names<'a> {
    pub graph: &'a mut Graph,
    pub declared: &'a mut Declared,
    /// Mistakes beside the first of an expression.
    pub further: Vec<Diagnostic>,
    /// Definitions that are being expanded, the innermost last.
    expanding: Vec<(usize, String)>,
    expansions: usize,
    /// Work of the graph before anything was read.
    work_before: usize,
    depth: usize,
}

impl Deref for Names<'_> {
    type Target = Declared;

    fn deref(&self) -> &Declared {
        self.declared
    }
}

impl DerefMut for Names<'_> {
    fn deref_mut(&mut self) -> &mut Declared {
        self.declared
    }
}

/// One place from which names are looked up.
#[derive(Clone)]
pub(super) struct View<'a> {
    pub scope: usize,
    pub context: Context,
    pub arguments: &'a [(String, Id)],
}

impl<'a> Names<'a> {
    pub fn new(graph: &'a mut Graph, declared: &'a mut Declared) -> Self {
        Names {
            work_before: graph.work(),
            graph,
            declared,
            further: Vec::new(),
            expanding: Vec::new(),
            expansions: 0,
            depth: 0,
        }
    }

    /// Runs `read` on a copy of the graph, which is then dropped with every expression that `read` made.
    pub fn on_scratch_graph(&mut self, read: impl FnOnce(&mut Names)) {
        let mut scratch = self.graph.clone();
        let memo = self.memo.clone();
        let mut names = Names {
            graph: &mut scratch,
            declared: &mut *self.declared,
            further: Vec::new(),
            expanding: Vec::new(),
            expansions: self.expansions,
            work_before: self.work_before,
            depth: 0,
        };
        read(&mut names);
        let further = names.further;
        self.further.extend(further);
        self.memo = memo;
    }

    /// The node of an expression of the model file.
    pub fn resolve(&mut self, expression: &Expression, context: Context) -> Resolved<Id> {
        self.expression(
            expression,
            &View {
                scope: 0,
                context,
                arguments: &[],
            },
        )
    }

    pub fn expression(&mut self, expression: &Expression, view: &View) -> Resolved<Id> {
        self.depth += 1;
        let result = if self.depth > DEEPEST_EXPRESSION
            || self.graph.work() - self.work_before > MOST_WORK
        {
            Err(Diagnostic::new(
                expression.location.clone(),
                "the expression is too large",
                "a smaller expression",
            )
            .hint("does a definition multiply itself?"))
        } else {
            self.expression_kind(expression, view)
        };
        self.depth -= 1;
        match result {
            Ok(id) if self.graph.depth(id) > DEEPEST_MEANING => Err(Diagnostic::new(
                expression.location.clone(),
                "the expression is nested too deeply",
                format!(
                    "at most {DEEPEST_MEANING} levels, those of its definitions and laws included"
                ),
            )),
            result => result,
        }
    }

    fn expression_kind(&mut self, expression: &Expression, view: &View) -> Resolved<Id> {
        let place = &expression.location;
        match &expression.kind {
            ExpressionKind::Number(value) => Ok(self.graph.number(value.clone())),
            ExpressionKind::Negative(inner) => {
                let inner = self.expression(inner, view)?;
                Ok(self.graph.neg(inner))
            }
            ExpressionKind::Binary(..) => self.operations(expression, view),
            ExpressionKind::Modulus(_) => Err(Diagnostic::new(
                place.clone(),
                "|q| stands for a modulus in the amplitude alone",
                "an expression without |…|",
            )),
            ExpressionKind::Select(switch, branches) => self.select(switch, branches, view, place),
            ExpressionKind::Name(name) => self.name(name, place, view),
            ExpressionKind::Call(name, arguments) => self.call(name, arguments, place, view),
        }
    }

    fn name(&mut self, name: &str, place: &Location, view: &View) -> Resolved<Id> {
        if let Some((_, id)) = view.arguments.iter().find(|(argument, _)| argument == name) {
            return Ok(*id);
        }
        if self.coordinate.as_deref() == Some(name) && view.scope == 0 {
            if matches!(view.context, Context::Constant | Context::Amplitude) {
                return Err(view.context.refusal(place, name, "the coordinate"));
            }
            return Ok(self.graph.coordinate());
        }
        if let Some(id) = self.name_of_model(name, place, view)? {
            return Ok(id);
        }
        if let Some(parameter) = self.find_parameter(name, view.scope) {
            self.used[parameter] = true;
            if !self.parameters[parameter].choices.is_empty() {
                let message = format!("`{name}` is a switch, not a number");
                return Err(Diagnostic::new(
                    place.clone(),
                    message,
                    "`select` to choose by a switch",
                ));
            }
            return Ok(self.graph.parameter(parameter));
        }
        if let Some(definition) = self.scopes[view.scope].definitions.get(name).cloned() {
            if let Some(arguments) = &definition.arguments {
                let message = format!("`{name}` takes {} argument(s)", arguments.len());
                return Err(Diagnostic::new(
                    place.clone(),
                    message,
                    format!("`{name}(…)`"),
                ));
            }
            return self.expand(view.scope, &definition, &[], place, view.context);
        }
        if let Some((_, law)) = self.scopes[view.scope].imports.get(name) {
            let message = format!("`{name}` is the law `{law}`, which takes arguments");
            return Err(Diagnostic::new(
                place.clone(),
                message,
                format!("`{name}(…)`"),
            ));
        }
        if name == "pi" {
            return Ok(self.graph.pi());
        }
        if name == self.periodic && view.scope == 0 {
            let message =
                format!("`{name}` may not appear: models do not depend on the periodic coordinate");
            return Err(Diagnostic::new(
                place.clone(),
                message,
                "a field, a parameter or a number",
            ));
        }
        Err(self.unknown(name, place, view))
    }

    /// A field, a law, or k: names that law files do not see.
    fn name_of_model(&mut self, name: &str, place: &Location, view: &View) -> Resolved<Option<Id>> {
        if view.scope != 0 {
            return Ok(None);
        }
        let holds_fields = matches!(view.context, Context::State | Context::Law);
        if let Some(&field) = self.fields.get(name) {
            if !holds_fields {
                return Err(view.context.refusal(place, name, "a field"));
            }
            return Ok(Some(self.graph.jet(Jet::value(field))));
        }
        if let Some(&law) = self.laws.get(name) {
            if !holds_fields {
                return Err(view.context.refusal(place, name, "a law"));
            }
            return Ok(Some(self.law_atom(law)));
        }
        let is_wavenumber = name == "k" && view.context == Context::Amplitude;
        Ok(is_wavenumber.then(|| self.graph.wavenumber()))
    }

    pub fn law_atom(&mut self, law: LawId) -> Id {
        let index = Table::filled(self.field_count, 0);
        self.graph.state_law(LawAtom { law, index, y: 0 })
    }

    fn call(
        &mut self,
        name: &Name,
        arguments: &[Expression],
        place: &Location,
        view: &View,
    ) -> Resolved<Id> {
        let word = name.text.as_str();
        if let Some(operator) = self.operator(word) {
            let argument = self.one_argument(name, arguments, place, view)?;
            return self.differential(operator, name, argument, view);
        }
        if word == "sqrt" {
            let argument = self.one_argument(name, arguments, place, view)?;
            return Ok(self.graph.pow(argument, Rational::new(1.into(), 2.into())));
        }
        if let Some(function) = Function::ALL.into_iter().find(|f| f.name() == word) {
            let argument = self.one_argument(name, arguments, place, view)?;
            if function == Function::Log && self.graph.vanishes(argument) {
                let message = "the logarithm of zero";
                return Err(Diagnostic::new(
                    place.clone(),
                    message,
                    "a nonzero argument",
                ));
            }
            return Ok(self.graph.call(function, argument));
        }
        if word == "integral" {
            let message = "an integral is not part of a local expression";
            return Err(Diagnostic::new(
                place.clone(),
                message,
                "an expression in the fields and their derivatives",
            )
            .hint("integrals stand in `base`, `mean`, `amplitude` and `outputs`"));
        }
        let Some((scope, definition)) = self.function(word, view.scope) else {
            return Err(self.no_function(name, place, view));
        };
        let expected = definition.arguments.as_deref().unwrap_or_default().len();
        if expected != arguments.len() {
            let message = format!(
                "`{word}` takes {expected} argument(s), {} given",
                arguments.len()
            );
            return Err(Diagnostic::new(
                place.clone(),
                message,
                format!("{expected} argument(s)"),
            ));
        }
        let mut values = Vec::with_capacity(arguments.len());
        for argument in arguments {
            values.push(self.expression(argument, view)?);
        }
        self.expand(scope, &definition, &values, place, view.context)
    }

    /// A definition or an imported law of this name, and the scope that its body is read in.
    fn function(&self, name: &str, scope: usize) -> Option<(usize, Definition)> {
        if let Some(definition) = self.scopes[scope].definitions.get(name) {
            return Some((scope, definition.clone()));
        }
        let (file, law) = self.scopes[scope].imports.get(name)?;
        let definition = self.scopes[*file].definitions.get(law)?;
        Some((*file, definition.clone()))
    }

    /// A name before brackets that is no function: perhaps a product without its sign.
    fn no_function(&mut self, name: &Name, place: &Location, view: &View) -> Diagnostic {
        let word = name.text.as_str();
        if !self.fields.contains_key(word) && self.find_parameter(word, view.scope).is_none() {
            return self.unknown(word, &name.location, view);
        }
        let message = format!("`{word}` is not a function");
        Diagnostic::new(place.clone(), message, "an operator between the factors")
            .hint(format!("write a product as {word}*(…)"))
    }

    fn one_argument(
        &mut self,
        name: &Name,
        arguments: &[Expression],
        place: &Location,
        view: &View,
    ) -> Resolved<Id> {
        match arguments {
            [argument] => self.expression(argument, view),
            _ => {
                let message = format!(
                    "`{}` takes one argument, {} given",
                    name.text,
                    arguments.len()
                );
                Err(Diagnostic::new(place.clone(), message, "one argument"))
            }
        }
    }

    /// The differential operator of this name: d or absd, then the name of a coordinate.
    pub fn operator(&self, word: &str) -> Option<Operator> {
        if word == "dt" {
            return Some(Operator::Dt);
        }
        let absolute = word.strip_prefix("absd").map(|c| (c, true));
        let plain = word.strip_prefix('d').map(|c| (c, false));
        let (coordinate, absolute) = absolute.or(plain)?;
        if coordinate == self.periodic {
            return Some(if absolute {
                Operator::AbsDx
            } else {
                Operator::Dx
            });
        }
        (Some(coordinate) == self.coordinate.as_deref() && !absolute).then_some(Operator::Dy)
    }

    fn differential(
        &mut self,
        operator: Operator,
        name: &Name,
        argument: Id,
        view: &View,
    ) -> Resolved<Id> {
        if view.context != Context::State {
            let message = format!("`{}` has no place here", name.text);
            let expected = match view.context {
                Context::Law => "a law is a function of the fields, not of their derivatives",
                _ => "an expression without derivatives",
            };
            return Err(Diagnostic::new(name.location.clone(), message, expected)
                .hint("put the derivative into a `let` of the model"));
        }
        if operator == Operator::Dt
            && self
                .graph
                .any(argument, |n| matches!(n, Node::Derivative(Operator::Dt, _)))
        {
            return Err(Diagnostic::new(
                name.location.clone(),
                "a time derivative of second order",
                "balances of first order in time",
            )
            .hint("introduce a field for the first time derivative"));
        }
        Ok(self.graph.derivative(operator, argument))
    }

    /// The body of a definition, its arguments replaced.
    pub fn expand(
        &mut self,
        scope: usize,
        definition: &Definition,
        values: &[Id],
        place: &Location,
        context: Context,
    ) -> Resolved<Id> {
        let name = &definition.name.text;
        let key = (scope, name.clone());
        if let Some(start) = self.expanding.iter().position(|k| *k == key) {
            let chain: Vec<_> = self.expanding[start..]
                .iter()
                .map(|(_, n)| n.as_str())
                .collect();
            let message = format!("`{name}` is defined by itself");
            return Err(Diagnostic::new(
                definition.name.location.clone(),
                message,
                "a definition in other terms",
            )
            .hint(format!("{} → {name}", chain.join(" → "))));
        }
        let plain = values.is_empty() && context == Context::State;
        if plain && let Some(&value) = self.memo.get(&key) {
            return Ok(value);
        }
        self.expansions += 1;
        if self.expansions > MOST_EXPANSIONS {
            return Err(Diagnostic::new(
                place.clone(),
                "the definitions expand without end",
                "a smaller model",
            ));
        }
        let names = definition.arguments.as_deref().unwrap_or_default();
        let arguments: Vec<_> = names
            .iter()
            .map(|n| n.text.clone())
            .zip(values.iter().copied())
            .collect();
        self.expanding.push(key.clone());
        let result = self.expression(
            &definition.body,
            &View {
                scope,
                context,
                arguments: &arguments,
            },
        );
        self.expanding.pop();
        if plain && let Ok(id) = result {
            self.memo.insert(key, id);
        }
        result
    }
}

/// Whether a rational is two.
pub(super) fn is_two(value: &Rational) -> bool {
    *value == Rational::one() + Rational::one()
}
