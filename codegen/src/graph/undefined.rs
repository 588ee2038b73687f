//! Expressions without a value: 1/0, ln 0, and whatever holds one of them.
//!
//! The constructors never lose them. 0 · ln 0, 0² · 0⁻² and 1/0 − 1/0 are no zeros, so a coefficient does not vanish
//! because one of its factors does not exist.

use super::{Function, Graph, Id, Node, Rational};
use num_traits::{One, Signed};

impl Graph {
    /// 1/0, which every product and sum with it equals.
    pub(super) fn undefined(&mut self) -> Id {
        let zero = self.zero();
        self.intern(Node::Product(vec![(zero, -Rational::one())]))
    }

    /// Whether it is 1/0 itself.
    pub(super) fn is_pole(&self, id: Id) -> bool {
        match self.node(id) {
            Node::Product(factors) => factors.iter().any(|(base, e)| self.is_pole_of(*base, e)),
            _ => false,
        }
    }

    /// Whether base^exponent is a negative power of zero.
    pub(super) fn is_pole_of(&self, base: Id, exponent: &Rational) -> bool {
        exponent.is_negative() && self.is_zero(base)
    }

    /// Whether it holds 1/0 or ln 0, and so has no value.
    pub fn is_undefined(&self, id: Id) -> bool {
        self.undefined[id.index()]
    }

    /// The same of a node that is not in the graph yet.
    pub(super) fn is_undefined_node(&self, node: &Node) -> bool {
        let mut is_undefined = match node {
            Node::Product(factors) => factors.iter().any(|(base, e)| self.is_pole_of(*base, e)),
            Node::Call(Function::Log, argument) => self.is_zero(*argument),
            _ => false,
        };
        node.for_each_child(|child| is_undefined |= self.is_undefined(child));
        is_undefined
    }
}

#[cfg(test)]
mod tests {
    use crate::graph::{FieldId, Function, Graph, Node, Rational, Variable};
    use num_traits::One;

    /// 0 · (1/0), 1/0 − 1/0 and the like stay expressions: a limit may give them any value, so none is the number zero.
    #[test]
    fn no_constructor_loses_a_pole() {
        let mut graph = Graph::new();
        let (zero, two) = (graph.zero(), Rational::from_integer(2.into()));
        let pole = graph.pow(zero, -Rational::one());
        let log = graph.call(Function::Log, zero);
        let square = graph.pow(zero, -two.clone());
        let root = graph.pow(zero, -Rational::new(1.into(), 2.into()));
        let expressions = [
            graph.mul(zero, pole),
            graph.mul(pole, zero),
            graph.mul(zero, log),
            graph.mul(log, zero),
            graph.product([(zero, two), (square, Rational::one())]),
            graph.sub(pole, pole),
            graph.sub(log, log),
            graph.div(log, log),
            graph.scale(log, Rational::from_integer(0.into())),
            graph.pow(pole, -Rational::one()),
            graph.mul(zero, root),
            graph.differentiate(pole, Variable::AlongBase),
            graph.differentiate(log, Variable::AlongBase),
            graph.call(Function::Exp, log),
        ];
        for (position, id) in expressions.into_iter().enumerate() {
            assert!(graph.is_undefined(id), "expression {position}");
            assert!(!graph.vanishes(id), "expression {position}");
            let collected = graph.collect(id);
            assert!(graph.is_undefined(collected), "expression {position}");
        }
    }

    /// sin(u)/u, put at u = 0, is not 0 (its limit is 1).
    #[test]
    fn a_quotient_of_zeros_is_no_zero() {
        let mut graph = Graph::new();
        let u = graph.base(FieldId(0), 0);
        let sine = graph.call(Function::Sin, u);
        let quotient = graph.div(sine, u);
        let zero = graph.zero();
        let at_zero = graph.substitute(quotient, &mut |_, node| match node {
            Node::Base(..) => Some(zero),
            _ => None,
        });
        assert!(graph.is_undefined(at_zero));
        assert!(!graph.vanishes(at_zero));
    }

    /// 1/(a − b) + 1/(b' − a) with b' = b: the divisor vanishes though it is not written as 0.
    #[test]
    fn a_root_of_zero_vanishes_and_its_logarithm_does_not() {
        let mut graph = Graph::new();
        let y = graph.coordinate();
        let one = graph.one();
        let sum = graph.add(y, one);
        let two = Rational::from_integer(2.into());
        let square = graph.pow(sum, two.clone());
        let written_out = [
            (graph.pow(y, two.clone()), Rational::one()),
            (y, two),
            (one, Rational::one()),
        ];
        let written_out = graph.sum(written_out);
        let nothing = graph.sub(square, written_out);
        let root = graph.pow(nothing, Rational::new(1.into(), 2.into()));
        assert!(graph.vanishes(root));
        let log = graph.call(Function::Log, nothing);
        let product = graph.mul(nothing, log);
        assert!(!graph.vanishes(product));
    }
}
