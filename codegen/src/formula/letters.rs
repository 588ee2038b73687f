//! Expressions of a graph as formulas, by the names of a model.

use super::{Formula, Mark};
use crate::graph::{
    FieldId, Graph, Id, Jet, LawAtom, LawId, Node, Operator, ParameterId, Rational, Table,
};
use num_traits::Signed;

/// In how many dimensions a formula stands.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Arrangement {
    /// On one line: x/2, and no grouping, which would hide more than it shows.
    Flat,
    /// With bars of fractions, and lines below one another: ½ x.
    Grouped,
}

/// Names for the atoms of a graph.
pub struct Letters {
    /// Names of the fields.
    pub fields: Table<FieldId, String>,
    /// Names of the parameters.
    pub parameters: Table<ParameterId, String>,
    /// Names of the laws.
    pub laws: Table<LawId, String>,
    /// Name of the periodic coordinate.
    pub periodic: String,
    /// Name of the cross-stream coordinate.
    pub coordinate: String,
    /// How products with numbers are written.
    pub arrangement: Arrangement,
}

impl Letters {
    /// An expression.
    pub fn formula(&self, graph: &Graph, id: Id) -> Formula {
        let of = |id: Id| self.formula(graph, id);
        match graph.node(id) {
            Node::Number(value) => Formula::number(value),
            Node::Pi => Formula::Letter("π".to_owned()),
            Node::Parameter(parameter) => Formula::Letter(self.parameters[*parameter].clone()),
            Node::Wavenumber => Formula::Letter("k".to_owned()),
            Node::Coordinate => Formula::Letter(self.coordinate.clone()),
            Node::Jet(jet) => self.jet(*jet, Mark::None),
            Node::Base(field, order) => Formula::Symbol {
                name: self.fields[*field].clone(),
                mark: Mark::Base,
                below: vec![self.coordinate.clone(); usize::from(*order)],
            },
            Node::StateLaw(atom) => self.law(atom, Mark::None),
            Node::BaseLaw(atom) => self.law(atom, Mark::Base),
            Node::Sum(constant, terms) => self.sum(graph, constant, terms),
            Node::Product(factors) => self.product(graph, factors),
            Node::Call(function, argument) => {
                Formula::Call(function.name().to_owned(), Box::new(of(*argument)))
            }
            Node::Select(switch, branches) => {
                let branches = branches.iter().map(|&b| of(b)).collect();
                Formula::Choice(self.parameters[*switch].clone(), branches)
            }
            Node::Derivative(operator, argument) => {
                let name = match operator {
                    Operator::Dx => format!("∂{}", self.periodic),
                    Operator::Dy => format!("∂{}", self.coordinate),
                    Operator::Dt => "∂t".to_owned(),
                    Operator::AbsDx => format!("|∂{}|", self.periodic),
                };
                Formula::Call(name, Box::new(of(*argument)))
            }
            Node::Symbol(name, below) => Formula::Symbol {
                name: name.clone(),
                mark: Mark::Base,
                below: below.chars().map(String::from).collect(),
            },
            Node::Slot(array, position) => Formula::Letter(format!("[{array}, {position}]")),
        }
    }

    /// A derivative of a field: ∂xy u'.
    pub fn jet(&self, jet: Jet, mark: Mark) -> Formula {
        self.named_jet(&self.fields[jet.of], jet, mark)
    }

    /// The same derivative of anything that has a name.
    pub fn named_jet<V>(&self, name: &str, jet: Jet<V>, mark: Mark) -> Formula {
        let mut below = vec!["t".to_owned(); usize::from(jet.t)];
        below.extend(vec![self.periodic.clone(); usize::from(jet.x)]);
        below.extend(vec![self.coordinate.clone(); usize::from(jet.y)]);
        let name = name.to_owned();
        let symbol = Formula::Symbol { name, mark, below };
        match jet.absx {
            0 => symbol,
            n => {
                let modulus = Formula::Modulus(self.periodic.clone(), n);
                Formula::Of(Box::new(modulus), Box::new(symbol))
            }
        }
    }

    /// ∂x^a |∂x|^b ∂y^c, factor by factor.
    pub fn operator<V>(&self, jet: Jet<V>) -> Vec<Formula> {
        let mut parts = Vec::new();
        if jet.x > 0 {
            parts.push(Formula::Partial(self.periodic.clone(), jet.x));
        }
        if jet.absx > 0 {
            parts.push(Formula::Modulus(self.periodic.clone(), jet.absx));
        }
        if jet.y > 0 {
            parts.push(Formula::Partial(self.coordinate.clone(), jet.y));
        }
        parts
    }

    fn law(&self, atom: &LawAtom, mark: Mark) -> Formula {
        let mut below = Vec::new();
        for (field, &order) in atom.index.pairs() {
            below.extend(vec![self.fields[field].clone(); usize::from(order)]);
        }
        below.extend(vec![self.coordinate.clone(); usize::from(atom.y)]);
        let name = self.laws[atom.law].clone();
        Formula::Symbol { name, mark, below }
    }

    fn sum(&self, graph: &Graph, constant: &Rational, terms: &[(Id, Rational)]) -> Formula {
        // A positive term first reads better than a leading minus.
        let first = terms.iter().position(|(_, c)| c.is_positive()).unwrap_or(0);
        let order = std::iter::once(first).chain((0..terms.len()).filter(|&i| i != first));
        let mut sum: Vec<Formula> = Vec::new();
        for index in order.filter(|&i| i < terms.len()) {
            let (id, coefficient) = &terms[index];
            sum.push(self.times(self.formula(graph, *id), coefficient));
        }
        if *constant != Rational::default() {
            sum.push(Formula::number(constant));
        }
        Formula::sum(sum)
    }

    /// coefficient · formula
    fn times(&self, formula: Formula, coefficient: &Rational) -> Formula {
        let size = coefficient.abs();
        let scaled = match self.arrangement {
            Arrangement::Flat if !size.is_integer() => {
                let above = Rational::from_integer(size.numer().clone());
                let below = Rational::from_integer(size.denom().clone());
                let above = Formula::product([Formula::Number(above), formula]);
                Formula::fraction(above, Formula::Number(below))
            }
            _ => Formula::product([Formula::Number(size), formula]),
        };
        scaled.signed(coefficient.is_negative())
    }

    /// Π base^exponent, negative powers below a bar.
    pub fn product(&self, graph: &Graph, factors: &[(Id, Rational)]) -> Formula {
        let side = |negative: bool| {
            let side = factors
                .iter()
                .filter(move |(_, e)| e.is_negative() == negative);
            let power =
                |(base, e): &(Id, Rational)| Formula::power(self.formula(graph, *base), &e.abs());
            Formula::product(side.map(power))
        };
        if factors.iter().any(|(_, e)| e.is_negative()) {
            Formula::fraction(side(false), side(true))
        } else {
            side(false)
        }
    }

    /// coefficient · Π what
    pub fn scaled(&self, graph: &Graph, coefficient: Id, what: Vec<Formula>) -> Formula {
        let factors = std::iter::once(self.formula(graph, coefficient)).chain(what);
        Formula::product(factors)
    }
}
