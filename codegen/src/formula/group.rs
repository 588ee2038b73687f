//! Operators grouped as the literature groups them, where a formula has two dimensions to stand in.
//!
//! An entry of L has its common denominator in front: (1/n⁰)[μ⁰ ∂x² + …]. A row of N has
//! a line for the terms without a law, then its laws one by one: terms that share what multiplies the
//! law's expansion stand together, (κ⁰_n n' + κ⁰_T T') T'_yy, and so do those that share the expansion,
//! (μ⁰_n n' + μ⁰_T T') (2 u'_xx + u'_yy + …).

use super::{Formula, Letters, Mark};
use crate::form::{Form, Monomial};
use crate::graph::{Graph, Id, Jet, LawAtom, LawId, Node, Rational};
use num_traits::{One, Signed};

/// Π base^exponent.
type Factors = Vec<(Id, Rational)>;

/// A coefficient before the factors of an operator.
pub type Coefficient = (Id, Vec<Formula>);

/// A number and what it multiplies.
#[derive(Clone, PartialEq)]
struct Scaled<T> {
    number: Rational,
    of: T,
}

/// What the expansion of a law contributes to a term: one of its derivatives, and the jets that go
/// with it.
#[derive(Clone, PartialEq)]
struct Expansion {
    law: Option<Id>,
    jets: Monomial,
}

/// What multiplies the expansion in a term: base-state factors and jets.
#[derive(Clone, PartialEq)]
struct Outer {
    factors: Factors,
    jets: Monomial,
}

/// One product of a coefficient's sum, with the jets of its term.
struct Piece {
    divided: bool,
    law: Option<LawId>,
    number: Rational,
    inner: Expansion,
    outer: Outer,
}

/// A line of a row: (Σ expansions) (Σ outer), over the divisor of the row or not.
struct Group {
    divided: bool,
    /// Of one law; empty for the terms without a law.
    expansions: Vec<Scaled<Expansion>>,
    outer: Vec<Scaled<Outer>>,
}

/// A row of N, a line an item.
pub fn grouped(graph: &Graph, letters: &Letters, form: &Form, divisor: Id) -> Vec<Formula> {
    let writer = Writer { graph, letters };
    let groups = groups(graph, form, divisor).into_iter();
    groups.map(|group| writer.line(&group, divisor)).collect()
}

/// Σ coefficient · operator, a common denominator in front of the sum.
pub fn over_common_denominator(graph: &Graph, letters: &Letters, terms: &[Coefficient]) -> Formula {
    let taken: Vec<(Rational, Factors)> = terms.iter().map(|(id, _)| factors(graph, *id)).collect();
    let below = |(_, factors): &(Rational, Factors)| -> Factors {
        factors
            .iter()
            .filter(|(_, e)| e.is_negative())
            .cloned()
            .collect()
    };
    let shared = |left: Factors, right: Factors| -> Factors {
        left.into_iter()
            .filter_map(|(base, exponent)| {
                let (_, exponent_right) = right.iter().find(|(b, _)| *b == base)?;
                Some((base, exponent.max(exponent_right.clone())))
            })
            .collect()
    };
    let common = taken.iter().map(below).reduce(shared).unwrap_or_default();
    let writer = Writer { graph, letters };
    if terms.len() < 2 || common.is_empty() {
        let parts = terms
            .iter()
            .map(|(id, what)| letters.scaled(graph, *id, what.clone()));
        return Formula::sum(parts);
    }
    let parts = taken
        .into_iter()
        .zip(terms)
        .map(|((number, mut factors), (_, what))| {
            for (base, exponent) in &common {
                if let Some((_, e)) = factors.iter_mut().find(|(b, _)| b == base) {
                    *e -= exponent;
                }
            }
            factors.retain(|(_, e)| *e != Rational::default());
            writer.product(&number, &factors, what.clone())
        });
    let inside = Formula::sum(parts);
    Formula::product([letters.product(graph, &common), inside])
}

/// The pass: terms by law, by expansion, by what multiplies it.
fn groups(graph: &Graph, form: &Form, divisor: Id) -> Vec<Group> {
    let keyed = pieces(graph, form, divisor).into_iter();
    let mut lines = gather(keyed.map(|piece| ((piece.divided, piece.law), piece)));
    lines.sort_by_key(|(key, _)| *key);
    let mut groups = Vec::new();
    for ((divided, law), pieces) in lines {
        match law {
            Some(_) => groups.extend(by_expansion(divided, pieces)),
            None => groups.push(Group {
                divided,
                expansions: Vec::new(),
                outer: pieces.into_iter().map(Piece::outer).collect(),
            }),
        }
    }
    groups
}

