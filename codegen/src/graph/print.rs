//! Expressions as text, in the notation of the literature: n⁰_y, p⁰_nT, μ.

use super::{Graph, Id, Jet, LawAtom, Node, Rational};
use num_traits::{One, Signed};

/// Names for the atoms of a graph.
pub struct Printer<'a> {
    pub graph: &'a Graph,
    pub fields: &'a [String],
    pub parameters: &'a [String],
    pub laws: &'a [String],
    pub coordinate: &'a str,
    /// Names of the kernel arrays.
    pub slots: &'a [String],
}

/// How tightly a printed expression binds.
#[derive(PartialEq, PartialOrd)]
enum Binding {
    Sum,
    Product,
    Power,
}

impl Printer<'_> {
    /// The expression on one line.
    pub fn print(&self, id: Id) -> String {
        self.at(id, Binding::Sum)
    }

    /// The expression as the first factor of a product: a sum of several terms in brackets.
    pub fn factor(&self, id: Id) -> String {
        match self.graph.node(id) {
            Node::Sum(constant, terms) if terms.len() == 1 && *constant == Rational::default() => {
                self.print(id)
            }
            Node::Number(value) if value.is_integer() => value.to_string(),
            _ => self.at(id, Binding::Product),
        }
    }

    fn at(&self, id: Id, context: Binding) -> String {
        let (text, binding) = self.text(id);
        if binding < context {
            format!("({text})")
        } else {
            text
        }
    }

    fn text(&self, id: Id) -> (String, Binding) {
        match self.graph.node(id) {
            Node::Number(value) => number(value),
            Node::Pi => ("π".into(), Binding::Power),
            Node::Parameter(index) => (self.parameters[*index].clone(), Binding::Power),
            Node::Wavenumber => ("k".into(), Binding::Power),
            Node::Coordinate => (self.coordinate.into(), Binding::Power),
            Node::Jet(jet) => (self.jet(*jet, ""), Binding::Power),
            Node::Base(field, order) => {
                let marks = self.coordinate.repeat(usize::from(*order));
                (
                    subscripted(&format!("{}⁰", self.fields[*field]), &marks),
                    Binding::Power,
                )
            }
            Node::StateLaw(atom) => (self.law(atom, ""), Binding::Power),
            Node::BaseLaw(atom) => (self.law(atom, "⁰"), Binding::Power),
            Node::Sum(constant, terms) => (self.sum(constant, terms), Binding::Sum),
            Node::Product(factors) => (self.product(factors), Binding::Product),
            Node::Call(function, argument) => (
                format!("{}({})", function.name(), self.print(*argument)),
                Binding::Power,
            ),
            Node::Select(switch, branches) => {
                let branches: Vec<_> = branches.iter().map(|&b| self.print(b)).collect();
                let name = &self.parameters[*switch];
                (
                    format!("select({name}; {})", branches.join(", ")),
                    Binding::Power,
                )
            }
            Node::Derivative(operator, argument) => {
                let name = match operator {
                    super::Operator::Dx => "∂x",
                    super::Operator::Dy => "∂y",
                    super::Operator::Dt => "∂t",
                    super::Operator::AbsDx => "|∂x|",
                };
                (format!("{name}({})", self.print(*argument)), Binding::Power)
            }
            Node::Slot(array, position) => (
                format!("{}[{position}]", self.slots[*array]),
                Binding::Power,
            ),
        }
    }

    /// A derivative of a field: `∂xy u'`, with `mark` after the name.
    pub fn jet(&self, jet: Jet, mark: &str) -> String {
        let order = |letter: &str, n: u8| letter.repeat(usize::from(n));
        let inner = order("t", jet.t) + &order("x", jet.x) + &order(self.coordinate, jet.y);
        let outer = order("|∂x|", jet.absx);
        let name = format!("{}{mark}", self.fields[usize::from(jet.field)]);
        format!("{outer}{}", subscripted(&name, &inner))
    }

    fn law(&self, atom: &LawAtom, mark: &str) -> String {
        let mut marks = String::new();
        for (field, &order) in atom.index.iter().enumerate() {
            marks += &self.fields[field].repeat(usize::from(order));
        }
        marks += &self.coordinate.repeat(usize::from(atom.y));
        subscripted(&format!("{}{mark}", self.laws[atom.law]), &marks)
    }

    fn sum(&self, constant: &Rational, terms: &[(Id, Rational)]) -> String {
        let mut text = String::new();
        // A positive term first reads better than a leading minus.
        let first = terms.iter().position(|(_, c)| c.is_positive()).unwrap_or(0);
        let order = std::iter::once(first).chain((0..terms.len()).filter(|&i| i != first));
        for i in order {
            let (id, coefficient) = &terms[i];
            push_signed(
                &mut text,
                coefficient.is_negative(),
                &self.scaled(*id, &coefficient.abs()),
            );
        }
        if *constant != Rational::default() {
            push_signed(
                &mut text,
                constant.is_negative(),
                &number(&constant.abs()).0,
            );
        }
        text
    }

    fn scaled(&self, id: Id, coefficient: &Rational) -> String {
        if coefficient.is_one() {
            return self.at(id, Binding::Product);
        }
        let (numerator, denominator) = (coefficient.numer(), coefficient.denom());
        let mut text = if numerator.is_one() {
            self.at(id, Binding::Product)
        } else {
            format!("{numerator} {}", self.at(id, Binding::Product))
        };
        if !denominator.is_one() {
            text = format!("{text}/{denominator}");
        }
        text
    }

    fn product(&self, factors: &[(Id, Rational)]) -> String {
        let side = |negative: bool| -> Vec<String> {
            factors
                .iter()
                .filter(|(_, e)| e.is_negative() == negative)
                .map(|(base, e)| self.power(*base, &e.abs()))
                .collect()
        };
        let (above, below) = (side(false), side(true));
        let numerator = if above.is_empty() {
            "1".into()
        } else {
            above.join(" ")
        };
        match below.len() {
            0 => numerator,
            1 => format!("{numerator}/{}", below[0]),
            _ => format!("{numerator}/({})", below.join(" ")),
        }
    }

    fn power(&self, base: Id, exponent: &Rational) -> String {
        if exponent.is_one() {
            return self.at(base, Binding::Power);
        }
        if *exponent == Rational::new(1.into(), 2.into()) {
            return format!("√{}", self.at(base, Binding::Power));
        }
        let base = self.at(base, Binding::Power);
        if exponent.is_integer() {
            format!("{base}^{exponent}")
        } else {
            format!("{base}^({exponent})")
        }
    }
}

fn subscripted(name: &str, marks: &str) -> String {
    if marks.is_empty() {
        name.into()
    } else {
        format!("{name}_{marks}")
    }
}

fn push_signed(text: &mut String, negative: bool, term: &str) {
    match (text.is_empty(), negative) {
        (true, false) => {}
        (true, true) => text.push('-'),
        (false, false) => text.push_str(" + "),
        (false, true) => text.push_str(" - "),
    }
    text.push_str(term);
}

fn number(value: &Rational) -> (String, Binding) {
    let binding = match (value.is_negative(), value.is_integer()) {
        (true, _) => Binding::Sum,
        (false, false) => Binding::Product,
        (false, true) => Binding::Power,
    };
    (value.to_string(), binding)
}
