//! Differentiation and substitution.

use super::{FieldId, Function, Graph, Id, Jet, Node, Rational};
use num_traits::One;
use std::collections::HashMap;

/// What an expression is differentiated with respect to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Variable {
    /// The value of a field in the full state (laws follow by their partial derivatives).
    Field(FieldId),
    /// Explicit dependence on the coordinate.
    Coordinate,
    /// A derivative of a solved base field; laws must have been opened.
    Base(FieldId, u8),
    /// d/dy along the base state.
    AlongBase,
    /// ∂x, ∂y, ∂t of the full state by the chain rule.
    State(super::Operator),
    /// A kernel input.
    Slot(usize, usize),
}

impl Graph {
    /// The derivative of `id` with respect to `variable`.
    pub fn differentiate(&mut self, id: Id, variable: Variable) -> Id {
        self.differentiate_memo(id, variable, &mut HashMap::new())
    }

    fn differentiate_memo(&mut self, id: Id, by: Variable, memo: &mut HashMap<Id, Id>) -> Id {
        if let Some(&done) = memo.get(&id) {
            return done;
        }
        let result = match self.node(id).clone() {
            Node::Sum(_, terms) => {
                let parts: Vec<_> = terms
                    .into_iter()
                    .map(|(t, c)| (self.differentiate_memo(t, by, memo), c))
                    .collect();
                self.sum(parts)
            }
            // 1/0 has no derivative either.
            Node::Product(_) if self.is_pole(id) => id,
            // (Π b_i^e_i)' = Σ_i e_i b_i^(e_i−1) b_i' Π_{j≠i} b_j^e_j
            Node::Product(factors) => {
                let mut parts = Vec::new();
                for (i, (base, exponent)) in factors.iter().enumerate() {
                    let inner = self.differentiate_memo(*base, by, memo);
                    if self.is_zero(inner) {
                        continue;
                    }
                    let mut product = factors.clone();
                    product[i].1 -= Rational::one();
                    product.push((inner, Rational::one()));
                    parts.push((self.product(product), exponent.clone()));
                }
                self.sum(parts)
            }
            Node::Call(function, argument) => {
                let inner = self.differentiate_memo(argument, by, memo);
                let outer = self.function_derivative(function, argument);
                self.mul(outer, inner)
            }
            Node::Select(switch, branches) => {
                let branches = branches
                    .into_iter()
                    .map(|b| self.differentiate_memo(b, by, memo))
                    .collect();
                self.select(switch, branches)
            }
            leaf => self.differentiate_leaf(&leaf, by),
        };
        memo.insert(id, result);
        result
    }

    fn differentiate_leaf(&mut self, leaf: &Node, by: Variable) -> Id {
        match (leaf, by) {
            (Node::Coordinate, Variable::Coordinate | Variable::AlongBase) => self.one(),
            (Node::Coordinate, Variable::State(super::Operator::Dy)) => self.one(),
            (Node::Jet(jet), Variable::Field(field)) if *jet == Jet::value(field) => self.one(),
            (Node::Jet(jet), Variable::State(operator)) => self.jet(jet.derived(operator)),
            (Node::StateLaw(atom), Variable::Field(field)) => self.state_law(atom.partial(field)),
            (Node::StateLaw(atom), Variable::Coordinate) => self.state_law(atom.dy()),
            // ∂q law = Σ_f law_f ∂q f (+ explicit y)
            (Node::StateLaw(atom), Variable::State(operator)) => {
                let mut parts = Vec::new();
                for field in atom.index.ids() {
                    let partial = self.state_law(atom.partial(field));
                    let jet = self.jet(Jet::value(field).derived(operator));
                    parts.push((self.mul(partial, jet), Rational::one()));
                }
                if operator == super::Operator::Dy {
                    parts.push((self.state_law(atom.dy()), Rational::one()));
                }
                self.sum(parts)
            }
            // The base state depends on y alone.
            (
                Node::Base(field, order),
                Variable::AlongBase | Variable::State(super::Operator::Dy),
            ) => self.base(*field, order + 1),
            (Node::Base(field, order), Variable::Base(f, o)) if (*field, *order) == (f, o) => {
                self.one()
            }
            (Node::BaseLaw(atom), Variable::AlongBase | Variable::State(super::Operator::Dy)) => {
                self.base_law(atom.dy())
            }
            (Node::Slot(a, p), Variable::Slot(array, position))
                if (*a, *p) == (array, position) =>
            {
                self.one()
            }
            // p⁰, p⁰_y, … hold base fields up to the same derivative, and no higher one. Only a bug in a pass can ask for
            // a slope that the closed form of the law would tell.
            (Node::BaseLaw(atom), Variable::Base(_, order)) => {
                assert!(order > atom.y, "internal error: a law is not opened");
                self.zero()
            }
            // A law of the full state hides how it depends on the base state.
            (Node::StateLaw(_), Variable::Base(..) | Variable::AlongBase) => {
                panic!("internal error: a law is not opened")
            }
            _ => self.zero(),
        }
    }

