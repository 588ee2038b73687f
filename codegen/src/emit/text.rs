//! The derived operators as text, in the notation of the literature.

use crate::derive::{AdjointCondition, CaseClosure, Derivation, Form, Term};
use crate::graph::{Id, Jet, Printer};
use crate::model::End;
use std::collections::BTreeMap;
use std::fmt::Write;

/// What `explain` can print.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Section {
    Base,
    Linear,
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

/// Prints one section.
pub fn print(derivation: &Derivation, section: Section) -> String {
    let writer = Writer::new(derivation);
    match section {
        Section::Base => writer.base(),
        Section::Linear => writer.linear(),
        Section::Adjoint => writer.adjoint(),
        Section::Nonlinear(degree) => writer.nonlinear(degree),
    }
}

/// One row of N of some degree as a sum, for doc comments.
pub fn nonlinear_row(derivation: &Derivation, degree: usize, row: usize) -> String {
    Writer::new(derivation).form(&derivation.operators.nonlinear[degree - 2][row])
}

struct Writer<'a> {
    derivation: &'a Derivation,
    fields: Vec<String>,
    /// Adjoint fields by balance.
    adjoint_fields: Vec<String>,
    parameters: Vec<String>,
    laws: Vec<String>,
}

impl<'a> Writer<'a> {
    fn new(derivation: &'a Derivation) -> Self {
        let model = &derivation.model;
        let fields = model.field_names();
        let adjoint_fields = derivation
            .operators
            .pairing
            .iter()
            .map(|&f| format!("{}†", fields[f]))
            .collect();
        Writer {
            derivation,
            fields,
            adjoint_fields,
            parameters: model.parameters.iter().map(|p| p.name.clone()).collect(),
            laws: model.laws.iter().map(|l| l.name.clone()).collect(),
        }
    }

    fn printer<'b>(&'b self, fields: &'b [String]) -> Printer<'b> {
        Printer {
            graph: &self.derivation.model.graph,
            fields,
            parameters: &self.parameters,
            laws: &self.laws,
            coordinate: self.derivation.model.coordinate(),
            slots: &[],
        }
    }

    fn print(&self, id: Id) -> String {
        self.printer(&self.fields).print(id)
    }

    fn place(&self, end: End) -> String {
        let model = &self.derivation.model;
        model.interval.as_ref().map_or(String::new(), |interval| {
            let id = if end == End::Lower {
                interval.lower
            } else {
                interval.upper
            };
            format!("at {} = {}", interval.name, self.print(id))
        })
    }

    /// ∂x^a |∂x|^b ∂y^c ∂t^d
    fn operator(&self, jet: Jet) -> String {
        let model = &self.derivation.model;
        let power = |name: &str, n: u8| match n {
            0 => String::new(),
            1 => format!(" {name}"),
            2 => format!(" {name}²"),
            3 => format!(" {name}³"),
            4 => format!(" {name}⁴"),
            n => format!(" {name}^{n}"),
        };
        let periodic = format!("∂{}", model.periodic);
        let cross = format!("∂{}", model.coordinate());
        power("∂t", jet.t)
            + &power(&periodic, jet.x)
            + &power(&format!("|{periodic}|"), jet.absx)
            + &power(&cross, jet.y)
    }

    /// Entry by entry: the coefficient, then the operator.
    fn entries(
        &self,
        text: &mut String,
        terms: &[Term],
        rows: &[String],
        columns: &[String],
        time: bool,
    ) {
        let mut blocks: BTreeMap<(usize, u8), Vec<String>> = BTreeMap::new();
        let mut sorted: Vec<&Term> = terms.iter().filter(|t| (t.jet.t > 0) == time).collect();
        sorted.sort_by_key(|t| (t.jet.y, t.jet.x, t.jet.absx));
        for term in sorted {
            let operator = self.operator(Jet { t: 0, ..term.jet });
            let block = blocks.entry((term.row, term.jet.field)).or_default();
            block.push(match operator.trim() {
                "" => self.print(term.coefficient),
                operator => self.scaled(term.coefficient, operator),
            });
        }
        for ((row, column), parts) in blocks {
            let _ = writeln!(
                text,
                "  [{}, {}] {}",
                rows[row],
                columns[usize::from(column)],
                signed_sum(parts)
            );
        }
    }

    fn base(&self) -> String {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        let mut text = String::from("Base state\n");
        for (field, closed) in model.base.closed.iter().enumerate() {
            if let Some(id) = closed {
                let _ = writeln!(text, "  {}⁰ = {}", self.fields[field], self.print(*id));
            }
        }
        for row in &operators.base {
            let name = &model.balances[row.balance].name;
            let _ = writeln!(text, "  {name}: {} = 0", self.print(row.residual));
        }
        for (integrand, value) in &operators.base_integrals {
            let (integrand, value) = (self.print(*integrand), self.print(*value));
            let _ = writeln!(text, "  ∫ {integrand} d{} = {value}", model.coordinate());
        }
        for case in &operators.cases {
            text += &self.case_title(&case.choices);
            for condition in &case.base_conditions {
                let _ = writeln!(
                    text,
                    "  {}: {} = 0",
                    self.place(condition.end),
                    self.print(condition.residual)
                );
            }
        }
        text
    }

