//! Is an expression identically zero?
//!
//! Schwartz–Zippel over the field of 2⁶¹ − 1 elements: atoms (parameters, base fields, laws) become
//! pseudo-random field elements fixed by a seed, and a rational expression that is not zero vanishes
//! there with probability of about 2⁻⁵⁰. Two seeds must agree. Roots and elementary functions count
//! as atoms of their argument's value. The answer is the same on every run.

use super::{Function, Graph, Id, Node, Rational};
use num_traits::{Signed, ToPrimitive};
use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

const PRIME: u64 = (1 << 61) - 1;
const SEEDS: [u64; 2] = [0x9e37_79b9_7f4a_7c15, 0xd1b5_4a32_d192_ed03];

impl Graph {
    /// Whether `id` is zero for all values of its atoms.
    pub fn vanishes(&self, id: Id) -> bool {
        if self.as_number(id).is_some() {
            return self.is_zero(id);
        }
        if self.is_undefined(id) {
            return false;
        }
        SEEDS.iter().all(|&seed| {
            let mut values = HashMap::new();
            for node in self.topological(&[id]) {
                let value = self.residue(node, seed, &values);
                values.insert(node, value);
            }
            // The sample divides by zero, which decides nothing about the expression: count it as nonzero.
            values[&id] == Some(0)
        })
    }

    fn residue(&self, id: Id, seed: u64, values: &HashMap<Id, Option<u64>>) -> Option<u64> {
        let atom = |node: &Node| Some(scatter((seed, node)));
        match self.node(id) {
            Node::Number(value) => rational(value),
            Node::Sum(constant, terms) => {
                let mut total = rational(constant)?;
                for (term, c) in terms {
                    total = add(total, mul(rational(c)?, values[term]?));
                }
                Some(total)
            }
            Node::Product(factors) => {
                let mut total = 1;
                for (base, exponent) in factors {
                    let base = values[base]?;
                    // b^e = b^⌊e⌋ · root, the root being an atom
                    let whole = exponent.floor();
                    let size = whole.numer().abs().to_u64()?;
                    let signed = if whole.is_negative() {
                        inverse(base)?
                    } else {
                        base
                    };
                    let mut factor = power(signed, size);
                    if base == 0 {
                        factor = 0;
                    } else if !exponent.is_integer() {
                        factor = mul(factor, scatter((seed, base, exponent - whole)));
                    }
                    total = mul(total, factor);
                }
                Some(total)
            }
            Node::Call(Function::Log, argument) if values[argument] == Some(0) => None,
            Node::Call(function, argument) => Some(scatter((seed, function, values[argument]?))),
            Node::Select(switch, branches) => {
                let branches: Option<Vec<u64>> = branches.iter().map(|b| values[b]).collect();
                let branches = branches?;
                // Zero only where every branch is; linear in the branches, so that sums cancel.
                let mut total = 0;
                for (choice, value) in branches.into_iter().enumerate() {
                    total = add(total, mul(scatter((seed, switch, choice)), value));
                }
                Some(total)
            }
            Node::Derivative(operator, argument) => {
                Some(scatter((seed, operator, values[argument]?)))
            }
            leaf => atom(leaf),
        }
    }
}

fn scatter(value: impl Hash) -> u64 {
    let mut hasher = DefaultHasher::new();
    value.hash(&mut hasher);
    hasher.finish() % PRIME
}

fn add(a: u64, b: u64) -> u64 {
    (a + b) % PRIME
}

fn mul(a: u64, b: u64) -> u64 {
    (u128::from(a) * u128::from(b) % u128::from(PRIME)) as u64
}

fn power(base: u64, mut exponent: u64) -> u64 {
    let (mut result, mut square) = (1, base);
    while exponent > 0 {
        if exponent & 1 == 1 {
            result = mul(result, square);
        }
        square = mul(square, square);
        exponent >>= 1;
    }
    result
}

fn inverse(a: u64) -> Option<u64> {
    (a != 0).then(|| power(a, PRIME - 2))
}

fn rational(value: &Rational) -> Option<u64> {
    let reduce = |part: &num_rational::BigRational| part.to_integer().to_u64();
    let prime = Rational::from_integer(PRIME.into());
    let modulo = |integer: Rational| {
        let quotient = (&integer / &prime).floor();
        reduce(&(integer - quotient * &prime))
    };
    let numerator = modulo(Rational::from_integer(value.numer().clone()))?;
    let denominator = modulo(Rational::from_integer(value.denom().clone()))?;
    Some(mul(numerator, inverse(denominator)?))
}

#[cfg(test)]
mod tests {
    use crate::graph::{Graph, ParameterId, Rational};

    #[test]
    fn what_vanishes_and_what_does_not() {
        let mut graph = Graph::new();
        let (a, b) = (
            graph.parameter(ParameterId(0)),
            graph.parameter(ParameterId(1)),
        );
        let two = Rational::from_integer(2.into());
        // (a + b)² − a² − 2ab − b²
        let sum = graph.add(a, b);
        let whole = graph.pow(sum, two.clone());
        let (aa, bb, ab) = (
            graph.pow(a, two.clone()),
            graph.pow(b, two.clone()),
            graph.mul(a, b),
        );
        let one = Rational::from_integer(1.into());
        let parts = [
            (whole, one.clone()),
            (aa, -one.clone()),
            (ab, -two),
            (bb, -one),
        ];
        let difference = graph.sum(parts.clone());
        assert!(graph.vanishes(difference));
        let short = graph.sum(parts[..3].to_vec());
        assert!(!graph.vanishes(short));
        // 1/(a − a) is no zero.
        let nothing = graph.sub(a, a);
        assert!(graph.vanishes(nothing));
        let infinite = graph.div(b, nothing);
        assert!(!graph.vanishes(infinite));
        // √a √a = a
        let half = Rational::new(1.into(), 2.into());
        let root = graph.pow(a, half);
        let square = graph.mul(root, root);
        let difference = graph.sub(square, a);
        assert!(graph.vanishes(difference));
    }
}
