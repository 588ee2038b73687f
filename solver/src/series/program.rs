//! A residual prepared for truncated polynomials: the branches of switches are chosen, and operations that no wanted output
//! needs are left out.
//!
//! Powers and functions are computed by the differential equations that they satisfy. The Euler operator
//! E z^p z̄^s = (|p| + |s|) z^p z̄^s obeys the product rule, so that
//!
//! a E(a^r) = r a^r E(a),  E(exp a) = exp(a) E(a),  E(sin a) = cos(a) E(a),  E(tan a) = (1 + tan² a) E(a), …

use crate::model::{Function, Kernel, Operation, Register, choose};
use std::collections::HashMap;

/// The numbers that coefficients are. Real arithmetic takes half the work or less.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arithmetic {
    /// Every coefficient is real, or every coefficient of a register is i times real: one number at a point.
    Real,
    /// Any: two numbers at a point.
    Complex,
}

/// How a register is made; operands are registers.
#[derive(Clone, Debug)]
pub(super) enum Step {
    Constant(f64),
    /// An element of the point state.
    Point(usize),
    /// A jet, by its position among those of the residual.
    Jet(usize),
    Add(Register, Register),
    Subtract(Register, Register),
    Negate(Register),
    Multiply(Register, Register),
    Divide(Register, Register),
    Power(Register, f64),
    /// f(a), with E f(a) = sign · slope · E a; the slope may be a later register, of which lower degrees are read.
    Function {
        function: Function,
        argument: Register,
        slope: Register,
        sign: f64,
    },
}

/// A residual prepared.
#[derive(Clone, Debug)]
pub struct Program {
    pub(super) steps: Vec<Step>,
    /// Whether a register depends on jets. If not, it is a real number at each point.
    pub(super) series: Vec<bool>,
    /// Whether a register's coefficients are i times real, in real arithmetic.
    pub(super) odd: Vec<bool>,
    pub(super) outputs: Vec<Register>,
    arithmetic: Arithmetic,
}

impl Program {
    /// The program for some of a kernel's outputs; `point` is the state at one of the points, whose switches hold for
    /// all. `odd` says which jets are i times real numbers, where all are that or real.
    pub fn new(kernel: &Kernel, outputs: &[usize], point: &[f64], odd: Option<&[bool]>) -> Self {
        let needed = needed(kernel, outputs, point);
        let mut builder = Builder {
            steps: Vec::new(),
            series: Vec::new(),
            made: HashMap::new(),
            one: None,
        };
        let mut registers = vec![usize::MAX; kernel.operations.len()];
        for (register, operation) in kernel.operations.iter().enumerate() {
            if needed[register] {
                registers[register] = builder.operation(kernel, operation, &registers, point);
            }
        }
        let outputs = outputs.iter().map(|&o| registers[kernel.outputs[o]]);
        let mut program = Program {
            outputs: outputs.collect(),
            odd: vec![false; builder.steps.len()],
            steps: builder.steps,
            series: builder.series,
            arithmetic: Arithmetic::Complex,
        };
        if let Some(parities) = odd.and_then(|odd| program.parities(odd)) {
            program.odd = parities;
            program.arithmetic = Arithmetic::Real;
        }
        program
    }

    /// Which of the two this program runs in.
    pub fn arithmetic(&self) -> Arithmetic {
        self.arithmetic
    }

    /// The jets that are read.
    pub fn jets(&self) -> Vec<usize> {
        let jet = |step: &Step| match step {
            Step::Jet(jet) => Some(*jet),
            _ => None,
        };
        self.steps.iter().filter_map(jet).collect()
    }

    /// Which registers are i times real, if each is that or real.
    fn parities(&self, odd_jets: &[bool]) -> Option<Vec<bool>> {
        let mut odd: Vec<bool> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            odd.push(match *step {
                Step::Constant(_) | Step::Point(_) => false,
                Step::Jet(jet) => odd_jets[jet],
                Step::Negate(a) => odd[a],
                Step::Add(a, b) | Step::Subtract(a, b) => (odd[a] == odd[b]).then_some(odd[a])?,
                Step::Multiply(a, b) => odd[a] != odd[b],
                Step::Divide(a, b) => (!odd[b]).then_some(odd[a])?,
                Step::Power(a, _) | Step::Function { argument: a, .. } => {
                    (!odd[a]).then_some(false)?
                }
            });
        }
        Some(odd)
    }
}

/// The registers of a kernel that some outputs depend on, the branches chosen.
fn needed(kernel: &Kernel, outputs: &[usize], point: &[f64]) -> Vec<bool> {
    let mut needed = vec![false; kernel.operations.len()];
    for &output in outputs {
        needed[kernel.outputs[output]] = true;
    }
    for register in (0..kernel.operations.len()).rev().collect::<Vec<_>>() {
        if !needed[register] {
            continue;
        }
        match &kernel.operations[register] {
            Operation::Constant(_) | Operation::Input(..) => {}
            Operation::Add(a, b)
            | Operation::Subtract(a, b)
            | Operation::Multiply(a, b)
            | Operation::Divide(a, b) => {
                needed[*a] = true;
                needed[*b] = true;
            }
            Operation::Negate(a)
            | Operation::Sqrt(a)
            | Operation::PowerI(a, _)
            | Operation::PowerF(a, _)
            | Operation::Call(_, a) => needed[*a] = true,
            Operation::Select(switch, branches) => {
                needed[chosen(kernel, *switch, branches, point)] = true;
            }
        }
    }
    needed
}

