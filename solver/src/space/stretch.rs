//! A coordinate η in which an interior layer of the base state is wide: ξ = c + w sinh(λ (η − m)).
//!
//! Points crowd around c on the scale w and thin out in proportion to their distance from it, so
//! that a profile which is smooth outside the layer stays smooth in η (Tee & Trefethen 2006 use
//! the same map).

use super::chebyshev::Series;

/// Number of places at which the steepest layer is looked for: five for each polynomial of the highest degree.
const SAMPLES: usize = 2000;
/// A layer wider than this part of the half-interval is resolved without a stretched coordinate.
const WIDE: f64 = 0.5;

/// The coordinate of a base state's series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Stretch {
    /// η = ξ
    None,
    /// ξ = centre + width sinh(…): a thin layer widened.
    Layer {
        /// ξ of the layer.
        centre: f64,
        /// Its width in ξ.
        width: f64,
    },
}

impl Stretch {
    /// λ and m
    fn constants(centre: f64, width: f64) -> (f64, f64) {
        let (lower, upper) = (
            ((-1.0 - centre) / width).asinh(),
            ((1.0 - centre) / width).asinh(),
        );
        let rate = 0.5 * (upper - lower);
        (rate, -0.5 * (upper + lower) / rate)
    }

    /// ξ(η)
    pub fn xi(&self, eta: f64) -> f64 {
        match *self {
            Stretch::None => eta,
            // Exact at the ends.
            Stretch::Layer { .. } if eta.abs() == 1.0 => eta,
            Stretch::Layer { centre, width } => {
                let (rate, middle) = Self::constants(centre, width);
                (centre + width * (rate * (eta - middle)).sinh()).clamp(-1.0, 1.0)
            }
        }
    }

    /// η(ξ)
    pub fn eta(&self, xi: f64) -> f64 {
        match *self {
            Stretch::None => xi,
            Stretch::Layer { .. } if xi.abs() == 1.0 => xi,
            Stretch::Layer { centre, width } => {
                let (rate, middle) = Self::constants(centre, width);
                (middle + ((xi - centre) / width).asinh() / rate).clamp(-1.0, 1.0)
            }
        }
    }

    /// A coordinate that widens the steepest interior layer of some profiles, which are series in this one.
    pub fn widening<'s>(&self, profiles: impl Iterator<Item = &'s Series>) -> Stretch {
        let mut thinnest = (WIDE, Stretch::None);
        let places = (1..SAMPLES).map(|i| -1.0 + 2.0 * i as f64 / SAMPLES as f64);
        let places: Vec<f64> = places.collect();
        for series in profiles.filter(|s| s.coefficients().len() > 1) {
            let [values, slopes] = [0, 1].map(|order| series.sampled(&places, order));
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            for ((&eta, value), slope) in places.iter().zip(values).zip(slopes) {
                let xi = self.xi(eta);
                let slope = self.compose(xi, &[value, slope])[1].abs();
                // Chebyshev points resolve a layer at an end by themselves.
                let width = (most - least) / slope;
                let seen = width / (1.0 - xi * xi + width).sqrt();
                if seen < thinnest.0 {
                    thinnest = (seen, Stretch::Layer { centre: xi, width });
                }
            }
        }
        thinnest.1
    }

    /// Taylor coefficients of η about a point: η', η''/2, … to h^order.
    pub fn taylor(&self, xi: f64, order: usize) -> Vec<f64> {
        let mut coefficients = vec![0.0; order];
        match *self {
            Stretch::None => {
                if order > 0 {
                    coefficients[0] = 1.0;
                }
            }
            Stretch::Layer { centre, width } => {
                let (rate, _) = Self::constants(centre, width);
                let s = xi - centre;
                let square = width * width + s * s;
                // g = dη/dξ = 1/(λ √(w² + s²)) solves (w² + s²) g' + s g = 0.
                let mut g = vec![0.0; order];
                for k in 0..order {
                    g[k] = match k {
                        0 => 1.0 / (rate * square.sqrt()),
                        _ => {
                            let n = (k - 1) as f64;
                            let before = if k > 1 { g[k - 2] } else { 0.0 };
                            -(s * (2.0 * n + 1.0) * g[k - 1] + n * before) / (square * (n + 1.0))
                        }
                    };
                    coefficients[k] = g[k] / (k + 1) as f64;
                }
            }
        }
        coefficients
    }

    /// d^m/dξ^m of F(η(ξ)) for m = 0, 1, …, given the derivatives of F by η.
    pub fn compose(&self, xi: f64, derivatives: &[f64]) -> Vec<f64> {
        if *self == Stretch::None {
            return derivatives.to_vec();
        }
        let order = derivatives.len() - 1;
        let step = self.taylor(xi, order);
        // F(η + δ) = Σ F^(m) δ^m / m! with δ = Σ step h^k
        let mut result = vec![0.0; order + 1];
        let mut power = vec![0.0; order + 1];
        power[0] = 1.0;
        let mut factorial = 1.0;
        for (m, derivative) in derivatives.iter().enumerate() {
            if m > 0 {
                factorial *= m as f64;
                let mut next = vec![0.0; order + 1];
                for (i, p) in power.iter().enumerate() {
                    for (k, s) in step.iter().enumerate().take(order - i) {
                        next[i + k + 1] += p * s;
                    }
                }
                power = next;
            }
            for (r, p) in result.iter_mut().zip(&power) {
                *r += derivative / factorial * p;
            }
        }
        let mut factorial = 1.0;
        for (m, r) in result.iter_mut().enumerate() {
            factorial *= (m as f64).max(1.0);
            *r *= factorial;
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::Stretch;

    #[test]
    fn a_map_and_its_inverse() {
        let layer = Stretch::Layer {
            centre: 0.3,
            width: 0.02,
        };
        for i in 0..=20 {
            let xi = -1.0 + 0.1 * f64::from(i);
            assert!((layer.xi(layer.eta(xi)) - xi).abs() < 1e-13);
        }
    }

    /// F(η) = η: its derivatives are those of asinh.
    #[test]
    fn derivatives_through_the_map() {
        let (centre, width) = (0.3, 0.02);
        let layer = Stretch::Layer { centre, width };
        let rate = 0.5 * (((1.0 - centre) / width).asinh() + ((1.0 + centre) / width).asinh());
        for xi in [-0.9, 0.2, 0.29, 0.3, 0.8] {
            let s: f64 = xi - centre;
            let square = s * s + width * width;
            let derivatives = layer.compose(xi, &[layer.eta(xi), 1.0, 0.0, 0.0]);
            let exact = [
                1.0 / square.sqrt(),
                -s / square.powf(1.5),
                (2.0 * s * s - width * width) / square.powf(2.5),
            ];
            for (computed, exact) in derivatives[1..].iter().zip(exact) {
                let exact = exact / rate;
                assert!(
                    (computed - exact).abs() < 1e-12 * exact.abs() + 1e-9,
                    "{computed} for {exact}"
                );
            }
        }
    }
}
