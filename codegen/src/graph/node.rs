//! What an expression can be.

use super::Id;
pub use landau_contract::{
    BalanceId, CaseId, FieldId, Function, Jet, LawId, Operator, ParameterId, Table,
};
pub use num_rational::BigRational as Rational;

/// A constitutive law kept opaque, with derivative indices: p⁰_nny is
/// `LawAtom { law: p, index: [2, 0, …], y: 1 }`.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct LawAtom {
    /// Which law.
    pub law: LawId,
    /// Partial derivatives with respect to each field.
    pub index: Table<FieldId, u8>,
    /// At the base state: total y-derivatives. In the full state: explicit partial y-derivatives.
    pub y: u8,
}

impl LawAtom {
    /// The atom with one more derivative with respect to `field`.
    pub fn partial(&self, field: FieldId) -> Self {
        let mut atom = self.clone();
        atom.index[field] += 1;
        atom
    }

    /// The atom with one more y-derivative.
    pub fn dy(&self) -> Self {
        LawAtom {
            y: self.y + 1,
            ..self.clone()
        }
    }
}

/// One expression; children are ids of the same graph.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    /// An exact rational number.
    Number(Rational),
    /// π
    Pi,
    /// A parameter.
    Parameter(ParameterId),
    /// The wavenumber of the fundamental (in the amplitude alone).
    Wavenumber,
    /// The cross-stream coordinate y.
    Coordinate,
    /// A derivative of a field of the full state.
    Jet(Jet),
    /// ∂y^order of a solved base field.
    Base(FieldId, u8),
    /// A law and its derivatives at the full state.
    StateLaw(LawAtom),
    /// A law and its derivatives at the base state.
    BaseLaw(LawAtom),
    /// constant + Σ coefficient · term, terms in id order, coefficients nonzero.
    Sum(Rational, Vec<(Id, Rational)>),
    /// Π base^exponent, bases in id order, exponents nonzero.
    Product(Vec<(Id, Rational)>),
    /// A function of one argument.
    Call(Function, Id),
    /// One branch a choice of the switch parameter.
    Select(ParameterId, Vec<Id>),
    /// A differential operator not yet carried out.
    Derivative(Operator, Id),
    /// Input `position` of array `array` of a kernel.
    Slot(usize, usize),
    /// A base-state symbol of a printed formula that the model knows nothing of: name, subscripts.
    Symbol(String, String),
}

impl Node {
    /// Calls `visit` on each child.
    pub fn for_each_child(&self, mut visit: impl FnMut(Id)) {
        match self {
            Node::Sum(_, parts) | Node::Product(parts) => parts.iter().for_each(|p| visit(p.0)),
            Node::Call(_, arg) | Node::Derivative(_, arg) => visit(*arg),
            Node::Select(_, branches) => branches.iter().for_each(|&b| visit(b)),
            Node::Number(_)
            | Node::Pi
            | Node::Parameter(_)
            | Node::Wavenumber
            | Node::Coordinate
            | Node::Jet(_)
            | Node::Base(..)
            | Node::StateLaw(_)
            | Node::BaseLaw(_)
            | Node::Slot(..)
            | Node::Symbol(..) => {}
        }
    }
}
