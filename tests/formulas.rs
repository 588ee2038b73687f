//! Generated kernels against formulas written by hand.

use crate::support::built;
use approx::assert_relative_eq;
use landau_solver::model::{FieldId, KernelId, Structure, evaluate};
use landau_solver::space::Place;
use landau_solver::study::Setup;
use landau_solver::wavevector::WaveVector;
use num_dual::{DualNum, second_derivative, second_partial_derivative};

/// P (2.13) by hand: pressure, conductivity (with the square), dissipation, at e = 0.9.
fn closure<D: DualNum<Primitive = f64> + Copy>(which: usize, n: D, t: D) -> D {
    let (alpha0, alpha1) = ((3.0_f64 / 32.0).sqrt(), 1.0 - (3.0_f64 / 8.0).sqrt());
    let l = (n.recip() - 1.0) * alpha0 / (-n * alpha1 + 1.0);
    match which {
        0 => n * t * (n + 1.0) / (-n + 1.0),
        1 => n * (l * 0.6 + 1.0).powi(2) / l * t.sqrt(),
        _ => n / l * t * t.sqrt() * ((1.0 - 0.81) / 2.26),
    }
}

/// Value, gradient and Hessian of a law at (n, T) by hyper-dual numbers.
fn derivatives(which: usize, n: f64, t: f64) -> (f64, [f64; 2], [[f64; 2]; 2]) {
    let (value, by_n, by_t, by_nt) =
        second_partial_derivative(|(n, t)| closure(which, n, t), (n, t));
    let (_, _, by_nn) = second_derivative(|n| closure(which, n, t.into()), n);
    let (_, _, by_tt) = second_derivative(|t| closure(which, n.into(), t), t);
    (value, [by_n, by_t], [[by_nn, by_nt], [by_nt, by_tt]])
}

fn coefficient(structure: &Structure, values: &[f64], row: &str, field: &str, x: u8, y: u8) -> f64 {
    let row = structure.balances.position(|b| b == row);
    let row = row.expect("a balance");
    let field = structure.field(field).expect("a field");
    let index = structure.linear.iter().position(|t| {
        t.row == row && t.jet.of == field && (t.jet.t, t.jet.x, t.jet.y) == (0, x, y)
    });
    index.map_or(0.0, |i| values[i])
}

