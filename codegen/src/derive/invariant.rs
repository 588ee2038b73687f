//! Integrals that the balances keep, nonlinear terms included: their search, and the proof to the order of the
//! derivation.
//!
//! S = Σ_i ℓ_i (balance i) is a divergence in x, y and t if and only if its variational derivative by every field
//! vanishes, E_q S = Σ_J (−∂)^J ∂S/∂q_J = 0; what integration by parts then leaves at the two ends must vanish under the
//! boundary conditions. The multiplier may hold fields beyond zeroth order (u · mass + momentum): Σ ℓ_i P_i + Σ x q'_j P_k
//! with numbers x that the second degree determines.

use super::boundary::Reduced;
use super::closure::CaseClosure;
use super::deriver::Deriver;
use super::mean::MeanWalls;
use super::wall::{BaseRules, CaseProblem, at_end};
use crate::form::Form;
use crate::formula::{Arrangement, Formula, Mark, plain};
use crate::graph::{
    BalanceId, FieldId, Graph, Id, Jet, LinearSystem, Operator, Rational, Variable,
};
use crate::model::End;
use num_traits::One;
use std::collections::BTreeSet;

/// Conditions of one end solved for jets without ∂x: each says jet = −Σ coefficient · jets.
pub(super) type EndRules = Vec<(Jet, Vec<(Jet, Id)>)>;

/// No proof either way: |∂x| in products, or nonlinear conditions at an end.
pub(super) struct Undecided;

/// The problem, its boundary forms and the conditions at its ends, which every proof reads.
pub(super) struct Proof<'a> {
    pub problem: &'a CaseProblem<'a>,
    pub walls: &'a MeanWalls,
    pub rules: &'a BaseRules,
    /// Each end with its coordinate and its conditions as rules; `None` if they are nonlinear or hold |∂x|.
    pub ends: Vec<(End, Id, Option<EndRules>)>,
}

/// The conditions of one end as rules `jet = −Σ coefficient · free jets`; `None` if they are nonlinear, or hold |∂x| or ∂t.
pub(super) fn end_rules(
    problem: &CaseProblem,
    reduced: Option<&Vec<(End, Reduced<FieldId>)>>,
    end: End,
) -> Option<EndRules> {
    let mut walls = problem.walls.iter().filter(|wall| wall.end == end);
    if walls.any(|wall| wall.form.highest_degree() > 1) {
        return None;
    }
    let (_, reduced) = reduced?.iter().find(|(at, _)| *at == end)?;
    let mut rules = EndRules::new();
    for (jet, combination) in &reduced.rules {
        let mut terms = Vec::new();
        for (free, symbol) in combination {
            for (&(x, absx), &coefficient) in symbol {
                if absx > 0 {
                    return None;
                }
                terms.push((Jet { x, ..*free }, coefficient));
            }
        }
        if jet.t > 0 {
            return None;
        }
        rules.push((*jet, terms));
    }
    Some(rules)
}