/// The branch that a switch, a parameter, selects.
fn chosen(kernel: &Kernel, switch: Register, branches: &[Register], point: &[f64]) -> Register {
    let value = match kernel.operations[switch] {
        Operation::Input(_, position) => point[position],
        _ => 0.0,
    };
    choose(value, branches)
}

struct Builder {
    steps: Vec<Step>,
    series: Vec<bool>,
    /// Sine and cosine of a register, hyperbolic or not, are made together: what has been made.
    made: HashMap<(Function, Register), Register>,
    one: Option<Register>,
}

impl Builder {
    fn push(&mut self, step: Step) -> Register {
        let series = |r: Register| self.series.get(r).copied().unwrap_or(false);
        self.series.push(match step {
            Step::Constant(_) | Step::Point(_) => false,
            Step::Jet(_) => true,
            Step::Add(a, b) | Step::Subtract(a, b) | Step::Multiply(a, b) | Step::Divide(a, b) => {
                series(a) || series(b)
            }
            Step::Negate(a) | Step::Power(a, _) | Step::Function { argument: a, .. } => series(a),
        });
        self.steps.push(step);
        self.steps.len() - 1
    }

    fn one(&mut self) -> Register {
        if let Some(one) = self.one {
            return one;
        }
        let one = self.push(Step::Constant(1.0));
        self.one = Some(one);
        one
    }

    fn operation(
        &mut self,
        kernel: &Kernel,
        operation: &Operation,
        registers: &[Register],
        point: &[f64],
    ) -> Register {
        let at = |r: &Register| registers[*r];
        match operation {
            Operation::Constant(value) => self.push(Step::Constant(*value)),
            Operation::Input(0, position) => self.push(Step::Point(*position)),
            Operation::Input(_, position) => self.push(Step::Jet(*position)),
            Operation::Add(a, b) => self.push(Step::Add(at(a), at(b))),
            Operation::Subtract(a, b) => self.push(Step::Subtract(at(a), at(b))),
            Operation::Multiply(a, b) => self.push(Step::Multiply(at(a), at(b))),
            Operation::Divide(a, b) => self.push(Step::Divide(at(a), at(b))),
            Operation::Negate(a) => self.push(Step::Negate(at(a))),
            Operation::Sqrt(a) => self.push(Step::Power(at(a), 0.5)),
            Operation::PowerI(a, exponent) => self.integer_power(at(a), *exponent),
            Operation::PowerF(a, exponent) => self.push(Step::Power(at(a), *exponent)),
            Operation::Call(function, a) => self.function(*function, at(a)),
            Operation::Select(switch, branches) => at(&chosen(kernel, *switch, branches, point)),
        }
    }

    /// Repeated squaring: a base that vanishes at the base state is no harm.
    fn integer_power(&mut self, base: Register, exponent: i32) -> Register {
        let (mut power, mut square, mut left) = (None, base, exponent.unsigned_abs());
        while left > 0 {
            if left & 1 == 1 {
                power = Some(match power {
                    None => square,
                    Some(power) => self.push(Step::Multiply(power, square)),
                });
            }
            left >>= 1;
            if left > 0 {
                square = self.push(Step::Multiply(square, square));
            }
        }
        let one = self.one();
        let power = power.unwrap_or(one);
        if exponent < 0 {
            self.push(Step::Divide(one, power))
        } else {
            power
        }
    }

    fn function(&mut self, function: Function, argument: Register) -> Register {
        if let Some(&register) = self.made.get(&(function, argument)) {
            return register;
        }
        let step = |function, slope, sign| Step::Function {
            function,
            argument,
            slope,
            sign,
        };
        let next = self.steps.len();
        match function {
            Function::Exp => self.push(step(function, next, 1.0)),
            Function::Log => {
                let one = self.one();
                let slope = self.push(Step::Divide(one, argument));
                self.push(step(function, slope, 1.0))
            }
            Function::Sin | Function::Cos | Function::Sinh | Function::Cosh => {
                let (sine, cosine, sign) = match function {
                    Function::Sin | Function::Cos => (Function::Sin, Function::Cos, -1.0),
                    _ => (Function::Sinh, Function::Cosh, 1.0),
                };
                let first = self.push(step(sine, next + 1, 1.0));
                let second = self.push(step(cosine, next, sign));
                self.made.insert((sine, argument), first);
                self.made.insert((cosine, argument), second);
                if function == sine { first } else { second }
            }
            Function::Tan | Function::Tanh => {
                let one = self.one();
                let next = self.steps.len();
                let value = self.push(step(function, next + 2, 1.0));
                let square = self.push(Step::Multiply(value, value));
                self.push(match function {
                    Function::Tan => Step::Add(one, square),
                    _ => Step::Subtract(one, square),
                });
                value
            }
            Function::Atan => {
                let one = self.one();
                let square = self.push(Step::Multiply(argument, argument));
                let below = self.push(Step::Add(one, square));
                let slope = self.push(Step::Divide(one, below));
                self.push(step(function, slope, 1.0))
            }
        }
    }
}
