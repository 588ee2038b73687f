//! The derived operators as lines in the notation of the literature, as text or as LaTeX.

use crate::derive::{AdjointCondition, CaseClosure, Derivation, Form, Term};
use crate::graph::{BalanceId, FieldId, Id, Jet, Latex, Notation, Plain, Printer, Table};
use crate::model::{End, Lettering};
use landau_contract::Id as Position;
use std::collections::BTreeMap;

/// What `explain` can print.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Section {
    /// The balances of the base state.
    Base,
    /// L and M0.
    Linear,
    /// L†, M0† and the adjoint conditions.
    Adjoint,
    /// N of this degree.
    Nonlinear(usize),
}

/// The sections of a derivation, in order.
pub fn sections(derivation: &Derivation) -> Vec<Section> {
    let mut sections = vec![Section::Base, Section::Linear, Section::Adjoint];
    sections.extend((2..=derivation.operators.order).map(Section::Nonlinear));
    sections
}

/// What stands before a formula.
enum Label {
    None,
    Name(String),
    /// A place, which is a formula itself.
    Place(String),
    /// Row and column of a matrix.
    Entry(String, String),
}

enum Line {
    Heading(String),
    /// The choices of the switches that the following lines hold for.
    Case(String),
    Words(String),
    Formula(Label, String),
}

/// One section as text.
pub fn print(derivation: &Derivation, section: Section) -> String {
    let lines = lines(&Writer::new(derivation, &Plain), section);
    let text = lines.into_iter().map(|line| match line {
        Line::Heading(words) => format!("{words}\n"),
        Line::Case(words) => format!("  -- {words}\n"),
        Line::Words(words) => format!("  {words}\n"),
        Line::Formula(Label::None, formula) => format!("  {formula}\n"),
        Line::Formula(Label::Name(name), formula) => format!("  {name}: {formula}\n"),
        Line::Formula(Label::Place(place), formula) => format!("  at {place}: {formula}\n"),
        Line::Formula(Label::Entry(row, column), formula) => {
            format!("  [{row}, {column}] {formula}\n")
        }
    });
    text.collect()
}

/// A row of a typeset section.
pub enum Typeset {
    /// A title.
    Heading(String),
    /// A sentence.
    Words(String),
    /// A displayed formula in LaTeX.
    Formula(String),
}

/// Words as LaTeX sets them inside a formula.
pub fn latex_words(text: &str) -> String {
    format!("\\text{{{}}}", text.replace('_', " "))
}

/// One section as LaTeX.
pub fn latex(derivation: &Derivation, section: Section) -> Vec<Typeset> {
    let words = latex_words;
    let lines = lines(&Writer::new(derivation, &Latex), section);
    let rows = lines.into_iter().map(|line| match line {
        Line::Heading(text) => Typeset::Heading(text),
        Line::Case(text) | Line::Words(text) => Typeset::Words(text),
        Line::Formula(label, formula) => Typeset::Formula(match label {
            Label::None => formula,
            Label::Name(name) => format!("{}\\quad {formula}", words(&name)),
            Label::Place(place) => format!("{place}{}\\quad {formula}", words(":")),
            Label::Entry(row, column) => {
                format!("[{},\\,{column}]\\quad {formula}", words(&row))
            }
        }),
    });
    rows.collect()
}

fn lines(writer: &Writer, section: Section) -> Vec<Line> {
    match section {
        Section::Base => writer.base(),
        Section::Linear => writer.linear(),
        Section::Adjoint => writer.adjoint(),
        Section::Nonlinear(degree) => writer.nonlinear(degree),
    }
}

/// One row of N of some degree as a sum, for doc comments.
pub fn nonlinear_row(derivation: &Derivation, degree: usize, row: BalanceId) -> String {
    Writer::new(derivation, &Plain).form(&derivation.operators.nonlinear[degree - 2][row])
}

