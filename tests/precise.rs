//! Amplitude equations of models without a cross-stream coordinate in arithmetic of 32 digits: the truth beside which
//! the error bars of rounding are judged. Written from the equations alone; nothing of the solver is used.

use landau_solver::model::C64;
use std::collections::BTreeMap;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// An unevaluated sum of two doubles (Dekker 1971).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Double2(f64, f64);

fn two_sum(a: f64, b: f64) -> Double2 {
    let s = a + b;
    let t = s - a;
    Double2(s, (a - (s - t)) + (b - t))
}

impl From<f64> for Double2 {
    fn from(x: f64) -> Self {
        Double2(x, 0.0)
    }
}

impl Add for Double2 {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        let s = two_sum(self.0, o.0);
        let t = two_sum(self.1, o.1);
        let u = two_sum(s.0, s.1 + t.0);
        two_sum(u.0, u.1 + t.1)
    }
}

impl Neg for Double2 {
    type Output = Self;
    fn neg(self) -> Self {
        Double2(-self.0, -self.1)
    }
}

impl Sub for Double2 {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Double2 {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        let p = self.0 * o.0;
        let e = self.0.mul_add(o.0, -p) + (self.0 * o.1 + self.1 * o.0);
        two_sum(p, e)
    }
}

impl Div for Double2 {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let q = Double2::from(self.0 / o.0);
        let r = self - q * o;
        let q = q + Double2::from(r.0 / o.0);
        let r = self - q * o;
        q + Double2::from(r.0 / o.0)
    }
}

/// A complex number of 32 digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Complex2 {
    re: Double2,
    im: Double2,
}

const NOTHING: Complex2 = Complex2 {
    re: Double2(0.0, 0.0),
    im: Double2(0.0, 0.0),
};

impl Complex2 {
    /// From two doubles.
    pub fn new(re: f64, im: f64) -> Self {
        Complex2 {
            re: re.into(),
            im: im.into(),
        }
    }

    fn real(re: Double2) -> Self {
        Complex2 { re, ..NOTHING }
    }

    fn conj(self) -> Self {
        Complex2 {
            im: -self.im,
            ..self
        }
    }

    /// The nearest double.
    pub fn rounded(self) -> C64 {
        C64::new(self.re.0, self.im.0)
    }

    fn sqrt(self) -> Self {
        // Newton's method from the root in doubles.
        let start = self.rounded().sqrt();
        if start == C64::new(0.0, 0.0) {
            return NOTHING;
        }
        let half = Complex2::new(0.5, 0.0);
        let first = Complex2::new(start.re, start.im);
        let second = half * (first + self / first);
        half * (second + self / second)
    }

    fn size(self) -> f64 {
        self.rounded().norm()
    }
}

impl Add for Complex2 {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Complex2 {
            re: self.re + o.re,
            im: self.im + o.im,
        }
    }
}

impl Neg for Complex2 {
    type Output = Self;
    fn neg(self) -> Self {
        Complex2 {
            re: -self.re,
            im: -self.im,
        }
    }
}

impl Sub for Complex2 {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        self + -o
    }
}

impl Mul for Complex2 {
    type Output = Self;
    fn mul(self, o: Self) -> Self {
        Complex2 {
            re: self.re * o.re - self.im * o.im,
            im: self.re * o.im + self.im * o.re,
        }
    }
}

impl Div for Complex2 {
    type Output = Self;
    fn div(self, o: Self) -> Self {
        let square = o.re * o.re + o.im * o.im;
        let above = self * o.conj();
        Complex2 {
            re: above.re / square,
            im: above.im / square,
        }
    }
}

/// coefficient · Π ∂x^order field in one balance.
pub struct Term {
    pub balance: usize,
    pub coefficient: Double2,
    pub factors: Vec<(usize, u32)>,
}

/// ∂t X = Σ terms.
pub struct Equations {
    pub fields: usize,
    pub terms: Vec<Term>,
}

type Degrees = (usize, usize);

impl Equations {
    /// (i q)^order
    fn symbol(q: Double2, order: u32) -> Complex2 {
        let step = Complex2 {
            re: 0.0.into(),
            im: q,
        };
        (0..order).fold(Complex2::new(1.0, 0.0), |product, _| product * step)
    }

    fn operator(&self, q: Double2) -> Vec<Vec<Complex2>> {
        let mut matrix = vec![vec![NOTHING; self.fields]; self.fields];
        for term in self.terms.iter().filter(|t| t.factors.len() == 1) {
            let (field, order) = term.factors[0];
            let entry = Complex2::real(term.coefficient) * Self::symbol(q, order);
            matrix[term.balance][field] = matrix[term.balance][field] + entry;
        }
        matrix
    }

