//! Amplitude equations: dz_j/dt = Σ g z^p z̄^s.

use crate::model::C64;
use crate::series::Monomial;

/// One term of an amplitude equation.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// z^p z̄^s
    pub monomial: Monomial,
    /// Its coefficient: g_jα, or c_j for z_j itself.
    pub g: C64,
}

/// dz_j/dt = Σ over `equations[j]`, linear terms first, by degree.
#[derive(Clone, Debug, PartialEq)]
pub struct AmplitudeSystem {
    /// The terms of dz_j/dt, `[j][term]`.
    pub equations: Vec<Vec<Term>>,
}

impl AmplitudeSystem {
    /// dz_j/dt = c_j z_j
    pub fn linear(rates: &[C64]) -> Self {
        let equation = |(j, &g): (usize, &C64)| {
            let monomial = Monomial::amplitude(rates.len(), j);
            vec![Term { monomial, g }]
        };
        AmplitudeSystem {
            equations: rates.iter().enumerate().map(equation).collect(),
        }
    }

    /// Number of amplitudes.
    pub fn modes(&self) -> usize {
        self.equations.len()
    }

    /// The coefficient of a monomial in the equation of z_j; `None` where the equation has no such term.
    pub fn coefficient(&self, j: usize, monomial: &Monomial) -> Option<C64> {
        let term = self.equations[j].iter().find(|t| t.monomial == *monomial);
        term.map(|t| t.g)
    }

    /// The highest degree of any term.
    pub fn order(&self) -> usize {
        let degrees = self.equations.iter().flatten().map(|t| t.monomial.degree());
        degrees.max().unwrap_or(1)
    }

    /// The system with the terms of some degrees alone.
    pub fn part(&self, degrees: std::ops::RangeInclusive<usize>) -> Self {
        let kept = |equation: &Vec<Term>| {
            let terms = equation.iter();
            let kept = terms.filter(|t| degrees.contains(&t.monomial.degree()));
            kept.cloned().collect()
        };
        AmplitudeSystem {
            equations: self.equations.iter().map(kept).collect(),
        }
    }

    /// dz_j/dt at z, `[j]`.
    pub fn rates(&self, z: &[C64]) -> Vec<C64> {
        let value = |term: &Term| term.g * power(&term.monomial, z);
        let sum = |equation: &Vec<Term>| equation.iter().map(value).sum();
        self.equations.iter().map(sum).collect()
    }

    /// ∂(dz_i/dt)/∂z_j and ∂(dz_i/dt)/∂z̄_j, `[by z or by z̄][i][j]`.
    pub fn slopes(&self, z: &[C64]) -> [Vec<Vec<C64>>; 2] {
        let n = z.len();
        let slope = |equation: &Vec<Term>, factor: &Monomial| -> C64 {
            let terms = equation.iter().filter_map(|term| {
                // d(g z_j^p …)/dz_j = p g z_j^(p−1) …
                let quotient = term.monomial.over(factor)?;
                let exponent = term.monomial.exponent_of(factor);
                Some(term.g * exponent * power(&quotient, z))
            });
            terms.sum()
        };
        let row = |equation: &Vec<Term>, conjugate: bool| -> Vec<C64> {
            let factors = (0..n).map(|j| Monomial::amplitude(n, j));
            let factors = factors.map(|one| if conjugate { one.conjugate() } else { one });
            factors.map(|factor| slope(equation, &factor)).collect()
        };
        [false, true].map(|conjugate| self.equations.iter().map(|e| row(e, conjugate)).collect())
    }
}

/// z^p z̄^s
pub fn power(monomial: &Monomial, z: &[C64]) -> C64 {
    let factor =
        |((z, &p), &s): ((&C64, &u8), &u8)| z.powi(i32::from(p)) * z.conj().powi(i32::from(s));
    let exponents = z.iter().zip(&monomial.z).zip(&monomial.conj);
    exponents.map(factor).product()
}
