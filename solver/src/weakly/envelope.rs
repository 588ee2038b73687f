//! The envelope of one mode: ∂A/∂t = c0 A − i c0' ∂A/∂x − ½ c0'' ∂²A/∂x² + c2 |A|² A.

use crate::error::{Error, Result};
use crate::measured::{Decided, Measured};
use crate::model::C64;
use crate::numerics::Applied;
use crate::numerics::dense::{Factorised, bordered, dot};
use crate::problem::{Combination, Problem};
use crate::spectrum::EigenPair;

/// How c0 depends on the wavenumber.
#[derive(Clone, Copy, Debug)]
pub struct Envelope {
    /// dc0/dk
    pub slope: C64,
    /// d²c0/dk²
    pub curvature: C64,
}

impl Envelope {
    /// dc0/dk = ⟨Y, (L' − c M') X⟩ / ⟨Y, M X⟩, and one bordered solve for
    /// d²c0/dk² = ⟨Y, (L'' − 2 c' M' − c M'') X + 2 (L' − c' M − c M') X'⟩ / ⟨Y, M X⟩ with
    /// (c M − L) X' = (L' − c' M − c M') X: exact, for k enters through (ik)^a |k|^b alone.
    ///
    /// # Errors
    /// An eigenvalue that is not simple.
    pub fn of(problem: &Problem, pair: &EigenPair) -> Result<Self> {
        let (k, c) = (pair.k, pair.c);
        let (x, y) = (&pair.right, &pair.left);
        let derivative = |of: Combination, order: u8, x: &[C64]| {
            problem.direct.wavenumber_derivative(k, of, order).apply(x)
        };
        let (operator, mass) = (Combination::at_eigenvalue(c), Combination::MASS);
        let plain = problem.direct.mass::<C64>(k);
        let mass_x = plain.apply(x);
        let below = dot(y, &mass_x);
        let first = derivative(operator, 1, x);
        let slope = dot(y, &first) / below;
        let difference = |first: &[C64], mass: &[C64]| -> Vec<C64> {
            let pairs = first.iter().zip(mass);
            pairs.map(|(l, m)| l - slope * m).collect()
        };
        let mut right = difference(&first, &mass_x);
        right.push(C64::new(0.0, 0.0));
        let border = (mass_x, plain.apply_adjoint(y));
        let matrix = bordered(&problem.shifted::<C64>(k, c), &[border]);
        let mut moved = Factorised::new(matrix)
            .solve_regular(&right)
            .ok_or_else(|| Error::computation("d²c0/dk² cannot be formed: c0 is not simple"))?;
        moved.truncate(x.len());
        let second = derivative(operator, 2, x);
        let mixed = derivative(mass, 1, x);
        let along = difference(&derivative(operator, 1, &moved), &plain.apply(&moved));
        let above = dot(y, &second) - 2.0 * slope * dot(y, &mixed) + 2.0 * dot(y, &along);
        Ok(Envelope {
            slope,
            curvature: above / below,
        })
    }

    /// −Im dc0/dk
    pub fn group_velocity(&self) -> f64 {
        0.0 - self.slope.im
    }
}

/// The Benjamin–Feir–Newell number 1 + (Im c0''/Re c0'')(Im c2/Re c2) of c0'' = `curvature`: a uniform wave is stable
/// where it is positive. The reason where a divisor is zero within its error.
pub fn benjamin_feir(curvature: Measured<C64>, c2: Measured<C64>) -> Decided {
    let ratio = |c: Measured<C64>, name: &str| {
        let zero = || format!("the real part of {name} is zero within its error");
        c.im().over(c.re()).ok_or_else(zero)
    };
    let product = ratio(curvature, "d²c0/dk²")? * ratio(c2, "c2")?;
    Ok(Measured::new(1.0, 0.0) + product)
}
