//! The typeset operators say the same as the derivation: LaTeX is read back, by a reader of its own,
//! into the notation of printed formulas, and compared with the derivation term by term.

use crate::support::landau;
use std::fs;

/// A reader of the LaTeX that formulas are written in.
struct Reader<'a> {
    rest: &'a str,
    /// The field that an operator without its argument acts on.
    field: Option<&'a str>,
}

impl<'a> Reader<'a> {
    fn skip(&mut self) {
        loop {
            let before = self.rest;
            for filler in [
                " ",
                "\n",
                "&",
                "\\\\",
                "\\,",
                "\\begin{aligned}",
                "\\end{aligned}",
            ] {
                self.rest = self.rest.strip_prefix(filler).unwrap_or(self.rest);
            }
            if self.rest == before {
                return;
            }
        }
    }

    fn take(&mut self, token: &str) -> bool {
        self.skip();
        let after = self.rest.strip_prefix(token);
        self.rest = after.unwrap_or(self.rest);
        after.is_some()
    }

    /// What stands in the next pair of braces.
    fn braces(&mut self) -> &'a str {
        assert!(self.take("{"), "a brace at {}", self.rest);
        let mut depth = 1;
        let end = self.rest.find(|c| {
            depth += match c {
                '{' => 1,
                '}' => -1,
                _ => 0,
            };
            depth == 0
        });
        let (inside, after) = self.rest.split_at(end.expect("a closing brace"));
        self.rest = &after[1..];
        inside
    }

    fn sum(&mut self) -> String {
        let mut text = String::new();
        loop {
            let negative = match (self.take("+"), self.take("-")) {
                (true, minus) | (false, minus) => minus,
            };
            text += if negative { " - " } else { " + " };
            text += &self.product();
            self.skip();
            let ended = self.rest.is_empty() || self.rest.starts_with("\\right");
            if ended {
                return text;
            }
        }
    }

    /// Factors side by side; ∂ at the end, or the field itself, where operators act on a field.
    fn product(&mut self) -> String {
        let (mut factors, mut operators, mut applied) = (Vec::new(), Vec::new(), false);
        loop {
            self.skip();
            if self.rest.is_empty()
                || self.rest.starts_with(['+', '-'])
                || self.rest.starts_with("\\right")
            {
                break;
            }
            if self.take("\\partial_") {
                let coordinate = self.braces();
                let times = if self.take("^") { self.braces() } else { "1" };
                let times: usize = times.parse().expect("an order");
                operators.extend(vec![coordinate; times]);
            } else if self.take("\\left[") {
                factors.push(format!("({})", self.sum()));
                assert!(self.take("\\right]"), "a bracket at {}", self.rest);
                applied = true;
            } else {
                factors.push(self.factor());
            }
        }
        if let Some(field) = self.field.filter(|_| !applied) {
            let acted = operators
                .iter()
                .fold(field.to_owned(), |inner, q| format!("d{q}({inner})"));
            factors.push(acted);
        }
        factors.join("*")
    }

    fn factor(&mut self) -> String {
        if self.take("\\left(") {
            // What stands in round brackets is a coefficient.
            let field = self.field.take();
            let inside = self.sum();
            self.field = field;
            assert!(self.take("\\right)"), "a bracket at {}", self.rest);
            return format!("({inside}){}", self.power());
        }
        if self.take("\\frac") || self.take("\\tfrac") {
            let [above, below] = [self.braces(), self.braces()].map(|text| {
                let mut reader = Reader {
                    rest: text,
                    field: None,
                };
                reader.sum()
            });
            return format!("({above})/({below})");
        }
        self.skip();
        let digits = self.rest.len()
            - self
                .rest
                .trim_start_matches(|c: char| c.is_ascii_digit())
                .len();
        if digits > 0 {
            let (number, rest) = self.rest.split_at(digits);
            self.rest = rest;
            return number.to_owned();
        }
        self.symbol()
    }

    fn power(&mut self) -> String {
        match self.take("^") {
            true => format!("^({})", self.braces()),
            false => String::new(),
        }
    }

    fn symbol(&mut self) -> String {
        let mut name = if self.take("\\mathrm") {
            self.braces().replace("\\_", "_")
        } else {
            self.rest = self.rest.strip_prefix('\\').unwrap_or(self.rest);
            let start = self.rest;
            let length = start
                .find(|c: char| !c.is_ascii_alphabetic())
                .unwrap_or(start.len());
            assert!(length > 0, "a name at {start}");
            self.rest = &start[length..];
            start[..length].to_owned()
        };
        // Digits below a name are part of it.
        let digits = |rest: &str| {
            rest.trim_start().starts_with("_{")
                && rest.trim_start()[2..].starts_with(|c: char| c.is_ascii_digit())
        };
        if digits(self.rest) && self.take("_") {
            name += self.braces();
        }
        // ^{0} and primes mark what a symbol stands for; any other number is a power.
        let marked = ["^{0", "^{\\prime", "^{\\dagger"];
        let marked = marked.iter().any(|mark| self.rest.starts_with(mark));
        let mark = if marked && self.take("^") {
            self.braces()
        } else {
            ""
        };
        let below = if self.take("_") { self.braces() } else { "" };
        let below: Vec<&str> = below
            .split_whitespace()
            .map(|s| s.trim_start_matches('\\'))
            .collect();
        match mark.strip_prefix("\\prime") {
            Some(times) => {
                let jet = below.iter().fold(name, |inner, q| format!("d{q}({inner})"));
                match times.trim() {
                    "" => format!("{jet}{}", self.power()),
                    times => format!("{jet}^{times}"),
                }
            }
            None => {
                name += mark;
                if !below.is_empty() {
                    name += &format!("_{}", below.concat());
                }
                name + &self.power()
            }
        }
    }
}

