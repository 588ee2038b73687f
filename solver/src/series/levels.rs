//! The coefficients of every register of a program on truncated polynomials Σ_α a_α z^p z̄^s, degree by degree.
//!
//! A coefficient of degree |α| is a sum of two parts. Products of lower degrees, Σ a_β b_γ over β γ = α with |β|, |γ| ≥ 1,
//! are computed once, by [`Levels::begin`]. The terms with β = 1 or γ = 1 are linear in coefficients of degree |α|, with
//! values at the base state as factors; they are added by [`Levels::outputs`] and [`Levels::complete`], as often as the
//! coefficients of the jets change. [`Product`] and `close` hold the equations of both parts.

use super::monomial::{Monomials, Place};
use super::program::{Arithmetic, Program, Step};
use crate::model::{C64, Number, Register, apply};
use crate::numerics::dense::vectorised;

/// The coefficients of all registers at the points of one grid, through some degree.
pub struct Levels {
    /// Number of points.
    points: usize,
    /// Numbers that a coefficient has at a point: one in real arithmetic; real and imaginary part in complex arithmetic.
    parts: usize,
    /// a_0, the values at the base state, `[register][point]`.
    base: Vec<f64>,
    /// Slot of a register: its position among those that depend on jets.
    slots: Vec<usize>,
    /// Number of slots.
    count: usize,
    /// a_α by degree from 1 on, `[degree − 1][slot][monomial][part][point]`, the last four in one array.
    levels: Vec<Vec<f64>>,
    /// Memory of a copy of the last level, kept from call to call.
    scratch: Vec<f64>,
}

impl Levels {
    /// The values at the base state. `states` and `jets` are its point states and jets, `[point][element]`.
    pub fn new(program: &Program, states: &[Vec<f64>], jets: &[Vec<f64>]) -> Self {
        let points = states.len();
        let (mut slots, mut count) = (Vec::new(), 0);
        for &series in &program.series {
            slots.push(count);
            count += usize::from(series);
        }
        let mut levels = Levels {
            points,
            parts: match program.arithmetic() {
                Arithmetic::Real => 1,
                Arithmetic::Complex => 2,
            },
            base: vec![0.0; program.steps.len() * points],
            slots,
            count,
            levels: Vec::new(),
            scratch: Vec::new(),
        };
        for register in 0..program.steps.len() {
            for point in 0..points {
                let value = levels.base_value(program, register, point, states, jets);
                levels.base[register * points + point] = value;
            }
        }
        levels
    }

    fn base_value(
        &self,
        program: &Program,
        register: Register,
        point: usize,
        states: &[Vec<f64>],
        jets: &[Vec<f64>],
    ) -> f64 {
        let at = |r: Register| self.base[r * self.points + point];
        match program.steps[register] {
            Step::Constant(value) => value,
            Step::Point(position) => states[point][position],
            Step::Jet(jet) => jets[point][jet],
            Step::Add(a, b) => at(a) + at(b),
            Step::Subtract(a, b) => at(a) - at(b),
            Step::Negate(a) => -at(a),
            Step::Multiply(a, b) => at(a) * at(b),
            Step::Divide(a, b) => at(a) / at(b),
            Step::Power(a, 0.5) => at(a).sqrt(),
            Step::Power(a, exponent) => Number::powf(at(a), exponent),
            Step::Function {
                function, argument, ..
            } => apply(function, at(argument)),
        }
    }

    /// Length of one coefficient: parts times points.
    fn width(&self) -> usize {
        self.parts * self.points
    }

    /// Begins the next degree: computes the products of lower degrees for the stored monomials with the indices `wanted`.
    /// Coefficients of all remaining monomials are zero. Levels of this degree and beyond are discarded.
    pub fn begin(
        &mut self,
        program: &Program,
        monomials: &Monomials,
        degree: usize,
        wanted: &[usize],
    ) {
        let count = monomials.of(degree).len();
        let width = self.width();
        self.levels.truncate(degree - 1);
        let mut level = vec![0.0; self.count * count * width];
        for (register, step) in program.steps.iter().enumerate() {
            if !program.series[register] {
                continue;
            }
            let Some(product) = Product::of(program, register, step) else {
                continue;
            };
            let first = self.slots[register] * count;
            for &index in wanted {
                let target = &mut level[(first + index) * width..][..width];
                vectorised(
                    #[inline(always)]
                    || {
                        // Σ weight(β, γ) a_β b_γ over β γ = α
                        for &(left, right) in monomials.products(degree, index) {
                            let factor = product.weight(left, right, degree);
                            let a = self.coefficient(monomials, product.left, left);
                            let b = self.coefficient(monomials, product.right, right);
                            product.add(target, a, b, factor, (left, right), self.points);
                        }
                    },
                );
            }
        }
        self.levels.push(level);
    }

