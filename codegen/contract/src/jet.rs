//! Derivatives of fields, the operators that make them, elementary functions, the ends of an interval.

use crate::ids::FieldId;

/// The derivative ∂x^x |∂x|^absx ∂y^y ∂t^t of a field. In L† it is a derivative of an adjoint field, of which every
/// balance has one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Jet<V = FieldId> {
    /// The field, or the balance whose adjoint field is meant.
    pub of: V,
    /// Powers of ∂t.
    pub t: u8,
    /// Powers of ∂x.
    pub x: u8,
    /// Powers of |∂x|.
    pub absx: u8,
    /// Powers of ∂y.
    pub y: u8,
}

impl<V> Jet<V> {
    /// The field itself.
    pub const fn value(of: V) -> Self {
        Jet {
            of,
            t: 0,
            x: 0,
            absx: 0,
            y: 0,
        }
    }

    /// Whether the jet can be nonzero in a base state, which depends on y alone: no derivative along x or t.
    pub fn is_base(&self) -> bool {
        self.t == 0 && self.x == 0 && self.absx == 0
    }

    /// The jet with |∂x|² written as −∂x², and whether the sign changes.
    pub fn canonical(self) -> (Self, bool) {
        let pairs = self.absx / 2;
        let jet = Jet {
            x: self.x + 2 * pairs,
            absx: self.absx % 2,
            ..self
        };
        (jet, pairs % 2 == 1)
    }

    /// The jet without ∂x and |∂x|, which multiply a mode e^{ikx} by powers of i k and |k|.
    pub fn profile(self) -> Self {
        Jet {
            x: 0,
            absx: 0,
            ..self
        }
    }

    /// The same derivative of `of`.
    pub fn about<W>(self, of: W) -> Jet<W> {
        let Jet { t, x, absx, y, .. } = self;
        Jet { of, t, x, absx, y }
    }

    /// The jet with one more derivative.
    pub fn derived(self, operator: Operator) -> Self {
        let mut jet = self;
        match operator {
            Operator::Dx => jet.x += 1,
            Operator::Dy => jet.y += 1,
            Operator::Dt => jet.t += 1,
            Operator::AbsDx => jet.absx += 1,
        }
        jet
    }
}

/// A jet from its parts, for literals in emitted code.
pub const fn jet<V>(of: V, t: u8, x: u8, absx: u8, y: u8) -> Jet<V> {
    Jet { of, t, x, absx, y }
}

/// Differential operators of the spec language.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Operator {
    /// ∂/∂x along the periodic coordinate.
    Dx,
    /// ∂/∂y across.
    Dy,
    /// ∂/∂t.
    Dt,
    /// |∂x|: multiplies e^{ikx} by |k|.
    AbsDx,
}

/// Elementary functions (√ is a power).
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Function {
    /// e^a
    Exp,
    /// Natural logarithm.
    Log,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent.
    Tan,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Inverse tangent.
    Atan,
}

impl Function {
    /// All of them, in the order of declaration.
    pub const ALL: [Function; 9] = [
        Function::Exp,
        Function::Log,
        Function::Sin,
        Function::Cos,
        Function::Tan,
        Function::Sinh,
        Function::Cosh,
        Function::Tanh,
        Function::Atan,
    ];

    /// The name in the spec language.
    pub fn name(self) -> &'static str {
        match self {
            Function::Exp => "exp",
            Function::Log => "log",
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Tan => "tan",
            Function::Sinh => "sinh",
            Function::Cosh => "cosh",
            Function::Tanh => "tanh",
            Function::Atan => "atan",
        }
    }
}

/// An end of the cross-stream interval.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum End {
    /// Where y is least.
    Lower,
    /// Where y is largest.
    Upper,
}

impl End {
    /// Both, the lower first.
    pub const BOTH: [End; 2] = [End::Lower, End::Upper];
}
