//! Chebyshev points on [−1, 1], barycentric interpolation and differentiation, Clenshaw–Curtis
//! quadrature (Trefethen, Spectral Methods in MATLAB; Berrut & Trefethen 2004).

use crate::numerics::dense::vectorised;
use faer::Mat;
use std::f64::consts::PI;

/// Points at which a series is evaluated at once.
const LANES: usize = 16;

/// A family of points; the number is the count of points.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum GridKind {
    /// Zeros of T_n.
    Gauss(usize),
    /// Extrema of T_(n−1), ends included.
    Lobatto(usize),
    /// Extrema of T_(n+1) without the ends.
    Interior(usize),
    /// The lower end alone.
    Lower,
    /// The upper end alone.
    Upper,
    /// One point of a model without cross-stream coordinate.
    Point,
}

impl GridKind {
    /// Number of points.
    pub fn count(self) -> usize {
        match self {
            GridKind::Gauss(n) | GridKind::Lobatto(n) | GridKind::Interior(n) => n,
            GridKind::Lower | GridKind::Upper | GridKind::Point => 1,
        }
    }

    /// The position in this grid of the first point of `part`, where the points of `part` are consecutive points of this
    /// grid; otherwise `None`.
    pub fn start_of(self, part: GridKind) -> Option<usize> {
        match (self, part) {
            (GridKind::Lobatto(n), GridKind::Interior(m)) if n == m + 2 => Some(1),
            (GridKind::Lobatto(_), GridKind::Lower) => Some(0),
            (GridKind::Lobatto(n), GridKind::Upper) => Some(n - 1),
            _ => (self == part).then_some(0),
        }
    }
}

/// Points in increasing order.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// Which family.
    pub kind: GridKind,
    /// ξ in [−1, 1].
    pub nodes: Vec<f64>,
}