/// The terms of a form, sums in their coefficients multiplied out.
fn pieces(graph: &Graph, form: &Form, divisor: Id) -> Vec<Piece> {
    let holds_law = |id: Id| graph.any(id, |node| matches!(node, Node::BaseLaw(_)));
    let mut pieces = Vec::new();
    for (monomial, &coefficient) in &form.terms {
        let (number, mut factors_of_term) = factors(graph, coefficient);
        let sum = factors_of_term.iter().position(|(base, e)| {
            e.is_one() && matches!(graph.node(*base), Node::Sum(..)) && holds_law(*base)
        });
        let Some(sum) = sum else {
            pieces.push(Piece::new(
                graph,
                number,
                factors_of_term,
                monomial,
                divisor,
            ));
            continue;
        };
        let (sum, _) = factors_of_term.remove(sum);
        let Node::Sum(constant, terms) = graph.node(sum) else {
            continue;
        };
        if *constant != Rational::default() {
            let scaled = number.clone() * constant;
            pieces.push(Piece::new(
                graph,
                scaled,
                factors_of_term.clone(),
                monomial,
                divisor,
            ));
        }
        for (term, scale) in terms {
            let (inside, mut within) = factors(graph, *term);
            within.extend(factors_of_term.clone());
            let scaled = number.clone() * scale * inside;
            pieces.push(Piece::new(graph, scaled, within, monomial, divisor));
        }
    }
    pieces
}

impl Piece {
    /// number · Π factors · Π jets, taken apart around its first law.
    fn new(
        graph: &Graph,
        number: Rational,
        mut factors: Factors,
        monomial: &Monomial,
        divisor: Id,
    ) -> Self {
        let below = (divisor, -Rational::one());
        let divided = factors.iter().position(|f| *f == below);
        if let Some(position) = divided {
            factors.remove(position);
        }
        let mut jets = monomial.clone();
        let mut numbered = factors.iter().enumerate();
        let first = numbered.find_map(|(position, (base, e))| match graph.node(*base) {
            Node::BaseLaw(atom) if e.is_one() => Some((position, atom)),
            _ => None,
        });
        let (law, inner) = match first {
            None => (
                None,
                Expansion {
                    law: None,
                    jets: Vec::new(),
                },
            ),
            Some((position, atom)) => {
                let (id, _) = factors.remove(position);
                let jets = take_jets_of(atom, &mut jets);
                (
                    Some(atom.law),
                    Expansion {
                        law: Some(id),
                        jets,
                    },
                )
            }
        };
        factors.sort();
        Piece {
            divided: divided.is_some(),
            law,
            number,
            inner,
            outer: Outer { factors, jets },
        }
    }

    fn outer(self) -> Scaled<Outer> {
        Scaled {
            number: self.number,
            of: self.outer,
        }
    }
}

/// Pieces of one law: equal outer parts together, then equal expansions.
fn by_expansion(divided: bool, pieces: Vec<Piece>) -> Vec<Group> {
    let keyed = pieces.into_iter().map(|piece| {
        let Piece { number, inner, .. } = piece;
        (piece.outer, Scaled { number, of: inner })
    });
    let mut keyed_by_inner = Vec::new();
    for (outer, mut inner) in gather(keyed) {
        inner.sort_by(|a, b| a.of.jets.cmp(&b.of.jets).then(a.of.law.cmp(&b.of.law)));
        let largest = inner.iter().map(|term| term.number.abs()).max();
        let size = largest.unwrap_or_else(Rational::one);
        let scale = if inner[0].number.is_negative() {
            -size
        } else {
            size
        };
        inner.iter_mut().for_each(|term| term.number /= &scale);
        keyed_by_inner.push((
            inner,
            Scaled {
                number: scale,
                of: outer,
            },
        ));
    }
    let mut groups = Vec::new();
    for (mut expansions, mut outer) in gather(keyed_by_inner.into_iter()) {
        // ½ and 1/6 stay with their terms; a number that all terms share stands before them.
        let least = outer.iter().map(|term| term.number.abs()).min();
        let whole = expansions.iter().all(|term| term.number.abs().is_one());
        if let (Some(least), false) = (least, whole) {
            expansions.iter_mut().for_each(|term| term.number *= &least);
            outer.iter_mut().for_each(|term| term.number /= &least);
        }
        groups.push(Group {
            divided,
            expansions,
            outer,
        });
    }
    groups
}

/// Groups as formulas.
struct Writer<'a> {
    graph: &'a Graph,
    letters: &'a Letters,
}

