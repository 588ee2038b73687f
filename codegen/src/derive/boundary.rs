//! The adjoint boundary conditions, by linear algebra on the boundary form.
//!
//! ⟨Y, L X⟩ − ⟨L† Y, X⟩ = [ Σ (−1)^l ∂^l(c Y) ∂x^a ∂y^(d−1−l) X ] between the ends: a bilinear
//! form in the values and derivatives of Y and X there. The direct conditions express some jets of X by
//! the jets that they leave free. The form vanishes for every X if the factor of each free jet vanishes:
//! these factors are the adjoint conditions. Coefficients are simplified by the boundary conditions of
//! the base state.

use super::linear::DirectTerm;
use crate::graph::{BalanceId, FieldId, Graph, Id, Jet, Rational, Variable};
use num_traits::One;
use std::collections::BTreeMap;

/// A polynomial in ∂x and |∂x| with base-state coefficients; |∂x|² is −∂x², so |∂x| stands at most once.
pub type Symbol = BTreeMap<(u8, u8), Id>;

/// A linear combination of jets at one end; jets carry no x-derivatives, the symbols do.
pub type Combination<V> = BTreeMap<Jet<V>, Symbol>;

/// X-jet → combination of Y-jets.
pub type BoundaryForm = BTreeMap<Jet<FieldId>, Combination<BalanceId>>;

/// into += left · right, where |∂x|² = −∂x².
fn symbol_add(graph: &mut Graph, into: &mut Symbol, left: &Symbol, right: &Symbol) {
    for (&(a, b), &coefficient) in left {
        for (&(c, d), &factor) in right {
            let product = graph.mul(coefficient, factor);
            let product = if (b + d) / 2 % 2 == 1 {
                graph.neg(product)
            } else {
                product
            };
            let key = (a + c + 2 * ((b + d) / 2), (b + d) % 2);
            let total = match into.get(&key) {
                Some(&present) => graph.add(present, product),
                None => product,
            };
            into.insert(key, total);
        }
    }
}

/// Simplifies coefficients at one end and drops those that vanish.
pub struct Simplifier<'a> {
    /// Replaces base atoms by the values that the boundary conditions of the base state give them.
    pub at_end: &'a mut dyn FnMut(&mut Graph, Id) -> Id,
}

impl Simplifier<'_> {
    fn symbol(&mut self, graph: &mut Graph, symbol: Symbol) -> Symbol {
        let mut simplified = Symbol::new();
        for (key, id) in symbol {
            let id = (self.at_end)(graph, id);
            let id = graph.collect(id);
            if !graph.vanishes(id) {
                simplified.insert(key, id);
            }
        }
        simplified
    }

    pub fn combination<V: Ord>(
        &mut self,
        graph: &mut Graph,
        combination: Combination<V>,
    ) -> Combination<V> {
        let mut simplified = Combination::new();
        for (jet, symbol) in combination {
            let symbol = self.symbol(graph, symbol);
            if !symbol.is_empty() {
                simplified.insert(jet, symbol);
            }
        }
        simplified
    }
}

/// A jet without its x-derivatives, and these as a symbol with the coefficient.
pub fn split<V: Copy>(jet: Jet<V>, coefficient: Id) -> (Jet<V>, Symbol) {
    let symbol = Symbol::from([((jet.x, jet.absx), coefficient)]);
    (jet.profile(), symbol)
}

/// The entry to eliminate by. Its symbol holds no ∂x, so that the division is exact at every k. Among several such
/// entries the highest y-derivative is taken, and among equal orders the first field.
fn pivot<V: Copy + Ord>(combination: &Combination<V>) -> Option<(Jet<V>, Id)> {
    combination
        .iter()
        .filter(|(_, symbol)| symbol.len() == 1 && symbol.contains_key(&(0, 0)))
        .max_by_key(|(jet, _)| (jet.y, std::cmp::Reverse(jet.of)))
        .map(|(jet, symbol)| (*jet, symbol[&(0, 0)]))
}

/// Reduced conditions: each says `jet = −Σ symbol · free jets`, the free jets being those that no rule is solved for.
#[derive(Clone)]
pub struct Reduced<V> {
    pub rules: Vec<(Jet<V>, Combination<V>)>,
}

/// Gauss–Jordan elimination. `Err` holds a condition without a pivot: the symbol of every jet in it holds ∂x.
pub fn reduce<V: Copy + Ord>(
    graph: &mut Graph,
    conditions: Vec<Combination<V>>,
    simplifier: &mut Simplifier,
) -> Result<Reduced<V>, Combination<V>> {
    let mut open: Vec<Combination<V>> = conditions
        .into_iter()
        .map(|c| simplifier.combination(graph, c))
        .collect();
    let mut reduced = Reduced { rules: Vec::new() };
    loop {
        open.retain(|c| !c.is_empty());
        // The shortest condition goes first: substituting it keeps the remaining conditions short.
        open.sort_by_key(Combination::len);
        let Some(position) = open.iter().position(|c| pivot(c).is_some()) else {
            break;
        };
        let mut row = open.remove(position);
        let Some((jet, coefficient)) = pivot(&row) else {
            break;
        };
        row.remove(&jet);
        for symbol in row.values_mut() {
            for id in symbol.values_mut() {
                *id = graph.divide_terms(*id, coefficient);
            }
        }
        let row = simplifier.combination(graph, row);
        for condition in &mut open {
            let shorter = substitute(graph, condition, jet, &row);
            *condition = simplifier.combination(graph, shorter);
        }
        for (_, rule) in &mut reduced.rules {
            let substituted = substitute(graph, rule, jet, &row);
            *rule = simplifier.combination(graph, substituted);
        }
        reduced.rules.push((jet, row));
    }
    match open.into_iter().next() {
        Some(stuck) => Err(stuck),
        None => {
            reduced.rules.sort_by_key(|(jet, _)| *jet);
            Ok(reduced)
        }
    }
}

