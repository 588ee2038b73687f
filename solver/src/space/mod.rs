//! The cross-stream direction, as base states and perturbations share it: an interval, or a single point.
//!
//! Places, derivatives and integrals are in y. The variable ξ ∈ [−1, 1] of the Chebyshev polynomials, and the
//! coordinate η in which a thin layer of a base state is wide, occur in this module alone.

mod chebyshev;
mod derivative;
mod layout;
mod stretch;

pub use chebyshev::Series;
pub use derivative::Derivative;
pub use layout::{Block, Layout};

use crate::model::{C64, End};
use crate::numerics::Noise;
use chebyshev::{Grid, GridKind, clenshaw_curtis, coefficients};
use faer::Mat;
use std::collections::HashMap;
use std::fmt;
use std::sync::{Arc, Mutex};
use stretch::Stretch;

/// A place in the interval, kept as ξ so that the ends are exact.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Place(f64);

impl Place {
    /// The middle of the interval, or the point.
    pub const MIDDLE: Place = Place(0.0);

    /// A place at a part of the way from the lower end, in (0, 1).
    pub fn at(part: f64) -> Self {
        Place(2.0 * part - 1.0)
    }
}

/// A family of points on which profiles have their values, or balances are collocated.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Points(GridKind);

impl Points {
    /// The end alone.
    pub fn end(end: End) -> Self {
        Points(match end {
            End::Lower => GridKind::Lower,
            End::Upper => GridKind::Upper,
        })
    }

    /// How many there are.
    pub fn count(self) -> usize {
        self.0.count()
    }
}

/// Points with the weights of ∫ … dy; of a point, the value itself.
#[derive(Clone, Debug)]
pub struct Quadrature {
    /// Where the integrand is wanted.
    pub points: Points,
    /// The same places, each with its weight.
    pub nodes: Vec<(Place, f64)>,
}

/// From which grid, to which, and the order of the derivative.
type MatrixKey = (GridKind, GridKind, usize);

/// Differentiation matrices of [−1, 1], made once and shared by all spaces of a study.
#[derive(Default)]
pub struct Matrices {
    /// Those that have been computed.
    computed: Mutex<HashMap<MatrixKey, Arc<Mat<f64>>>>,
    /// Matrices whose entries these are, times the factors of a noise.
    disturbed: Option<(Arc<Matrices>, Noise)>,
}

impl Matrices {
    /// d^order/dξ^order from values on one grid to values on another.
    fn get(&self, from: GridKind, to: GridKind, order: usize) -> Arc<Mat<f64>> {
        let mut computed = match self.computed.lock() {
            Ok(guard) => guard,
            Err(poisoned) => poisoned.into_inner(),
        };
        computed
            .entry((from, to, order))
            .or_insert_with(|| Arc::new(self.compute(from, to, order)))
            .clone()
    }

    fn compute(&self, from: GridKind, to: GridKind, order: usize) -> Mat<f64> {
        let Some((exact, noise)) = &self.disturbed else {
            return Grid::new(from).derivative_on(&Grid::new(to), order);
        };
        let exact = exact.get(from, to, order);
        let (rows, columns) = (exact.nrows(), exact.ncols());
        let noise = noise.stream(rows as u64).stream(columns as u64);
        let noise = noise.stream(order as u64);
        Mat::from_fn(rows, columns, |i, j| {
            exact[(i, j)] * noise.factor(i * columns + j)
        })
    }
}

/// An interval with its collocation, or a point.
#[derive(Clone)]
pub struct Space {
    /// The ends in y; `None` without a cross-stream coordinate.
    ends: Option<[f64; 2]>,
    stretch: Stretch,
    matrices: Arc<Matrices>,
}

impl fmt::Debug for Space {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Space({:?}, {:?})", self.ends, self.stretch)
    }
}

impl Space {
    /// The space between two ends, or a point.
    pub fn new(ends: Option<[f64; 2]>, matrices: Arc<Matrices>) -> Self {
        Space {
            ends,
            stretch: Stretch::None,
            matrices,
        }
    }

    /// The same interval without a stretched coordinate.
    pub fn plain(&self) -> Self {
        Space::new(self.ends, self.matrices.clone())
    }

