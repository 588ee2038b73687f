//! Spectra of matrix pencils L x = c M0 x with singular M0, and modes refined or followed.
//!
//! Boundary conditions, continuity and closures make M0 singular; the infinite eigenvalues are
//! deflated exactly before anything is computed, so none can show up as a spurious finite one.

use crate::dense::{Factorised, Scalar, dot, norm, scaled};
use crate::error::{Error, Result};
use crate::model::C64;
use crate::problem::Problem;
use faer::{Mat, MatRef};

/// Rounds of deflation: boundary conditions, a constraint, its hidden constraint, and one to spare.
const MOST_DEFLATIONS: usize = 4;
/// Singular directions of M0 after deflation, relative to its largest.
const RANK: f64 = 1e-11;
const MOST_ITERATIONS: usize = 30;
/// Cosine between a mode and its continuation below which it counts as another mode.
const SAME_SHAPE: f64 = 0.6;

/// An eigenvalue with right and left eigenvectors, in the solver's basis.
#[derive(Clone, Debug)]
pub struct EigenPair {
    pub k: f64,
    pub c: C64,
    pub right: Vec<C64>,
    /// yᴴ L = c yᴴ M0, boundary rows included.
    pub left: Vec<C64>,
}

/// All finite eigenvalues by decreasing real part.
///
/// # Errors
/// A pencil that is singular for every c (a gauge that the spec does not name).
pub fn eigenvalues(problem: &Problem, k: f64) -> Result<Vec<C64>> {
    if problem.is_real() || k == 0.0 {
        eigenvalues_of::<f64>(pencil(problem, k))
    } else {
        eigenvalues_of::<C64>(pencil(problem, k))
    }
}

/// Finite eigenvalues of the separately discretised adjoint, by decreasing real part.
///
/// # Errors
/// As [`eigenvalues`], and where the model has no adjoint boundary conditions.
pub fn adjoint_eigenvalues(problem: &Problem, k: f64) -> Result<Vec<C64>> {
    let adjoint = problem.adjoint()?;
    if problem.is_real() {
        eigenvalues_of::<f64>(problem.pencil_of(adjoint, k))
    } else {
        eigenvalues_of::<C64>(problem.pencil_of(adjoint, k))
    }
}

/// L and M0, bordered at k = 0.
fn pencil<T: Scalar>(problem: &Problem, k: f64) -> (Mat<T>, Mat<T>) {
    if k == 0.0 {
        problem.bordered_pencil()
    } else {
        problem.pencil(k)
    }
}

fn eigenvalues_of<T: Scalar>((operator, mass): (Mat<T>, Mat<T>)) -> Result<Vec<C64>> {
    let reduced = deflate(operator, mass)?;
    let shift = reduced.shift();
    let inverse = reduced.shift_invert(shift);
    let values = T::eigenvalues(inverse.as_ref())
        .ok_or_else(|| Error::computation("the eigenvalue iteration did not converge"))?;
    Ok(sorted(
        values.into_iter().map(|mu| shift + mu.inv()).collect(),
    ))
}

fn sorted(mut values: Vec<C64>) -> Vec<C64> {
    values.retain(|c| c.re.is_finite() && c.im.is_finite());
    values.sort_by(|a, b| b.re.total_cmp(&a.re).then(b.im.total_cmp(&a.im)));
    values
}

/// A pencil without infinite eigenvalues: x = basis · w.
struct Reduced<T: Scalar> {
    operator: Mat<T>,
    mass: Mat<T>,
    basis: Mat<T>,
}

