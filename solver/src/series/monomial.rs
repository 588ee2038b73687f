//! Monomials z^p z̄^s, and the products of which each is made.
//!
//! Series stand for real quantities, so that the coefficient of z^s z̄^p is the conjugate of that of z^p z̄^s. One of the
//! two is stored: that with p ≥ s in lexical order.

use std::collections::HashMap;

/// Raised digits.
const SUPERSCRIPTS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// z^p z̄^s: the exponents of each amplitude, and of its conjugate.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Monomial {
    /// p, by amplitude.
    pub z: Vec<u8>,
    /// s, by amplitude.
    pub conj: Vec<u8>,
}

impl Monomial {
    /// z^0
    pub fn one(modes: usize) -> Self {
        Monomial {
            z: vec![0; modes],
            conj: vec![0; modes],
        }
    }

    /// z_j
    pub fn amplitude(modes: usize, j: usize) -> Self {
        let mut monomial = Monomial::one(modes);
        monomial.z[j] = 1;
        monomial
    }

    /// |p| + |s|
    pub fn degree(&self) -> usize {
        let exponents = self.z.iter().chain(&self.conj);
        exponents.map(|&e| usize::from(e)).sum()
    }

    /// z^s z̄^p
    pub fn conjugate(&self) -> Self {
        Monomial {
            z: self.conj.clone(),
            conj: self.z.clone(),
        }
    }

    /// Whether it equals its conjugate, as a product of |z_j|² does.
    pub fn is_real(&self) -> bool {
        self.z == self.conj
    }

    /// p_j − s_j, by amplitude.
    pub fn differences(&self) -> impl Iterator<Item = f64> {
        let pairs = self.z.iter().zip(&self.conj);
        pairs.map(|(&p, &s)| f64::from(p) - f64::from(s))
    }

    /// The product with another monomial.
    pub fn times(&self, factor: &Monomial) -> Monomial {
        let sum = |a: &[u8], b: &[u8]| a.iter().zip(b).map(|(a, b)| a + b).collect();
        Monomial {
            z: sum(&self.z, &factor.z),
            conj: sum(&self.conj, &factor.conj),
        }
    }

    /// The exponent of `one`, a single z_j or z̄_j, in this monomial.
    pub fn exponent_of(&self, one: &Monomial) -> f64 {
        let exponents = self.z.iter().chain(&self.conj);
        let pairs = exponents.zip(one.z.iter().chain(&one.conj));
        pairs.map(|(e, o)| f64::from(e * o)).sum()
    }

    /// The quotient by another monomial; `None` where that does not divide this one.
    pub fn over(&self, divisor: &Monomial) -> Option<Monomial> {
        let difference = |a: &[u8], b: &[u8]| -> Option<Vec<u8>> {
            a.iter().zip(b).map(|(a, b)| a.checked_sub(*b)).collect()
        };
        Some(Monomial {
            z: difference(&self.z, &divisor.z)?,
            conj: difference(&self.conj, &divisor.conj)?,
        })
    }

    /// As it is written: z1² z̄2, the index left out where there is one amplitude.
    pub fn name(&self) -> String {
        let index = |j: usize| match self.z.len() {
            1 => String::new(),
            _ => (j + 1).to_string(),
        };
        let power = |exponent: u8| match exponent {
            1 => String::new(),
            exponent => exponent
                .to_string()
                .chars()
                .map(|digit| SUPERSCRIPTS[digit.to_digit(10).unwrap_or(0) as usize])
                .collect(),
        };
        let mut factors = Vec::new();
        for (letter, exponents) in [("z", &self.z), ("z̄", &self.conj)] {
            let present = exponents.iter().enumerate().filter(|(_, e)| **e > 0);
            factors.extend(present.map(|(j, &e)| format!("{letter}{}{}", index(j), power(e))));
        }
        factors.join(" ")
    }