    /// The same interval, every entry of its differentiation matrices times a factor of the noise.
    pub fn disturbed(&self, noise: Noise) -> Self {
        Space {
            matrices: Arc::new(Matrices {
                computed: Mutex::default(),
                disturbed: Some((self.matrices.clone(), noise)),
            }),
            ..self.clone()
        }
    }

    /// The same interval in the stretched coordinate of another space.
    pub fn like(&self, template: &Space) -> Self {
        Space {
            stretch: template.stretch,
            ..self.clone()
        }
    }

    /// The ends in y; `None` for a point.
    pub fn ends(&self) -> Option<[f64; 2]> {
        self.ends
    }

    /// Whether it is a single point.
    pub fn is_point(&self) -> bool {
        self.ends.is_none()
    }

    /// The differentiation matrices, which all spaces of a study share.
    pub fn matrices(&self) -> &Arc<Matrices> {
        &self.matrices
    }

    /// y; zero for a point.
    pub fn y(&self, Place(xi): Place) -> f64 {
        // Exact at the ends.
        self.ends.map_or(0.0, |[lower, upper]| {
            0.5 * ((1.0 - xi) * lower + (1.0 + xi) * upper)
        })
    }

    /// The place of a y.
    pub fn place(&self, y: f64) -> Place {
        match self.ends {
            None => Place::MIDDLE,
            Some([lower, _]) => Place(-1.0 + (y - lower) * self.rate()),
        }
    }

    /// An end; of a point, the point.
    pub fn end(&self, end: End) -> Place {
        match (self.ends, end) {
            (None, _) => Place::MIDDLE,
            (Some(_), End::Lower) => Place(-1.0),
            (Some(_), End::Upper) => Place(1.0),
        }
    }

    /// Evenly spaced places, both ends included; one for a point.
    pub fn evenly(&self, count: usize) -> Vec<Place> {
        if self.is_point() || count < 2 {
            return vec![Place::MIDDLE];
        }
        let last = (count - 1) as f64;
        (0..count)
            .map(|i| Place(-1.0 + 2.0 * i as f64 / last))
            .collect()
    }

    /// The places of some points, by increasing y.
    pub fn places(&self, points: Points) -> Vec<Place> {
        let nodes = Grid::new(points.0).nodes.into_iter();
        nodes.map(|eta| Place(self.stretch.xi(eta))).collect()
    }

    /// dξ/dy = 2/h, in units of 1/y: the size of one derivative by y. One for a point.
    pub fn rate(&self) -> f64 {
        self.ends
            .map_or(1.0, |[lower, upper]| 2.0 / (upper - lower))
    }

    /// ∂y^order of the interpolant through values at the points `from`, evaluated at the points `to`. In a stretched
    /// coordinate `order` is at most 2.
    pub fn derivative(&self, from: Points, to: Points, order: usize) -> Derivative {
        if let Some(start) = from.0.start_of(to.0).filter(|_| order == 0) {
            let count = to.count();
            return Derivative::Selection { start, count };
        }
        let matrix = match self.stretch {
            Stretch::None => self.matrices.get(from.0, to.0, order),
            _ => Arc::new(self.stretched(from.0, to.0, order)),
        };
        Derivative::Dense {
            matrix,
            factor: self.rate().powi(order as i32),
        }
    }

    /// d/dξ = η' d/dη, d²/dξ² = η'² d²/dη² + η'' d/dη
    fn stretched(&self, from: GridKind, to: GridKind, order: usize) -> Mat<f64> {
        let by_eta = |order: usize| self.matrices.get(from, to, order);
        let nodes = Grid::new(to).nodes;
        let rates: Vec<Vec<f64>> = nodes
            .iter()
            .map(|&eta| self.stretch.taylor(self.stretch.xi(eta), 2))
            .collect();
        let (rows, columns) = (nodes.len(), from.count());
        let first = by_eta(1);
        match order {
            0 => by_eta(0).as_ref().clone(),
            1 => Mat::from_fn(rows, columns, |i, j| rates[i][0] * first[(i, j)]),
            _ => {
                let second = by_eta(2);
                Mat::from_fn(rows, columns, |i, j| {
                    rates[i][0].powi(2) * second[(i, j)] + 2.0 * rates[i][1] * first[(i, j)]
                })
            }
        }
    }

