//! Operators grouped as the literature groups them, where a formula has two dimensions to stand in.
//!
//! An entry of L has its common denominator in front: (1/n⁰)[μ⁰ ∂x² + …]. A row of N has
//! a line for the terms without a law, then its laws one by one: terms that share what multiplies the
//! law's expansion stand together, (κ⁰_n n' + κ⁰_T T') T'_yy, and so do those that share the expansion,
//! (μ⁰_n n' + μ⁰_T T') (2 u'_xx + u'_yy + …).

use super::text::{Writer, signed_sum};
use crate::derive::{Form, Monomial};
use crate::graph::{Id, Jet, LawAtom, LawId, Node, Rational};
use num_traits::{One, Signed};

/// Π base^exponent.
type Factors = Vec<(Id, Rational)>;

/// A number and what it multiplies.
type Scaled<T> = (Rational, T);

/// What the expansion of a law contributes to a term: one of its derivatives, and the jets that go
/// with it.
type Expansion = (Option<Id>, Monomial);

/// The rest of a term: base-state factors and jets.
type Outer = (Factors, Monomial);

/// One product of a coefficient's sum, with the jets of its term.
struct Piece {
    divided: bool,
    law: Option<LawId>,
    number: Rational,
    inner: Expansion,
    outer: Outer,
}

