//! The derived operators as lines in the notation of the literature, as text or as LaTeX.

use crate::derive::{AdjointCondition, Case, CaseClosure, Derivation, Term};
use crate::form::Form;
use crate::formula::{self, Arrangement, Coefficient, Formula, Letters, Mark, latex_words, plain};
use crate::graph::{BalanceId, FieldId, Id, Jet, Table};
use crate::model::End;
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

/// The label before a formula.
#[derive(Clone, PartialEq)]
enum Label {
    None,
    Name(String),
    /// A place, which is a formula itself.
    Place(Formula),
    /// Row and column of a matrix.
    Entry(String, Formula),
}

#[derive(Clone, PartialEq)]
enum Line {
    Heading(String),
    /// The choices of the switches that the following lines hold for.
    Case(String),
    Words(String),
    Formula(Label, Formula),
}

/// One section as text.
pub fn print(derivation: &Derivation, section: Section) -> String {
    let lines = lines(&Writer::new(derivation, Arrangement::Flat), section);
    let text = lines.into_iter().map(|line| match line {
        Line::Heading(words) => format!("{words}\n"),
        Line::Case(words) => format!("  -- {words}\n"),
        Line::Words(words) => format!("  {words}\n"),
        Line::Formula(label, formula) => {
            let label = match label {
                Label::None => String::new(),
                Label::Name(name) => format!("{name}: "),
                Label::Place(place) => format!("at {}: ", plain(&place)),
                Label::Entry(row, column) => format!("[{row}, {}] ", plain(&column)),
            };
            format!("  {label}{}\n", plain(&formula))
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

/// One section as LaTeX.
pub fn latex(derivation: &Derivation, section: Section) -> Vec<Typeset> {
    let (words, latex) = (latex_words, formula::latex);
    let lines = lines(&Writer::new(derivation, Arrangement::Grouped), section);
    let rows = lines.into_iter().map(|line| match line {
        Line::Heading(text) => Typeset::Heading(text),
        Line::Case(text) | Line::Words(text) => Typeset::Words(text),
        Line::Formula(label, formula) => Typeset::Formula(match label {
            Label::None => latex(&formula),
            Label::Name(name) => format!("{}\\quad {}", words(&name), latex(&formula)),
            Label::Place(place) => {
                format!("{}{}\\quad {}", latex(&place), words(":"), latex(&formula))
            }
            Label::Entry(row, column) => {
                format!(
                    "[{},\\,{}]\\quad {}",
                    words(&row),
                    latex(&column),
                    latex(&formula)
                )
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
    let form = &derivation.operators.nonlinear[degree - 2][row];
    plain(&Writer::new(derivation, Arrangement::Flat).form(form))
}

pub(super) struct Writer<'a> {
    derivation: &'a Derivation,
    letters: Letters,
    /// Adjoint fields by balance.
    adjoint_fields: Table<BalanceId, String>,
}

impl<'a> Writer<'a> {
    pub(super) fn new(derivation: &'a Derivation, arrangement: Arrangement) -> Self {
        let letters = derivation.model.letters(arrangement);
        let pairing = &derivation.operators.pairing;
        let adjoint_fields = pairing.map(|&field| format!("{}†", letters.fields[field]));
        Writer {
            derivation,
            letters,
            adjoint_fields,
        }
    }

    fn fields(&self) -> &Table<FieldId, String> {
        &self.letters.fields
    }

    fn formula(&self, id: Id) -> Formula {
        self.letters.formula(&self.derivation.graph, id)
    }

    /// coefficient · Π what
    fn scaled(&self, coefficient: Id, what: Vec<Formula>) -> Formula {
        self.letters
            .scaled(&self.derivation.graph, coefficient, what)
    }

    /// y = H, by the name of the end if it has one.
    fn place(&self, end: End) -> Formula {
        let model = &self.derivation.model;
        let Some(interval) = &model.interval else {
            return Formula::zero();
        };
        let place = if interval.named(end) {
            Formula::Letter(interval.written(end).to_owned())
        } else {
            self.formula(interval.end(end))
        };
        Formula::equation(Formula::Letter(interval.name.clone()), place)
    }

    /// formula = 0
    fn vanishes(&self, label: Label, formula: Formula) -> Line {
        Line::Formula(label, Formula::equation(formula, Formula::zero()))
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
        let mut blocks: BTreeMap<(Row, Column), Vec<Coefficient>> = BTreeMap::new();
        let mut sorted: Vec<&Term<Row, Column>> =
            terms.iter().filter(|t| (t.jet.t > 0) == time).collect();
        sorted.sort_by_key(|t| (t.jet.y, t.jet.x, t.jet.absx));
        for term in sorted {
            let operator = self.letters.operator(term.jet);
            let block = blocks.entry((term.row, term.jet.of)).or_default();
            block.push((term.coefficient, operator));
        }
        for ((row, column), parts) in blocks {
            let column = symbol(&columns[column], Mark::None);
            let label = Label::Entry(rows[row].clone(), column);
            let formula = match self.letters.arrangement {
                Arrangement::Flat => Formula::sum(
                    parts
                        .into_iter()
                        .map(|(id, operator)| self.scaled(id, operator)),
                ),
                Arrangement::Grouped => {
                    let graph = &self.derivation.graph;
                    formula::over_common_denominator(graph, &self.letters, &parts)
                }
            };
            lines.push(Line::Formula(label, formula));
        }
    }

    fn base(&self) -> Vec<Line> {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        let mut lines = vec![Line::Heading("Base state".into())];
        for (field, closed) in model.base.closed.pairs() {
            if let Some(id) = closed {
                let name = symbol(&self.fields()[field], Mark::Base);
                let formula = Formula::equation(name, self.formula(*id));
                lines.push(Line::Formula(Label::None, formula));
            }
        }
        for row in &operators.base {
            let name = Label::Name(model.balances[row.balance].name.clone());
            lines.push(self.vanishes(name, self.formula(row.residual)));
        }
        for (integrand, value) in &operators.base_integrals {
            let integral = integral(self.formula(*integrand), model.coordinate());
            let formula = Formula::equation(integral, self.formula(*value));
            lines.push(Line::Formula(Label::None, formula));
        }
        lines.extend(self.by_case(|case| {
            let conditions = case.base_conditions.iter().map(|condition| {
                let place = Label::Place(self.place(condition.end));
                self.vanishes(place, self.formula(condition.residual))
            });
            conditions.collect()
        }));
        lines
    }

    /// Lines that depend on the switches. Grouped, what every choice has stands once.
    fn by_case(&self, of: impl Fn(&Case) -> Vec<Line>) -> Vec<Line> {
        let cases = &self.derivation.operators.cases;
        let mut lists: Vec<Vec<Line>> = cases.iter().map(of).collect();
        let mut lines = Vec::new();
        if self.letters.arrangement == Arrangement::Grouped && cases.len() > 1 {
            let shared = |line: &Line| lists[1..].iter().all(|list| list.contains(line));
            lines = lists[0]
                .iter()
                .filter(|line| shared(line))
                .cloned()
                .collect();
            for list in &mut lists {
                list.retain(|line| !lines.contains(line));
            }
        }
        for (case, list) in cases.iter().zip(lists) {
            let needless = list.is_empty() && self.letters.arrangement == Arrangement::Grouped;
            if !needless {
                lines.extend(self.case(&case.choices));
                lines.extend(list);
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
        lines.extend(self.by_case(|case| {
            let conditions = case.conditions.iter().map(|condition| {
                let place = Label::Place(self.place(condition.end));
                self.vanishes(place, self.form(&condition.form))
            });
            conditions.collect()
        }));
        lines.push(Line::Heading("Closure at k = 0".into()));
        lines.extend(self.by_case(|case| {
            let closures = case.closures.iter();
            closures.map(|closure| self.closure(closure)).collect()
        }));
        lines.push(Line::Heading(self.parity()));
        lines
    }

    fn closure(&self, closure: &CaseClosure) -> Line {
        let field = match closure {
            CaseClosure::Gauge { field, .. } | CaseClosure::Drift { field, .. } => {
                &self.fields()[*field]
            }
            CaseClosure::Conserved { density, .. }
            | CaseClosure::Claimed { density, .. }
            | CaseClosure::Unknown { density, .. } => {
                let terms = density.linear.iter();
                let terms = terms.map(|(jet, weight)| self.scaled(*weight, vec![self.jet(*jet)]));
                let integral = self.mean(Formula::sum(terms));
                return self.vanishes(self.closure_label(closure), integral);
            }
        };
        let drift = match closure {
            CaseClosure::Drift { .. } => ", which may drift",
            _ => "",
        };
        Line::Words(format!("gauge: the constant of {field}{drift}"))
    }

    fn closure_label(&self, closure: &CaseClosure) -> Label {
        Label::Name(match closure {
            CaseClosure::Conserved { .. } => "conserved".to_owned(),
            CaseClosure::Claimed { .. } => "conserved, as claimed".to_owned(),
            CaseClosure::Gauge { field, .. } | CaseClosure::Drift { field, .. } => {
                format!("gauge {}", self.fields()[*field])
            }
            CaseClosure::Unknown { field, .. } => format!("unknown {}", self.fields()[*field]),
        })
    }

    /// The integral of a closure; without a cross-stream coordinate over the periodic one.
    fn mean(&self, density: Formula) -> Formula {
        let model = &self.derivation.model;
        let variable = match model.interval {
            Some(_) => model.coordinate(),
            None => &model.periodic,
        };
        integral(density, variable)
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
        lines.extend(self.by_case(|case| match &case.adjoint {
            Err(reason) => vec![Line::Words(reason.clone())],
            Ok(conditions) => {
                let conditions = conditions.iter().map(|condition| {
                    let place = Label::Place(self.place(condition.end));
                    self.vanishes(place, self.adjoint_condition(condition))
                });
                conditions.collect()
            }
        }));
        lines
    }

    fn adjoint_condition(&self, condition: &AdjointCondition) -> Formula {
        let mut parts = Vec::new();
        // The highest derivative first, as it is solved for.
        for (jet, symbol) in condition.combination.iter().rev() {
            for (&(x, absx), &id) in symbol {
                let jet = Jet { x, absx, ..*jet };
                let field = self
                    .letters
                    .named_jet(&self.adjoint_fields[jet.of], jet, Mark::None);
                parts.push(self.scaled(id, vec![field]));
            }
        }
        Formula::sum(parts)
    }

    fn nonlinear(&self, degree: usize) -> Vec<Line> {
        let (model, operators) = (&self.derivation.model, &self.derivation.operators);
        let mut lines = vec![Line::Heading(format!("N{degree}"))];
        for (row, form) in operators.nonlinear[degree - 2].pairs() {
            let name = Label::Name(model.balances[row].name.clone());
            lines.push(Line::Formula(name, self.row(form, operators.divisors[row])));
        }
        let is_nonlinear = |closure: &CaseClosure| {
            let form = closure.density().map(|density| density.form.degree(degree));
            form.is_some_and(|form| !form.terms.is_empty())
        };
        let mut cases = operators.cases.iter().flat_map(|case| &case.closures);
        if cases.any(is_nonlinear) {
            lines.push(Line::Heading(format!(
                "N{degree} of the integral conditions"
            )));
            lines.extend(self.by_case(|case| {
                let closures = case.closures.iter().filter(|closure| is_nonlinear(closure));
                let lines = closures.filter_map(|closure| {
                    let form = self.form(&closure.density()?.form.degree(degree));
                    Some(Line::Formula(self.closure_label(closure), self.mean(form)))
                });
                lines.collect()
            }));
        }
        lines
    }

    /// A row of N.
    fn row(&self, form: &Form, divisor: Id) -> Formula {
        match self.letters.arrangement {
            Arrangement::Grouped if !form.terms.is_empty() => {
                let graph = &self.derivation.graph;
                Formula::Lines(formula::grouped(graph, &self.letters, form, divisor))
            }
            _ => self.form(form),
        }
    }

    fn jet(&self, jet: Jet) -> Formula {
        self.letters.jet(jet, Mark::Prime)
    }

    fn form(&self, form: &Form) -> Formula {
        let terms = form.terms.iter().map(|(monomial, &coefficient)| {
            let jets = monomial.iter().map(|&jet| self.jet(jet)).collect();
            self.scaled(coefficient, jets)
        });
        Formula::sum(terms)
    }
}

/// A name with a mark.
fn symbol(name: &str, mark: Mark) -> Formula {
    Formula::Symbol {
        name: name.to_owned(),
        mark,
        below: Vec::new(),
    }
}

/// ∫ integrand d(variable)
fn integral(integrand: Formula, variable: &str) -> Formula {
    Formula::Integral(Box::new(integrand), variable.to_owned())
}