    /// Values at some points interpolated to any places.
    pub fn interpolated(&self, from: Points, values: &[C64], to: &[Place]) -> Vec<C64> {
        if from.count() == 1 {
            return vec![values[0]; to.len()];
        }
        let places: Vec<f64> = to.iter().map(|place| self.stretch.eta(place.0)).collect();
        let matrix = Grid::new(from.0).interpolate_to(&places);
        let row = |i: usize| {
            let terms = values.iter().enumerate();
            terms.map(|(j, v)| v * matrix[(i, j)]).sum()
        };
        (0..to.len()).map(row).collect()
    }

    /// ∫ … dy, exact for polynomials of degree `count` − 1.
    pub fn quadrature(&self, count: usize) -> Quadrature {
        let Some([lower, upper]) = self.ends else {
            return Quadrature {
                points: Points(GridKind::Point),
                nodes: vec![(Place::MIDDLE, 1.0)],
            };
        };
        let points = Points(GridKind::Lobatto(count));
        let half = 0.5 * (upper - lower);
        // dξ = dη / η'
        let weight = |(place, weight): (Place, f64)| {
            let slope = self.stretch.taylor(place.0, 1)[0];
            (place, weight * half / slope)
        };
        let places = self.places(points).into_iter();
        Quadrature {
            points,
            nodes: places.zip(clenshaw_curtis(count)).map(weight).collect(),
        }
    }

    /// The Chebyshev series through values at extrema, to be differentiated up to `order` times.
    pub fn series(&self, values: &[f64], order: usize) -> Series {
        Series::new(coefficients(values), order)
    }

    /// The n-th Chebyshev polynomial, to be differentiated up to `order` times.
    pub fn polynomial(&self, n: usize, order: usize) -> Series {
        let mut unit = vec![0.0; n + 1];
        unit[n] = 1.0;
        Series::new(unit, order)
    }

    /// Size of the last Chebyshev coefficients of a profile, real and imaginary parts apart.
    pub fn tail(&self, from: Points, values: &[C64]) -> f64 {
        let extrema = GridKind::Lobatto(from.count());
        let matrix = self.matrices.get(from.0, extrema, 0);
        let part = |of: fn(&C64) -> f64| {
            let value = |i: usize| {
                let terms = values.iter().enumerate();
                terms.map(|(j, v)| of(v) * matrix[(i, j)]).sum()
            };
            let series = coefficients(&(0..from.count()).map(value).collect::<Vec<f64>>());
            let last = series.iter().rev().take(3);
            last.map(|c| c.abs()).fold(0.0, f64::max)
        };
        part(|v| v.re).max(part(|v| v.im))
    }

    /// A series and its y-derivatives at a place: ∂y^m for m from 0 to `order`.
    pub fn evaluate(&self, series: &Series, place: Place, order: usize) -> Vec<f64> {
        let by_eta = series.values(self.stretch.eta(place.0), order);
        let mut values = self.stretch.compose(place.0, &by_eta);
        let mut factor = 1.0;
        for value in &mut values {
            *value *= factor;
            factor *= self.rate();
        }
        values
    }

    /// The same interval in a coordinate that widens the steepest interior layer of some profiles.
    pub fn widened<'s>(&self, profiles: impl Iterator<Item = &'s Series>) -> Self {
        Space {
            stretch: self.stretch.widening(profiles),
            ..self.clone()
        }
    }

    /// Whether its polynomials are in a stretched coordinate.
    pub fn is_stretched(&self) -> bool {
        self.stretch != Stretch::None
    }
}

#[cfg(test)]
mod tests {
    use super::{Place, Points, Space};
    use crate::model::{C64, End};
    use crate::space::Layout;
    use landau_contract::{BalanceId, FieldId, OffsetsInfo};

    fn space() -> Space {
        Space::new(Some([1.0, 4.0]), Default::default())
    }

