//! Expression → form: the expansion around a y-dependent base, to any order.
//!
//! X = X⁰(y) + X'. A law expands in its Taylor series with opaque coefficients,
//! p = p⁰ + p⁰_n n' + p⁰_T T' + ½ p⁰_nn n'² + …, and derivatives act on the series afterwards, so
//! that coefficients such as p⁰_nny come out as the literature writes them.

use super::open::Dependence;
use super::value::base_value;
use crate::form::Form;
use crate::graph::{
    FieldId, Function, Graph, Id, Jet, LawAtom, Node, Operator, ParameterId, Rational, Table,
    Variable,
};
use num_traits::{One, Zero};
use std::collections::HashMap;

/// Limit on the products of terms in one product of series; no model comes near it.
const MOST_PRODUCTS: usize = 1_000_000;

/// Limit on the order of derivatives; no model comes near it.
const HIGHEST_DERIVATIVE: u8 = 64;

/// Why an expression has no expansion, and what to write in its place.
#[derive(Debug, Clone)]
pub struct Inexpandable {
    pub reason: String,
    pub remedy: Option<&'static str>,
}

impl From<&str> for Inexpandable {
    fn from(reason: &str) -> Self {
        Inexpandable {
            reason: reason.to_owned(),
            remedy: None,
        }
    }
}

/// The parts of a model that an expansion reads.
pub struct Expander<'a> {
    pub order: usize,
    /// Closed form of each base field; `None` for a field that is solved for.
    pub closed: &'a Table<FieldId, Option<Id>>,
    /// Fields that are numbers: their derivatives vanish.
    pub uniform: &'a Table<FieldId, bool>,
    /// Fields that each law depends on.
    pub dependence: &'a Dependence,
    memo: HashMap<Id, Form>,
}

type Expanded = Result<Form, Inexpandable>;

impl<'a> Expander<'a> {
    pub fn new(
        order: usize,
        closed: &'a Table<FieldId, Option<Id>>,
        uniform: &'a Table<FieldId, bool>,
        dependence: &'a Dependence,
    ) -> Self {
        Expander {
            order,
            closed,
            uniform,
            dependence,
            memo: HashMap::new(),
        }
    }

    /// The expansion of an expression of the full state.
    pub fn expand(&mut self, graph: &mut Graph, id: Id) -> Expanded {
        if let Some(form) = self.memo.get(&id) {
            return Ok(form.clone());
        }
        let form = self.expand_node(graph, id)?;
        self.memo.insert(id, form.clone());
        Ok(form)
    }

    fn expand_node(&mut self, graph: &mut Graph, id: Id) -> Expanded {
        match graph.node(id).clone() {
            Node::Sum(constant, terms) => {
                let constant = graph.number(constant);
                let mut total = Form::constant(graph, constant);
                for (term, coefficient) in terms {
                    let form = self.expand(graph, term)?;
                    total.add(graph, &form, &coefficient);
                }
                Ok(total)
            }
            Node::Product(factors) => {
                let one = graph.one();
                let mut total = Form::constant(graph, one);
                for (base, exponent) in factors {
                    let form = self.power(graph, base, &exponent)?;
                    if total.terms.len() * form.terms.len() > MOST_PRODUCTS {
                        return Err("it has too many terms".into());
                    }
                    total = total.multiply(graph, &form, self.order);
                }
                Ok(total)
            }
            Node::Call(function, argument) => {
                let form = self.expand(graph, argument)?;
                let value = form.base(graph);
                if function == Function::Log && graph.vanishes(value) {
                    return Err(Inexpandable {
                        reason: "a logarithm, or a power with a parameter in its exponent, of something that vanishes in the base state".to_owned(),
                        remedy: Some("a power expands around zero if its exponent is written as a whole number: `u^2`, not `u^m`"),
                    });
                }
                let taylor = self.function_series(graph, function, &form);
                Ok(form.compose(graph, &taylor))
            }
            Node::Select(switch, branches) => {
                let forms: Result<Vec<Form>, _> =
                    branches.iter().map(|&b| self.expand(graph, b)).collect();
                Ok(select(graph, switch, &forms?))
            }
            Node::Derivative(operator, argument) => self.derivative(graph, operator, argument),
            Node::Jet(jet) => {
                let base = self.base_value(graph, jet);
                let mut form = Form::constant(graph, base);
                let one = graph.one();
                form.accumulate(graph, vec![jet], one);
                Ok(self.without_uniform(form))
            }
            Node::StateLaw(atom) => Ok(self.law_series(graph, &atom)),
            _ => Ok(Form::constant(graph, id)),
        }
    }

