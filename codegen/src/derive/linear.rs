//! The linear operator and its adjoint as lists of coefficients.
//!
//! L = Σ c(y) ∂x^a |∂x|^b ∂y^d per (row, field); the mass matrix M0 likewise, with one ∂t.

use crate::form::Form;
use crate::graph::{BalanceId, FieldId, Graph, Id, Jet, Rational, Table, Variable};
use num_traits::One;
use std::collections::BTreeMap;

/// coefficient(y) · ∂(jet): a term of an operator from columns to rows.
#[derive(Clone, Copy, Debug)]
pub struct Term<Row, Column> {
    /// The row that holds the term.
    pub row: Row,
    /// The derivative it multiplies.
    pub jet: Jet<Column>,
    /// Its coefficient.
    pub coefficient: Id,
}

/// A term of L or M0, which take fields to balances.
pub type DirectTerm = Term<BalanceId, FieldId>;

/// A term of L† or M0†, which take the adjoint fields of balances to fields.
pub type AdjointTerm = Term<FieldId, BalanceId>;

/// The terms of M0 and L, from the expanded balances M ∂t X − R = 0, one form for each balance. Linear terms with one ∂t
/// belong to M0. Those without ∂t belong to −L, so that their sign changes.
pub fn linear_operator(graph: &mut Graph, forms: &Table<BalanceId, Form>) -> Vec<DirectTerm> {
    let mut terms = Vec::new();
    for (row, form) in forms.pairs() {
        for (monomial, &coefficient) in &form.degree(1).terms {
            let jet = monomial[0];
            let coefficient = if jet.t == 0 {
                graph.neg(coefficient)
            } else {
                coefficient
            };
            terms.push(Term {
                row,
                jet,
                coefficient,
            });
        }
    }
    terms
}

/// L† and M0† by integration by parts, without the boundary terms:
/// ⟨Y, c ∂x^a |∂x|^b ∂y^d X⟩ = ⟨(−1)^(a+d) ∂x^a |∂x|^b ∂y^d (c Y), X⟩ + …
pub fn adjoint_operator(graph: &mut Graph, terms: &[DirectTerm]) -> Vec<AdjointTerm> {
    let mut sums: BTreeMap<(FieldId, Jet<BalanceId>), Id> = BTreeMap::new();
    for term in terms {
        let order = term.jet.y;
        let odd = (term.jet.x + order) % 2 == 1;
        let mut derivative = term.coefficient;
        let mut binomial = Rational::one();
        // ∂^d (c Y) = Σ_l binomial(d, l) c^(l) ∂^(d−l) Y
        for l in 0..=order {
            let jet = Jet {
                y: order - l,
                ..term.jet.about(term.row)
            };
            let sign = if odd {
                -binomial.clone()
            } else {
                binomial.clone()
            };
            let coefficient = graph.scale(derivative, sign);
            let key = (term.jet.of, jet);
            let total = match sums.get(&key) {
                Some(&present) => graph.add(present, coefficient),
                None => coefficient,
            };
            sums.insert(key, total);
            derivative = graph.differentiate(derivative, Variable::AlongBase);
            binomial = binomial * Rational::from_integer(i64::from(order - l).into())
                / Rational::from_integer((i64::from(l) + 1).into());
        }
    }
    let mut adjoint = Vec::new();
    for ((row, jet), coefficient) in sums {
        let coefficient = graph.collect(coefficient);
        if !graph.vanishes(coefficient) {
            adjoint.push(Term {
                row,
                jet,
                coefficient,
            });
        }
    }
    adjoint
}
