//! Expressions → one straight-line program.

use super::{Array, Kernel, Operation, Register};
use crate::graph::{Graph, Id, Node, Rational};
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::collections::HashMap;

/// The inputs of a kernel, and where its leaves lie in them.
pub struct Lowering<'a> {
    /// Input arrays, by name.
    pub inputs: Vec<Array>,
    /// Array and position of a leaf; `None` for a leaf the kernel does not have.
    pub locate: &'a dyn Fn(&Node) -> Option<(usize, usize)>,
}

struct Builder<'a> {
    graph: &'a Graph,
    lowering: Lowering<'a>,
    operations: Vec<Operation>,
    /// Equal operations are one register.
    registers: HashMap<String, Register>,
    values: HashMap<Id, Register>,
}

impl Lowering<'_> {
    /// The kernel that computes `outputs`.
    pub fn lower(self, graph: &Graph, outputs: &[Id]) -> Kernel {
        let mut builder = Builder {
            graph,
            lowering: self,
            operations: Vec::new(),
            registers: HashMap::new(),
            values: HashMap::new(),
        };
        let order = graph.topological(outputs);
        let mut written: HashMap<Id, usize> = HashMap::new();
        for &id in &order {
            let register = builder.node(id);
            builder.values.insert(id, register);
            let cost = unshared_cost(graph, id, &written);
            written.insert(id, cost);
        }
        let unshared = outputs
            .iter()
            .map(|id| written[id])
            .fold(0, usize::saturating_add);
        let outputs: Vec<Register> = outputs.iter().map(|id| builder.values[id]).collect();
        let mut kernel = Kernel {
            inputs: builder.lowering.inputs.into(),
            operations: builder.operations.into(),
            outputs: outputs.into(),
            unshared,
        };
        drop_unused(&mut kernel);
        kernel
    }
}

/// Operations below a node before common subexpressions are shared.
fn unshared_cost(graph: &Graph, id: Id, written: &HashMap<Id, usize>) -> usize {
    let node = graph.node(id);
    let mut cost = match node {
        Node::Sum(c, terms) => {
            let scalings = terms.iter().filter(|(_, c)| !c.abs().is_one()).count();
            terms.len() - 1 + usize::from(!c.is_zero()) + scalings
        }
        Node::Product(factors) => {
            let powers = factors.iter().filter(|(_, e)| !e.abs().is_one()).count();
            factors.len() - 1 + powers + usize::from(factors.iter().all(|(_, e)| e.is_negative()))
        }
        Node::Call(..) | Node::Select(..) => 1,
        _ => 0,
    };
    node.for_each_child(|child| cost = cost.saturating_add(written[&child]));
    cost
}

