//! Constructors of expressions. Each returns the canonical node, so that equal expressions are one node.

use super::{FieldId, Function, Graph, Id, Jet, LawAtom, Node, Operator, ParameterId, Rational};
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::collections::BTreeMap;

/// Powers of numbers beyond this many bits stay unevaluated.
const LARGEST_NUMBER: u64 = 4096;
/// Products of sums with more terms than this stay factored.
const MOST_TERMS: usize = 256;

impl Graph {
    /// A rational number.
    pub fn number(&mut self, value: Rational) -> Id {
        self.intern(Node::Number(value))
    }

    /// A whole number.
    pub fn integer(&mut self, value: i64) -> Id {
        self.number(Rational::from_integer(value.into()))
    }

    /// 0
    pub fn zero(&mut self) -> Id {
        self.integer(0)
    }

    /// 1
    pub fn one(&mut self) -> Id {
        self.integer(1)
    }

    /// π
    pub fn pi(&mut self) -> Id {
        self.intern(Node::Pi)
    }

    /// A parameter.
    pub fn parameter(&mut self, parameter: ParameterId) -> Id {
        self.intern(Node::Parameter(parameter))
    }

    /// k
    pub fn wavenumber(&mut self) -> Id {
        self.intern(Node::Wavenumber)
    }

    /// y
    pub fn coordinate(&mut self) -> Id {
        self.intern(Node::Coordinate)
    }

    /// A derivative of a field.
    pub fn jet(&mut self, jet: Jet) -> Id {
        self.intern(Node::Jet(jet))
    }

    /// ∂y^order of a base field.
    pub fn base(&mut self, field: FieldId, order: u8) -> Id {
        self.intern(Node::Base(field, order))
    }

    /// A law of the full state.
    pub fn state_law(&mut self, atom: LawAtom) -> Id {
        self.intern(Node::StateLaw(atom))
    }

    /// A law of the base state.
    pub fn base_law(&mut self, atom: LawAtom) -> Id {
        self.intern(Node::BaseLaw(atom))
    }

    /// An argument of a polarised form.
    pub fn slot(&mut self, array: usize, position: usize) -> Id {
        self.intern(Node::Slot(array, position))
    }

    /// A derivative of an expression, not yet carried out.
    pub fn derivative(&mut self, operator: Operator, argument: Id) -> Id {
        self.intern(Node::Derivative(operator, argument))
    }

    /// The number that it is, if it is one.
    pub fn as_number(&self, id: Id) -> Option<&Rational> {
        match self.node(id) {
            Node::Number(value) => Some(value),
            _ => None,
        }
    }

    /// Whether it is the number 0.
    pub fn is_zero(&self, id: Id) -> bool {
        self.as_number(id).is_some_and(Zero::is_zero)
    }

    /// Σ coefficient · term.
    pub fn sum(&mut self, parts: impl IntoIterator<Item = (Id, Rational)>) -> Id {
        let mut constant = Rational::zero();
        let mut terms: BTreeMap<Id, Rational> = BTreeMap::new();
        let mut work = 0;
        for (id, coefficient) in parts {
            if self.is_pole(id) {
                return id;
            }
            match self.node(id) {
                Node::Number(value) => constant += value * &coefficient,
                Node::Sum(inner, inner_terms) => {
                    work += inner_terms.len();
                    constant += inner * &coefficient;
                    for (term, c) in inner_terms {
                        *terms.entry(*term).or_default() += c * &coefficient;
                    }
                }
                _ => *terms.entry(id).or_default() += coefficient,
            }
        }
        self.work += work;
        // ln 0 − ln 0
        if terms
            .iter()
            .any(|(&term, c)| c.is_zero() && self.is_undefined(term))
        {
            return self.undefined();
        }
        terms.retain(|_, c| !c.is_zero());
        let mut terms: Vec<_> = terms.into_iter().collect();
        match (terms.len(), constant.is_zero()) {
            (0, _) => self.number(constant),
            (1, true) if terms[0].1.is_one() => terms.remove(0).0,
            _ => self.intern(Node::Sum(constant, terms)),
        }
    }

    /// a + b
    pub fn add(&mut self, a: Id, b: Id) -> Id {
        self.sum([(a, Rational::one()), (b, Rational::one())])
    }

    /// a − b
    pub fn sub(&mut self, a: Id, b: Id) -> Id {
        self.sum([(a, Rational::one()), (b, -Rational::one())])
    }

    /// −a
    pub fn neg(&mut self, a: Id) -> Id {
        self.scale(a, -Rational::one())
    }