    fn case_title(&self, choices: &[usize]) -> String {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        if choices.is_empty() {
            return String::new();
        }
        let named: Vec<String> = operators
            .switches
            .iter()
            .zip(choices)
            .map(|(&switch, &choice)| {
                let parameter = &model.parameters[switch];
                format!("{} = {}", parameter.name, parameter.choices[choice])
            })
            .collect();
        format!("  -- {}\n", named.join(", "))
    }

    fn linear(&self) -> String {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        let rows: Vec<String> = model.balances.iter().map(|b| b.name.clone()).collect();
        let mut text = String::from("Mass matrix M0 [balance, field]\n");
        self.entries(&mut text, &operators.linear, &rows, &self.fields, true);
        text += "Linear operator L [balance, field]\n";
        self.entries(&mut text, &operators.linear, &rows, &self.fields, false);
        text += "Boundary conditions\n";
        for case in &operators.cases {
            text += &self.case_title(&case.choices);
            for condition in &case.conditions {
                let _ = writeln!(
                    text,
                    "  {}: {} = 0",
                    self.place(condition.end),
                    self.form(&condition.form)
                );
            }
        }
        text += "Closure at k = 0\n";
        for case in &operators.cases {
            text += &self.case_title(&case.choices);
            for closure in &case.closures {
                text += &self.closure(closure);
            }
        }
        text += &self.parity();
        text
    }

    fn closure(&self, closure: &CaseClosure) -> String {
        let density = |density: &[(Jet, Id)]| {
            let terms: Vec<String> = density
                .iter()
                .map(|(jet, weight)| self.scaled(*weight, &self.jet(*jet)))
                .collect();
            terms.join(" + ")
        };
        match closure {
            CaseClosure::Conserved { density: d, .. } => {
                format!("  conserved: ∫ {} = 0\n", density(d))
            }
            CaseClosure::Gauge { field, .. } => {
                format!("  gauge: the constant of {}\n", self.fields[*field])
            }
            CaseClosure::Unknown { field, density: d } => {
                format!(
                    "  unknown {}, closed by ∫ {} = 0\n",
                    self.fields[*field],
                    density(d)
                )
            }
        }
    }

    fn parity(&self) -> String {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        match &operators.parity {
            None => format!("Symmetry: none under {0} → -{0}\n", model.periodic),
            Some(parity) => {
                let signs: Vec<String> = self
                    .fields
                    .iter()
                    .zip(&parity.fields)
                    .map(|(name, odd)| {
                        if *odd {
                            format!("-{name}")
                        } else {
                            name.clone()
                        }
                    })
                    .collect();
                let (before, after) = (self.fields.join(", "), signs.join(", "));
                format!(
                    "Symmetry: {0} → -{0} with ({before}) → ({after})\n",
                    model.periodic
                )
            }
        }
    }

    fn adjoint(&self) -> String {
        let operators = &self.derivation.operators;
        let mut text = String::from("Adjoint mass matrix M0† [field, balance's adjoint]\n");
        self.entries(
            &mut text,
            &operators.adjoint,
            &self.fields,
            &self.adjoint_fields,
            true,
        );
        text += "Adjoint operator L† [field, balance's adjoint]\n";
        self.entries(
            &mut text,
            &operators.adjoint,
            &self.fields,
            &self.adjoint_fields,
            false,
        );
        text += "Adjoint boundary conditions\n";
        for case in &operators.cases {
            text += &self.case_title(&case.choices);
            match &case.adjoint {
                Err(reason) => {
                    let _ = writeln!(text, "  {reason}");
                }
                Ok(conditions) => {
                    for condition in conditions {
                        let _ = writeln!(
                            text,
                            "  {}: {} = 0",
                            self.place(condition.end),
                            self.adjoint_condition(condition)
                        );
                    }
                }
            }
        }
        text
    }

    fn adjoint_condition(&self, condition: &AdjointCondition) -> String {
        let printer = self.printer(&self.adjoint_fields);
        let mut parts = Vec::new();
        // The highest derivative first, as it is solved for.
        for (jet, symbol) in condition.combination.iter().rev() {
            for (&(x, absx), &id) in symbol {
                let mark = printer.jet(Jet { x, absx, ..*jet }, "");
                parts.push(self.scaled(id, &mark));
            }
        }
        signed_sum(parts)
    }

    fn nonlinear(&self, degree: usize) -> String {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        let mut text = format!("N{degree}\n");
        for (row, form) in operators.nonlinear[degree - 2].iter().enumerate() {
            let _ = writeln!(text, "  {}: {}", model.balances[row].name, self.form(form));
        }
        text
    }

    fn jet(&self, jet: Jet) -> String {
        self.printer(&self.fields).jet(jet, "'")
    }

    /// coefficient · what, ones left out.
    fn scaled(&self, coefficient: Id, what: &str) -> String {
        let text = self.printer(&self.fields).factor(coefficient);
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
fn signed_sum(parts: Vec<String>) -> String {
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
