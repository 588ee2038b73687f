//! Expressions in the notation of the literature: n⁰_y, p⁰_nT, μ.

use super::{
    FieldId, Graph, Id, Jet, LawAtom, LawId, Node, Notation, ParameterId, Rational, Table,
};
use num_traits::{One, Signed};

/// Names for the atoms of a graph.
pub struct Printer<'a> {
    /// Every expression of the model.
    pub graph: &'a Graph,
    /// Names of the fields.
    pub fields: &'a Table<FieldId, String>,
    /// Names of the parameters.
    pub parameters: &'a Table<ParameterId, String>,
    /// Names of the laws.
    pub laws: &'a Table<LawId, String>,
    /// Name of the periodic coordinate.
    pub periodic: &'a str,
    /// Name of the cross-stream coordinate.
    pub coordinate: &'a str,
    /// How it is written.
    pub notation: &'a dyn Notation,
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
            Node::Number(value) if value.is_integer() => {
                let sign = if value.is_negative() { "-" } else { "" };
                format!("{sign}{}", self.notation.number(&value.abs()))
            }
            _ => self.at(id, Binding::Product),
        }
    }

    fn at(&self, id: Id, context: Binding) -> String {
        let (text, binding) = self.text(id);
        if binding < context {
            self.notation.brackets(&text)
        } else {
            text
        }
    }

    fn text(&self, id: Id) -> (String, Binding) {
        let notation = self.notation;
        match self.graph.node(id) {
            Node::Number(value) => self.number(value),
            Node::Pi => (notation.letter("π"), Binding::Power),
            Node::Parameter(index) => {
                let name = notation.letter(&self.parameters[*index]);
                (name, Binding::Power)
            }
            Node::Wavenumber => (notation.letter("k"), Binding::Power),
            Node::Coordinate => (notation.letter(self.coordinate), Binding::Power),
            Node::Jet(jet) => (self.jet(*jet, ""), Binding::Power),
            Node::Base(field, order) => {
                let marks = vec![self.coordinate; usize::from(*order)];
                let name = notation.symbol(&self.fields[*field], "⁰", &marks);
                (name, Binding::Power)
            }
            Node::StateLaw(atom) => (self.law(atom, ""), Binding::Power),
            Node::BaseLaw(atom) => (self.law(atom, "⁰"), Binding::Power),
            Node::Sum(constant, terms) => (self.sum(constant, terms), Binding::Sum),
            Node::Product(factors) => (self.product(factors), Binding::Product),
            Node::Call(function, argument) => {
                let call = notation.call(function.name(), &self.print(*argument));
                (call, Binding::Power)
            }
            Node::Select(switch, branches) => {
                let branches: Vec<_> = branches.iter().map(|&b| self.print(b)).collect();
                let choice = notation.choice(&self.parameters[*switch], &branches);
                (choice, Binding::Power)
            }
            Node::Derivative(operator, argument) => {
                let name = match operator {
                    super::Operator::Dx => format!("∂{}", self.periodic),
                    super::Operator::Dy => format!("∂{}", self.coordinate),
                    super::Operator::Dt => "∂t".to_owned(),
                    super::Operator::AbsDx => format!("|∂{}|", self.periodic),
                };
                (notation.call(&name, &self.print(*argument)), Binding::Power)
            }
            Node::Symbol(name, below) => {
                let marks: Vec<String> = below.chars().map(String::from).collect();
                let marks: Vec<&str> = marks.iter().map(String::as_str).collect();
                (notation.symbol(name, "⁰", &marks), Binding::Power)
            }
            Node::Slot(array, position) => (format!("[{array}, {position}]"), Binding::Power),
        }
    }

    /// A derivative of a field: `∂xy u'`, with `mark` after the name.
    pub fn jet(&self, jet: Jet, mark: &str) -> String {
        self.named_jet(&self.fields[jet.of], jet, mark)
    }

    /// The same derivative of whatever has a name.
    pub fn named_jet<V>(&self, name: &str, jet: Jet<V>, mark: &str) -> String {
        let mut below = vec!["t"; usize::from(jet.t)];
        below.extend(vec![self.periodic; usize::from(jet.x)]);
        below.extend(vec![self.coordinate; usize::from(jet.y)]);
        let symbol = self.notation.symbol(name, mark, &below);
        match jet.absx {
            0 => symbol,
            n => format!(
                "{}{symbol}",
                self.notation.absolute_partial(self.periodic, n)
            ),
        }
    }

    fn law(&self, atom: &LawAtom, mark: &str) -> String {
        let mut marks: Vec<&str> = Vec::new();
        for (field, &order) in atom.index.pairs() {
            marks.extend(vec![self.fields[field].as_str(); usize::from(order)]);
        }
        marks.extend(vec![self.coordinate; usize::from(atom.y)]);
        self.notation.symbol(&self.laws[atom.law], mark, &marks)
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
                &self.notation.number(&constant.abs()),
            );
        }
        text
    }

    fn scaled(&self, id: Id, coefficient: &Rational) -> String {
        if coefficient.is_one() {
            return self.at(id, Binding::Product);
        }
        if !self.notation.is_flat() {
            let number = self.notation.number(coefficient);
            return format!("{number} {}", self.at(id, Binding::Product));
        }
        let (numerator, denominator) = (coefficient.numer(), coefficient.denom());
        let text = if numerator.is_one() {
            self.at(id, Binding::Product)
        } else {
            format!("{numerator} {}", self.at(id, Binding::Product))
        };
        if denominator.is_one() {
            text
        } else {
            self.notation.fraction(&text, &[denominator.to_string()])
        }
    }

    /// Π base^exponent, negative powers below a fraction bar.
    pub fn product(&self, factors: &[(Id, Rational)]) -> String {
        let fraction = factors.iter().any(|(_, e)| e.is_negative());
        let side = |negative: bool| -> Vec<String> {
            let side = factors.iter().filter(|(_, e)| e.is_negative() == negative);
            match side.clone().collect::<Vec<_>>().as_slice() {
                // The bar of a fraction is bracket enough.
                [(base, e)] if e.abs().is_one() && fraction && !self.notation.is_flat() => {
                    vec![self.print(*base)]
                }
                _ => side.map(|(base, e)| self.power(*base, &e.abs())).collect(),
            }
        };
        let (above, below) = (side(false), side(true));
        let numerator = if above.is_empty() {
            "1".into()
        } else {
            above.join(" ")
        };
        match below.as_slice() {
            [] => numerator,
            _ => self.notation.fraction(&numerator, &below),
        }
    }

    fn power(&self, base: Id, exponent: &Rational) -> String {
        if exponent.is_one() {
            return self.at(base, Binding::Power);
        }
        let text = self.at(base, Binding::Power);
        if *exponent == Rational::new(1.into(), 2.into()) {
            self.notation.root(&text)
        } else {
            self.notation.power(&text, exponent)
        }
    }

    fn number(&self, value: &Rational) -> (String, Binding) {
        let text = self.notation.number(&value.abs());
        match (value.is_negative(), value.is_integer()) {
            (true, _) => (format!("-{text}"), Binding::Sum),
            (false, false) => (text, Binding::Product),
            (false, true) => (text, Binding::Power),
        }
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