pub(super) struct Writer<'a> {
    pub(super) derivation: &'a Derivation,
    pub(super) notation: &'a dyn Notation,
    lettering: Lettering,
    /// Adjoint fields by balance.
    adjoint_fields: Table<BalanceId, String>,
}

impl<'a> Writer<'a> {
    pub(super) fn new(derivation: &'a Derivation, notation: &'a dyn Notation) -> Self {
        let lettering = derivation.model.lettering();
        let pairing = &derivation.operators.pairing;
        let adjoint_fields = pairing.map(|&field| format!("{}†", lettering.fields[field]));
        Writer {
            derivation,
            notation,
            lettering,
            adjoint_fields,
        }
    }

    pub(super) fn fields(&self) -> &Table<FieldId, String> {
        &self.lettering.fields
    }

    pub(super) fn printer(&self) -> Printer<'_> {
        let graph = &self.derivation.model.graph;
        self.lettering.printer(graph, self.notation)
    }

    fn print(&self, id: Id) -> String {
        self.printer().print(id)
    }

    fn place(&self, end: End) -> String {
        let model = &self.derivation.model;
        model.interval.as_ref().map_or(String::new(), |interval| {
            let name = self.notation.letter(&interval.name);
            let place = match (interval.named(end), self.notation.is_flat()) {
                (true, true) => interval.written(end).to_owned(),
                (true, false) => self.notation.letter(interval.written(end)),
                (false, _) => self.print(interval.end(end)),
            };
            format!("{name} = {place}")
        })
    }

    /// ∂x^a |∂x|^b ∂y^c ∂t^d
    fn operator<V>(&self, jet: Jet<V>) -> String {
        let model = &self.derivation.model;
        let notation = self.notation;
        let mut parts = Vec::new();
        for (coordinate, power) in [("t", jet.t), (model.periodic.as_str(), jet.x)] {
            if power > 0 {
                parts.push(notation.partial(coordinate, power));
            }
        }
        if jet.absx > 0 {
            parts.push(notation.absolute_partial(&model.periodic, jet.absx));
        }
        if jet.y > 0 {
            parts.push(notation.partial(model.coordinate(), jet.y));
        }
        parts.join(" ")
    }

    fn name(&self, name: &str) -> String {
        self.notation.symbol(name, "", &[])
    }

    /// formula = 0
    fn vanishes(&self, label: Label, formula: &str) -> Line {
        Line::Formula(label, format!("{formula} = 0"))
    }

    /// Entry by entry: the coefficient, then the operator.
    fn entries<Row: Position, Column: Position>(
        &self,
        lines: &mut Vec<Line>,
        terms: &[Term<Row, Column>],
        rows: &Table<Row, String>,
        columns: &Table<Column, String>,
        time: bool,
    ) {
        let mut blocks: BTreeMap<(Row, Column), Vec<(Id, String)>> = BTreeMap::new();
        let mut sorted: Vec<&Term<Row, Column>> =
            terms.iter().filter(|t| (t.jet.t > 0) == time).collect();
        sorted.sort_by_key(|t| (t.jet.y, t.jet.x, t.jet.absx));
        for term in sorted {
            let operator = self.operator(Jet { t: 0, ..term.jet });
            let block = blocks.entry((term.row, term.jet.of)).or_default();
            block.push((term.coefficient, operator));
        }
        for ((row, column), parts) in blocks {
            let column = self.name(&columns[column]);
            let label = Label::Entry(rows[row].clone(), column);
            let formula = if self.notation.is_flat() {
                let parts = parts
                    .iter()
                    .map(|(coefficient, operator)| match operator.as_str() {
                        "" => self.print(*coefficient),
                        operator => self.scaled(*coefficient, operator),
                    });
                signed_sum(parts.collect())
            } else {
                self.over_common_denominator(&parts)
            };
            lines.push(Line::Formula(label, formula));
        }
    }

    fn base(&self) -> Vec<Line> {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        let mut lines = vec![Line::Heading("Base state".into())];
        for (field, closed) in model.base.closed.pairs() {
            if let Some(id) = closed {
                let name = self.notation.symbol(&self.fields()[field], "⁰", &[]);
                let formula = format!("{name} = {}", self.print(*id));
                lines.push(Line::Formula(Label::None, formula));
            }
        }
        for row in &operators.base {
            let name = Label::Name(model.balances[row.balance].name.clone());
            lines.push(self.vanishes(name, &self.print(row.residual)));
        }
        for (integrand, value) in &operators.base_integrals {
            let integral = self
                .notation
                .integral(&self.print(*integrand), model.coordinate());
            let formula = format!("{integral} = {}", self.print(*value));
            lines.push(Line::Formula(Label::None, formula));
        }
        for case in &operators.cases {
            lines.extend(self.case(&case.choices));
            for condition in &case.base_conditions {
                let place = Label::Place(self.place(condition.end));
                lines.push(self.vanishes(place, &self.print(condition.residual)));
            }
        }
        lines
    }

    fn case(&self, choices: &[usize]) -> Option<Line> {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        let named: Vec<String> = operators
            .switches
            .iter()
            .zip(choices)
            .map(|(&switch, &choice)| {
                let parameter = &model.parameters[switch];
                format!("{} = {}", parameter.name, parameter.choices[choice])
            })
            .collect();
        (!named.is_empty()).then(|| Line::Case(named.join(", ")))
    }

    fn linear(&self) -> Vec<Line> {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        let rows = model.balances.map(|b| b.name.clone());
        let mut lines = vec![Line::Heading("Mass matrix M0 [balance, field]".into())];
        self.entries(&mut lines, &operators.linear, &rows, self.fields(), true);
        lines.push(Line::Heading("Linear operator L [balance, field]".into()));
        self.entries(&mut lines, &operators.linear, &rows, self.fields(), false);
        lines.push(Line::Heading("Boundary conditions".into()));
        for case in &operators.cases {
            lines.extend(self.case(&case.choices));
            for condition in &case.conditions {
                let place = Label::Place(self.place(condition.end));
                lines.push(self.vanishes(place, &self.form(&condition.form)));
            }
        }
        lines.push(Line::Heading("Closure at k = 0".into()));
        for case in &operators.cases {
            lines.extend(self.case(&case.choices));
            lines.extend(case.closures.iter().map(|closure| self.closure(closure)));
        }
        lines.push(Line::Heading(self.parity()));
        lines
    }

    fn closure(&self, closure: &CaseClosure) -> Line {
        let integral = |density: &[(Jet, Id)]| {
            let terms: Vec<String> = density
                .iter()
                .map(|(jet, weight)| self.scaled(*weight, &self.jet(*jet)))
                .collect();
            let model = &self.derivation.model;
            let variable = match model.interval {
                Some(_) => model.coordinate(),
                None => &model.periodic,
            };
            self.notation.integral(&terms.join(" + "), variable)
        };
        match closure {
            CaseClosure::Conserved { density, .. } => {
                self.vanishes(Label::Name("conserved".into()), &integral(density))
            }
            CaseClosure::Claimed { density, .. } => self.vanishes(
                Label::Name("conserved, as claimed".into()),
                &integral(density),
            ),
            CaseClosure::Gauge { field, .. } => {
                Line::Words(format!("gauge: the constant of {}", self.fields()[*field]))
            }
            CaseClosure::Drift { field, .. } => Line::Words(format!(
                "gauge: the constant of {}, which may drift",
                self.fields()[*field]
            )),
            CaseClosure::Unknown { field, density } => {
                let name = Label::Name(format!("unknown {}", self.fields()[*field]));
                self.vanishes(name, &integral(density))
            }
        }
    }

    fn parity(&self) -> String {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        match &operators.parity {
            None => format!("Symmetry: none under {0} → -{0}", model.periodic),
            Some(parity) => {
                let signs: Vec<String> = self
                    .fields()
                    .iter()
                    .zip(parity.fields.iter())
                    .map(|(name, odd)| {
                        if *odd {
                            format!("-{name}")
                        } else {
                            name.clone()
                        }
                    })
                    .collect();
                let (before, after) = (self.fields().join(", "), signs.join(", "));
                format!(
                    "Symmetry: {0} → -{0} with ({before}) → ({after})",
                    model.periodic
                )
            }
        }
    }

    fn adjoint(&self) -> Vec<Line> {
        let operators = &self.derivation.operators;
        let (rows, columns) = (self.fields(), &self.adjoint_fields);
        let title = |what: &str| Line::Heading(format!("{what} [field, balance's adjoint]"));
        let mut lines = vec![title("Adjoint mass matrix M0†")];
        self.entries(&mut lines, &operators.adjoint, rows, columns, true);
        lines.push(title("Adjoint operator L†"));
        self.entries(&mut lines, &operators.adjoint, rows, columns, false);
        lines.push(Line::Heading("Adjoint boundary conditions".into()));
        for case in &operators.cases {
            lines.extend(self.case(&case.choices));
            match &case.adjoint {
                Err(reason) => lines.push(Line::Words(reason.clone())),
                Ok(conditions) => {
                    for condition in conditions {
                        let place = Label::Place(self.place(condition.end));
                        lines.push(self.vanishes(place, &self.adjoint_condition(condition)));
                    }
                }
            }
        }
        lines
    }

    fn adjoint_condition(&self, condition: &AdjointCondition) -> String {
        let printer = self.printer();
        let mut parts = Vec::new();
        // The highest derivative first, as it is solved for.
        for (jet, symbol) in condition.combination.iter().rev() {
            for (&(x, absx), &id) in symbol {
                let jet = Jet { x, absx, ..*jet };
                let mark = printer.named_jet(&self.adjoint_fields[jet.of], jet, "");
                parts.push(self.scaled(id, &mark));
            }
        }
        signed_sum(parts)
    }

    fn nonlinear(&self, degree: usize) -> Vec<Line> {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        let mut lines = vec![Line::Heading(format!("N{degree}"))];
        for (row, form) in operators.nonlinear[degree - 2].pairs() {
            let name = Label::Name(model.balances[row].name.clone());
            let formula = if self.notation.is_flat() || form.terms.is_empty() {
                self.form(form)
            } else {
                let lines = self.grouped_form(form, operators.divisors[row]);
                self.notation.lines(&lines)
            };
            lines.push(Line::Formula(name, formula));
        }
        lines
    }

    fn jet(&self, jet: Jet) -> String {
        self.printer().jet(jet, "'")
    }

    /// coefficient · what, ones left out.
    pub(super) fn scaled(&self, coefficient: Id, what: &str) -> String {
        let text = self.printer().factor(coefficient);
        match text.as_str() {
            "1" => what.to_owned(),
            "-1" => format!("-{what}"),
            _ => format!("{text} {what}"),
        }
    }

    fn form(&self, form: &Form) -> String {
        let mut parts = Vec::new();
        for (monomial, &coefficient) in &form.terms {
            let jets: Vec<String> = monomial.iter().map(|&jet| self.jet(jet)).collect();
            parts.push(self.scaled(coefficient, &jets.join(" ")));
        }
        if parts.is_empty() {
            "0".into()
        } else {
            signed_sum(parts)
        }
    }
}

/// Joins terms with + and −.
pub(super) fn signed_sum(parts: Vec<String>) -> String {
    let mut text = String::new();
    for part in parts {
        match (text.is_empty(), part.strip_prefix('-')) {
            (true, _) => text.push_str(&part),
            (false, Some(rest)) => {
                text.push_str(" - ");
                text.push_str(rest);
            }
            (false, None) => {
                text.push_str(" + ");
                text.push_str(&part);
            }
        }
    }
    text
}