    /// All monomials of a degree, in falling lexical order of (p, s).
    fn all(modes: usize, degree: usize) -> Vec<Monomial> {
        /// Completes `exponents` to `count` numbers in all ways in which the new ones sum to `left`.
        fn fill(exponents: &mut Vec<u8>, left: usize, count: usize, all: &mut Vec<Vec<u8>>) {
            if exponents.len() + 1 == count {
                exponents.push(left as u8);
                all.push(exponents.clone());
                exponents.pop();
                return;
            }
            for next in (0..=left).rev() {
                exponents.push(next as u8);
                fill(exponents, left - next, count, all);
                exponents.pop();
            }
        }
        let mut all = Vec::new();
        fill(&mut Vec::new(), degree, 2 * modes, &mut all);
        let split = |e: Vec<u8>| Monomial {
            z: e[..modes].to_vec(),
            conj: e[modes..].to_vec(),
        };
        all.into_iter().map(split).collect()
    }
}

/// Where the coefficient of a monomial is stored.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    pub degree: usize,
    /// Position among the stored monomials of its degree.
    pub index: usize,
    /// Whether the coefficient is the conjugate of the stored one.
    pub conjugate: bool,
}

/// The stored monomials by degree.
#[derive(Clone, Debug)]
pub struct Monomials {
    modes: usize,
    stored: Vec<Vec<Monomial>>,
    places: HashMap<Monomial, Place>,
    /// All (β, γ) with β γ = α and neither of degree 0, `[degree][index of α]`.
    products: Vec<Vec<Vec<(Place, Place)>>>,
}

impl Monomials {
    /// The monomial 1, of degree 0, in the amplitudes of `modes` modes.
    pub fn new(modes: usize) -> Self {
        let mut monomials = Monomials {
            modes,
            stored: Vec::new(),
            places: HashMap::new(),
            products: Vec::new(),
        };
        monomials.extend();
        monomials
    }

    /// Number of amplitudes.
    pub fn modes(&self) -> usize {
        self.modes
    }

    /// The highest degree.
    pub fn degree(&self) -> usize {
        self.stored.len() - 1
    }

    /// The stored monomials of one degree.
    pub fn of(&self, degree: usize) -> &[Monomial] {
        &self.stored[degree]
    }

    /// Where a monomial's coefficient is.
    pub fn place(&self, monomial: &Monomial) -> Option<Place> {
        self.places.get(monomial).copied()
    }

    /// The products that make one stored monomial, factors of degree 0 left out.
    pub fn products(&self, degree: usize, index: usize) -> &[(Place, Place)] {
        &self.products[degree][index]
    }

    /// Adds the monomials of the next degree.
    pub fn extend(&mut self) {
        let degree = self.stored.len();
        let all = Monomial::all(self.modes, degree);
        let mut stored: Vec<Monomial> = Vec::new();
        for monomial in all.iter().filter(|m| m.z >= m.conj) {
            let place = Place {
                degree,
                index: stored.len(),
                conjugate: false,
            };
            self.places.insert(monomial.clone(), place);
            let mirrored = Place {
                conjugate: true,
                ..place
            };
            self.places.entry(monomial.conjugate()).or_insert(mirrored);
            stored.push(monomial.clone());
        }
        let products: Vec<_> = stored.iter().map(|alpha| self.factorings(alpha)).collect();
        self.products.push(products);
        self.stored.push(stored);
    }

    /// All (β, γ) with β γ = α and neither of degree 0.
    fn factorings(&self, alpha: &Monomial) -> Vec<(Place, Place)> {
        let mut pairs = Vec::new();
        for degree in 1..alpha.degree() {
            for beta in Monomial::all(self.modes, degree) {
                if let Some(gamma) = alpha.over(&beta) {
                    pairs.push((self.places[&beta], self.places[&gamma]));
                }
            }
        }
        pairs
    }
}

#[cfg(test)]
mod tests {
    use super::Monomials;

    /// z^p z̄^s has Π (p + 1)(s + 1) divisors, itself and 1 among them.
    #[test]
    fn every_product_once() {
        let mut monomials = Monomials::new(2);
        for _ in 0..5 {
            monomials.extend();
        }
        for degree in 1..=5 {
            for (index, alpha) in monomials.of(degree).iter().enumerate() {
                let exponents = alpha.z.iter().chain(&alpha.conj);
                let divisors: usize = exponents.map(|&e| usize::from(e) + 1).product();
                assert_eq!(monomials.products(degree, index).len(), divisors - 2);
            }
        }
        // C(2n + d − 1, d) monomials of a degree, pairs of conjugates stored once.
        assert_eq!(monomials.of(2).len(), (10 + 2) / 2);
        assert_eq!(monomials.of(3).len(), 20 / 2);
    }
}