    /// One coefficient, `[part][point]`, as it is stored.
    fn coefficient(&self, monomials: &Monomials, register: Register, place: Place) -> &[f64] {
        let count = monomials.of(place.degree).len();
        let position = self.slots[register] * count + place.index;
        &self.levels[place.degree - 1][position * self.width()..][..self.width()]
    }

    /// The outputs' coefficients of the degree begun, `[output][monomial][point]`. `jets(jet, monomial)` are the
    /// coefficients of the jets, `[point]`, `None` being zero. They are not kept.
    pub fn outputs(
        &mut self,
        program: &Program,
        monomials: &Monomials,
        degree: usize,
        jets: &dyn Fn(usize, usize) -> Option<Vec<C64>>,
    ) -> Vec<Vec<Vec<C64>>> {
        let count = monomials.of(degree).len();
        let mut level = std::mem::take(&mut self.scratch);
        level.clone_from(&self.levels[degree - 1]);
        self.close(program, count, &mut level, jets);
        let outputs = program.outputs.iter().map(|&register| {
            let value = |index: usize| self.read(program, register, count, index, &level);
            (0..count).map(value).collect()
        });
        let outputs = outputs.collect();
        self.scratch = level;
        outputs
    }

    /// Completes the degree begun with the coefficients of the jets, as in [`Levels::outputs`], and keeps it.
    pub fn complete(
        &mut self,
        program: &Program,
        monomials: &Monomials,
        degree: usize,
        jets: &dyn Fn(usize, usize) -> Option<Vec<C64>>,
    ) {
        let count = monomials.of(degree).len();
        let mut level = std::mem::take(&mut self.levels[degree - 1]);
        self.close(program, count, &mut level, jets);
        self.levels[degree - 1] = level;
    }

    /// One coefficient of a register in `level`, as complex numbers, `[point]`.
    fn read(
        &self,
        program: &Program,
        register: Register,
        count: usize,
        index: usize,
        level: &[f64],
    ) -> Vec<C64> {
        if !program.series[register] {
            return vec![C64::new(0.0, 0.0); self.points];
        }
        let width = self.width();
        let values = &level[(self.slots[register] * count + index) * width..][..width];
        match (program.arithmetic(), program.odd[register]) {
            (Arithmetic::Real, false) => values.iter().map(|&v| C64::new(v, 0.0)).collect(),
            (Arithmetic::Real, true) => values.iter().map(|&v| C64::new(0.0, v)).collect(),
            (Arithmetic::Complex, _) => {
                let (re, im) = values.split_at(self.points);
                re.iter()
                    .zip(im)
                    .map(|(&re, &im)| C64::new(re, im))
                    .collect()
            }
        }
    }

    /// Adds the terms that are linear in coefficients of this degree, register by register. `level` holds the `count`
    /// coefficients of every slot; operands come before the register that they make.
    fn close(
        &self,
        program: &Program,
        count: usize,
        level: &mut [f64],
        jets: &dyn Fn(usize, usize) -> Option<Vec<C64>>,
    ) {
        let length = count * self.width();
        for (register, step) in program.steps.iter().enumerate() {
            if !program.series[register] {
                continue;
            }
            let (before, from_here) = level.split_at_mut(self.slots[register] * length);
            let target = &mut from_here[..length];
            let operand = |r: Register| {
                program.series[r].then(|| &before[self.slots[r] * length..][..length])
            };
            let base = |r: Register| &self.base[r * self.points..][..self.points];
            // `target` holds S, the sum over products of lower degrees.
            match *step {
                Step::Constant(_) | Step::Point(_) => {}
                Step::Jet(jet) => self.fill(program, register, target, &|index| jets(jet, index)),
                // c_α = a_α + b_α
                Step::Add(a, b) => {
                    self.add(target, operand(a), 1.0);
                    self.add(target, operand(b), 1.0);
                }
                // c_α = a_α − b_α
                Step::Subtract(a, b) => {
                    self.add(target, operand(a), 1.0);
                    self.add(target, operand(b), -1.0);
                }
                // c_α = −a_α
                Step::Negate(a) => self.add(target, operand(a), -1.0),
                // c_α = S + a_α b_0 + a_0 b_α
                Step::Multiply(a, b) => {
                    self.add_times(target, operand(a), 1.0, base(b));
                    self.add_times(target, operand(b), 1.0, base(a));
                }
                // c = a/b: c_α = (S + a_α − c_0 b_α)/b_0
                Step::Divide(a, b) => {
                    self.add(target, operand(a), 1.0);
                    self.add_times(target, operand(b), -1.0, base(register));
                    self.divide(target, base(b));
                }
                // c = a^r: c_α = (S + r c_0 a_α)/a_0
                Step::Power(a, exponent) => {
                    self.add_times(target, operand(a), exponent, base(register));
                    self.divide(target, base(a));
                }
                // f with E f = sign · w · E a: f_α = S + sign · w_0 a_α
                Step::Function {
                    argument,
                    slope,
                    sign,
                    ..
                } => self.add_times(target, operand(argument), sign, base(slope)),
            }
        }
    }

