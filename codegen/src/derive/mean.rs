//! The problem at k = 0: null functions ℓ(y) of L†, and the boundary form that they leave at the two ends.

use super::boundary::{
    BoundaryForm, Combination, Reduced, Simplifier, at_zero_wavenumber, boundary_form, demands,
    reduce, split,
};
use super::closure::CaseClosure;
use super::deriver::Deriver;
use super::linear::{AdjointTerm, DirectTerm};
use super::wall::{BaseRules, CaseProblem, at_end};
use crate::graph::{BalanceId, FieldId, Graph, Id, Jet, LinearSystem, Rational, Table, Variable};
use crate::model::End;
use landau_contract::Id as _;
use num_traits::One;

/// The column M0 w of a density with weights w: Σ_j m_ij w_j for each balance i.
pub(super) fn carried(
    deriver: &mut Deriver,
    linear: &[DirectTerm],
    density: &[(Jet, Id)],
) -> Vec<(BalanceId, Id)> {
    let mut column = Vec::new();
    for (jet, weight) in density {
        let time = Jet { t: 1, ..*jet };
        for term in linear.iter().filter(|t| t.jet == time) {
            column.push((term.row, deriver.graph.mul(term.coefficient, *weight)));
        }
    }
    column
}

/// ℓ with M0†ℓ = density, by elimination in the mass matrix; `None` if there is none, or the density holds ∂y.
pub(super) fn multiplier(
    deriver: &mut Deriver,
    linear: &[DirectTerm],
    density: &[(Jet, Id)],
) -> Option<Vec<(BalanceId, Id)>> {
    let graph = &mut *deriver.graph;
    if density.is_empty() || density.iter().any(|(j, _)| j.y > 0) {
        return None;
    }
    let mut fields: Vec<FieldId> = linear
        .iter()
        .filter(|t| t.jet.t == 1)
        .map(|t| t.jet.of)
        .chain(density.iter().map(|(jet, _)| jet.of))
        .collect();
    fields.sort_unstable();
    fields.dedup();
    // One equation for each field j: Σ_i m_ij ℓ_i = w_j.
    let mut system = LinearSystem::new(graph, deriver.model.balances.len());
    for field in fields {
        let mass = linear.iter().filter(|t| t.jet.of == field && t.jet.t == 1);
        let plain = mass.filter(|t| t.jet.x == 0 && t.jet.absx == 0 && t.jet.y == 0);
        let coefficients = plain.map(|t| (t.row.index(), t.coefficient)).collect();
        let weight = density.iter().find(|(jet, _)| jet.of == field);
        system.equation(graph, coefficients, weight.map(|(_, weight)| *weight));
    }
    let solution = system.solve(graph)?.into_iter();
    Some(
        solution
            .filter(|(_, weight)| !graph.vanishes(*weight))
            .map(|(row, weight)| (BalanceId::at(row), weight))
            .collect(),
    )
}

/// Whether L†ℓ = 0 and the boundary form vanishes, at k = 0. L†ℓ may also be a multiple of the density of an integral in
/// `declared`, which is conserved: in a Jordan block ∫u changes by ∫v, which stays zero.
pub(super) fn conserved(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    walls: &MeanWalls,
    column: &[(BalanceId, Id)],
    declared: &[CaseClosure],
) -> bool {
    let image = image(deriver, problem.adjoint, column, 0);
    let null = image.iter().all(|&id| deriver.vanishes_opened(id));
    if !null
        && !declared
            .iter()
            .any(|closure| is_multiple(deriver.graph, &image, closure))
    {
        return false;
    }
    walls.vanish(deriver, &walls.operator, column)
}

/// L†ℓ (`time` = 0) or M0†ℓ (`time` = 1) at k = 0: Σ c ∂y^d ℓ_i over the terms c ∂y^d of each field's row, without those
/// that hold ∂x.
fn image(
    deriver: &mut Deriver,
    adjoint: &[AdjointTerm],
    column: &[(BalanceId, Id)],
    time: u8,
) -> Table<FieldId, Id> {
    let mut image: Table<FieldId, Id> = Table::default();
    for field in deriver.model.profiles() {
        let mut total = deriver.graph.zero();
        let terms = adjoint.iter().filter(|t| t.row == field);
        for term in terms.filter(|t| t.jet.t == time && Jet { t: 0, ..t.jet }.is_base()) {
            let Some((_, weight)) = column.iter().find(|(row, _)| *row == term.jet.of) else {
                continue;
            };
            let derivative = along_base(deriver.graph, *weight, term.jet.y);
            let product = deriver.graph.mul(term.coefficient, derivative);
            total = deriver.graph.add(total, product);
        }
        image.push(total);
    }
    image
}

/// Boundary forms and conditions at k = 0: the terms without ∂x.
pub(super) struct MeanWalls {
    /// The boundary form of L.
    operator: BoundaryForm,
    /// That of M0, which acts on ∂t X: the conditions hold for it as they do for X.
    mass: BoundaryForm,
    /// The conditions of each end, solved, and its coordinate.
    ends: Vec<(End, Id, Reduced<FieldId>)>,
    rules: BaseRules,
}