/// Removes the algebraic equations, as often as they hide new ones.
fn deflate<T: Scalar>(mut operator: Mat<T>, mut mass: Mat<T>) -> Result<Reduced<T>> {
    let n = operator.ncols();
    let mut basis: Option<Mat<T>> = None;
    for round in 0..=MOST_DEFLATIONS {
        let size = operator.nrows();
        let algebraic: Vec<usize> = (0..size)
            .filter(|&i| (0..size).all(|j| mass[(i, j)].size() == 0.0))
            .collect();
        if algebraic.is_empty() {
            // Rotate rows so that hidden algebraic equations show as zero rows.
            let qr = mass.col_piv_qr();
            let r = qr.thin_R();
            let largest = r[(0, 0)].size();
            let rank = (0..size)
                .filter(|&i| r[(i, i)].size() > RANK * largest)
                .count();
            if rank == size {
                let basis = basis.unwrap_or_else(|| Mat::identity(n, n));
                return Ok(Reduced {
                    operator,
                    mass,
                    basis,
                });
            }
            if round == MOST_DEFLATIONS {
                break;
            }
            let q = qr.compute_Q();
            operator = q.adjoint() * &operator;
            mass = q.adjoint() * &mass;
            for i in rank..size {
                for j in 0..size {
                    mass[(i, j)] = T::from_complex(C64::new(0.0, 0.0));
                }
            }
            continue;
        }
        let dynamic: Vec<usize> = (0..size).filter(|i| !algebraic.contains(i)).collect();
        if dynamic.is_empty() {
            return Err(Error::computation(
                "the problem has no finite eigenvalue at this wavenumber",
            ));
        }
        // x in the null space of the algebraic rows: the last columns of Q of their adjoint, each
        // row scaled first so that no equation outweighs another.
        let constraints = Mat::from_fn(size, algebraic.len(), |j, a| {
            let row = algebraic[a];
            let largest = (0..size)
                .map(|c| operator[(row, c)].size())
                .fold(1e-300, f64::max);
            T::from_complex(operator[(row, j)].complex().conj() / largest)
        });
        let qr = constraints.col_piv_qr();
        let r = qr.thin_R();
        let count = algebraic.len();
        let largest = r[(0, 0)].size();
        if (0..count).any(|i| r[(i, i)].size() <= RANK * largest) {
            return Err(Error::computation(
                "the linear problem is singular for every growth rate: a field is determined up to \
                 something arbitrary; name it as `gauge` in the block `mean`, or check the balances",
            ));
        }
        let q = qr.compute_Q();
        let null = q.subcols(count, size - count);
        let rows = |m: &Mat<T>| Mat::from_fn(dynamic.len(), size, |i, j| m[(dynamic[i], j)]);
        operator = rows(&operator) * null;
        mass = rows(&mass) * null;
        basis = Some(match basis {
            None => null.to_owned(),
            Some(before) => before * null,
        });
    }
    Err(Error::computation(
        "the mass matrix stays singular after its hidden constraints are removed",
    ))
}

impl<T: Scalar> Reduced<T> {
    /// A real shift on the scale of the slow part of the spectrum.
    fn shift(&self) -> C64 {
        // An irrational number is no eigenvalue of a model with round parameters.
        C64::new(0.577_215_664_901_532_9, 0.0)
    }

    /// (L − σ M0)⁻¹ M0
    fn shift_invert(&self, shift: C64) -> Mat<T> {
        let n = self.operator.nrows();
        let shifted = Mat::from_fn(n, n, |i, j| {
            T::from_complex(self.operator[(i, j)].complex() - shift * self.mass[(i, j)].complex())
        });
        let scale: Vec<f64> = (0..n)
            .map(|i| {
                1.0 / (0..n)
                    .map(|j| shifted[(i, j)].size())
                    .fold(1e-300, f64::max)
            })
            .collect();
        let row_scaled = |m: MatRef<'_, T>| {
            Mat::from_fn(n, n, |i, j| T::from_complex(m[(i, j)].complex() * scale[i]))
        };
        let lu = row_scaled(shifted.as_ref()).partial_piv_lu();
        let mut inverse = row_scaled(self.mass.as_ref());
        use faer::linalg::solvers::Solve;
        lu.solve_in_place(inverse.as_mut());
        inverse
    }
}

/// Eigenvalues with right eigenvectors in the solver's basis, by decreasing real part.
fn eigenvectors(problem: &Problem, k: f64) -> Result<Vec<(C64, Vec<C64>)>> {
    if problem.is_real() {
        eigenvectors_of::<f64>(problem.pencil(k))
    } else {
        eigenvectors_of::<C64>(problem.pencil(k))
    }
}