    /// f'(argument) of an elementary function.
    fn function_derivative(&mut self, function: Function, argument: Id) -> Id {
        let two = Rational::from_integer(2.into());
        match function {
            Function::Exp => self.call(Function::Exp, argument),
            Function::Log => self.pow(argument, -Rational::one()),
            Function::Sin => self.call(Function::Cos, argument),
            Function::Cos => {
                let sine = self.call(Function::Sin, argument);
                self.neg(sine)
            }
            // tan' = 1 + tan²
            Function::Tan => {
                let tangent = self.call(Function::Tan, argument);
                let square = self.pow(tangent, two);
                let one = self.one();
                self.add(one, square)
            }
            Function::Sinh => self.call(Function::Cosh, argument),
            Function::Cosh => self.call(Function::Sinh, argument),
            // tanh' = 1 − tanh²
            Function::Tanh => {
                let tangent = self.call(Function::Tanh, argument);
                let square = self.pow(tangent, two);
                let one = self.one();
                self.sub(one, square)
            }
            // atan' = 1 / (1 + z²)
            Function::Atan => {
                let square = self.pow(argument, two);
                let one = self.one();
                let denominator = self.add(one, square);
                self.pow(denominator, -Rational::one())
            }
        }
    }

    /// Rebuilds `id` with leaves (and unevaluated derivatives) replaced where `replace` says so.
    pub fn substitute(
        &mut self,
        id: Id,
        replace: &mut dyn FnMut(&mut Graph, &Node) -> Option<Id>,
    ) -> Id {
        self.substitute_memo(id, replace, &mut HashMap::new())
    }

    fn substitute_memo(
        &mut self,
        id: Id,
        replace: &mut dyn FnMut(&mut Graph, &Node) -> Option<Id>,
        memo: &mut HashMap<Id, Id>,
    ) -> Id {
        if let Some(&done) = memo.get(&id) {
            return done;
        }
        let node = self.node(id).clone();
        let result = if let Some(new) = replace(self, &node) {
            new
        } else {
            match node {
                Node::Sum(constant, terms) => {
                    let mut parts = vec![(self.number(constant), Rational::one())];
                    for (term, c) in terms {
                        parts.push((self.substitute_memo(term, replace, memo), c));
                    }
                    self.sum(parts)
                }
                Node::Product(factors) => {
                    let mut parts = Vec::with_capacity(factors.len());
                    for (base, e) in factors {
                        parts.push((self.substitute_memo(base, replace, memo), e));
                    }
                    self.product(parts)
                }
                Node::Call(function, argument) => {
                    let argument = self.substitute_memo(argument, replace, memo);
                    self.call(function, argument)
                }
                Node::Select(switch, branches) => {
                    let branches = branches
                        .into_iter()
                        .map(|b| self.substitute_memo(b, replace, memo))
                        .collect();
                    self.select(switch, branches)
                }
                Node::Derivative(operator, argument) => {
                    let argument = self.substitute_memo(argument, replace, memo);
                    self.derivative(operator, argument)
                }
                _ => id,
            }
        };
        memo.insert(id, result);
        result
    }
}

#[cfg(test)]
mod tests {
    use super::{Function, Graph, Rational, Variable};
    use crate::graph::{FieldId, Id, LawAtom, LawId, Table};
    use num_traits::One;