pub(super) fn mean_walls(
    deriver: &mut Deriver,
    problem: &CaseProblem,
    rules: &BaseRules,
) -> MeanWalls {
    let mean = |time: u8| {
        let terms = problem.linear.iter().filter(move |t| t.jet.t == time);
        terms.map(|t| DirectTerm {
            jet: Jet { t: 0, ..t.jet },
            ..*t
        })
    };
    let terms = |time| mean(time).filter(|t| t.jet.is_base()).collect::<Vec<_>>();
    let operator = boundary_form(deriver.graph, &terms(0));
    let mass = boundary_form(deriver.graph, &terms(1));
    let mut ends = Vec::new();
    for end in End::BOTH {
        let place = deriver.place(end);
        let rows = problem.walls.iter().filter(|c| c.end == end).map(|wall| {
            let mut row = Combination::new();
            for (monomial, &coefficient) in &wall.form.degree(1).terms {
                let (jet, symbol) = split(monomial[0], coefficient);
                if symbol.contains_key(&(0, 0)) {
                    row.insert(jet, symbol);
                }
            }
            row
        });
        let rows: Vec<_> = rows.collect();
        let mut simplify = |graph: &mut Graph, id| at_end(graph, place, end, rules, id);
        let mut simplifier = Simplifier {
            at_end: &mut simplify,
        };
        // Every term of a row is without ∂x, so that the elimination always has a pivot.
        if let Ok(reduced) = reduce(deriver.graph, rows, &mut simplifier) {
            ends.push((end, place, reduced));
        }
    }
    MeanWalls {
        operator,
        mass,
        ends,
        rules: rules.clone(),
    }
}

impl MeanWalls {
    /// L†ℓ at k = 0, field by field.
    pub fn image(
        &self,
        deriver: &mut Deriver,
        problem: &CaseProblem,
        column: &[(BalanceId, Id)],
    ) -> Table<FieldId, Id> {
        image(deriver, problem.adjoint, column, 0)
    }

    /// M0†ℓ at k = 0: jets with weights.
    pub fn density(
        &self,
        deriver: &mut Deriver,
        problem: &CaseProblem,
        column: &[(BalanceId, Id)],
    ) -> Vec<(Jet, Id)> {
        let image = image(deriver, problem.adjoint, column, 1);
        let weights = image.pairs().map(|(field, &id)| (Jet::value(field), id));
        let weights: Vec<_> = weights.collect();
        let present = weights.into_iter();
        present
            .filter(|(_, id)| !deriver.vanishes_opened(*id))
            .collect()
    }

    /// Whether the boundary forms of L and of M0 vanish for ℓ at both ends.
    pub fn vanish_for(&self, deriver: &mut Deriver, column: &[(BalanceId, Id)]) -> bool {
        self.vanish(deriver, &self.operator, column) && self.vanish(deriver, &self.mass, column)
    }

    /// Whether a boundary form vanishes for ℓ at both ends.
    fn vanish(
        &self,
        deriver: &mut Deriver,
        form: &BoundaryForm,
        column: &[(BalanceId, Id)],
    ) -> bool {
        for (end, place, direct) in &self.ends {
            let (end, place) = (*end, *place);
            let mut simplify = |graph: &mut Graph, id| at_end(graph, place, end, &self.rules, id);
            let mut simplifier = Simplifier {
                at_end: &mut simplify,
            };
            let demanded = demands(deriver.graph, form, direct, &mut simplifier);
            for combination in demanded.values() {
                let mut parts = Vec::new();
                for (jet, id) in at_zero_wavenumber(combination) {
                    let Some((_, weight)) = column.iter().find(|(row, _)| *row == jet.of) else {
                        continue;
                    };
                    let derivative = along_base(deriver.graph, *weight, jet.y);
                    parts.push((deriver.graph.mul(id, derivative), Rational::one()));
                }
                let total = deriver.graph.sum(parts);
                let total = at_end(deriver.graph, place, end, &self.rules, total);
                if !deriver.vanishes_opened(total) {
                    return false;
                }
            }
        }
        true
    }

    /// Whether M0†ℓ is the density, and the boundary form of M0 vanishes for ℓ at both ends.
    pub fn carries(
        &self,
        deriver: &mut Deriver,
        problem: &CaseProblem,
        column: &[(BalanceId, Id)],
        density: &[(Jet, Id)],
    ) -> bool {
        let image = image(deriver, problem.adjoint, column, 1);
        let matches = image.pairs().all(|(field, &total)| {
            let term = density.iter().find(|(jet, _)| *jet == Jet::value(field));
            let expected = term.map_or_else(|| deriver.graph.zero(), |(_, weight)| *weight);
            let difference = deriver.graph.sub(total, expected);
            deriver.vanishes_opened(difference)
        });
        matches && self.vanish(deriver, &self.mass, column)
    }
}

/// Whether Σ_f image_f q_f is a constant times the density of a conserved integral.
fn is_multiple(graph: &mut Graph, image: &Table<FieldId, Id>, closure: &CaseClosure) -> bool {
    let CaseClosure::Conserved { density, .. } = closure else {
        return false;
    };
    let density = &density.linear;
    let Some((first, weight)) = density.first() else {
        return false;
    };
    // image_f = factor · w_f with d factor/dy = 0; the first field of the density gives the factor.
    let factor = graph.divide_terms(image[first.of], *weight);
    let slope = graph.differentiate(factor, Variable::AlongBase);
    if !graph.vanishes(slope) {
        return false;
    }
    image.ids().all(|field| {
        let term = density.iter().find(|(jet, _)| jet.of == field);
        let expected = match term {
            Some((_, weight)) => graph.mul(factor, *weight),
            None => graph.zero(),
        };
        let difference = graph.sub(image[field], expected);
        graph.vanishes(difference)
    })
}

fn along_base(graph: &mut Graph, mut id: Id, order: u8) -> Id {
    for _ in 0..order {
        id = graph.differentiate(id, Variable::AlongBase);
    }
    id
}