impl Writer<'_> {
    /// Σ coefficient · what, common denominators in front of a bracket.
    pub(super) fn over_common_denominator(&self, terms: &[(Id, String)]) -> String {
        let mut common: Option<Factors> = None;
        for (coefficient, _) in terms {
            let (_, factors) = self.factors(*coefficient);
            let below = factors.into_iter().filter(|(_, e)| e.is_negative());
            common = Some(match common {
                None => below.collect(),
                Some(known) => {
                    let below: Factors = below.collect();
                    let shared = known.into_iter().filter_map(|(base, e)| {
                        let (_, other) = below.iter().find(|(b, _)| *b == base)?;
                        Some((base, e.max(other.clone())))
                    });
                    shared.collect()
                }
            });
        }
        let common = common.filter(|c| terms.len() > 1 && !c.is_empty());
        let Some(common) = common else {
            let parts = terms.iter().map(|(coefficient, what)| match what.as_str() {
                "" => self.printer().print(*coefficient),
                what => self.scaled(*coefficient, what),
            });
            return signed_sum(parts.collect());
        };
        let parts = terms.iter().map(|(coefficient, what)| {
            let (number, mut factors) = self.factors(*coefficient);
            for (base, exponent) in &common {
                let own = factors.iter_mut().find(|(b, _)| b == base);
                if let Some((_, e)) = own {
                    *e -= exponent;
                }
            }
            factors.retain(|(_, e)| *e != Rational::default());
            match (factors.as_slice(), what.as_str()) {
                // A sum that nothing multiplies needs no bracket in a sum.
                ([(sum, e)], "") if e.is_one() && number.is_one() => self.printer().print(*sum),
                _ => self.product(&number, &factors, what),
            }
        });
        let inside = signed_sum(parts.collect());
        let front = self.product(&Rational::one(), &common, "");
        format!("{front} {}", self.notation.square_brackets(&inside))
    }

    /// A row of N, a line an item.
    pub(super) fn grouped_form(&self, form: &Form, divisor: Id) -> Vec<String> {
        let keyed = self.pieces(form, divisor).into_iter();
        let mut lines = gather(keyed.map(|piece| ((piece.divided, piece.law), piece)));
        lines.sort_by_key(|(key, _)| *key);
        let mut rows = Vec::new();
        for ((divided, law), pieces) in lines {
            let mut parts = match law {
                Some(_) => self.by_expansion(pieces),
                None => vec![self.one_by_one(&pieces)],
            };
            if divided {
                parts = parts
                    .iter()
                    .map(|part| self.divided(part, divisor))
                    .collect();
            }
            rows.extend(parts);
        }
        rows
    }

    /// A sum over the divisor of its row.
    fn divided(&self, sum: &str, divisor: Id) -> String {
        let (sign, rest) = match sum.strip_prefix('-') {
            Some(rest) => ("-", rest),
            None => ("", sum),
        };
        // 2/n⁰ rather than 1/n⁰ 2
        let whole = |number: &str| number.bytes().all(|b| b.is_ascii_digit());
        let (number, rest) = match rest.split_once(' ') {
            Some((number, rest)) if whole(number) => (number, rest),
            _ => ("1", rest),
        };
        let below = self.printer().print(divisor);
        format!("{sign}{} {rest}", self.notation.fraction(number, &[below]))
    }

    /// The terms of a form, sums in their coefficients multiplied out.
    fn pieces(&self, form: &Form, divisor: Id) -> Vec<Piece> {
        let mut pieces = Vec::new();
        for (monomial, &coefficient) in &form.terms {
            let (number, factors) = self.factors(coefficient);
            let sum = factors.iter().position(|(base, e)| {
                e.is_one() && matches!(self.node(*base), Node::Sum(..)) && self.law_below(*base)
            });
            let Some(sum) = sum else {
                pieces.push(self.piece(number, factors, monomial, divisor));
                continue;
            };
            let mut others = factors.clone();
            let (sum, _) = others.remove(sum);
            let Node::Sum(constant, terms) = self.node(sum) else {
                continue;
            };
            if *constant != Rational::default() {
                let scaled = number.clone() * constant;
                pieces.push(self.piece(scaled, others.clone(), monomial, divisor));
            }
            for (term, scale) in terms {
                let (inside, mut factors) = self.factors(*term);
                factors.extend(others.clone());
                let number = number.clone() * scale * inside;
                pieces.push(self.piece(number, factors, monomial, divisor));
            }
        }
        pieces
    }

    /// number · Π factors · Π jets, taken apart around its first law.
    fn piece(
        &self,
        number: Rational,
        mut factors: Factors,
        monomial: &Monomial,
        divisor: Id,
    ) -> Piece {
        let minus = -Rational::one();
        let divided = factors.iter().position(|f| *f == (divisor, minus.clone()));
        if let Some(position) = divided {
            factors.remove(position);
        }
        let mut jets = monomial.clone();
        let mut numbered = factors.iter().enumerate();
        let first = numbered.find_map(|(position, (base, e))| match self.node(*base) {
            Node::BaseLaw(atom) if e.is_one() => Some((position, atom)),
            _ => None,
        });
        let (law, inner) = match first {
            None => (None, (None, Vec::new())),
            Some((position, atom)) => {
                let (id, _) = factors.remove(position);
                (Some(atom.law), (Some(id), take_own(atom, &mut jets)))
            }
        };
        factors.sort();
        Piece {
            divided: divided.is_some(),
            law,
            number,
            inner,
            outer: (factors, jets),
        }
    }

    /// Pieces without a law: Σ, in brackets where they are divided and more than one.
    fn one_by_one(&self, pieces: &[Piece]) -> String {
        let bracketed = pieces.len() > 1 && pieces[0].divided;
        let sign = match bracketed {
            true => pieces[0].number.signum(),
            false => Rational::one(),
        };
        let shown = pieces.iter().map(|piece| {
            let (factors, jets) = &piece.outer;
            self.product(&(&piece.number * &sign), factors, &self.jets(jets))
        });
        let sum = signed_sum(shown.collect());
        match bracketed {
            true => self.product(&sign, &[], &self.notation.square_brackets(&sum)),
            false => sum,
        }
    }

    /// Pieces of one law: equal outer parts together, then equal expansions.
    fn by_expansion(&self, pieces: Vec<Piece>) -> Vec<String> {
        let keyed = pieces.into_iter();
        let by_outer = gather(keyed.map(|piece| (piece.outer, (piece.number, piece.inner))));
        let mut keyed = Vec::new();
        for (outer, mut inner) in by_outer {
            inner.sort_by(|(_, (atom, jets)), (_, (other, others))| {
                jets.cmp(others).then(atom.cmp(other))
            });
            let largest = inner.iter().map(|(number, _)| number.abs()).max();
            let size = largest.unwrap_or_else(Rational::one);
            let scale = if inner[0].0.is_negative() {
                -size
            } else {
                size
            };
            inner.iter_mut().for_each(|(number, _)| *number /= &scale);
            keyed.push((inner, (scale, outer)));
        }
        let mut by_inner = gather(keyed.into_iter());
        for (inner, outers) in &mut by_inner {
            // ½ and 1/6 stay with their terms; a number that all terms share stands before them.
            let least = outers.iter().map(|(scale, _)| scale.abs()).min();
            if let (Some(least), false) = (least, inner.iter().all(|(n, _)| n.abs().is_one())) {
                inner.iter_mut().for_each(|(number, _)| *number *= &least);
                outers.iter_mut().for_each(|(scale, _)| *scale /= &least);
            }
        }
        let shown = by_inner
            .iter()
            .map(|(inner, outers)| self.group(inner, outers));
        shown.collect()
    }

    /// (Σ expansion) (Σ outer), brackets where there is more than one.
    fn group(&self, inner: &[Scaled<Expansion>], outers: &[Scaled<Outer>]) -> String {
        let expansion = |(number, (atom, jets)): &Scaled<Expansion>| {
            let factors: Factors = atom.iter().map(|&id| (id, Rational::one())).collect();
            self.product(number, &factors, &self.jets(jets))
        };
        let expansions: Vec<String> = inner.iter().map(expansion).collect();
        let expansion = match expansions.as_slice() {
            [one] => one.clone(),
            _ => self.notation.brackets(&signed_sum(expansions)),
        };
        match outers {
            [(number, (factors, jets))] => {
                let jets = self.jets(jets);
                let what = format!("{expansion} {jets}");
                self.product(number, factors, what.trim_end())
            }
            [(first, (common, _)), ..] => {
                let shared = outers.iter().all(|(_, (factors, _))| factors == common);
                let sign = first.signum();
                let parts = outers.iter().map(|(number, (factors, jets))| {
                    let own = if shared { &[] } else { factors.as_slice() };
                    self.product(&(number * &sign), own, &self.jets(jets))
                });
                let outer = self.notation.brackets(&signed_sum(parts.collect()));
                let common = if shared { common.as_slice() } else { &[] };
                self.product(&sign, common, &format!("{expansion} {outer}"))
            }
            [] => String::new(),
        }
    }

    /// number · Π factors · what.
    fn product(&self, number: &Rational, factors: &[(Id, Rational)], what: &str) -> String {
        let printer = self.printer();
        let mut text = match (factors.is_empty(), number.abs().is_one()) {
            (true, true) => String::new(),
            (true, false) => self.notation.number(&number.abs()),
            (false, true) => printer.product(factors),
            (false, false) => {
                let number = self.notation.number(&number.abs());
                format!("{number} {}", printer.product(factors))
            }
        };
        if !what.is_empty() {
            text = format!("{text} {what}").trim_start().to_owned();
        } else if text.is_empty() {
            text = "1".to_owned();
        }
        match number.is_negative() {
            true => format!("-{text}"),
            false => text,
        }
    }

    /// Π jets, equal ones as a power.
    fn jets(&self, monomial: &[Jet]) -> String {
        let runs = monomial.chunk_by(|a, b| a == b).map(|run| {
            let jet = self.printer().jet(run[0], "'");
            match run.len() {
                1 => jet,
                times => {
                    let times = Rational::from_integer(times.into());
                    self.notation.power(&jet, &times)
                }
            }
        });
        runs.collect::<Vec<_>>().join(" ")
    }

    /// An expression as a number times factors.
    fn factors(&self, id: Id) -> (Rational, Factors) {
        match self.node(id) {
            Node::Number(value) => (value.clone(), Vec::new()),
            Node::Product(factors) => (Rational::one(), factors.clone()),
            Node::Sum(constant, terms) if terms.len() == 1 && *constant == Rational::default() => {
                let (number, factors) = self.factors(terms[0].0);
                (number * &terms[0].1, factors)
            }
            _ => (Rational::one(), vec![(id, Rational::one())]),
        }
    }

    fn node(&self, id: Id) -> &Node {
        self.derivation.model.graph.node(id)
    }

    fn law_below(&self, id: Id) -> bool {
        let graph = &self.derivation.model.graph;
        graph.any(id, |node| matches!(node, Node::BaseLaw(_)))
    }
}

/// Values by key, keys in the order in which they first come.
fn gather<K: PartialEq, V>(pairs: impl Iterator<Item = (K, V)>) -> Vec<(K, Vec<V>)> {
    let mut gathered: Vec<(K, Vec<V>)> = Vec::new();
    for (key, value) in pairs {
        match gathered.iter_mut().find(|(known, _)| *known == key) {
            Some((_, values)) => values.push(value),
            None => gathered.push((key, vec![value])),
        }
    }
    gathered
}

/// Removes from `jets` one jet for each field that the law is differentiated by, the lowest
/// derivative first: what the Taylor series of the law brought with it.
fn take_own(atom: &LawAtom, jets: &mut Monomial) -> Monomial {
    let mut own = Monomial::new();
    for (field, &order) in atom.index.pairs() {
        for _ in 0..order {
            let of_field = |j: &&Jet| j.of == field;
            let lowest = jets
                .iter()
                .filter(of_field)
                .min_by_key(|j| j.t + j.x + j.y)
                .copied();
            if let Some(position) = lowest.and_then(|jet| jets.iter().position(|j| *j == jet)) {
                own.push(jets.remove(position));
            }
        }
    }
    own.sort_unstable();
    own
}