    /// Stores the coefficients of a jet, `values(monomial)` being `[point]`.
    fn fill(
        &self,
        program: &Program,
        register: Register,
        target: &mut [f64],
        values: &dyn Fn(usize) -> Option<Vec<C64>>,
    ) {
        for (index, target) in target.chunks_exact_mut(self.width()).enumerate() {
            let Some(values) = values(index) else {
                target.fill(0.0);
                continue;
            };
            match (program.arithmetic(), program.odd[register]) {
                (Arithmetic::Real, odd) => {
                    for (t, v) in target.iter_mut().zip(values) {
                        *t = if odd { v.im } else { v.re };
                    }
                }
                (Arithmetic::Complex, _) => {
                    let (re, im) = target.split_at_mut(self.points);
                    for ((re, im), v) in re.iter_mut().zip(im).zip(values) {
                        (*re, *im) = (v.re, v.im);
                    }
                }
            }
        }
    }

    /// target += factor · operand
    fn add(&self, target: &mut [f64], operand: Option<&[f64]>, factor: f64) {
        let Some(operand) = operand else { return };
        for (t, x) in target.iter_mut().zip(operand) {
            *t += factor * x;
        }
    }

    /// target += factor · operand · base, with `base` by point.
    fn add_times(&self, target: &mut [f64], operand: Option<&[f64]>, factor: f64, base: &[f64]) {
        let Some(operand) = operand else { return };
        let chunks = target.chunks_exact_mut(self.points);
        for (target, x) in chunks.zip(operand.chunks_exact(self.points)) {
            for ((t, x), b) in target.iter_mut().zip(x).zip(base) {
                *t += factor * x * b;
            }
        }
    }

    /// target /= base, with `base` by point.
    fn divide(&self, target: &mut [f64], base: &[f64]) {
        for target in target.chunks_exact_mut(self.points) {
            for (t, b) in target.iter_mut().zip(base) {
                *t /= b;
            }
        }
    }
}

/// The products of lower degrees that enter a register: S = Σ weight(|β|, |γ|) left_β right_γ over β γ = α with
/// |β|, |γ| ≥ 1.
struct Product {
    left: Register,
    right: Register,
    kind: Kind,
    /// Whether left and right are i times real, in real arithmetic.
    odd: (bool, bool),
    complex: bool,
}

/// Where the products come from. E is the Euler operator, E z^p z̄^s = (|p| + |s|) z^p z̄^s.
enum Kind {
    /// c = a b: S = Σ a_β b_γ.
    Product,
    /// b c = a: S = −Σ b_β c_γ.
    Quotient,
    /// c = a^r, from a E c = r c E a: S = Σ (r |β| − |γ|)/|α| a_β c_γ.
    Power(f64),
    /// f(a), from E f = sign · w · E a: S = sign Σ |β|/|α| a_β w_γ.
    Function(f64),
}

impl Product {
    /// The products that enter a register; `None` for a step without, or with an operand that is no series.
    fn of(program: &Program, register: Register, step: &Step) -> Option<Self> {
        let (left, right, kind) = match *step {
            Step::Multiply(a, b) => (a, b, Kind::Product),
            Step::Divide(_, b) => (b, register, Kind::Quotient),
            Step::Power(a, exponent) => (a, register, Kind::Power(exponent)),
            Step::Function {
                argument,
                slope,
                sign,
                ..
            } => (argument, slope, Kind::Function(sign)),
            _ => return None,
        };
        (program.series[left] && program.series[right]).then(|| Product {
            left,
            right,
            kind,
            odd: (program.odd[left], program.odd[right]),
            complex: program.arithmetic() == Arithmetic::Complex,
        })
    }

    /// The weight of the product of coefficients of two degrees, `degree` being their sum.
    #[inline(always)]
    fn weight(&self, left: Place, right: Place, degree: usize) -> f64 {
        let (l, r, d) = (left.degree as f64, right.degree as f64, degree as f64);
        match self.kind {
            Kind::Product => 1.0,
            Kind::Quotient => -1.0,
            Kind::Power(exponent) => (exponent * l - r) / d,
            Kind::Function(sign) => sign * l / d,
        }
    }

