//! Linear equations with expressions as coefficients, solved exactly. A pivot is nonzero by [`Graph::vanishes`].

use super::{Graph, Id};

/// Σ_j a_j x_j = b, equation by equation.
pub struct LinearSystem {
    unknowns: usize,
    /// The coefficients, then the right-hand side.
    rows: Vec<Vec<Id>>,
    zero: Id,
}

impl LinearSystem {
    /// A system without equations.
    pub fn new(graph: &mut Graph, unknowns: usize) -> Self {
        LinearSystem {
            unknowns,
            rows: Vec::new(),
            zero: graph.zero(),
        }
    }

    /// Adds Σ coefficient · unknown = `right` (zero if `None`), from pairs of an unknown's position and a coefficient.
    /// Coefficients of one unknown are summed.
    pub fn equation(
        &mut self,
        graph: &mut Graph,
        coefficients: Vec<(usize, Id)>,
        right: Option<Id>,
    ) {
        let mut row = vec![self.zero; self.unknowns + 1];
        for (unknown, coefficient) in coefficients {
            row[unknown] = graph.add(row[unknown], coefficient);
        }
        row[self.unknowns] = right.unwrap_or(self.zero);
        self.rows.push(row);
    }

    /// Solves by Gauss–Jordan elimination. The answer lists each unknown that has a pivot, with its value where the
    /// unknowns without a pivot are zero; `None` if the equations contradict each other.
    pub fn solve(mut self, graph: &mut Graph) -> Option<Vec<(usize, Id)>> {
        let mut pivots = Vec::new();
        for column in 0..self.unknowns {
            let rank = pivots.len();
            let mut open = rank..self.rows.len();
            let Some(nonzero) = open.find(|&r| !graph.vanishes(self.rows[r][column])) else {
                continue;
            };
            self.rows.swap(rank, nonzero);
            let pivot = self.rows[rank][column];
            for entry in &mut self.rows[rank] {
                *entry = graph.divide_terms(*entry, pivot);
            }
            let pivot_row = self.rows[rank].clone();
            for (r, row) in self.rows.iter_mut().enumerate() {
                let factor = row[column];
                if r == rank || graph.vanishes(factor) {
                    continue;
                }
                for (entry, &by) in row.iter_mut().zip(&pivot_row) {
                    let product = graph.mul(factor, by);
                    *entry = graph.sub(*entry, product);
                }
            }
            pivots.push(column);
        }
        let right = self.unknowns;
        let mut left_over = self.rows[pivots.len()..].iter();
        if left_over.any(|row| !graph.vanishes(row[right])) {
            return None;
        }
        let solved = pivots.into_iter().zip(&self.rows);
        Some(solved.map(|(column, row)| (column, row[right])).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::LinearSystem;
    use crate::graph::{Graph, ParameterId};

    /// a x + y = b, x + c y = 0: x = b c/(a c − 1), y = −b/(a c − 1).
    #[test]
    fn two_by_two() {
        let mut graph = Graph::new();
        let [a, b, c] = [0, 1, 2].map(|p| graph.parameter(ParameterId(p)));
        let one = graph.one();
        let mut system = LinearSystem::new(&mut graph, 2);
        system.equation(&mut graph, vec![(0, a), (1, one)], Some(b));
        system.equation(&mut graph, vec![(0, one), (1, c)], None);
        let solution = system.solve(&mut graph).expect("a solution");
        let product = graph.mul(a, c);
        let below = graph.sub(product, one);
        let above = graph.mul(b, c);
        let expected = [graph.div(above, below), {
            let quotient = graph.div(b, below);
            graph.neg(quotient)
        }];
        for ((unknown, value), expected) in solution.into_iter().zip(expected) {
            let difference = graph.sub(value, expected);
            assert!(graph.vanishes(difference), "unknown {unknown}");
        }
    }

    #[test]
    fn open_and_contradictory_systems() {
        let mut graph = Graph::new();
        let (one, two) = (graph.one(), graph.integer(2));
        let mut system = LinearSystem::new(&mut graph, 2);
        system.equation(&mut graph, vec![(0, one), (1, one)], Some(two));
        let open = system.solve(&mut graph).expect("a solution");
        assert_eq!(open, vec![(0, two)]);
        let mut system = LinearSystem::new(&mut graph, 1);
        system.equation(&mut graph, vec![(0, one)], Some(one));
        system.equation(&mut graph, vec![(0, one)], Some(two));
        assert!(system.solve(&mut graph).is_none());
    }
}