fn read(latex: &str, field: Option<&str>) -> String {
    let mut reader = Reader { rest: latex, field };
    reader.sum()
}

/// Every formula of an operator of the model, as entries of a file of printed formulas.
fn entries(model: &str, operator: &str) -> String {
    let answer = landau(&[
        "explain",
        model,
        "--operator",
        operator,
        "--format",
        "latex",
    ]);
    assert_eq!(answer.status, 0, "{}", answer.err);
    let mut text = String::new();
    let mut matrix = String::new();
    for line in answer.out.lines() {
        let line = line.trim_start_matches("\\[ ").trim_end_matches(" \\]");
        if line.starts_with("\\text{") && !line.contains("\\quad") {
            matrix = line.to_owned();
        }
        let Some((label, formula)) = line.split_once("\\quad ") else {
            continue;
        };
        let name = |label: &str| {
            let inside = label.split('{').nth(1).and_then(|l| l.split('}').next());
            inside.unwrap_or_default().replace(' ', "_")
        };
        let (about, formula) = if let Some((row, column)) = label.split_once(",\\,") {
            let column = column.trim_end_matches(']').trim_start_matches('\\');
            let column = column.split('^').next().unwrap_or_default();
            let row = name(row);
            match matrix.as_str() {
                m if m.contains("Linear operator") => (
                    format!("linear = {{ balance = \"{row}\", field = \"{column}\" }}"),
                    read(formula, Some(column)),
                ),
                m if m.contains("Adjoint operator") => (
                    format!("adjoint = {{ row = \"{row}\", field = \"{column}\" }}"),
                    read(formula, Some(column)),
                ),
                _ => continue,
            }
        } else if formula.contains("\\int") {
            // A part of an integral condition, which is no row of N.
            continue;
        } else if let Some(degree) = operator.strip_prefix('N') {
            let row = name(label);
            (
                format!("nonlinear = {{ degree = {degree}, balance = \"{row}\" }}"),
                read(formula, None),
            )
        } else {
            continue;
        };
        text += &format!(
            "[[formula]]\nnumber = '{operator} {label}'\nabout = {{ {about} }}\nprinted = \"{formula}\"\n"
        );
    }
    text
}

#[test]
fn typeset_operators_agree_with_the_derivation() {
    for model in landau_spec::models() {
        let model = model.structure().name.as_str();
        let operators = ["L", "adjoint", "N2", "N3"].map(|operator| entries(model, operator));
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("typeset.toml");
        fs::write(
            &file,
            format!("source = \"typeset\"\n{}", operators.concat()),
        )
        .expect("written");
        let answer = landau(&[
            "explain",
            model,
            "--against",
            file.to_str().expect("a path"),
        ]);
        assert_eq!(answer.status, 0, "{model}: {}{}", answer.err, answer.out);
        // Every row of N2 and N3, and at least one entry of L and of L†.
        let (read, rows) = (
            answer.out.matches(": agrees").count(),
            operators[2..].concat(),
        );
        let least = rows.matches("[[formula]]").count() + 2;
        assert!(
            read >= least,
            "{model}: {read} formulas only\n{}",
            answer.out
        );
    }
}