    /// A field of N + 2 values, a balance at N points.
    fn layout() -> Layout<BalanceId, FieldId> {
        let offsets = OffsetsInfo {
            rows: vec![0].into(),
            columns: vec![2].into(),
        };
        Layout::staggered(&offsets, Some(9)).expect("a layout")
    }

    /// y³: 3y², 6y at every kind of point, ends included; ∫ y³ dy = (4⁴ − 1)/4.
    #[test]
    fn derivatives_and_integrals_are_in_y() {
        let (space, layout) = (space(), layout());
        let column = layout.columns[FieldId(0)].points;
        let row = layout.rows[BalanceId(0)].points;
        let cube = |place: &Place| C64::new(space.y(*place).powi(3), -1.0);
        let values: Vec<C64> = space.places(column).iter().map(cube).collect();
        for to in [
            row,
            column,
            Points::end(End::Lower),
            Points::end(End::Upper),
        ] {
            let exact: [fn(f64) -> f64; 3] = [|y| y.powi(3), |y| 3.0 * y * y, |y| 6.0 * y];
            for (order, exact) in exact.iter().enumerate() {
                let derivative = space.derivative(column, to, order).of(&values);
                for (place, value) in space.places(to).into_iter().zip(derivative) {
                    let expected = exact(space.y(place));
                    assert!((value.re - expected).abs() < 1e-11 * 64.0, "order {order}");
                }
            }
        }
        let quadrature = space.quadrature(9);
        let integral: f64 = quadrature
            .nodes
            .iter()
            .map(|(place, weight)| weight * space.y(*place).powi(3))
            .sum();
        assert!((integral - 63.75).abs() < 1e-12);
        let at = space.interpolated(column, &values, &[space.place(2.5)]);
        assert!((at[0].re - 15.625).abs() < 1e-12);
        assert!(space.tail(column, &values) < 1e-13);
    }

    /// The same of a series, and in a coordinate that widens tanh((y − 2)/0.05).
    #[test]
    fn a_layer_in_its_own_coordinate() {
        let space = space();
        let steep = |y: f64| ((y - 2.0) / 0.05).tanh();
        let degree = 120;
        let extrema = |space: &Space| {
            let nodes = space.quadrature(degree + 1).nodes.into_iter();
            let values: Vec<f64> = nodes.map(|(place, _)| steep(space.y(place))).collect();
            space.series(&values, 2)
        };
        let coarse = extrema(&space);
        let wide = space.widened(std::iter::once(&coarse));
        assert!(wide.is_stretched());
        let fine = extrema(&wide);
        let last = |series: &super::Series| {
            let last = series.coefficients().iter().rev().take(3);
            last.fold(0.0_f64, |m, c| m.max(c.abs()))
        };
        assert!(last(&fine) < 1e-6 * last(&coarse));
        for y in [1.9, 2.0, 2.03, 3.5] {
            let place = wide.place(y);
            let computed = wide.evaluate(&fine, place, 2);
            let value = steep(y);
            let slope = (1.0 - value * value) / 0.05;
            let expected = [value, slope, -2.0 * value * slope / 0.05];
            let sizes = [1.0, 20.0, 400.0];
            for ((computed, expected), size) in computed.iter().zip(expected).zip(sizes) {
                assert!(
                    (computed - expected).abs() < 1e-6 * size,
                    "{computed} for {expected} at {y}"
                );
            }
        }
        let integral: f64 = wide
            .quadrature(degree + 1)
            .nodes
            .iter()
            .map(|(place, weight)| weight * steep(wide.y(*place)))
            .sum();
        let exact = |y: f64| 0.05 * ((y - 2.0) / 0.05).cosh().ln();
        assert!((integral - (exact(4.0) - exact(1.0))).abs() < 1e-9);
    }

    #[test]
    fn a_point_is_its_own_integral() {
        let point = Space::new(None, Default::default());
        let nodes = point.quadrature(33).nodes;
        assert_eq!(nodes, vec![(Place::MIDDLE, 1.0)]);
        assert_eq!(point.evenly(50), vec![Place::MIDDLE]);
        assert_eq!((point.y(Place::MIDDLE), point.rate()), (0.0, 1.0));
    }
}