    /// c0, c2, c4, … of the mode whose eigenvalue is nearest to `near` and whose first field is 1.
    pub fn coefficients(&self, k: f64, near: C64, count: usize) -> Vec<C64> {
        let k = Double2::from(k);
        let matrix = self.operator(k);
        let (c, right, left) = eigenpair(&matrix, near);
        let mut modes: BTreeMap<Degrees, Vec<Complex2>> = BTreeMap::new();
        modes.insert((1, 0), right.clone());
        modes.insert((0, 1), right.iter().map(|x| x.conj()).collect());
        let mut g = vec![c];
        for degree in 2..2 * count {
            for p in degree.div_ceil(2)..=degree {
                let s = degree - p;
                let (harmonic, forcing) = (p - s, self.forcing(&modes, k, (p, s), &g));
                let resonant = harmonic == 1;
                let q = k * Double2::from(harmonic as f64);
                // σ = p c + s c̄
                let number = |n: usize| Complex2::new(n as f64, 0.0);
                let sigma = number(p) * c + number(s) * c.conj();
                let mut system = self.operator(q);
                for (i, row) in system.iter_mut().enumerate() {
                    row.iter_mut().for_each(|x| *x = -*x);
                    row[i] = row[i] + sigma;
                }
                let mut forcing = forcing;
                if resonant {
                    for (row, x) in system.iter_mut().zip(&right) {
                        row.push(*x);
                    }
                    let mut last = left.clone();
                    last.push(NOTHING);
                    system.push(last);
                    forcing.push(NOTHING);
                }
                let mut solution = solved(system, forcing);
                if resonant {
                    g.push(solution.pop().expect("a coefficient"));
                }
                if p > s {
                    modes.insert((s, p), solution.iter().map(|x| x.conj()).collect());
                }
                modes.insert((p, s), solution);
            }
        }
        g.iter().map(|c| c.rounded()).collect()
    }

    /// The products that force X_ps, less the rates of lower coefficients that the nonlinear terms of dz/dt give.
    fn forcing(
        &self,
        modes: &BTreeMap<Degrees, Vec<Complex2>>,
        k: Double2,
        alpha: Degrees,
        g: &[Complex2],
    ) -> Vec<Complex2> {
        let mut sum = vec![NOTHING; self.fields];
        for term in self.terms.iter().filter(|t| t.factors.len() > 1) {
            let product = product(modes, k, alpha, &term.factors);
            sum[term.balance] = sum[term.balance] + Complex2::real(term.coefficient) * product;
        }
        for (n, g) in g.iter().enumerate().skip(1) {
            if alpha.0 < n || alpha.1 < n {
                continue;
            }
            let lower = (alpha.0 - n, alpha.1 - n);
            if let Some(mode) = modes.get(&lower).filter(|_| lower.0 + lower.1 > 1) {
                let number = |n: usize| Complex2::new(n as f64, 0.0);
                let rate = number(lower.0) * *g + number(lower.1) * g.conj();
                for (sum, x) in sum.iter_mut().zip(mode) {
                    *sum = *sum - rate * *x;
                }
            }
        }
        sum
    }
}

/// The coefficient of one monomial in a product of derivatives.
fn product(
    modes: &BTreeMap<Degrees, Vec<Complex2>>,
    k: Double2,
    alpha: Degrees,
    factors: &[(usize, u32)],
) -> Complex2 {
    let Some(((field, order), others)) = factors.split_first() else {
        return Complex2::new(f64::from(u8::from(alpha == (0, 0))), 0.0);
    };
    let mut sum = NOTHING;
    for (beta, mode) in modes {
        if beta.0 > alpha.0 || beta.1 > alpha.1 {
            continue;
        }
        let left = (alpha.0 - beta.0, alpha.1 - beta.1);
        if left.0 + left.1 < others.len() {
            continue;
        }
        let q = k * Double2::from(beta.0 as f64 - beta.1 as f64);
        let value = Equations::symbol(q, *order) * mode[*field];
        sum = sum + value * product(modes, k, left, others);
    }
    sum
}

/// The eigenvalue nearest to `near` of one or two equations, the vector whose first entry is 1, and the left one, conjugate.
fn eigenpair(m: &[Vec<Complex2>], near: C64) -> (Complex2, Vec<Complex2>, Vec<Complex2>) {
    let one = Complex2::new(1.0, 0.0);
    if m.len() == 1 {
        return (m[0][0], vec![one], vec![one]);
    }
    let half = Complex2::new(0.5, 0.0);
    let middle = half * (m[0][0] + m[1][1]);
    let difference = half * (m[0][0] - m[1][1]);
    let root = (difference * difference + m[0][1] * m[1][0]).sqrt();
    let distance = |c: &Complex2| (c.rounded() - near).norm();
    let roots = [middle + root, middle - root];
    let c = if distance(&roots[0]) <= distance(&roots[1]) {
        roots[0]
    } else {
        roots[1]
    };
    // (M − c) x = 0 and y (M − c) = 0 by the first row, and the first column.
    let right = vec![one, (c - m[0][0]) / m[0][1]];
    let left = vec![one, (c - m[0][0]) / m[1][0]];
    (c, right, left)
}

