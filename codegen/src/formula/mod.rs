//! Formulas as trees, made from the graph and printed as text or LaTeX.
//!
//! `Letters` writes expressions of a graph as trees, `group` gathers the terms of an operator as papers do,
//! and two printers say the same tree in one line of text ([`plain`]) or in LaTeX ([`latex`]). Brackets
//! are the printers' business: a tree has none.

mod group;
mod latex;
mod letters;
mod plain;

pub use group::{Coefficient, grouped, over_common_denominator};
pub use latex::{latex, latex_words};
pub use letters::{Arrangement, Letters};
pub use plain::plain;

use crate::graph::Rational;
use num_traits::{One, Signed, Zero};

/// What a symbol carries above its name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Mark {
    /// Nothing: the full state.
    None,
    /// ⁰, a value of the base state.
    Base,
    /// ′, a perturbation.
    Prime,
}

/// A formula as it is read, innermost last.
#[derive(Clone, PartialEq, Debug)]
pub enum Formula {
    /// A number that is not negative.
    Number(Rational),
    /// A bare name: a parameter, a coordinate, π.
    Letter(String),
    /// A name with a mark and subscripts; a trailing † belongs to the name.
    Symbol {
        /// The name.
        name: String,
        /// The mark above: 0 for the base state, a prime for a perturbation.
        mark: Mark,
        /// Subscripts.
        below: Vec<String>,
    },
    /// ∂ by a coordinate, to a power above 0.
    Partial(String, u8),
    /// |∂| by a coordinate, to a power above 0.
    Modulus(String, u8),
    /// An operator before what it acts on.
    Of(Box<Formula>, Box<Formula>),
    /// −a
    Negative(Box<Formula>),
    /// Σ, two terms or more.
    Sum(Vec<Formula>),
    /// Π, two factors or more.
    Product(Vec<Formula>),
    /// above/below
    Fraction(Box<Formula>, Box<Formula>),
    /// base^exponent
    Power(Box<Formula>, Rational),
    /// √
    Root(Box<Formula>),
    /// function(argument)
    Call(String, Box<Formula>),
    /// One of several, by a switch.
    Choice(String, Vec<Formula>),
    /// ∫ integrand d(variable)
    Integral(Box<Formula>, String),
    /// A sum that goes on from line to line.
    Lines(Vec<Formula>),
    /// left = right
    Equation(Box<Formula>, Box<Formula>),
}

/// How tightly a formula holds together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Power,
    Atom,
}

impl Formula {
    /// 0
    pub fn zero() -> Self {
        Formula::Number(Rational::zero())
    }

    /// 1
    pub fn one() -> Self {
        Formula::Number(Rational::one())
    }

    /// A number of either sign.
    pub fn number(value: &Rational) -> Self {
        Formula::Number(value.abs()).signed(value.is_negative())
    }

    /// −a where `negative`, a otherwise.
    pub fn signed(self, negative: bool) -> Self {
        match (negative, self) {
            (false, formula) => formula,
            (true, Formula::Negative(inside)) => *inside,
            (true, formula) => Formula::Negative(Box::new(formula)),
        }
    }

    /// Σ terms, sums among them opened.
    pub fn sum(terms: impl IntoIterator<Item = Formula>) -> Self {
        let mut flat = Vec::new();
        for term in terms {
            match term {
                Formula::Sum(inner) => flat.extend(inner),
                term => flat.push(term),
            }
        }
        match flat.len() {
            0 => Formula::zero(),
            1 => flat.remove(0),
            _ => Formula::Sum(flat),
        }
    }

    /// Π factors: ones left out, products among them opened, the sign before the whole.
    pub fn product(factors: impl IntoIterator<Item = Formula>) -> Self {
        let (mut flat, mut negative) = (Vec::new(), false);
        for factor in factors {
            let factor = match factor {
                Formula::Negative(inside) => {
                    negative = !negative;
                    *inside
                }
                factor => factor,
            };
            match factor {
                Formula::Number(one) if one.is_one() => {}
                Formula::Product(inner) => flat.extend(inner),
                factor => flat.push(factor),
            }
        }
        let product = match flat.len() {
            0 => Formula::one(),
            1 => flat.remove(0),
            _ => Formula::Product(flat),
        };
        product.signed(negative)
    }

    /// above/below
    pub fn fraction(above: Formula, below: Formula) -> Self {
        Formula::Fraction(Box::new(above), Box::new(below))
    }