fn eigenvectors_of<T: Scalar>((operator, mass): (Mat<T>, Mat<T>)) -> Result<Vec<(C64, Vec<C64>)>> {
    let reduced = deflate(operator, mass)?;
    let shift = reduced.shift();
    let inverse = reduced.shift_invert(shift);
    let (values, vectors) = T::eigen(inverse.as_ref())
        .ok_or_else(|| Error::computation("the eigenvalue iteration did not converge"))?;
    let n = reduced.basis.nrows();
    let basis = Mat::from_fn(n, reduced.basis.ncols(), |i, j| {
        reduced.basis[(i, j)].complex()
    });
    let full = &basis * &vectors;
    let mut pairs: Vec<(C64, Vec<C64>)> = values
        .into_iter()
        .enumerate()
        .map(|(j, mu)| (shift + mu.inv(), (0..n).map(|i| full[(i, j)]).collect()))
        .filter(|(c, _): &(C64, Vec<C64>)| c.re.is_finite() && c.im.is_finite())
        .collect();
    pairs.sort_by(|a, b| b.0.re.total_cmp(&a.0.re).then(b.0.im.total_cmp(&a.0.im)));
    Ok(pairs)
}

/// The leading mode.
///
/// # Errors
/// A spectrum that cannot be computed, or a mode that inverse iteration does not confirm.
pub fn leading(problem: &Problem, k: f64) -> Result<EigenPair> {
    let (c, right) = eigenvectors(problem, k)?
        .into_iter()
        .next()
        .ok_or_else(no_modes)?;
    confirm(problem, k, c, right)
}

/// The mode nearest to a given eigenvalue.
///
/// # Errors
/// As [`leading`].
pub fn nearest(problem: &Problem, k: f64, target: C64) -> Result<EigenPair> {
    let pairs = eigenvectors(problem, k)?;
    let best = pairs
        .into_iter()
        .min_by(|a, b| (a.0 - target).norm().total_cmp(&(b.0 - target).norm()))
        .ok_or_else(no_modes)?;
    confirm(problem, k, best.0, best.1)
}

/// The continuation of a mode to another wavenumber or base state, by its shape.
///
/// # Errors
/// Where no mode has a similar shape.
pub fn follow(problem: &Problem, k: f64, near: &EigenPair) -> Result<EigenPair> {
    if near.right.len() == problem.direct.layout.size
        && let Some(pair) = refine(
            problem,
            k,
            predict(problem, k, near),
            &near.right,
            &near.left,
        )
        && likeness(&near.right, &pair.right) > SAME_SHAPE
    {
        return Ok(pair);
    }
    let pairs = eigenvectors(problem, k)?;
    let (c, right) = pairs
        .into_iter()
        .max_by(|a, b| likeness(&near.right, &a.1).total_cmp(&likeness(&near.right, &b.1)))
        .ok_or_else(no_modes)?;
    let overlap = likeness(&near.right, &right);
    if overlap < SAME_SHAPE {
        return Err(Error::computation(format!(
            "the mode was lost at k = {k}: none has its shape (best overlap {overlap:.2}); try smaller steps"
        )));
    }
    confirm(problem, k, c, right)
}

/// yᴴ L x / yᴴ M0 x with the vectors found nearby: off by the square of the distance.
fn predict(problem: &Problem, k: f64, near: &EigenPair) -> C64 {
    let c = if problem.is_real() && near.c.im == 0.0 {
        quotient::<f64>(problem, k, near)
    } else {
        quotient::<C64>(problem, k, near)
    };
    beside(if c.norm().is_finite() { c } else { near.c })
}

fn quotient<T: Scalar>(problem: &Problem, k: f64, near: &EigenPair) -> C64 {
    let kind = |x: &[C64]| -> Vec<T> { x.iter().map(|&v| T::from_complex(v)).collect() };
    let (right, left) = (kind(&near.right), kind(&near.left));
    let above = dot(&left, &problem.operator::<T>(k).apply(&right));
    above / dot(&left, &problem.mass::<T>(k).apply(&right))
}