/// `combination` with `jet` replaced by −`row`.
fn substitute<V: Copy + Ord>(
    graph: &mut Graph,
    combination: &Combination<V>,
    jet: Jet<V>,
    row: &Combination<V>,
) -> Combination<V> {
    let mut result = combination.clone();
    let Some(factor) = result.remove(&jet) else {
        return result;
    };
    let minus: Symbol = factor
        .into_iter()
        .map(|(key, id)| (key, graph.neg(id)))
        .collect();
    for (jet, symbol) in row {
        symbol_add(graph, result.entry(*jet).or_default(), symbol, &minus);
    }
    result
}

/// The boundary form as X-jet → combination of Y-jets, before any condition is used.
pub fn boundary_form(graph: &mut Graph, terms: &[DirectTerm]) -> BoundaryForm {
    let mut form = BoundaryForm::new();
    for term in terms.iter().filter(|t| t.jet.y > 0) {
        for l in 0..term.jet.y {
            let x_jet = Jet {
                y: term.jet.y - 1 - l,
                ..term.jet.profile()
            };
            let mut derivative = term.coefficient;
            let mut binomial = Rational::one();
            // (−1)^l ∂^l (c Y) = (−1)^l Σ_r binomial(l, r) c^(r) ∂^(l−r) Y
            for r in 0..=l {
                let sign = if l % 2 == 1 {
                    -binomial.clone()
                } else {
                    binomial.clone()
                };
                let y_jet = Jet {
                    y: l - r,
                    ..Jet::value(term.row)
                };
                let coefficient = graph.scale(derivative, sign);
                let unit = Symbol::from([((term.jet.x, term.jet.absx), graph.one())]);
                let symbol = Symbol::from([((0, 0), coefficient)]);
                let entry = form.entry(x_jet).or_default().entry(y_jet).or_default();
                symbol_add(graph, entry, &symbol, &unit);
                derivative = graph.differentiate(derivative, Variable::AlongBase);
                binomial = binomial * Rational::from_integer(i64::from(l - r).into())
                    / Rational::from_integer((i64::from(r) + 1).into());
            }
        }
    }
    form
}

/// One combination of Y-jets for each X-jet that the direct conditions leave free at one end. The boundary form
/// vanishes there if all of them do.
pub fn demands(
    graph: &mut Graph,
    form: &BoundaryForm,
    direct: &Reduced<FieldId>,
    simplifier: &mut Simplifier,
) -> BoundaryForm {
    let mut demands = form.clone();
    for (jet, rule) in &direct.rules {
        let Some(factor) = demands.remove(jet) else {
            continue;
        };
        // X-jet = −Σ symbol · free X-jets
        for (free, symbol) in rule {
            let minus: Symbol = symbol.iter().map(|(k, &id)| (*k, graph.neg(id))).collect();
            for (y_jet, y_symbol) in &factor {
                let entry = demands.entry(*free).or_default().entry(*y_jet).or_default();
                symbol_add(graph, entry, y_symbol, &minus);
            }
        }
    }
    let demands: Vec<_> = demands.into_iter().collect();
    demands
        .into_iter()
        .map(|(jet, combination)| (jet, simplifier.combination(graph, combination)))
        .filter(|(_, combination)| !combination.is_empty())
        .collect()
}

/// A demand on conj(Y) read as a condition on Y: ∂x changes sign under conjugation.
pub fn conjugate<V: Copy + Ord>(graph: &mut Graph, combination: &Combination<V>) -> Combination<V> {
    let mut result = Combination::new();
    for (jet, symbol) in combination {
        let mirrored = symbol.iter().map(|(&(x, absx), &id)| {
            let id = if x % 2 == 1 { graph.neg(id) } else { id };
            ((x, absx), id)
        });
        result.insert(*jet, mirrored.collect());
    }
    result
}

/// A reduced rule written out as a condition: jet + Σ symbol · free jets = 0.
pub fn as_condition<V: Copy + Ord>(
    graph: &mut Graph,
    jet: Jet<V>,
    rule: &Combination<V>,
) -> Combination<V> {
    let mut condition = rule.clone();
    let one = graph.one();
    condition.insert(jet, Symbol::from([((0, 0), one)]));
    condition
}

/// The part of a combination at k = 0.
pub fn at_zero_wavenumber<V: Copy + Ord>(combination: &Combination<V>) -> BTreeMap<Jet<V>, Id> {
    let mut part = BTreeMap::new();
    for (jet, symbol) in combination {
        if let Some(&id) = symbol.get(&(0, 0)) {
            part.insert(*jet, id);
        }
    }
    part
}
