//! Straight-line programs with common subexpressions shared: what the Rust emitter prints and what the tape runs,
//! the same operations in the same order.

use crate::jet::Function;
use crate::structure::{KernelId, ResidualId, Structure};

/// A value computed earlier in the kernel.
pub type Register = usize;

/// One operation; operands are registers defined before it.
#[derive(Clone, Debug, PartialEq)]
pub enum Operation {
    Constant(f64),
    /// Element `1` of input array `0`.
    Input(usize, usize),
    Add(Register, Register),
    Subtract(Register, Register),
    Multiply(Register, Register),
    Divide(Register, Register),
    Negate(Register),
    Sqrt(Register),
    /// Integer power.
    PowerI(Register, i32),
    /// Power with any real exponent.
    PowerF(Register, f64),
    Call(Function, Register),
    /// One of the registers, by the value of a (switch) register.
    Select(Register, Vec<Register>),
}

/// An input array of a kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct Array {
    pub name: &'static str,
    /// Whether elements are real whatever number type the kernel runs on.
    pub real: bool,
}

/// A straight-line program.
#[derive(Clone, Debug)]
pub struct Kernel {
    pub inputs: Vec<Array>,
    pub operations: Vec<Operation>,
    /// Whether each register is real whatever the number type.
    pub real: Vec<bool>,
    pub outputs: Vec<Register>,
    /// Arithmetic operations of the expressions as written, nothing shared.
    pub unshared: usize,
}

impl Kernel {
    /// Arithmetic operations after sharing.
    pub fn shared(&self) -> usize {
        let free = |op: &&Operation| matches!(op, Operation::Constant(_) | Operation::Input(..));
        self.operations.iter().filter(|op| !free(op)).count()
    }
}

/// The kernels of a model with their structure.
#[derive(Clone, Debug)]
pub struct ModelKernels {
    pub structure: Structure,
    pub kernels: Vec<(KernelId, Kernel)>,
    /// `forms[d − 2][row]`
    pub forms: Vec<Vec<Option<Kernel>>>,
    pub residuals: Vec<(ResidualId, Kernel)>,
}