    /// factor · a
    pub fn scale(&mut self, a: Id, factor: Rational) -> Id {
        self.sum([(a, factor)])
    }

    /// Π base^exponent.
    pub fn product(&mut self, parts: impl IntoIterator<Item = (Id, Rational)>) -> Id {
        let mut number = Rational::one();
        let mut factors: BTreeMap<Id, Rational> = BTreeMap::new();
        let mut stack: Vec<(Id, Rational)> = parts.into_iter().collect();
        let mut work = 0;
        stack.reverse();
        while let Some((id, exponent)) = stack.pop() {
            if self.is_pole(id) || self.is_pole_of(id, &exponent) {
                return self.undefined();
            }
            if exponent.is_zero() {
                continue;
            }
            match self.node(id) {
                Node::Number(value) => match power_of_number(value, &exponent) {
                    Some(value) => number *= value,
                    None => *factors.entry(id).or_default() += exponent,
                },
                // (a b)^q = a^q b^q holds on every branch only for integer q.
                Node::Product(inner) if exponent.is_integer() => {
                    work += inner.len();
                    for (base, e) in inner {
                        stack.push((*base, e * &exponent));
                    }
                }
                // (c t)^q = c^q t^q
                Node::Sum(constant, terms)
                    if constant.is_zero() && terms.len() == 1 && exponent.is_integer() =>
                {
                    let (term, coefficient) = terms[0].clone();
                    match power_of_number(&coefficient, &exponent) {
                        Some(value) => {
                            number *= value;
                            stack.push((term, exponent));
                        }
                        None => *factors.entry(id).or_default() += exponent,
                    }
                }
                // A sum of mostly negative terms gives its sign away, so that equal sums meet.
                Node::Sum(constant, terms)
                    if exponent.is_integer() && mostly_negative(constant, terms) =>
                {
                    let negated = self.neg(id);
                    if !is_even(&exponent) {
                        number = -number;
                    }
                    *factors.entry(negated).or_default() += exponent;
                }
                _ => *factors.entry(id).or_default() += exponent,
            }
        }
        self.work += work;
        self.collected_product(number, factors)
    }

    /// number · Π base^exponent, each base once and none of them a number or a pole.
    fn collected_product(&mut self, number: Rational, mut factors: BTreeMap<Id, Rational>) -> Id {
        // 0 · ln 0, ln 0 / ln 0
        let is_lost = |(&base, exponent): (&Id, &Rational)| {
            (number.is_zero() || exponent.is_zero()) && self.is_undefined(base)
        };
        if factors.iter().any(is_lost) {
            return self.undefined();
        }
        if number.is_zero() {
            return self.zero();
        }
        factors.retain(|_, e| !e.is_zero());
        let mut factors: Vec<_> = factors.into_iter().collect();
        let product = match factors.len() {
            0 => return self.number(number),
            1 if factors[0].1.is_one() => factors.remove(0).0,
            _ => self.intern(Node::Product(factors)),
        };
        self.scale(product, number)
    }

    /// a b
    pub fn mul(&mut self, a: Id, b: Id) -> Id {
        self.product([(a, Rational::one()), (b, Rational::one())])
    }

    /// a / b
    pub fn div(&mut self, a: Id, b: Id) -> Id {
        self.product([(a, Rational::one()), (b, -Rational::one())])
    }

    /// base^exponent
    pub fn pow(&mut self, base: Id, exponent: Rational) -> Id {
        self.product([(base, exponent)])
    }

    /// `a / b` with the division carried into the terms of a sum, where they then may cancel.
    pub fn divide_terms(&mut self, a: Id, b: Id) -> Id {
        let Node::Sum(constant, terms) = self.node(a).clone() else {
            return self.div(a, b);
        };
        let mut parts = Vec::with_capacity(terms.len() + 1);
        let head = self.number(constant);
        parts.push((self.div(head, b), Rational::one()));
        for (term, coefficient) in terms {
            parts.push((self.div(term, b), coefficient));
        }
        self.sum(parts)
    }

    /// Products carried into sums, like terms collected, then the factors and denominators that all
    /// terms share taken out again: the form in which equal coefficients are equal nodes.
    pub fn collect(&mut self, id: Id) -> Id {
        let expanded = self.distribute(id);
        self.extract_common(expanded)
    }