    fn slope(graph: &mut Graph, id: Id) -> Id {
        graph.differentiate(id, Variable::Coordinate)
    }

    fn power(graph: &mut Graph, id: Id, exponent: i64) -> Id {
        graph.pow(id, Rational::from_integer(exponent.into()))
    }

    /// f' of every elementary function, by the identity that defines it.
    #[test]
    fn elementary_functions() {
        let mut graph = Graph::new();
        let y = graph.coordinate();
        let one = graph.one();
        for function in Function::ALL {
            let f = graph.call(function, y);
            let derivative = slope(&mut graph, f);
            let square = power(&mut graph, f, 2);
            let expected = match function {
                Function::Exp => f,
                Function::Log => power(&mut graph, y, -1),
                Function::Sin => graph.call(Function::Cos, y),
                Function::Cos => {
                    let sine = graph.call(Function::Sin, y);
                    graph.neg(sine)
                }
                Function::Tan => graph.add(one, square),
                Function::Sinh => graph.call(Function::Cosh, y),
                Function::Cosh => graph.call(Function::Sinh, y),
                Function::Tanh => graph.sub(one, square),
                Function::Atan => {
                    let below = power(&mut graph, y, 2);
                    let below = graph.add(one, below);
                    power(&mut graph, below, -1)
                }
            };
            let difference = graph.sub(derivative, expected);
            assert!(graph.vanishes(difference), "{function:?}");
        }
    }

    /// A law of one field, none of its slopes taken.
    fn atom() -> LawAtom {
        LawAtom {
            law: LawId(0),
            index: Table::filled(1, 0),
            y: 0,
        }
    }

    /// A law at the base state does not depend on derivatives of the base fields beyond its order.
    #[test]
    fn laws_of_the_base_state() {
        let mut graph = Graph::new();
        let law = graph.base_law(atom());
        let by_slope = graph.differentiate(law, Variable::Base(FieldId(0), 1));
        assert!(graph.is_zero(by_slope));
    }

    /// Its slope by a value is in its closed form alone: asking for it is a bug, and never zero.
    #[test]
    #[should_panic(expected = "a law is not opened")]
    fn laws_have_to_be_opened() {
        let mut graph = Graph::new();
        let law = graph.base_law(atom());
        graph.differentiate(law, Variable::Base(FieldId(0), 0));
    }

    /// The same of a law at the full state, whose derivative along the base state is hidden too.
    #[test]
    #[should_panic(expected = "a law is not opened")]
    fn laws_of_the_full_state_have_to_be_opened() {
        let mut graph = Graph::new();
        let law = graph.state_law(atom());
        graph.differentiate(law, Variable::Base(FieldId(0), 0));
    }

    /// (u/v)' = (u' v − u v')/v², (√u)' = u'/(2√u), the chain rule.
    #[test]
    fn rules() {
        let mut graph = Graph::new();
        let y = graph.coordinate();
        let (u, v) = (graph.call(Function::Sin, y), graph.call(Function::Exp, y));
        let quotient = graph.div(u, v);
        let derivative = slope(&mut graph, quotient);
        let (du, dv) = (slope(&mut graph, u), slope(&mut graph, v));
        let (a, b) = (graph.mul(du, v), graph.mul(u, dv));
        let above = graph.sub(a, b);
        let below = power(&mut graph, v, 2);
        let expected = graph.div(above, below);
        let difference = graph.sub(derivative, expected);
        assert!(graph.vanishes(difference));
        let half = Rational::new(1.into(), 2.into());
        let root = graph.pow(u, half.clone());
        let derivative = slope(&mut graph, root);
        let inverse = graph.pow(u, -half.clone());
        let expected = graph.product([(du, Rational::one()), (inverse, Rational::one())]);
        let expected = graph.scale(expected, half);
        let difference = graph.sub(derivative, expected);
        assert!(graph.vanishes(difference));
        let nested = graph.call(Function::Exp, u);
        let derivative = slope(&mut graph, nested);
        let expected = graph.mul(nested, du);
        assert_eq!(derivative, expected);
    }
}