impl Proof<'_> {
    /// The integrals that the case keeps beside `declared`, as a spec would name them.
    pub fn undeclared(&self, deriver: &mut Deriver, declared: &[CaseClosure]) -> Vec<String> {
        let mut words = Vec::new();
        let mut densities: Vec<Vec<(Jet, Id)>> = Vec::new();
        let columns = self.columns(deriver);
        for column in self.null(deriver, &columns) {
            let linear = self.walls.density(deriver, self.problem, &column);
            let named: Vec<Vec<(Jet, Id)>> = declared
                .iter()
                .filter_map(CaseClosure::density)
                .map(|density| density.linear.clone())
                .chain(densities.iter().cloned())
                .collect();
            if linear.is_empty() || depends(deriver, &linear, &named) {
                continue;
            }
            if let Ok(Some(sum)) = self.kept(deriver, &column) {
                let moving = |m: &Vec<Jet>| m.len() > 1 && m.iter().any(|jet| jet.t > 0);
                let more = if sum.terms.keys().any(moving) {
                    " to first order, with products beyond it"
                } else {
                    ""
                };
                words.push(format!("integral({}){more}", written(deriver, &linear)));
                densities.push(linear);
            }
        }
        words
    }

    /// Weights ℓ_i that a balance may have in a divergence: its divisor, and its divisor times the coordinate.
    fn columns(&self, deriver: &mut Deriver) -> Vec<(BalanceId, Id)> {
        let mut columns = Vec::new();
        for (row, &divisor) in self.problem.divisors.pairs() {
            columns.push((row, divisor));
            if deriver.model.interval.is_some() {
                let coordinate = deriver.graph.coordinate();
                columns.push((row, deriver.graph.mul(divisor, coordinate)));
            }
        }
        columns
    }

    /// Sums of columns, with numbers as factors, that L† maps to zero.
    fn null(
        &self,
        deriver: &mut Deriver,
        columns: &[(BalanceId, Id)],
    ) -> Vec<Vec<(BalanceId, Id)>> {
        let images: Vec<_> = columns
            .iter()
            .map(|&column| self.walls.image(deriver, self.problem, &[column]))
            .collect();
        let mut sums = Vec::new();
        for last in 0..columns.len() {
            // Σ_c x_c L†ℓ_c = −L†ℓ_last, one equation for each field, with numbers x_c
            let mut system = LinearSystem::new(deriver.graph, last);
            for field in deriver.model.profiles() {
                let entries = (0..last).map(|c| (c, images[c][field])).collect();
                let right = deriver.graph.neg(images[last][field]);
                system.equation(deriver.graph, entries, Some(right));
            }
            let Some(solution) = system.solve(deriver.graph) else {
                continue;
            };
            let mut sum: Vec<(BalanceId, Id)> = vec![columns[last]];
            let mut is_constant = true;
            for (c, factor) in solution {
                if deriver.graph.vanishes(factor) {
                    continue;
                }
                is_constant &= is_number(deriver, factor);
                let (row, weight) = columns[c];
                let part = deriver.graph.mul(factor, weight);
                match sum.iter_mut().find(|(balance, _)| *balance == row) {
                    Some((_, total)) => *total = deriver.graph.add(*total, part),
                    None => sum.push((row, part)),
                }
            }
            if is_constant && self.walls.vanish_for(deriver, &sum) {
                sums.push(sum);
            }
        }
        sums
    }

    /// Σ ℓ_i P_i with corrections, if it is a divergence whose flux through the ends vanishes; `None` if it is not.
    ///
    /// # Errors
    /// No proof either way.
    pub fn kept(
        &self,
        deriver: &mut Deriver,
        column: &[(BalanceId, Id)],
    ) -> Result<Option<Form>, Undecided> {
        let order = deriver.order;
        // S = Σ_i ℓ_i P_i
        let mut sum = Form::default();
        for &(row, weight) in column {
            let balance = self.balance(deriver, row, weight, order);
            sum.add(deriver.graph, &balance, &Rational::one());
        }
        sum.terms.remove(&Vec::new());
        // E_q S = 0 at the second degree, if need be with the correction Σ x q'_j P_k
        if !is_divergence(deriver, &sum, 2)? {
            let Some(correction) = self.correction(deriver, &sum)? else {
                return Ok(None);
            };
            sum.add(deriver.graph, &correction, &Rational::one());
        }
        let is_kept = is_divergence(deriver, &sum, order)? && self.is_closed(deriver, &sum)?;
        Ok(is_kept.then_some(sum))
    }

    /// A balance times a weight, over its divisor.
    fn balance(&self, deriver: &mut Deriver, row: BalanceId, weight: Id, order: usize) -> Form {
        let factor = deriver.graph.div(weight, self.problem.divisors[row]);
        let form = self.problem.balances[row].times(deriver.graph, factor);
        let terms = form.terms.into_iter().filter(|(m, _)| m.len() <= order);
        Form {
            terms: terms.collect(),
        }
    }

    /// Σ x q'_j P_k that makes the second degree of a sum a divergence.
    fn correction(&self, deriver: &mut Deriver, sum: &Form) -> Result<Option<Form>, Undecided> {
        let order = deriver.order;
        let fields: Vec<FieldId> = deriver.model.profiles().collect();
        let one = deriver.graph.one();
        let mut products = Vec::new();
        for row in self.problem.balances.ids() {
            let balance = self.balance(deriver, row, one, order);
            for &field in &fields {
                let mut factor = Form::default();
                factor.terms.insert(vec![Jet::value(field)], one);
                products.push(balance.multiply(deriver.graph, &factor, order));
            }
        }
        // E_q (S + Σ x q'_j P_k) = 0: one equation for each field and each monomial
        let mut system = LinearSystem::new(deriver.graph, products.len());
        for &field in &fields {
            let right = variation(deriver.graph, &sum.degree(2), field)?;
            let mut left = Vec::new();
            for product in &products {
                left.push(variation(deriver.graph, &product.degree(2), field)?);
            }
            let all = left
                .iter()
                .chain([&right])
                .flat_map(|form| form.terms.keys());
            for monomial in all.cloned().collect::<BTreeSet<_>>() {
                let entries = left.iter().enumerate();
                let entries = entries.filter_map(|(c, f)| Some((c, *f.terms.get(&monomial)?)));
                let value = right.terms.get(&monomial).copied();
                let value = value.map(|value| deriver.graph.neg(value));
                system.equation(deriver.graph, entries.collect(), value);
            }
        }
        let Some(factors) = system.solve(deriver.graph) else {
            return Ok(None);
        };
        let mut correction = Form::default();
        for (c, factor) in factors {
            if !is_number(deriver, factor) {
                return Ok(None);
            }
            let part = products[c].times(deriver.graph, factor);
            correction.add(deriver.graph, &part, &Rational::one());
        }
        Ok(Some(correction))
    }

    /// Whether the boundary terms of integration by parts vanish at the ends, up to derivatives along them.
    fn is_closed(&self, deriver: &mut Deriver, sum: &Form) -> Result<bool, Undecided> {
        if deriver.model.interval.is_none() {
            return Ok(true);
        }
        for degree in 1..=deriver.order {
            // The flux at an end, in the jets that the conditions leave free, integrates to zero along x and t if its
            // variational derivative by every free jet vanishes.
            let flux = flux(deriver.graph, &sum.degree(degree));
            for (end, place, said) in &self.ends {
                if flux.terms.is_empty() {
                    continue;
                }
                let there = self.at(
                    deriver,
                    &flux,
                    *end,
                    *place,
                    said.as_ref().ok_or(Undecided)?,
                );
                let free: BTreeSet<(FieldId, u8)> =
                    there.terms.keys().flatten().map(|j| (j.of, j.y)).collect();
                for (field, y) in free {
                    let chosen = |jet: &Jet| jet.of == field && jet.y == y;
                    let left = variation_by(deriver.graph, &there, chosen, Along::TheEnd)?;
                    for id in left.terms.values() {
                        let id = at_end(deriver.graph, *place, *end, self.rules, *id);
                        if !deriver.vanishes_opened(id) {
                            return Ok(false);
                        }
                    }
                }
            }
        }
        Ok(true)
    }

    /// A form at one end, its conditions used.
    fn at(&self, deriver: &mut Deriver, form: &Form, end: End, place: Id, said: &EndRules) -> Form {
        let graph = &mut *deriver.graph;
        let mut result = Form::default();
        for (monomial, &coefficient) in &form.terms {
            let coefficient = at_end(graph, place, end, self.rules, coefficient);
            let mut product = Form::constant(graph, coefficient);
            for jet in monomial {
                let factor = solved(graph, *jet, said);
                product = product.multiply(graph, &factor, usize::MAX);
            }
            result.add(graph, &product, &Rational::one());
        }
        result
    }
}

