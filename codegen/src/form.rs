//! Truncated power series in the perturbation's derivatives.
//!
//! A [`Form`] is Σ coefficient(y) · Π jets, each jet a derivative of a perturbation field, the
//! coefficient an expression in the base state. Degree 0 is the base part, degree 1 linear,
//! degree 2 and 3 what becomes N2 and N3. Terms beyond the truncation order are dropped as they
//! arise.

use crate::graph::{Graph, Id, Jet, Node, Operator, Rational, Variable};
use num_traits::{One, ToPrimitive};
use std::collections::BTreeMap;

/// A product of jets, sorted.
pub type Monomial = Vec<Jet>;

/// A polynomial in the perturbation with coefficients of the base state.
#[derive(Clone, Default, Debug)]
pub struct Form {
    /// Coefficient by monomial.
    pub terms: BTreeMap<Monomial, Id>,
}

impl Form {
    /// A base-state expression.
    pub fn constant(graph: &Graph, value: Id) -> Self {
        let mut form = Form::default();
        if !graph.is_zero(value) {
            form.terms.insert(Vec::new(), value);
        }
        form
    }

    /// An expression as a polynomial in its jets; what is no polynomial in them is a coefficient.
    pub fn polynomial(graph: &mut Graph, id: Id) -> Self {
        match graph.node(id).clone() {
            Node::Jet(jet) => {
                let one = graph.one();
                let mut form = Form::default();
                form.terms.insert(vec![jet], one);
                form
            }
            Node::Sum(constant, terms) => {
                let constant = graph.number(constant);
                let mut form = Form::constant(graph, constant);
                for (term, factor) in terms {
                    let term = Form::polynomial(graph, term);
                    form.add(graph, &term, &factor);
                }
                form
            }
            Node::Product(factors) => {
                let one = graph.one();
                let mut form = Form::constant(graph, one);
                for (base, exponent) in factors {
                    let power = exponent.to_integer().to_usize();
                    let power = power.filter(|_| exponent.is_integer());
                    let (factor, times) = match power {
                        Some(power) if graph.any(base, |n| matches!(n, Node::Jet(_))) => {
                            (Form::polynomial(graph, base), power)
                        }
                        _ => {
                            let whole = graph.pow(base, exponent);
                            (Form::constant(graph, whole), 1)
                        }
                    };
                    for _ in 0..times {
                        form = form.multiply(graph, &factor, usize::MAX);
                    }
                }
                form
            }
            _ => Form::constant(graph, id),
        }
    }

    /// The part of degree 0.
    pub fn base(&self, graph: &mut Graph) -> Id {
        self.terms
            .get(&Vec::new())
            .copied()
            .unwrap_or_else(|| graph.zero())
    }

    /// The terms of one degree.
    pub fn degree(&self, degree: usize) -> Form {
        let of_degree = self.terms.iter().filter(|(m, _)| m.len() == degree);
        Form {
            terms: of_degree.map(|(m, c)| (m.clone(), *c)).collect(),
        }
    }

    /// The highest degree met.
    pub fn highest_degree(&self) -> usize {
        self.terms.keys().map(Vec::len).max().unwrap_or(0)
    }

    /// Adds coefficient · Π monomial, the monomial being sorted.
    pub fn accumulate(&mut self, graph: &mut Graph, monomial: Monomial, coefficient: Id) {
        if monomial.iter().any(|jet| jet.absx > 1) {
            let written = monomial.into_iter().map(Jet::canonical);
            let (mut monomial, signs): (Monomial, Vec<bool>) = written.unzip();
            monomial.sort_unstable();
            let odd = signs.into_iter().filter(|&s| s).count() % 2 == 1;
            let coefficient = if odd {
                graph.neg(coefficient)
            } else {
                coefficient
            };
            return self.accumulate(graph, monomial, coefficient);
        }
        let total = match self.terms.get(&monomial) {
            Some(&present) => graph.add(present, coefficient),
            None => coefficient,
        };
        if graph.is_zero(total) {
            self.terms.remove(&monomial);
        } else {
            self.terms.insert(monomial, total);
        }
    }

    /// Adds `factor` · `form`.
    pub fn add(&mut self, graph: &mut Graph, form: &Form, factor: &Rational) {
        for (monomial, coefficient) in &form.terms {
            let scaled = graph.scale(*coefficient, factor.clone());
            self.accumulate(graph, monomial.clone(), scaled);
        }
    }

    /// Each coefficient multiplied by `factor`, the product carried into the terms of sums.
    pub fn times(&self, graph: &mut Graph, factor: Id) -> Form {
        let mut product = Form::default();
        for (monomial, coefficient) in &self.terms {
            let scaled = graph.mul(*coefficient, factor);
            product.accumulate(graph, monomial.clone(), scaled);
        }
        product
    }

    /// Coefficients in collected form, those that vanish dropped.
    pub fn collected(&self, graph: &mut Graph) -> Form {
        let mut form = Form::default();
        for (monomial, &coefficient) in &self.terms {
            let coefficient = graph.collect(coefficient);
            if !graph.vanishes(coefficient) {
                form.terms.insert(monomial.clone(), coefficient);
            }
        }
        form
    }

    /// The product with `form`, without terms of a degree above `order`.
    pub fn multiply(&self, graph: &mut Graph, form: &Form, order: usize) -> Form {
        let mut product = Form::default();
        for (a, x) in &self.terms {
            for (b, y) in &form.terms {
                if a.len() + b.len() > order {
                    continue;
                }
                let mut monomial = a.clone();
                monomial.extend(b);
                monomial.sort_unstable();
                let coefficient = graph.mul(*x, *y);
                product.accumulate(graph, monomial, coefficient);
            }
        }
        product
    }

    /// ∂x, ∂y, ∂t or |∂x| by the product rule; base coefficients depend on y alone.
    ///
    /// |∂x| obeys no product rule and asks for a form that is linear.
    pub fn differentiate(&self, graph: &mut Graph, operator: Operator) -> Form {
        let mut derivative = Form::default();
        for (monomial, coefficient) in &self.terms {
            for i in 0..monomial.len() {
                let mut changed = monomial.clone();
                changed[i] = changed[i].derived(operator);
                changed.sort_unstable();
                derivative.accumulate(graph, changed, *coefficient);
            }
            if operator == Operator::Dy {
                let slope = graph.differentiate(*coefficient, Variable::AlongBase);
                derivative.accumulate(graph, monomial.clone(), slope);
            }
        }
        derivative
    }

    /// Σ_m `taylor[m]` · (self without its base part)^m.
    pub fn compose(&self, graph: &mut Graph, taylor: &[Id]) -> Form {
        let order = taylor.len() - 1;
        let mut increment = self.clone();
        increment.terms.remove(&Vec::new());
        let one = graph.one();
        let mut power = Form::constant(graph, one);
        let mut result = Form::default();
        for (m, &coefficient) in taylor.iter().enumerate() {
            if m > 0 {
                power = power.multiply(graph, &increment, order);
            }
            let term = power.times(graph, coefficient);
            result.add(graph, &term, &Rational::one());
        }
        result
    }
}