/// Gauss's elimination with the largest pivot of each column.
fn solved(mut a: Vec<Vec<Complex2>>, mut b: Vec<Complex2>) -> Vec<Complex2> {
    let n = b.len();
    for column in 0..n {
        let size = |r: &usize| a[*r][column].size();
        let pivot = (column..n)
            .max_by(|r, s| size(r).total_cmp(&size(s)))
            .expect("a row");
        a.swap(column, pivot);
        b.swap(column, pivot);
        for row in column + 1..n {
            let factor = a[row][column] / a[column][column];
            let pivot_row = a[column].clone();
            for (entry, above) in a[row].iter_mut().zip(pivot_row).skip(column) {
                *entry = *entry - factor * above;
            }
            b[row] = b[row] - factor * b[column];
        }
    }
    for row in (0..n).rev() {
        for j in row + 1..n {
            b[row] = b[row] - a[row][j] * b[j];
        }
        b[row] = b[row] / a[row][row];
    }
    b
}

fn term(balance: usize, coefficient: impl Into<Double2>, factors: &[(usize, u32)]) -> Term {
    Term {
        balance,
        coefficient: coefficient.into(),
        factors: factors.to_vec(),
    }
}

/// u_t = r u − (1 + ∂xx)² u + b u² − u³
pub fn swift_hohenberg(r: f64, b: f64) -> Equations {
    Equations {
        fields: 1,
        terms: vec![
            term(0, Double2::from(r) - 1.0.into(), &[(0, 0)]),
            term(0, -2.0, &[(0, 2)]),
            term(0, -1.0, &[(0, 4)]),
            term(0, b, &[(0, 0), (0, 0)]),
            term(0, -1.0, &[(0, 0), (0, 0), (0, 0)]),
        ],
    }
}

/// u_t + u u_x + u_xx + ν u_xxxx + δ u_xxx = 0
pub fn kuramoto_sivashinsky(nu: f64, delta: f64) -> Equations {
    Equations {
        fields: 1,
        terms: vec![
            term(0, -1.0, &[(0, 0), (0, 1)]),
            term(0, -1.0, &[(0, 2)]),
            term(0, -nu, &[(0, 4)]),
            term(0, -delta, &[(0, 3)]),
        ],
    }
}

/// The Brusselator about u = A, v = B/A.
pub fn brusselator(a: f64, b: f64, d1: f64, d2: f64) -> Equations {
    let (a, b) = (Double2::from(a), Double2::from(b));
    let mut terms = vec![
        term(0, b - 1.0.into(), &[(0, 0)]),
        term(0, a * a, &[(1, 0)]),
        term(0, d1, &[(0, 2)]),
        term(1, -b, &[(0, 0)]),
        term(1, -(a * a), &[(1, 0)]),
        term(1, d2, &[(1, 2)]),
    ];
    for (balance, sign) in [(0, Double2::from(1.0)), (1, Double2::from(-1.0))] {
        terms.extend([
            term(balance, sign * (b / a), &[(0, 0), (0, 0)]),
            term(balance, sign * (a + a), &[(0, 0), (1, 0)]),
            term(balance, sign, &[(0, 0), (0, 0), (1, 0)]),
        ]);
    }
    Equations { fields: 2, terms }
}

/// The exact c2 of the first two, and 32 digits of a square root.
#[test]
fn the_truth_is_true() {
    let root = Complex2::new(-2.0, 3.0).sqrt();
    let left = root * root - Complex2::new(-2.0, 3.0);
    assert!(left.size() < 1e-30, "{left:?}");
    let (r, b, k) = (0.3_f64, 0.7_f64, 1.1_f64);
    let q = (1.0 - k * k).powi(2);
    let q2 = (1.0 - 4.0 * k * k).powi(2);
    let exact = -3.0 + 4.0 * b * b / (r + 1.0 - 2.0 * q) + 2.0 * b * b / (r - 2.0 * q + q2);
    let found = swift_hohenberg(r, b).coefficients(k, C64::new(r - q, 0.0), 2);
    assert!((found[1].re - exact).abs() < 1e-14, "{found:?} for {exact}");
    // P. Kuramoto–Sivashinsky at k = 1: c2 = −1/(2 (7 ν − 1) − 6 i δ).
    let (nu, delta) = (0.9, 0.4);
    let exact = -C64::new(2.0 * (7.0 * nu - 1.0), -6.0 * delta).inv();
    let near = C64::new(1.0 - nu, delta);
    let found = kuramoto_sivashinsky(nu, delta).coefficients(1.0, near, 2);
    assert!((found[1] - exact).norm() < 1e-15, "{found:?} for {exact}");
}