impl Grid {
    /// The points of a family.
    pub fn new(kind: GridKind) -> Self {
        let nodes = match kind {
            GridKind::Gauss(n) => {
                // −cos((2j+1)π/2n), written as a sine for symmetry to rounding
                (0..n)
                    .map(|j| (PI * (2.0 * j as f64 + 1.0 - n as f64) / (2.0 * n as f64)).sin())
                    .collect()
            }
            GridKind::Lobatto(n) => lobatto(n),
            GridKind::Interior(n) => lobatto(n + 2)[1..=n].to_vec(),
            GridKind::Lower => vec![-1.0],
            GridKind::Upper => vec![1.0],
            GridKind::Point => vec![0.0],
        };
        Grid { kind, nodes }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Barycentric weights up to a common factor.
    fn weights(&self) -> Vec<f64> {
        let n = self.len();
        let alternate = |j: usize| if j.is_multiple_of(2) { 1.0 } else { -1.0 };
        (0..n)
            .map(|j| match self.kind {
                GridKind::Gauss(_) => alternate(j) * (1.0 - self.nodes[j] * self.nodes[j]).sqrt(),
                GridKind::Interior(_) => alternate(j) * (1.0 - self.nodes[j] * self.nodes[j]),
                GridKind::Lobatto(_) if j == 0 || j + 1 == n => 0.5 * alternate(j),
                _ => alternate(j),
            })
            .collect()
    }

    /// The matrix of d^order/dξ^order at the nodes of this grid.
    fn differentiation(&self, order: usize) -> Mat<f64> {
        let n = self.len();
        let weights = self.weights();
        let mut previous = Mat::<f64>::identity(n, n);
        // Welfert's recursion; diagonals by the negative-sum trick.
        for m in 1..=order {
            let mut next = Mat::<f64>::zeros(n, n);
            for i in 0..n {
                let mut sum = 0.0;
                for j in 0..n {
                    if i == j {
                        continue;
                    }
                    let ratio = weights[j] / weights[i];
                    let gap = self.nodes[i] - self.nodes[j];
                    let entry = m as f64 / gap * (ratio * previous[(i, i)] - previous[(i, j)]);
                    next[(i, j)] = entry;
                    sum += entry;
                }
                next[(i, i)] = -sum;
            }
            previous = next;
        }
        previous
    }

    /// Interpolation from the nodes of this grid to any points.
    fn interpolation(&self, to: &[f64]) -> Mat<f64> {
        let weights = self.weights();
        let mut matrix = Mat::<f64>::zeros(to.len(), self.len());
        for (i, &x) in to.iter().enumerate() {
            if let Some(j) = self.nodes.iter().position(|&node| node == x) {
                matrix[(i, j)] = 1.0;
                continue;
            }
            let terms: Vec<f64> = self
                .nodes
                .iter()
                .zip(&weights)
                .map(|(node, w)| w / (x - node))
                .collect();
            let sum: f64 = terms.iter().sum();
            for (j, term) in terms.iter().enumerate() {
                matrix[(i, j)] = term / sum;
            }
        }
        matrix
    }

    /// d^order/dξ^order of the interpolant, evaluated on another grid.
    pub fn derivative_on(&self, to: &Grid, order: usize) -> Mat<f64> {
        if self.len() == 1 {
            let value = if order == 0 { 1.0 } else { 0.0 };
            return Mat::from_fn(to.len(), 1, |_, _| value);
        }
        let differentiation = self.differentiation(order);
        if self.kind == to.kind {
            return differentiation;
        }
        &self.interpolation(&to.nodes) * &differentiation
    }

    /// Interpolation to arbitrary points of [−1, 1].
    pub fn interpolate_to(&self, points: &[f64]) -> Mat<f64> {
        if self.len() == 1 {
            return Mat::from_fn(points.len(), 1, |_, _| 1.0);
        }
        self.interpolation(points)
    }
}

fn lobatto(n: usize) -> Vec<f64> {
    if n == 1 {
        return vec![0.0];
    }
    let degree = (n - 1) as f64;
    (0..n)
        .map(|j| (PI * (2.0 * j as f64 - degree) / (2.0 * degree)).sin())
        .collect()
}

/// Clenshaw–Curtis weights for the n extrema on [−1, 1]: exact for polynomials of degree n − 1.
pub(super) fn clenshaw_curtis(n: usize) -> Vec<f64> {
    if n == 1 {
        return vec![2.0];
    }
    let degree = n - 1;
    (0..n)
        .map(|j| {
            let theta = PI * j as f64 / degree as f64;
            let mut sum = 1.0;
            for m in 1..=degree / 2 {
                let half = if 2 * m == degree { 1.0 } else { 2.0 };
                sum -= half * (2.0 * m as f64 * theta).cos() / ((4 * m * m - 1) as f64);
            }
            let end = if j == 0 || j == degree { 1.0 } else { 2.0 };
            end * sum / degree as f64
        })
        .collect()
}

/// Chebyshev coefficients of the interpolant through values at the extrema (increasing ξ).
pub(super) fn coefficients(values: &[f64]) -> Vec<f64> {
    let n = values.len();
    if n == 1 {
        return values.to_vec();
    }
    let degree = n - 1;
    let cosines: Vec<f64> = (0..2 * degree)
        .map(|phase| (PI * phase as f64 / degree as f64).cos())
        .collect();
    (0..n)
        .map(|m| {
            let mut sum = 0.0;
            for (j, value) in values.iter().enumerate() {
                // ξ_j = −cos(jπ/degree), T_m(ξ_j) = cos(m (degree − j) π/degree)
                let weight = if j == 0 || j == degree { 0.5 } else { 1.0 };
                let phase = (m * (degree - j)) % (2 * degree);
                sum += weight * value * cosines[phase];
            }
            let end = if m == 0 || m == degree { 1.0 } else { 2.0 };
            end * sum / degree as f64
        })
        .collect()
}

/// A Chebyshev series with its derivatives, made once and evaluated at many points.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Coefficients of the series and of d/dξ, d²/dξ², … of it.
    derivatives: Vec<Vec<f64>>,
}

impl Series {
    /// The series of some coefficients, with derivatives to `order`.
    pub fn new(coefficients: Vec<f64>, order: usize) -> Self {
        let mut derivatives = vec![coefficients];
        for lower in 0..order {
            let next = differentiate(&derivatives[lower]);
            derivatives.push(next);
        }
        Series { derivatives }
    }

    /// The coefficients of the series itself.
    pub fn coefficients(&self) -> &[f64] {
        &self.derivatives[0]
    }

    /// Value and derivatives by ξ at one point (Clenshaw's recurrence), up to `order`, at most that of [`Series::new`].
    pub fn values(&self, xi: f64, order: usize) -> Vec<f64> {
        let kept = self.derivatives.iter().take(order + 1);
        kept.map(|series| clenshaw(series, xi)).collect()
    }

    /// The derivative of an order, at most that of [`Series::new`], at many points: what [`Series::values`] gives for
    /// each of them, several at once.
    pub fn sampled(&self, points: &[f64], order: usize) -> Vec<f64> {
        let series = &self.derivatives[order];
        let mut sampled = Vec::with_capacity(points.len());
        vectorised(
            #[inline(always)]
            || {
                for points in points.chunks(LANES) {
                    let mut xi = [0.0; LANES];
                    xi[..points.len()].copy_from_slice(points);
                    sampled.extend_from_slice(&clenshaw_in_lanes(series, &xi)[..points.len()]);
                }
            },
        );
        sampled
    }
}