impl Writer<'_> {
    fn line(&self, group: &Group, divisor: Id) -> Formula {
        let [first, ..] = group.outer.as_slice() else {
            return Formula::zero();
        };
        // The sign of the first stands before brackets.
        let bracketed = group.outer.len() > 1 && (group.divided || !group.expansions.is_empty());
        let sign = if bracketed {
            first.number.signum()
        } else {
            Rational::one()
        };
        let agree = |term: &Scaled<Outer>| term.of.factors == first.of.factors;
        let common = if !group.expansions.is_empty() && group.outer.iter().all(agree) {
            first.of.factors.clone()
        } else {
            Factors::new()
        };
        let outer = group.outer.iter().map(|term| {
            let factors: &[_] = if common.is_empty() {
                &term.of.factors
            } else {
                &[]
            };
            self.product(&(&term.number * &sign), factors, self.jets(&term.of.jets))
        });
        let outer = Formula::sum(outer);
        if group.expansions.is_empty() {
            let front = self.over(&sign, group.divided.then_some(divisor), &outer);
            return Formula::product([front.0, front.1]);
        }
        let expansions = group.expansions.iter().map(|term| {
            let law = term.of.law.map(|id| (id, Rational::one()));
            let law: Factors = law.into_iter().collect();
            self.product(&term.number, &law, self.jets(&term.of.jets))
        });
        let (number, outer) = match (group.outer.as_slice(), outer) {
            // A number stands before the expansion.
            ([one], _) => (
                one.number.clone(),
                Formula::product(self.jets(&one.of.jets)),
            ),
            (_, outer) => (sign, outer),
        };
        let base = self.letters.product(self.graph, &common);
        let product = Formula::product([base, Formula::sum(expansions), outer]);
        let (front, product) = self.over(&number, group.divided.then_some(divisor), &product);
        Formula::product([front, product])
    }

    /// number/divisor, and what it stands before: 2/n⁰ rather than 1/n⁰ 2.
    fn over(&self, number: &Rational, divisor: Option<Id>, what: &Formula) -> (Formula, Formula) {
        let Some(divisor) = divisor else {
            return (Formula::number(number), what.clone());
        };
        let (sign, what) = match what {
            Formula::Negative(inside) => (true, (**inside).clone()),
            positive => (false, positive.clone()),
        };
        let (mut above, mut after) = (number.abs(), what);
        if let Formula::Product(factors) = &after
            && let [Formula::Number(value), factors @ ..] = factors.as_slice()
            && value.is_integer()
        {
            above *= value;
            after = Formula::product(factors.iter().cloned());
        }
        let below = self.letters.formula(self.graph, divisor);
        let front = if above.is_integer() {
            Formula::fraction(Formula::Number(above), below)
        } else {
            Formula::product([
                Formula::fraction(Formula::one(), below),
                Formula::Number(above),
            ])
        };
        (front.signed(number.is_negative() != sign), after)
    }

    /// number · Π factors · Π what
    fn product(
        &self,
        number: &Rational,
        factors: &[(Id, Rational)],
        what: Vec<Formula>,
    ) -> Formula {
        let front = [
            Formula::number(number),
            self.letters.product(self.graph, factors),
        ];
        Formula::product(front.into_iter().chain(what))
    }

    /// Π jets, equal ones as a power.
    fn jets(&self, monomial: &[Jet]) -> Vec<Formula> {
        let runs = monomial.chunk_by(|a, b| a == b).map(|run| {
            let jet = self.letters.jet(run[0], Mark::Prime);
            Formula::power(jet, &Rational::from_integer(run.len().into()))
        });
        runs.collect()
    }
}

/// An expression as a number times factors.
fn factors(graph: &Graph, id: Id) -> (Rational, Factors) {
    match graph.node(id) {
        Node::Number(value) => (value.clone(), Vec::new()),
        Node::Product(factors) => (Rational::one(), factors.clone()),
        Node::Sum(constant, terms) if terms.len() == 1 && *constant == Rational::default() => {
            let (number, factors) = factors(graph, terms[0].0);
            (number * &terms[0].1, factors)
        }
        _ => (Rational::one(), vec![(id, Rational::one())]),
    }
}

/// Values by key, keys in the order in which they first come.
fn gather<K: PartialEq, V>(pairs: impl Iterator<Item = (K, V)>) -> Vec<(K, Vec<V>)> {
    let mut gathered: Vec<(K, Vec<V>)> = Vec::new();
    for (key, value) in pairs {
        match gathered.iter_mut().find(|(present, _)| *present == key) {
            Some((_, values)) => values.push(value),
            None => gathered.push((key, vec![value])),
        }
    }
    gathered
}

/// Removes from `jets` one jet for each field that the law is differentiated by, the lowest
/// derivative first: what the Taylor series of the law brought with it.
fn take_jets_of(atom: &LawAtom, jets: &mut Monomial) -> Monomial {
    let mut taken = Monomial::new();
    for (field, &order) in atom.index.pairs() {
        for _ in 0..order {
            let of_field = |j: &&Jet| j.of == field;
            let lowest = jets
                .iter()
                .filter(of_field)
                .min_by_key(|j| j.t + j.x + j.y)
                .copied();
            if let Some(position) = lowest.and_then(|jet| jets.iter().position(|j| *j == jet)) {
                taken.push(jets.remove(position));
            }
        }
    }
    taken.sort_unstable();
    taken
}