    /// target += factor · a b, a or b being conjugate where its place says so.
    #[inline(always)]
    fn add(
        &self,
        target: &mut [f64],
        a: &[f64],
        b: &[f64],
        factor: f64,
        (left, right): (Place, Place),
        points: usize,
    ) {
        let sign = |conjugate: bool| if conjugate { -1.0 } else { 1.0 };
        if self.complex {
            let (s, t) = (sign(left.conjugate), sign(right.conjugate));
            let (re, im) = target.split_at_mut(points);
            let ((ar, ai), (br, bi)) = (a.split_at(points), b.split_at(points));
            for (i, (re, im)) in re.iter_mut().zip(im).enumerate() {
                *re += factor * (ar[i] * br[i] - s * t * ai[i] * bi[i]);
                *im += factor * (s * ai[i] * br[i] + t * ar[i] * bi[i]);
            }
            return;
        }
        // A number that is i times real changes sign when conjugate, and the product of two such has the sign of i² = −1.
        let signs = sign(self.odd.0 && left.conjugate)
            * sign(self.odd.1 && right.conjugate)
            * sign(self.odd.0 && self.odd.1);
        let factor = factor * signs;
        for ((t, a), b) in target.iter_mut().zip(a).zip(b) {
            *t += factor * a * b;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Monomials, Program};
    use super::Levels;
    use crate::model::{Array, C64, Function, Kernel, Operation};

    /// f(x0 + z + z̄): the coefficient of z^p z̄^s is C(p + s, p) f⁽ᵖ⁺ˢ⁾(x0)/(p + s)!.
    #[test]
    fn functions_by_their_taylor_series() {
        let x0 = 0.4_f64;
        let sech2 = 1.0 - x0.tanh().powi(2);
        let (q, a) = (1.0 + x0 * x0, x0);
        // The fourth derivatives.
        let cases: [(Vec<Operation>, f64); 9] = [
            (vec![Operation::Call(Function::Exp, 0)], x0.exp()),
            (vec![Operation::Call(Function::Log, 0)], -6.0 / x0.powi(4)),
            (vec![Operation::Call(Function::Sin, 0)], x0.sin()),
            (vec![Operation::Call(Function::Cosh, 0)], x0.cosh()),
            (
                vec![Operation::Call(Function::Tanh, 0)],
                8.0 * x0.tanh() * sech2 * (2.0 * sech2 - x0.tanh().powi(2)),
            ),
            (
                vec![Operation::Call(Function::Atan, 0)],
                24.0 * (a - a.powi(3)) / q.powi(4),
            ),
            (vec![Operation::Sqrt(0)], -15.0 / 16.0 * x0.powf(-3.5)),
            (vec![Operation::PowerI(0, 5)], 120.0 * x0),
            (
                vec![Operation::Constant(1.0), Operation::Divide(1, 0)],
                24.0 / x0.powi(5),
            ),
        ];
        for (operations, expected) in cases {
            let mut all = vec![Operation::Input(1, 0)];
            all.extend(operations);
            let kernel = Kernel {
                inputs: vec![
                    Array {
                        name: "p",
                        real: true,
                    },
                    Array {
                        name: "x",
                        real: false,
                    },
                ]
                .into(),
                outputs: vec![all.len() - 1].into(),
                operations: all.into(),
                unshared: 0,
            };
            for odd in [None, Some(&[false][..])] {
                let program = Program::new(&kernel, &[0], &[], odd);
                let mut monomials = Monomials::new(1);
                let mut levels = Levels::new(&program, &[vec![]], &[vec![x0]]);
                for degree in 1..=4 {
                    monomials.extend();
                    let wanted: Vec<usize> = (0..monomials.of(degree).len()).collect();
                    levels.begin(&program, &monomials, degree, &wanted);
                    let jets = |_: usize, _: usize| (degree == 1).then(|| vec![C64::new(1.0, 0.0)]);
                    if degree == 4 {
                        let outputs = levels.outputs(&program, &monomials, degree, &jets);
                        let binomials = [1.0, 4.0, 6.0];
                        for (value, binomial) in outputs[0].iter().zip(binomials) {
                            let expected = binomial * expected / 24.0;
                            let error = (value[0] - expected).norm();
                            assert!(
                                error < 1e-12 * expected.abs().max(1.0),
                                "{:?}: {} against {expected}",
                                kernel.operations,
                                value[0]
                            );
                        }
                    }
                    levels.complete(&program, &monomials, degree, &jets);
                }
            }
        }
    }
}