    /// ∂x, ∂y, ∂t or |∂x| of an expression.
    fn derivative(&mut self, graph: &mut Graph, operator: Operator, argument: Id) -> Expanded {
        let form = self.expand(graph, argument)?;
        let order = |j: &Jet| j.t.max(j.x).max(j.absx).max(j.y);
        let mut jets = form.terms.keys().flatten();
        if jets.any(|jet| order(jet) >= HIGHEST_DERIVATIVE) {
            return Err(Inexpandable {
                reason: format!("it holds a derivative beyond the order {HIGHEST_DERIVATIVE}"),
                remedy: None,
            });
        }
        if operator == Operator::AbsDx && form.highest_degree() > 1 {
            return Err("|∂x| of a nonlinear expression".into());
        }
        Ok(self.without_uniform(form.differentiate(graph, operator)))
    }

    /// The derivative of a base field.
    pub fn base_value(&self, graph: &mut Graph, jet: Jet) -> Id {
        if !jet.is_base() {
            return graph.zero();
        }
        base_value(graph, self.closed, jet.of, jet.y)
    }

    fn without_uniform(&self, mut form: Form) -> Form {
        form.terms.retain(|monomial, _| {
            monomial
                .iter()
                .all(|j| !self.uniform[j.of] || *j == Jet::value(j.of))
        });
        form
    }

    /// (g⁰ + δ)^q = Σ_m binomial(q, m) g⁰^(q−m) δ^m
    fn power(&mut self, graph: &mut Graph, base: Id, exponent: &Rational) -> Expanded {
        let form = self.expand(graph, base)?;
        if exponent.is_one() {
            return Ok(form);
        }
        let value = form.base(graph);
        let is_whole = exponent.is_integer() && *exponent > Rational::zero();
        if !is_whole && graph.vanishes(value) {
            return Err("a root or a quotient of something that vanishes in the base state".into());
        }
        let mut taylor = Vec::with_capacity(self.order + 1);
        let mut binomial = Rational::one();
        for m in 0..=self.order {
            let index = Rational::from_integer((m as i64).into());
            let lower = exponent - &index;
            let coefficient = if binomial.is_zero() || (graph.is_zero(value) && !lower.is_zero()) {
                graph.zero()
            } else {
                let power = graph.pow(value, lower.clone());
                graph.scale(power, binomial.clone())
            };
            taylor.push(coefficient);
            binomial = binomial * lower / (index + Rational::one());
        }
        Ok(form.compose(graph, &taylor))
    }

    /// f(g⁰ + δ) = Σ_m f⁽ᵐ⁾(g⁰)/m! δ^m
    fn function_series(&mut self, graph: &mut Graph, function: Function, form: &Form) -> Vec<Id> {
        let argument = graph.slot(0, 0);
        let mut derivative = graph.call(function, argument);
        let value = form.base(graph);
        let mut factorial = Rational::one();
        let mut taylor = Vec::with_capacity(self.order + 1);
        for m in 0..=self.order {
            let at_base = graph.substitute(derivative, &mut |_, node| match node {
                Node::Slot(0, 0) => Some(value),
                _ => None,
            });
            taylor.push(graph.scale(at_base, factorial.recip()));
            derivative = graph.differentiate(derivative, Variable::Slot(0, 0));
            factorial *= Rational::from_integer((m as i64 + 1).into());
        }
        taylor
    }

    /// Σ_α law⁰_α/α! Π δ_f^α_f over the fields the law depends on.
    fn law_series(&mut self, graph: &mut Graph, atom: &LawAtom) -> Form {
        let mut form = Form::default();
        let depends = &self.dependence[atom.law];
        let fields: Vec<FieldId> = depends.ids().filter(|&f| depends[f]).collect();
        let mut open = vec![(atom.clone(), Vec::<Jet>::new(), Rational::one(), 0)];
        while let Some((atom, monomial, factor, first)) = open.pop() {
            if monomial.len() < self.order {
                for (position, &field) in fields.iter().enumerate().skip(first) {
                    let mut longer = monomial.clone();
                    longer.push(Jet::value(field));
                    let repeats = longer.iter().filter(|j| **j == Jet::value(field)).count();
                    let factor = &factor / Rational::from_integer((repeats as i64).into());
                    open.push((atom.partial(field), longer, factor, position));
                }
            }
            let value = graph.base_law(atom);
            let value = graph.scale(value, factor);
            let mut monomial = monomial;
            monomial.sort_unstable();
            form.accumulate(graph, monomial, value);
        }
        form
    }
}

fn select(graph: &mut Graph, switch: ParameterId, forms: &[Form]) -> Form {
    let mut chosen = Form::default();
    let zero = graph.zero();
    let monomials: std::collections::BTreeSet<_> =
        forms.iter().flat_map(|f| f.terms.keys().cloned()).collect();
    for monomial in monomials {
        let branches = forms
            .iter()
            .map(|f| f.terms.get(&monomial).copied().unwrap_or(zero))
            .collect();
        let coefficient = graph.select(switch, branches);
        chosen.accumulate(graph, monomial, coefficient);
    }
    chosen
}
