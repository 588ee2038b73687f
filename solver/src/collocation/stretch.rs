//! A coordinate η in which an interior layer of the base state is wide: ξ = c + w sinh(λ (η − m)).
//!
//! Points crowd around c on the scale w and thin out in proportion to their distance from it, so
//! that a profile which is smooth outside the layer stays smooth in η (Tee & Trefethen 2006 use
//! the same map).

/// The coordinate of a base state's series.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stretch {
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

    /// F(η) = η: d/dξ and d²/dξ² by differences of η(ξ).
    #[test]
    fn derivatives_through_the_map() {
        let layer = Stretch::Layer {
            centre: -0.2,
            width: 0.1,
        };
        for xi in [-0.9, -0.25, 0.0, 0.6] {
            let eta = |s: f64| layer.eta(xi + s);
            let found = layer.compose(xi, &[eta(0.0), 1.0, 0.0]);
            let h = 1e-4;
            let first = (eta(h) - eta(-h)) / (2.0 * h);
            let second = (eta(h) - 2.0 * eta(0.0) + eta(-h)) / (h * h);
            assert!((found[1] - first).abs() < 1e-4 * first.abs());
            assert!((found[2] - second).abs() < 1e-3 * second.abs().max(1.0));
        }
    }
}
