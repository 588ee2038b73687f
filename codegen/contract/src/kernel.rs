//! Straight-line programs with common subexpressions shared, as data. The Rust emitter prints them, the tape runs them
//! on `f64`, and the solver runs them on any [`Number`]: the same operations in the same order.

use crate::ids::{BalanceId, CaseId, Table};
use crate::jet::Function;
use crate::number::Number;
use crate::structure::{KernelId, ResidualId, Structure};
use std::borrow::Cow;

/// A value computed earlier in the kernel.
pub type Register = usize;

/// One operation; operands are registers defined before it.
#[derive(Clone, Debug, PartialEq)]
pub enum Operation {
    /// A number.
    Constant(f64),
    /// Element `1` of input array `0`.
    Input(usize, usize),
    /// a + b
    Add(Register, Register),
    /// a − b
    Subtract(Register, Register),
    /// a b
    Multiply(Register, Register),
    /// a / b
    Divide(Register, Register),
    /// −a
    Negate(Register),
    /// √a
    Sqrt(Register),
    /// Integer power.
    PowerI(Register, i32),
    /// Power with any real exponent.
    PowerF(Register, f64),
    /// f(a)
    Call(Function, Register),
    /// One of the registers, by the value of a (switch) register.
    Select(Register, Cow<'static, [Register]>),
}

/// An input array of a kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    /// As it is called in emitted code.
    pub name: &'static str,
    /// Whether elements are real whatever number type the kernel runs on.
    pub real: bool,
}

/// A straight-line program; a constant of emitted code, or made at run time.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// What `Operation::Input` reads from.
    pub inputs: Cow<'static, [Array]>,
    /// In order of execution: register i is the result of operation i.
    pub operations: Cow<'static, [Operation]>,
    /// The registers that are the results.
    pub outputs: Cow<'static, [Register]>,
    /// Arithmetic operations of the expressions as written, before common subexpressions are shared.
    pub unshared: usize,
}

/// What a residual reads: the point state, then the jets of the full state.
pub const RESIDUAL_INPUTS: [Array; 2] = [
    Array {
        name: "p",
        real: true,
    },
    Array {
        name: "x",
        real: false,
    },
];

impl Kernel {
    /// Arithmetic operations after sharing.
    pub fn shared(&self) -> usize {
        let free = |op: &&Operation| matches!(op, Operation::Constant(_) | Operation::Input(..));
        self.operations.iter().filter(|op| !free(op)).count()
    }

    /// Whether each register is real whatever the number type: made of constants and real inputs alone.
    pub fn real(&self) -> Vec<bool> {
        let mut real: Vec<bool> = Vec::with_capacity(self.operations.len());
        for operation in self.operations.iter() {
            let is_real = match operation {
                Operation::Constant(_) => true,
                Operation::Input(array, _) => self.inputs[*array].real,
                Operation::Add(a, b)
                | Operation::Subtract(a, b)
                | Operation::Multiply(a, b)
                | Operation::Divide(a, b) => real[*a] && real[*b],
                Operation::Negate(a)
                | Operation::Sqrt(a)
                | Operation::PowerI(a, _)
                | Operation::PowerF(a, _)
                | Operation::Call(_, a) => real[*a],
                Operation::Select(_, branches) => branches.iter().all(|&b| real[b]),
            };
            real.push(is_real);
        }
        real
    }

    /// Runs the program: `input(array, position)` gives the leaves, `registers` is filled anew.
    pub fn run<T: Number>(&self, input: impl Fn(usize, usize) -> T, registers: &mut Vec<T>) {
        let r = registers;
        r.clear();
        for operation in self.operations.iter() {
            let value = match operation {
                Operation::Constant(value) => T::from(*value),
                Operation::Input(array, position) => input(*array, *position),
                Operation::Add(a, b) => r[*a] + r[*b],
                Operation::Subtract(a, b) => r[*a] - r[*b],
                Operation::Multiply(a, b) => r[*a] * r[*b],
                Operation::Divide(a, b) => r[*a] / r[*b],
                Operation::Negate(a) => -r[*a],
                Operation::Sqrt(a) => r[*a].sqrt(),
                Operation::PowerI(a, exponent) => r[*a].powi(*exponent),
                Operation::PowerF(a, exponent) => r[*a].powf(*exponent),
                Operation::Call(function, a) => apply(*function, r[*a]),
                Operation::Select(switch, branches) => {
                    let branches: Vec<T> = branches.iter().map(|&b| r[b]).collect();
                    choose(r[*switch].real_part(), &branches)
                }
            };
            r.push(value);
        }
    }

    /// The outputs at one point: `point` and `jets` are the two input arrays of a residual.
    pub fn evaluate<T: Number>(&self, point: &[f64], jets: &[T]) -> Vec<T> {
        let mut registers = Vec::with_capacity(self.operations.len());
        let input = |array: usize, i: usize| match array {
            0 => T::from(point[i]),
            _ => jets[i],
        };
        self.run(input, &mut registers);
        self.outputs.iter().map(|&o| registers[o]).collect()
    }
}

/// A function of the spec language.
pub fn apply<T: Number>(function: Function, x: T) -> T {
    match function {
        Function::Exp => x.exp(),
        Function::Log => x.log(),
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tan => x.tan(),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        Function::Tanh => x.tanh(),
        Function::Atan => x.atan(),
    }
}

/// The branch that a switch parameter selects (emitted code calls this).
pub fn choose<T: Clone>(switch: f64, branches: &[T]) -> T {
    let last = branches.len() - 1;
    branches[(switch.max(0.0).round() as usize).min(last)].clone()
}

/// The kernels of a model with their structure.
#[derive(Clone, Debug)]
pub struct ModelKernels {
    /// What their inputs and outputs mean.
    pub structure: Structure,
    /// The real kernels.
    pub kernels: Vec<(KernelId, Kernel)>,
    /// `forms[d − 2][row]`
    pub forms: Vec<Table<BalanceId, Option<Kernel>>>,
    /// The unexpanded residuals.
    pub residuals: Vec<(ResidualId, Kernel)>,
    /// By case, integrals that its balances keep and the spec does not declare, in words; cases without any are left
    /// out.
    pub undeclared: Vec<(CaseId, Vec<String>)>,
}