    /// base^exponent; ½ is a root.
    pub fn power(base: Formula, exponent: &Rational) -> Self {
        if exponent.is_one() {
            base
        } else if *exponent == Rational::new(1.into(), 2.into()) {
            Formula::Root(Box::new(base))
        } else {
            Formula::Power(Box::new(base), exponent.clone())
        }
    }

    /// left = right
    pub fn equation(left: Formula, right: Formula) -> Self {
        Formula::Equation(Box::new(left), Box::new(right))
    }

    fn binding(&self) -> Binding {
        match self {
            Formula::Negative(_)
            | Formula::Sum(_)
            | Formula::Lines(_)
            | Formula::Equation(..)
            | Formula::Integral(..) => Binding::Sum,
            Formula::Number(value) if value.is_integer() => Binding::Atom,
            Formula::Number(_) | Formula::Product(_) | Formula::Fraction(..) => Binding::Product,
            Formula::Power(..) | Formula::Root(_) => Binding::Power,
            Formula::Letter(_)
            | Formula::Symbol { .. }
            | Formula::Partial(..)
            | Formula::Modulus(..)
            | Formula::Of(..)
            | Formula::Call(..)
            | Formula::Choice(..) => Binding::Atom,
        }
    }

    /// The terms of a sum, each with its sign: whether it is subtracted, and what is.
    fn terms(&self) -> Vec<(bool, &Formula)> {
        let list = match self {
            Formula::Sum(terms) => terms.iter().collect(),
            line => vec![line],
        };
        let signed = list.into_iter().map(|formula| match formula {
            Formula::Negative(inside) => (true, &**inside),
            positive => (false, positive),
        });
        signed.collect()
    }
}

/// A sum by a printer: terms joined with + and −.
fn signed_sum(formula: &Formula, at: fn(&Formula, Binding) -> String) -> String {
    let mut text = String::new();
    for (negative, term) in formula.terms() {
        text += match (text.is_empty(), negative) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        text += &at(term, Binding::Product);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{Formula, Mark, latex, plain};
    use crate::graph::Rational;

    fn letter(name: &str) -> Formula {
        Formula::Letter(name.to_owned())
    }

    fn number(above: i64, below: i64) -> Formula {
        Formula::number(&Rational::new(above.into(), below.into()))
    }

    #[test]
    fn the_sign_of_a_product_stands_before_it() {
        let product = Formula::product([letter("a"), number(-1, 2), number(1, 1), letter("b")]);
        assert_eq!(plain(&product), "-a 1/2 b");
        let twice = Formula::product([product, letter("c").signed(true)]);
        assert_eq!(plain(&twice), "a 1/2 b c");
        let difference = Formula::sum([letter("a"), letter("b").signed(true)]);
        assert_eq!(plain(&difference.clone().signed(true)), "-(a - b)");
        let opened = Formula::sum([letter("c"), difference]);
        assert_eq!(plain(&opened), "c + a - b");
    }

    #[test]
    fn brackets_where_they_are_needed_alone() {
        let sum = Formula::sum([letter("a"), letter("b")]);
        let below = Formula::product([letter("c"), letter("d")]);
        let fraction = Formula::fraction(sum.clone(), below);
        assert_eq!(plain(&fraction), "(a + b)/(c d)");
        assert_eq!(latex(&fraction), "\\frac{a + b}{c d}");
        let half = Rational::new(1.into(), 2.into());
        let root = Formula::power(sum.clone(), &half);
        assert_eq!(
            (plain(&root), latex(&root)),
            ("√(a + b)".to_owned(), "\\sqrt{a + b}".to_owned())
        );
        let square = Formula::power(sum, &Rational::from_integer(2.into()));
        assert_eq!(plain(&square), "(a + b)^2");
    }

    #[test]
    fn superscripts_share_their_place() {
        let symbol = |mark, below: &[&str]| Formula::Symbol {
            name: "mu".to_owned(),
            mark,
            below: below.iter().map(|s| (*s).to_owned()).collect(),
        };
        let squared = |formula| Formula::power(formula, &Rational::from_integer(2.into()));
        assert_eq!(
            latex(&squared(symbol(Mark::Prime, &[]))),
            "\\mu^{\\prime 2}"
        );
        let base = squared(symbol(Mark::Base, &["y"]));
        assert_eq!(latex(&base), "\\left(\\mu^{0}_{y}\\right)^{2}");
        assert_eq!(plain(&base), "mu⁰_y^2");
    }
}