    /// Products over sums multiplied out (positive integer powers of sums, within reason).
    fn distribute(&mut self, id: Id) -> Id {
        match self.node(id).clone() {
            Node::Sum(constant, terms) => {
                let mut parts = vec![(self.number(constant), Rational::one())];
                for (term, coefficient) in terms {
                    parts.push((self.distribute(term), coefficient));
                }
                self.sum(parts)
            }
            Node::Product(factors) => {
                let mut terms = vec![self.one()];
                for (base, exponent) in factors {
                    let once = exponent.is_one();
                    let parts = match self.node(base).clone() {
                        Node::Sum(constant, terms) if once => {
                            let mut parts = vec![(self.number(constant), Rational::one())];
                            parts.extend(terms);
                            parts
                        }
                        _ => vec![(self.pow(base, exponent), Rational::one())],
                    };
                    if terms.len() * parts.len() > MOST_TERMS {
                        return id;
                    }
                    let mut longer = Vec::with_capacity(terms.len() * parts.len());
                    for &term in &terms {
                        for (part, coefficient) in &parts {
                            let part = self.scale(*part, coefficient.clone());
                            longer.push(self.mul(term, part));
                        }
                    }
                    terms = longer;
                }
                self.sum(terms.into_iter().map(|t| (t, Rational::one())))
            }
            _ => id,
        }
    }

    fn extract_common(&mut self, id: Id) -> Id {
        let Node::Sum(constant, terms) = self.node(id).clone() else {
            return id;
        };
        if terms.len() + usize::from(!constant.is_zero()) < 2 {
            return id;
        }
        let mut lists: Vec<BTreeMap<Id, Rational>> = Vec::new();
        for (term, _) in &terms {
            lists.push(match self.node(*term) {
                Node::Product(factors) => factors.iter().cloned().collect(),
                _ => BTreeMap::from([(*term, Rational::one())]),
            });
        }
        if !constant.is_zero() {
            lists.push(BTreeMap::new());
        }
        let mut common = Vec::new();
        let bases: std::collections::BTreeSet<Id> =
            lists.iter().flat_map(|l| l.keys().copied()).collect();
        for base in bases {
            let exponents = lists
                .iter()
                .map(|l| l.get(&base).cloned().unwrap_or_default());
            let least = exponents.min().unwrap_or_default();
            if !least.is_zero() {
                common.push((base, least));
            }
        }
        if common.is_empty() {
            return id;
        }
        let factor = self.product(common.clone());
        let inner = self.divide_terms(id, factor);
        common.push((inner, Rational::one()));
        self.product(common)
    }

    /// function(argument)
    pub fn call(&mut self, function: Function, argument: Id) -> Id {
        if self.is_zero(argument) {
            match function {
                Function::Exp | Function::Cos | Function::Cosh => return self.one(),
                Function::Sin
                | Function::Tan
                | Function::Sinh
                | Function::Tanh
                | Function::Atan => return self.zero(),
                Function::Log => {}
            }
        }
        if function == Function::Log && self.as_number(argument).is_some_and(One::is_one) {
            return self.zero();
        }
        self.intern(Node::Call(function, argument))
    }

    /// One branch for each choice of a switch. Equal branches give the branch itself.
    pub fn select(&mut self, switch: ParameterId, branches: Vec<Id>) -> Id {
        match branches.first() {
            Some(&first) if branches.iter().all(|&b| b == first) => first,
            _ => self.intern(Node::Select(switch, branches)),
        }
    }
}

fn is_even(integer: &Rational) -> bool {
    (integer / Rational::from_integer(2.into())).is_integer()
}

/// More negative terms than positive ones, the leading term deciding a draw.
fn mostly_negative(constant: &Rational, terms: &[(Id, Rational)]) -> bool {
    let sign = |value: &Rational| match (value.is_positive(), value.is_negative()) {
        (true, _) => 1,
        (_, true) => -1,
        _ => 0,
    };
    let balance: i32 = sign(constant) + terms.iter().map(|(_, c)| sign(c)).sum::<i32>();
    balance < 0 || balance == 0 && terms.first().is_some_and(|(_, c)| c.is_negative())
}

/// value^exponent where that is a rational of moderate size.
fn power_of_number(value: &Rational, exponent: &Rational) -> Option<Rational> {
    if value.is_one() {
        return Some(Rational::one());
    }
    if value.is_zero() {
        return exponent.is_positive().then(Rational::zero);
    }
    if !exponent.is_integer() {
        return None;
    }
    let exponent = exponent.to_integer().to_i32()?;
    let bits = value.numer().bits().max(value.denom().bits());
    (bits * u64::from(exponent.unsigned_abs()) <= LARGEST_NUMBER).then(|| value.pow(exponent))
}