/// A shift next to an eigenvalue: off it by a little, so that the matrix can be factorised.
fn beside(c: C64) -> C64 {
    c + C64::new(1e-7 * c.norm().max(1e-3), 0.0)
}

fn no_modes() -> Error {
    Error::computation("the linear problem has no finite eigenvalue")
}

/// |cosine| of the angle between two shapes.
pub fn likeness(a: &[C64], b: &[C64]) -> f64 {
    if a.len() != b.len() {
        return 0.0;
    }
    dot(a, b).norm() / (norm(a) * norm(b)).max(1e-300)
}

fn confirm(problem: &Problem, k: f64, c: C64, right: Vec<C64>) -> Result<EigenPair> {
    // The left vector comes from the iteration itself; any start that is not orthogonal will do.
    let start: Vec<C64> = (0..right.len())
        .map(|i| C64::new(1.0 + 0.37 * ((i * i) as f64).sin(), 0.0))
        .collect();
    refine(problem, k, beside(c), &right, &start).ok_or_else(|| {
        Error::computation(format!(
            "the eigenvalue {c:.6e} at k = {k} was not confirmed by inverse iteration; try another M"
        ))
    })
}

/// Two-sided inverse iteration with one factorisation at `shift`.
fn refine(problem: &Problem, k: f64, shift: C64, right: &[C64], left: &[C64]) -> Option<EigenPair> {
    if problem.is_real() && shift.im.abs() <= 1e-12 * shift.norm().max(1e-6) {
        iterate::<f64>(problem, k, C64::new(shift.re, 0.0), right, left)
    } else {
        iterate::<C64>(problem, k, shift, right, left)
    }
}

fn iterate<T: Scalar>(
    problem: &Problem,
    k: f64,
    shift: C64,
    right: &[C64],
    left: &[C64],
) -> Option<EigenPair> {
    let mass = problem.mass::<T>(k);
    let factorised = Factorised::new(problem.shifted::<T>(k, shift));
    let kind = |x: &[C64]| -> Vec<T> {
        // A real mode may come with a complex factor: turn its largest entry real.
        let largest = x
            .iter()
            .max_by(|a, b| a.norm().total_cmp(&b.norm()))
            .copied();
        let phase = largest
            .filter(|l| l.norm() > 0.0)
            .map_or(C64::new(1.0, 0.0), |l| l.conj() / l.norm());
        x.iter().map(|v| T::from_complex(v * phase)).collect()
    };
    let (mut x, mut y) = (kind(right), kind(left));
    let mut mass_x = mass.apply(&x);
    let mut mass_y = mass.apply_adjoint(&y);
    let (mut c, mut change) = (shift, f64::INFINITY);
    for iteration in 0..MOST_ITERATIONS {
        let new_x = factorised.solve(&mass_x);
        let new_y = factorised.solve_adjoint(&mass_y);
        let (size_x, size_y) = (norm(&new_x), norm(&new_y));
        if !(size_x.is_finite() && size_y.is_finite()) || size_x == 0.0 || size_y == 0.0 {
            return None;
        }
        let new_mass_x = mass.apply(&new_x);
        // (σ M0 − L) x_new = M0 x_old
        let denominator = dot(&new_y, &new_mass_x);
        if denominator.norm() == 0.0 {
            return None;
        }
        let next = shift - dot(&new_y, &mass_x) / denominator;
        x = scaled(&new_x, 1.0 / size_x);
        y = scaled(&new_y, 1.0 / size_y);
        mass_x = scaled(&new_mass_x, 1.0 / size_x);
        mass_y = mass.apply_adjoint(&y);
        let step = (next - c).norm();
        c = next;
        // The eigenvalue converges twice as fast as the vectors: one more turn after it settles.
        let floor = 1e-14 * c.norm().max((shift - c).norm()) + 1e-17;
        if iteration > 0
            && (step <= floor || (step < 1e-10 * c.norm().max(1e-6) && step >= 0.5 * change))
        {
            let complex = |v: Vec<T>| v.into_iter().map(Scalar::complex).collect();
            return Some(EigenPair {
                k,
                c,
                right: complex(x),
                left: complex(y),
            });
        }
        change = step;
    }
    None
}
