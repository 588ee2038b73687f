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
    /// dc0/dk, in units of c0/k.
    pub slope: C64,
    /// d²c0/dk², in units of c0/k².
    pub curvature: C64,
}

impl Envelope {
    /// Both derivatives, exact but for rounding, since k enters L and M0 through factors (ik)^a |k|^b alone. Costs one
    /// factorisation.
    ///
    /// # Errors
    /// The eigenvalue is not simple.
    pub fn of(problem: &Problem, pair: &EigenPair) -> Result<Self> {
        let (k, c) = (pair.k, pair.c);
        let (x, y) = (&pair.right, &pair.left);
        let derivative = |of: Combination, order: u8, x: &[C64]| {
            problem.direct.wavenumber_derivative(k, of, order).apply(x)
        };
        let (operator, mass) = (Combination::at_eigenvalue(c), Combination::MASS);
        let plain = problem.direct.mass::<C64>(k);
        let mass_x = plain.apply(x);
        let y_mass_x = dot(y, &mass_x);

        // c' = ⟨Y, (L' − c M') X⟩ / ⟨Y, M X⟩
        let first = derivative(operator, 1, x);
        let slope = dot(y, &first) / y_mass_x;

        // (c M − L) X' = (L' − c' M − c M') X with ⟨Y, M X'⟩ = 0
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

        // c'' = ⟨Y, (L'' − 2 c' M' − c M'') X + 2 (L' − c' M − c M') X'⟩ / ⟨Y, M X⟩
        let second = derivative(operator, 2, x);
        let mixed = derivative(mass, 1, x);
        let along = difference(&derivative(operator, 1, &moved), &plain.apply(&moved));
        let above = dot(y, &second) - 2.0 * slope * dot(y, &mixed) + 2.0 * dot(y, &along);
        Ok(Envelope {
            slope,
            curvature: above / y_mass_x,
        })
    }

    /// Group velocity −Im dc0/dk, towards +x where positive.
    pub fn group_velocity(&self) -> f64 {
        0.0 - self.slope.im
    }
}

/// The Benjamin–Feir–Newell number 1 + (Im c0''/Re c0'')(Im c2/Re c2) of c0'' = `curvature`: a uniform wave is stable
/// where it is positive. `Err` gives the reason where Re c0'' or Re c2 is zero within its error.
pub fn benjamin_feir(curvature: Measured<C64>, c2: Measured<C64>) -> Decided {
    let ratio = |c: Measured<C64>, name: &str| {
        let zero = || format!("the real part of {name} is zero within its error");
        c.im().over(c.re()).ok_or_else(zero)
    };
    let product = ratio(curvature, "d²c0/dk²")? * ratio(c2, "c2")?;
    Ok(Measured::new(1.0, 0.0) + product)
}