/// P (A 1), entry by entry, at points of the base state.
#[test]
fn linear_operator_of_the_bed() {
    let model = built("vibrated_bed");
    let structure = model.structure();
    let state = Setup::new(model.clone(), 50).expect("M").base(None);
    let state = state.expect("a base state");
    for part in [0.015, 0.2, 0.45, 0.675, 0.9] {
        let point = state.at(Place::at(part), WaveVector::MEAN);
        let at = |field, order| structure.base_value(&point, FieldId(field), order);
        let (n, n_y) = (at(0, 0), at(0, 1));
        let (t, t_y, t_yy) = (at(3, 0), at(3, 1), at(3, 2));
        let (p, [p_n, p_t], p2) = derivatives(0, n, t);
        let (kappa, [kappa_n, kappa_t], k2) = derivatives(1, n, t);
        let (_, [d_n, d_t], _) = derivatives(2, n, t);
        let (mu, mu_y) = (1.7 * kappa, 1.7 * (kappa_n * n_y + kappa_t * t_y));
        let (lambda, lambda_y) = (-mu, -mu_y);
        let along = |h: [f64; 2]| h[0] * n_y + h[1] * t_y;
        let values = evaluate(model.as_ref(), KernelId::Linear, &point);
        let l = |row, field, x, y| coefficient(structure, &values, row, field, x, y);
        let expected = [
            (l("mass", "u", 1, 0), -n),
            (l("mass", "v", 0, 0), -n_y),
            (l("mass", "v", 0, 1), -n),
            (l("momentum_x", "n", 1, 0), -p_n / n),
            (l("momentum_x", "u", 2, 0), (2.0 * mu + lambda) / n),
            (l("momentum_x", "u", 0, 1), mu_y / n),
            (l("momentum_x", "u", 0, 2), mu / n),
            (l("momentum_x", "v", 1, 0), mu_y / n),
            (l("momentum_x", "v", 1, 1), (mu + lambda) / n),
            (l("momentum_x", "T", 1, 0), -p_t / n),
            (l("momentum_y", "n", 0, 0), -(0.01 + along(p2[0])) / n),
            (l("momentum_y", "n", 0, 1), -p_n / n),
            (l("momentum_y", "u", 1, 0), lambda_y / n),
            (l("momentum_y", "v", 2, 0), mu / n),
            (l("momentum_y", "v", 0, 1), (2.0 * mu_y + lambda_y) / n),
            (l("momentum_y", "v", 0, 2), (2.0 * mu + lambda) / n),
            (l("momentum_y", "T", 0, 0), -along(p2[1]) / n),
            (l("momentum_y", "T", 0, 1), -p_t / n),
            (
                l("energy", "n", 0, 0),
                (t_y * along(k2[0]) + kappa_n * t_yy - d_n) / n,
            ),
            (l("energy", "n", 0, 1), t_y * kappa_n / n),
            (l("energy", "u", 1, 0), -p / n),
            (l("energy", "v", 0, 0), -t_y),
            (l("energy", "v", 0, 1), -p / n),
            (l("energy", "T", 2, 0), kappa / n),
            (
                l("energy", "T", 0, 0),
                (t_y * along(k2[1]) + kappa_t * t_yy - d_t) / n,
            ),
            (
                l("energy", "T", 0, 1),
                (kappa_n * n_y + kappa_t * t_y + t_y * kappa_t) / n,
            ),
            (l("energy", "T", 0, 2), kappa / n),
        ];
        for (i, (found, wanted)) in expected.into_iter().enumerate() {
            let scale = wanted.abs().max(1e-6);
            assert_relative_eq!(
                found / scale,
                wanted / scale,
                epsilon = 1e-10,
                max_relative = 1e-10
            );
            assert!(found.is_finite(), "entry {i}");
        }
    }
}

/// The only nonlinearity of the strip stands in its wall: u_y + βu + γu² = 0 at y = 1. By hand,
/// with φ = sin(qy)/sin q, q cot q = −β, c0 = r − q² at k = 1:
/// order 2: w'' = s² w, w(0) = 0, w' + βw = −γ · (2 for the mean, 1 for the second harmonic) at 1,
/// s² = 2c0 − r + 1 for the mean and 2c0 − r + 9 for the harmonic, so w(1) = −γ (2 or 1) S/(C + βS)
/// with S = sinh(s)/s, C = cosh s; order 3: c2 ∫φ² = −2γ (w_mean(1) + w_harmonic(1)).
#[test]
fn nonlinear_wall() {
    for (r, beta, gamma) in [(4.2, 1.0_f64, 1.0_f64), (5.0, 1.0, 0.7), (6.0, 2.5, -1.3)] {
        // q in (π/2, π)
        let (mut low, mut high) = (std::f64::consts::FRAC_PI_2, std::f64::consts::PI);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if middle / middle.tan() > -beta {
                low = middle
            } else {
                high = middle
            }
        }
        let q = 0.5 * (low + high);
        let c0 = r - q * q;
        let value = |square: f64| {
            let s = square.abs().sqrt();
            let (sine, cosine) = if square < 0.0 {
                (s.sin() / s, s.cos())
            } else {
                (s.sinh() / s, s.cosh())
            };
            sine / (cosine + beta * sine)
        };
        let mean = -2.0 * gamma * value(2.0 * c0 - r + 1.0);
        let harmonic = -gamma * value(2.0 * c0 - r + 9.0);
        let norm = (0.5 - (2.0 * q).sin() / (4.0 * q)) / q.sin().powi(2);
        let c2 = -2.0 * gamma * (mean + harmonic) / norm;
        let line = format!(
            "point robin_strip --k 1 -M 24 --set r={r} --set beta={beta} --set gamma={gamma}"
        );
        let found = crate::support::json(&line);
        crate::support::close("c0", crate::support::number(&found, "/c0/0"), c0, 1e-10);
        crate::support::close(
            "c2",
            crate::support::number(&found, "/c2/0"),
            c2,
            1e-8 * c2.abs(),
        );
    }
}