fn clenshaw(series: &[f64], xi: f64) -> f64 {
    let (mut b1, mut b2) = (0.0, 0.0);
    for &c in series.iter().skip(1).rev() {
        (b1, b2) = (2.0 * xi * b1 - b2 + c, b1);
    }
    xi * b1 - b2 + series.first().copied().unwrap_or(0.0)
}

/// [`clenshaw`] at several points, by the same operations.
#[inline(always)]
fn clenshaw_in_lanes(series: &[f64], xi: &[f64; LANES]) -> [f64; LANES] {
    let (mut b1, mut b2) = ([0.0; LANES], [0.0; LANES]);
    for &c in series.iter().skip(1).rev() {
        for lane in 0..LANES {
            let b = 2.0 * xi[lane] * b1[lane] - b2[lane] + c;
            (b1[lane], b2[lane]) = (b, b1[lane]);
        }
    }
    let first = series.first().copied().unwrap_or(0.0);
    std::array::from_fn(|lane| xi[lane] * b1[lane] - b2[lane] + first)
}

/// Coefficients of the derivative.
fn differentiate(series: &[f64]) -> Vec<f64> {
    let n = series.len();
    if n < 2 {
        return vec![0.0];
    }
    let mut derivative = vec![0.0; n - 1];
    for m in (0..n - 1).rev() {
        let above = if m + 2 < n - 1 {
            derivative[m + 2]
        } else {
            0.0
        };
        derivative[m] = above + 2.0 * (m + 1) as f64 * series[m + 1];
    }
    derivative[0] *= 0.5;
    derivative
}

#[cfg(test)]
mod tests {
    use super::{Grid, GridKind, Series, clenshaw_curtis, coefficients};

    /// d/dξ and d²/dξ² of ξⁿ between any two grids.
    #[test]
    fn differentiation_is_exact_for_polynomials() {
        let kinds = [
            GridKind::Gauss(9),
            GridKind::Lobatto(9),
            GridKind::Interior(9),
        ];
        let targets = [
            GridKind::Gauss(6),
            GridKind::Lower,
            GridKind::Upper,
            GridKind::Lobatto(12),
        ];
        for from in kinds.map(Grid::new) {
            for to in targets.into_iter().chain(kinds).map(Grid::new) {
                for n in 0..9_i32 {
                    for order in 0..3_i32 {
                        let factor: f64 = (0..order).map(|i| f64::from(n - i)).product();
                        let matrix = from.derivative_on(&to, order as usize);
                        for (i, xi) in to.nodes.iter().enumerate() {
                            let computed: f64 = from
                                .nodes
                                .iter()
                                .enumerate()
                                .map(|(j, x)| matrix[(i, j)] * x.powi(n))
                                .sum();
                            let power = (n - order).max(0);
                            let expected = factor * xi.powi(power);
                            assert!((computed - expected).abs() < 1e-10, "ξ^{n}, order {order}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn many_points_are_as_one_by_one() {
        let series = Series::new(vec![0.3, -1.2, 0.7, 0.1, -0.02], 2);
        let points: Vec<f64> = (0..37).map(|i| f64::from(i) / 18.0 - 1.0).collect();
        for order in 0..3 {
            let one_by_one = points.iter().map(|&xi| series.values(xi, order)[order]);
            assert_eq!(
                series.sampled(&points, order),
                one_by_one.collect::<Vec<_>>()
            );
        }
    }

    #[test]
    fn quadrature_is_exact_for_polynomials() {
        let grid = Grid::new(GridKind::Lobatto(10));
        let weights = clenshaw_curtis(10);
        for n in 0..10_i32 {
            let computed: f64 = weights
                .iter()
                .zip(&grid.nodes)
                .map(|(w, x)| w * x.powi(n))
                .sum();
            let expected = if n % 2 == 0 {
                2.0 / f64::from(n + 1)
            } else {
                0.0
            };
            assert!((computed - expected).abs() < 1e-14, "ξ^{n}: {computed}");
        }
    }

    /// T₄ = 8ξ⁴ − 8ξ² + 1: T₄(1) = 1, T₄'(1) = 16, T₄''(1) = 80.
    #[test]
    fn series_of_a_chebyshev_polynomial() {
        let grid = Grid::new(GridKind::Lobatto(8));
        let values: Vec<f64> = grid
            .nodes
            .iter()
            .map(|x| 8.0 * x.powi(4) - 8.0 * x.powi(2) + 1.0)
            .collect();
        let series = coefficients(&values);
        for (n, c) in series.iter().enumerate() {
            let expected = if n == 4 { 1.0 } else { 0.0 };
            assert!((c - expected).abs() < 1e-14, "coefficient {n}");
        }
        let values = Series::new(series, 2).values(1.0, 2);
        for (value, expected) in values.iter().zip([1.0, 16.0, 80.0]) {
            assert!((value - expected).abs() < 1e-11);
        }
    }
}
