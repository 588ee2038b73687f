//! The syntax tree: what the user wrote, each piece with its place.

use crate::diagnostic::Location;
use crate::graph::Rational;

/// An identifier.
#[derive(Clone, Debug)]
pub struct Name {
    pub text: String,
    pub location: Location,
}

/// An expression with its place.
#[derive(Clone, Debug)]
pub struct Expression {
    pub kind: ExpressionKind,
    pub location: Location,
    /// Expressions on the longest way down, this one included.
    pub height: usize,
}

impl Expression {
    pub fn new(kind: ExpressionKind, location: Location) -> Self {
        let below = match &kind {
            ExpressionKind::Number(_) | ExpressionKind::Name(_) => 0,
            ExpressionKind::Negative(inner) | ExpressionKind::Modulus(inner) => inner.height,
            ExpressionKind::Binary(_, left, right) => left.height.max(right.height),
            ExpressionKind::Call(_, arguments) => {
                arguments.iter().map(|a| a.height).max().unwrap_or(0)
            }
            ExpressionKind::Select(_, branches) => {
                branches.iter().map(|(_, b)| b.height).max().unwrap_or(0)
            }
        };
        Expression {
            kind,
            location,
            height: below + 1,
        }
    }
}

#[derive(Clone, Debug)]
pub enum ExpressionKind {
    Number(Rational),
    Name(String),
    /// A function, an operator, a law or a definition applied to arguments.
    Call(Name, Vec<Expression>),
    Negative(Box<Expression>),
    Binary(Binary, Box<Expression>, Box<Expression>),
    /// |q|, in the amplitude alone.
    Modulus(Box<Expression>),
    /// `select switch { choice: expression, … }`
    Select(Name, Vec<(Name, Expression)>),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binary {
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
}

/// `left = right`
#[derive(Clone, Debug)]
pub struct Equation {
    pub left: Expression,
    pub right: Expression,
    pub location: Location,
}

/// A printed formula: an equation, or an expression alone.
#[derive(Clone, Debug)]
pub struct Formula {
    pub left: Expression,
    pub right: Option<Expression>,
}

/// A parsed `.model` file.
#[derive(Clone, Debug, Default)]
pub struct ModelTree {
    pub name: Option<Name>,
    pub title: String,
    pub imports: Vec<Import>,
    pub coordinates: Vec<CoordinateItem>,
    pub parameters: Vec<ParameterItem>,
    pub fields: Vec<FieldItem>,
    pub definitions: Vec<Definition>,
    pub balances: Vec<BalanceItem>,
    pub base: BaseBlock,
    pub boundary: Vec<WallItem>,
    pub mean: Vec<MeanItem>,
    pub amplitude: Option<AmplitudeItem>,
    pub outputs: Vec<OutputItem>,
    pub typical: Option<TypicalItem>,
}

/// `typical { k = number; near = re, im; }`
#[derive(Clone, Debug)]
pub struct TypicalItem {
    pub k: Expression,
    pub near: Option<(Expression, Option<Expression>)>,
}

/// A parsed `.law` file.
#[derive(Clone, Debug, Default)]
pub struct LawTree {
    pub imports: Vec<Import>,
    pub parameters: Vec<ParameterItem>,
    pub definitions: Vec<Definition>,
}

/// `use laws::file::{law(arguments) as alias, …};`
#[derive(Clone, Debug)]
pub struct Import {
    pub file: Name,
    pub items: Vec<ImportItem>,
}

#[derive(Clone, Debug)]
pub struct ImportItem {
    pub law: Name,
    /// Fields to apply the law to; by default those named like its arguments.
    pub arguments: Option<Vec<Name>>,
    pub alias: Name,
}

/// `x: periodic` or `y: lower..upper`
#[derive(Clone, Debug)]
pub struct CoordinateItem {
    pub name: Name,
    /// `None` for the periodic coordinate.
    pub interval: Option<(Expression, Expression)>,
}

#[derive(Clone, Debug)]
pub struct ParameterItem {
    pub name: Name,
    /// `None` in a law file whose model must declare it.
    pub default: Option<ParameterDefault>,
    pub domain: ParameterDomain,
    /// `whole`: it takes whole numbers alone.
    pub whole: Option<Location>,
    pub doc: String,
}

#[derive(Clone, Debug)]
pub enum ParameterDefault {
    Value(Expression),
    Choice(Name),
}

#[derive(Clone, Debug)]
pub enum ParameterDomain {
    Any,
    Range(Option<Expression>, Option<Expression>),
    Choices(Vec<Name>),
}

#[derive(Clone, Debug)]
pub struct FieldItem {
    pub name: Name,
    pub range: Option<(Option<Expression>, Option<Expression>)>,
    pub doc: String,
}

/// `let name(arguments) = body;` or `law name(arguments) = body;`
#[derive(Clone, Debug)]
pub struct Definition {
    pub name: Name,
    pub arguments: Option<Vec<Name>>,
    pub body: Expression,
    /// Kept as an opaque atom with derivative indices.
    pub is_law: bool,
    pub doc: String,
}

#[derive(Clone, Debug)]
pub struct BalanceItem {
    pub name: Name,
    pub equation: Equation,
    pub divide_by: Option<Expression>,
    /// Overrides the pairing of balances and fields.
    pub paired_field: Option<Name>,
    pub doc: String,
}

#[derive(Clone, Debug, Default)]
pub struct BaseBlock {
    pub location: Option<Location>,
    pub closed: Vec<(Name, Expression)>,
    pub walls: Vec<WallItem>,
    pub integrals: Vec<IntegralCondition>,
    pub guesses: Vec<(Name, Expression)>,
    pub automatic: Vec<AutomaticItem>,
}

/// `integral(integrand) = value;`
#[derive(Clone, Debug)]
pub struct IntegralCondition {
    pub integrand: Expression,
    pub value: Expression,
    pub location: Location,
}

/// `auto H { at y = H: left = right; }`: a condition that determines a parameter set to `auto`.
#[derive(Clone, Debug)]
pub struct AutomaticItem {
    pub parameter: Name,
    pub place: Expression,
    pub equation: Equation,
}

/// Conditions at one end of the interval.
#[derive(Clone, Debug)]
pub struct WallItem {
    pub coordinate: Name,
    pub place: Expression,
    pub conditions: Vec<ConditionItem>,
}

#[derive(Clone, Debug)]
pub enum ConditionItem {
    Equation(Equation),
    /// `select switch { choice { … } … }`
    Select(Name, Vec<(Name, Vec<ConditionItem>)>),
}

/// An item of the block `mean`, which closes the problem at k = 0.
#[derive(Clone, Debug)]
pub enum MeanItem {
    /// `conserved integral(q);`
    Conserved(Expression),
    /// `gauge p;`
    Gauge(Name),
    /// `unknown G: integral(q) = value;`
    Unknown(Name, IntegralCondition),
}

/// How eigenfunctions are normalised.
#[derive(Clone, Debug)]
pub enum AmplitudeItem {
    /// `integral(Σ w |q|^2) = value;`
    Integral {
        integrand: Expression,
        value: Expression,
    },
    /// `at y = place { q = value; }`, or `q = value;` without a cross-stream coordinate
    Point {
        place: Option<Expression>,
        field: Expression,
        value: Expression,
    },
}

#[derive(Clone, Debug)]
pub struct OutputItem {
    pub name: Name,
    /// `None` for an integral (or the value, without a cross-stream coordinate).
    pub place: Option<Expression>,
    pub body: Expression,
    pub doc: String,
}