/// A linear density in the notation of the balances.
fn written(deriver: &Deriver, density: &[(Jet, Id)]) -> String {
    let letters = deriver.model.letters(Arrangement::Flat);
    let terms = density.iter().map(|&(jet, weight)| {
        let jet = letters.jet(jet, Mark::None);
        letters.scaled(deriver.graph, weight, vec![jet])
    });
    plain(&Formula::sum(terms))
}

/// A jet at an end by the jets that the conditions leave free.
fn solved(graph: &mut Graph, jet: Jet, said: &EndRules) -> Form {
    let mut form = Form::default();
    let rule = said.iter().find(|(about, _)| {
        *about
            == Jet {
                x: 0,
                t: 0,
                absx: 0,
                ..jet
            }
    });
    match rule {
        None => {
            let one = graph.one();
            form.accumulate(graph, vec![jet], one);
        }
        Some((_, terms)) => {
            for (free, coefficient) in terms {
                let coefficient = graph.neg(*coefficient);
                let free = Jet {
                    x: free.x + jet.x,
                    t: free.t + jet.t,
                    ..*free
                };
                form.accumulate(graph, vec![free], coefficient);
            }
        }
    }
    form
}

/// The directions whose total derivatives integrate to zero.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Along {
    /// x, y and t.
    TheInterior,
    /// x and t.
    TheEnd,
}

/// E_q of a form; undecided where products hold |∂x|.
fn variation(graph: &mut Graph, form: &Form, field: FieldId) -> Result<Form, Undecided> {
    variation_by(graph, form, |jet| jet.of == field, Along::TheInterior)
}