impl Builder<'_> {
    fn push(&mut self, operation: Operation) -> Register {
        let key = format!("{operation:?}");
        if let Some(&register) = self.registers.get(&key) {
            return register;
        }
        let register = self.operations.len();
        self.operations.push(operation);
        self.registers.insert(key, register);
        register
    }

    fn constant(&mut self, value: &Rational) -> Register {
        self.push(Operation::Constant(value.to_f64().unwrap_or(f64::NAN)))
    }

    fn node(&mut self, id: Id) -> Register {
        match self.graph.node(id).clone() {
            Node::Number(value) => self.constant(&value),
            Node::Pi => self.push(Operation::Constant(std::f64::consts::PI)),
            Node::Sum(constant, terms) => self.sum(&constant, &terms),
            Node::Product(factors) => self.product(&factors),
            Node::Call(function, argument) => {
                let argument = self.values[&argument];
                self.push(Operation::Call(function, argument))
            }
            Node::Select(switch, branches) => {
                let switch = self.leaf(&Node::Parameter(switch));
                let branches: Vec<Register> = branches.iter().map(|b| self.values[b]).collect();
                self.push(Operation::Select(switch, branches.into()))
            }
            leaf => self.leaf(&leaf),
        }
    }

    fn leaf(&mut self, leaf: &Node) -> Register {
        match (self.lowering.locate)(leaf) {
            Some((array, position)) => self.push(Operation::Input(array, position)),
            // Only a bug in a pass can leave an atom behind that its kernel does not have.
            None => panic!("internal error: {leaf:?} reached a kernel without such an input"),
        }
    }

    /// Positive terms first, then the negative ones subtracted.
    fn sum(&mut self, constant: &Rational, terms: &[(Id, Rational)]) -> Register {
        let mut total: Option<Register> = None;
        if constant.is_positive() {
            total = Some(self.constant(constant));
        }
        for negative in [false, true] {
            for (term, coefficient) in terms.iter().filter(|(_, c)| c.is_negative() == negative) {
                let mut value = self.values[term];
                let size = coefficient.abs();
                if !size.is_one() {
                    let factor = self.constant(&size);
                    value = self.push(Operation::Multiply(factor, value));
                }
                total = Some(match (total, negative) {
                    (None, false) => value,
                    (None, true) => self.push(Operation::Negate(value)),
                    (Some(total), false) => self.push(Operation::Add(total, value)),
                    (Some(total), true) => self.push(Operation::Subtract(total, value)),
                });
            }
        }
        match total {
            Some(total) if constant.is_negative() => {
                let value = self.constant(&constant.abs());
                self.push(Operation::Subtract(total, value))
            }
            Some(total) => total,
            None => self.constant(constant),
        }
    }

    /// Numerator and denominator are multiplied up apart, so that there is one division.
    fn product(&mut self, factors: &[(Id, Rational)]) -> Register {
        let mut sides = [None, None];
        for (base, exponent) in factors {
            let base = self.values[base];
            let value = self.power(base, &exponent.abs());
            let side = &mut sides[usize::from(exponent.is_negative())];
            *side = Some(match *side {
                None => value,
                Some(product) => self.push(Operation::Multiply(product, value)),
            });
        }
        match sides {
            [Some(above), None] => above,
            [Some(above), Some(below)] => self.push(Operation::Divide(above, below)),
            [None, below] => {
                let one = self.push(Operation::Constant(1.0));
                match below {
                    Some(below) => self.push(Operation::Divide(one, below)),
                    None => one,
                }
            }
        }
    }

    /// base^exponent for a positive exponent: half-integers by one square root.
    fn power(&mut self, base: Register, exponent: &Rational) -> Register {
        if exponent.is_one() {
            return base;
        }
        let whole = exponent.floor();
        let fraction = exponent - &whole;
        let integer = whole.to_integer().to_i32().unwrap_or(i32::MAX);
        if fraction.is_zero() {
            return self.integer_power(base, integer);
        }
        if fraction != Rational::new(1.into(), 2.into()) {
            return self.push(Operation::PowerF(
                base,
                exponent.to_f64().unwrap_or(f64::NAN),
            ));
        }
        let root = self.push(Operation::Sqrt(base));
        if integer == 0 {
            return root;
        }
        let power = self.integer_power(base, integer);
        self.push(Operation::Multiply(power, root))
    }

    fn integer_power(&mut self, base: Register, exponent: i32) -> Register {
        match exponent {
            1 => base,
            2 => self.push(Operation::Multiply(base, base)),
            _ => self.push(Operation::PowerI(base, exponent)),
        }
    }
}

/// Removes the operations that no output needs; those it keeps stay in order.
fn drop_unused(kernel: &mut Kernel) {
    let count = kernel.operations.len();
    let mut needed = vec![false; count];
    for &output in kernel.outputs.iter() {
        needed[output] = true;
    }
    for register in (0..count).rev() {
        if needed[register] {
            operands(&kernel.operations[register], |operand| {
                needed[operand] = true
            });
        }
    }
    let mut moved = vec![0; count];
    let mut next = 0;
    for register in 0..count {
        moved[register] = next;
        next += usize::from(needed[register]);
    }
    let mut register = 0..count;
    let operations = kernel.operations.to_mut();
    operations.retain(|_| register.next().is_some_and(|r| needed[r]));
    for operation in operations {
        rename(operation, &moved);
    }
    for output in kernel.outputs.to_mut() {
        *output = moved[*output];
    }
}

fn operands(operation: &Operation, mut visit: impl FnMut(Register)) {
    match operation {
        Operation::Constant(_) | Operation::Input(..) => {}
        Operation::Add(a, b)
        | Operation::Subtract(a, b)
        | Operation::Multiply(a, b)
        | Operation::Divide(a, b) => {
            visit(*a);
            visit(*b);
        }
        Operation::Negate(a)
        | Operation::Sqrt(a)
        | Operation::PowerI(a, _)
        | Operation::PowerF(a, _)
        | Operation::Call(_, a) => visit(*a),
        Operation::Select(switch, branches) => {
            visit(*switch);
            branches.iter().for_each(|&b| visit(b));
        }
    }
}

fn rename(operation: &mut Operation, moved: &[Register]) {
    match operation {
        Operation::Constant(_) | Operation::Input(..) => {}
        Operation::Add(a, b)
        | Operation::Subtract(a, b)
        | Operation::Multiply(a, b)
        | Operation::Divide(a, b) => {
            *a = moved[*a];
            *b = moved[*b];
        }
        Operation::Negate(a)
        | Operation::Sqrt(a)
        | Operation::PowerI(a, _)
        | Operation::PowerF(a, _)
        | Operation::Call(_, a) => *a = moved[*a],
        Operation::Select(switch, branches) => {
            *switch = moved[*switch];
            branches.to_mut().iter_mut().for_each(|b| *b = moved[*b]);
        }
    }
}
