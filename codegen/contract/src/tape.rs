//! A model run from its spec without a build: the kernels' operations, interpreted.

use crate::jet::Function;
use crate::kernel::{Kernel, ModelKernels, Operation};
use crate::model::{Model, ResidualCall, choose};
use crate::number::{C64, Number};
use crate::structure::{KernelId, ResidualId, Structure};
use std::cell::RefCell;
use std::collections::HashMap;

/// A model that interprets its kernels: the same operations in the same order as emitted code.
pub struct TapeModel {
    structure: Structure,
    sources: Vec<(String, String)>,
    laws: Vec<(String, String)>,
    kernels: HashMap<KernelId, Kernel>,
    forms: Vec<Vec<Option<Kernel>>>,
    residuals: HashMap<ResidualId, Kernel>,
}

impl TapeModel {
    /// A model of kernels; `sources` are path and text of the spec and its law files, `laws` of every law file
    /// at hand.
    pub fn new(
        kernels: ModelKernels,
        sources: Vec<(String, String)>,
        laws: Vec<(String, String)>,
    ) -> Self {
        let ModelKernels {
            structure,
            kernels,
            forms,
            residuals,
        } = kernels;
        TapeModel {
            structure,
            sources,
            laws,
            kernels: kernels.into_iter().collect(),
            forms,
            residuals: residuals.into_iter().collect(),
        }
    }
}

impl Model for TapeModel {
    fn structure(&self) -> &Structure {
        &self.structure
    }

    fn sources(&self) -> Vec<(String, String)> {
        self.sources.clone()
    }

    fn laws(&self) -> Vec<(String, String)> {
        self.laws.clone()
    }

    fn evaluate(&self, kernel: KernelId, point: &[f64], out: &mut [f64]) {
        thread_local!(static REGISTERS: RefCell<Vec<f64>> = const { RefCell::new(Vec::new()) });
        let Some(kernel) = self.kernels.get(&kernel) else {
            return out.fill(0.0);
        };
        REGISTERS.with_borrow_mut(|registers| run(kernel, |_, i| point[i], registers));
        REGISTERS.with_borrow(|registers| copy_outputs(kernel, registers, out));
    }

    fn form(&self, degree: usize, row: usize, c: &[f64], x: &[&[C64]]) -> C64 {
        thread_local!(static REGISTERS: RefCell<Vec<C64>> = const { RefCell::new(Vec::new()) });
        let Some(kernel) = &self.forms[degree - 2][row] else {
            return C64::new(0.0, 0.0);
        };
        REGISTERS.with_borrow_mut(|registers| {
            let input = |array: usize, i: usize| match array {
                0 => C64::from(c[i]),
                _ => x[array - 1][i],
            };
            run(kernel, input, registers);
            registers[kernel.outputs[0]]
        })
    }

    fn residual(&self, residual: ResidualId, point: &[f64], call: ResidualCall<'_>) {
        let Some(kernel) = self.residuals.get(&residual) else {
            return;
        };
        match call {
            ResidualCall::Real(x, out) => run_residual(kernel, point, x, out),
            ResidualCall::Rounding(x, out) => run_residual(kernel, point, x, out),
            ResidualCall::Series(x, out) => run_residual(kernel, point, x, out),
        }
    }
}

fn run_residual<T: Number>(kernel: &Kernel, point: &[f64], x: &[T], out: &mut [T]) {
    let mut registers = Vec::new();
    let input = |array: usize, i: usize| if array == 0 { T::from(point[i]) } else { x[i] };
    run(kernel, input, &mut registers);
    copy_outputs(kernel, &registers, out);
}

fn copy_outputs<T: Copy>(kernel: &Kernel, registers: &[T], out: &mut [T]) {
    for (value, &register) in out.iter_mut().zip(&kernel.outputs) {
        *value = registers[register];
    }
}

fn run<T: Number>(kernel: &Kernel, input: impl Fn(usize, usize) -> T, r: &mut Vec<T>) {
    r.clear();
    for operation in &kernel.operations {
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
                let Operation::Input(array, position) = kernel.operations[*switch] else {
                    unreachable!("a switch is a parameter")
                };
                let switch = input(array, position);
                let branches: Vec<T> = branches.iter().map(|&b| r[b]).collect();
                choose(switch.real_part(), &branches)
            }
        };
        r.push(value);
    }
}

fn apply<T: Number>(function: Function, x: T) -> T {
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