fn variation_by(
    graph: &mut Graph,
    form: &Form,
    chosen: impl Fn(&Jet) -> bool,
    along: Along,
) -> Result<Form, Undecided> {
    let mut total = Form::default();
    for (monomial, &coefficient) in &form.terms {
        let is_nonlocal = monomial.iter().any(|jet| jet.absx > 0);
        if is_nonlocal && monomial.len() > 1 {
            return Err(Undecided);
        }
        for (position, jet) in monomial.iter().enumerate().filter(|(_, jet)| chosen(jet)) {
            if is_nonlocal {
                continue;
            }
            let mut factors = monomial.clone();
            factors.remove(position);
            let mut part = Form::default();
            part.terms.insert(factors, coefficient);
            let y = if along == Along::TheInterior {
                jet.y
            } else {
                0
            };
            let orders = [
                (Operator::Dx, jet.x),
                (Operator::Dt, jet.t),
                (Operator::Dy, y),
            ];
            part = derived(graph, part, &orders);
            let sign = if (jet.x + jet.t + y) % 2 == 1 {
                -Rational::one()
            } else {
                Rational::one()
            };
            total.add(graph, &part, &sign);
        }
    }
    Ok(total)
}

fn derived(graph: &mut Graph, mut form: Form, orders: &[(Operator, u8)]) -> Form {
    for &(operator, times) in orders {
        for _ in 0..times {
            form = form.differentiate(graph, operator);
        }
    }
    form
}

/// Whether every variational derivative of the degrees from 2 to `order` vanishes; the first degree is L†ℓ = 0.
fn is_divergence(deriver: &mut Deriver, sum: &Form, order: usize) -> Result<bool, Undecided> {
    let uniform = sum
        .terms
        .keys()
        .flatten()
        .any(|jet| deriver.uniform[jet.of]);
    if uniform {
        return Ok(false);
    }
    for degree in 2..=order {
        for field in deriver.model.profiles() {
            let left = variation(deriver.graph, &sum.degree(degree), field)?;
            for &id in left.terms.values() {
                if !deriver.vanishes_opened(id) {
                    return Ok(false);
                }
            }
        }
    }
    Ok(true)
}

/// The boundary terms of a homogeneous divergence of degree d after integration by parts in y:
/// 1/d Σ_J Σ_l (−1)^l ∂y^l[(−∂x)^a (−∂t)^c ∂S/∂q_J] ∂y^(b−1−l) q.
fn flux(graph: &mut Graph, form: &Form) -> Form {
    let mut total = Form::default();
    for (monomial, &coefficient) in &form.terms {
        // |∂x| of an average over x is zero.
        if monomial.iter().any(|jet| jet.absx > 0) {
            continue;
        }
        let share = Rational::new(1.into(), (monomial.len() as i64).into());
        for (position, jet) in monomial.iter().enumerate() {
            let mut factors = monomial.clone();
            factors.remove(position);
            let mut remainder = Form::default();
            remainder.terms.insert(factors, coefficient);
            let mut remainder = derived(
                graph,
                remainder,
                &[(Operator::Dx, jet.x), (Operator::Dt, jet.t)],
            );
            let mut is_negative = (jet.x + jet.t) % 2 == 1;
            for l in 0..jet.y {
                let one = graph.one();
                let mut factor = Form::default();
                let value = Jet {
                    y: jet.y - 1 - l,
                    ..Jet::value(jet.of)
                };
                factor.terms.insert(vec![value], one);
                let product = remainder.multiply(graph, &factor, usize::MAX);
                let sign = if is_negative {
                    -share.clone()
                } else {
                    share.clone()
                };
                total.add(graph, &product, &sign);
                remainder = remainder.differentiate(graph, Operator::Dy);
                is_negative = !is_negative;
            }
        }
    }
    total
}

/// Whether an expression does not depend on y.
fn is_number(deriver: &mut Deriver, id: Id) -> bool {
    let slope = deriver.graph.differentiate(id, Variable::AlongBase);
    deriver.vanishes_opened(slope)
}

/// Whether a density is Σ number · density over `basis`: the weight of every jet has to agree.
fn depends(deriver: &mut Deriver, density: &[(Jet, Id)], basis: &[Vec<(Jet, Id)>]) -> bool {
    let jets = basis.iter().flatten().chain(density).map(|(jet, _)| *jet);
    let jets: BTreeSet<Jet> = jets.collect();
    let weight = |of: &[(Jet, Id)], jet: Jet| of.iter().find(|(j, _)| *j == jet).map(|(_, id)| *id);
    let mut system = LinearSystem::new(deriver.graph, basis.len());
    for jet in jets {
        let factors = basis.iter().enumerate();
        let factors = factors.filter_map(|(column, of)| Some((column, weight(of, jet)?)));
        system.equation(deriver.graph, factors.collect(), weight(density, jet));
    }
    let solution = system.solve(deriver.graph);
    solution.is_some_and(|factors| factors.iter().all(|&(_, id)| is_number(deriver, id)))
}
