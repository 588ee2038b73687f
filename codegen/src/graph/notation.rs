//! Two ways of writing the same formulas: plain text on one line, and LaTeX.

use super::Rational;
use num_traits::Signed;

/// How the pieces of a formula are written.
pub trait Notation {
    /// Whether a formula is one line, so that a fraction needs brackets and grouping would hide more
    /// than it shows.
    fn is_flat(&self) -> bool;
    /// A sum that goes on from line to line.
    fn lines(&self, lines: &[String]) -> String;
    /// A name with a mark (`⁰`, `'` or none; a trailing † belongs to the name) and subscripts.
    fn symbol(&self, name: &str, mark: &str, subscripts: &[&str]) -> String;
    /// ∂ by a coordinate, to a power above 0.
    fn partial(&self, coordinate: &str, power: u8) -> String;
    /// |∂| by a coordinate, to a power above 0.
    fn absolute_partial(&self, coordinate: &str, power: u8) -> String;
    /// A bare name: a coordinate, π, a wavenumber.
    fn letter(&self, name: &str) -> String;
    /// A number that is not negative.
    fn number(&self, value: &Rational) -> String;
    /// above/below
    fn fraction(&self, above: &str, below: &[String]) -> String;
    /// base^exponent
    fn power(&self, base: &str, exponent: &Rational) -> String;
    /// √of
    fn root(&self, of: &str) -> String;
    /// function(argument)
    fn call(&self, function: &str, argument: &str) -> String;
    /// (inside)
    fn brackets(&self, inside: &str) -> String;
    /// The same in square brackets.
    fn square_brackets(&self, inside: &str) -> String;
    /// One of several, by a switch.
    fn choice(&self, switch: &str, branches: &[String]) -> String;
    /// ∫ integrand d(variable)
    fn integral(&self, integrand: &str, variable: &str) -> String;
}

/// One line of text.
pub struct Plain;

/// LaTeX without packages beyond amsmath.
pub struct Latex;

impl Notation for Plain {
    fn is_flat(&self) -> bool {
        true
    }

    fn lines(&self, lines: &[String]) -> String {
        lines.join(" + ").replace("+ -", "- ")
    }

    fn symbol(&self, name: &str, mark: &str, subscripts: &[&str]) -> String {
        match subscripts.concat().as_str() {
            "" => format!("{name}{mark}"),
            below => format!("{name}{mark}_{below}"),
        }
    }

    fn partial(&self, coordinate: &str, power: u8) -> String {
        match power {
            1 => format!("∂{coordinate}"),
            2 => format!("∂{coordinate}²"),
            3 => format!("∂{coordinate}³"),
            4 => format!("∂{coordinate}⁴"),
            n => format!("∂{coordinate}^{n}"),
        }
    }

    fn absolute_partial(&self, coordinate: &str, power: u8) -> String {
        match power {
            1 => format!("|∂{coordinate}|"),
            n => format!("|∂{coordinate}|^{n}"),
        }
    }

    fn letter(&self, name: &str) -> String {
        name.to_owned()
    }

    fn number(&self, value: &Rational) -> String {
        value.to_string()
    }

    fn fraction(&self, above: &str, below: &[String]) -> String {
        match below {
            [one] => format!("{above}/{one}"),
            _ => format!("{above}/({})", below.join(" ")),
        }
    }

    fn power(&self, base: &str, exponent: &Rational) -> String {
        if exponent.is_integer() {
            format!("{base}^{exponent}")
        } else {
            format!("{base}^({exponent})")
        }
    }

    fn root(&self, of: &str) -> String {
        format!("√{of}")
    }

    fn call(&self, function: &str, argument: &str) -> String {
        format!("{function}({argument})")
    }

    fn brackets(&self, inside: &str) -> String {
        format!("({inside})")
    }

    fn square_brackets(&self, inside: &str) -> String {
        format!("[{inside}]")
    }

    fn choice(&self, switch: &str, branches: &[String]) -> String {
        format!("select({switch}; {})", branches.join(", "))
    }

    fn integral(&self, integrand: &str, variable: &str) -> String {
        format!("∫ {integrand} d{variable}")
    }
}

/// Names that LaTeX has a letter for.
const GREEK: [&str; 23] = [
    "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa",
    "lambda", "mu", "nu", "xi", "pi", "rho", "sigma", "tau", "upsilon", "phi", "chi", "psi",
    "omega",
];

impl Notation for Latex {
    fn is_flat(&self) -> bool {
        false
    }

    fn lines(&self, lines: &[String]) -> String {
        let mut text = String::from("\\begin{aligned}");
        for (index, line) in lines.iter().enumerate() {
            let line = match line.strip_prefix('-') {
                Some(rest) => format!("-\\,{rest}"),
                None if index > 0 => format!("+\\,{line}"),
                None => line.clone(),
            };
            let end = if index > 0 { " \\\\ " } else { " " };
            text += &format!("{end}& {line}");
        }
        text + " \\end{aligned}"
    }

    fn symbol(&self, name: &str, mark: &str, subscripts: &[&str]) -> String {
        let (name, dagger) = match name.strip_suffix('†') {
            Some(name) => (name, "\\dagger"),
            None => (name, ""),
        };
        let mark = match mark {
            "⁰" => "0",
            "'" => "\\prime",
            _ => "",
        };
        let mut text = self.letter(name);
        let above = format!("{mark}{dagger}");
        if !above.is_empty() {
            text += &format!("^{{{above}}}");
        }
        if !subscripts.is_empty() {
            let below: Vec<String> = subscripts.iter().map(|s| self.letter(s)).collect();
            text += &format!("_{{{}}}", below.join(" "));
        }
        text
    }

    fn partial(&self, coordinate: &str, power: u8) -> String {
        let below = self.letter(coordinate);
        match power {
            1 => format!("\\partial_{{{below}}}"),
            n => format!("\\partial_{{{below}}}^{{{n}}}"),
        }
    }

    fn absolute_partial(&self, coordinate: &str, power: u8) -> String {
        let below = self.letter(coordinate);
        match power {
            1 => format!("|\\partial_{{{below}}}|"),
            n => format!("|\\partial_{{{below}}}|^{{{n}}}"),
        }
    }

    fn letter(&self, name: &str) -> String {
        let (stem, digits) =
            name.split_at(name.trim_end_matches(|c: char| c.is_ascii_digit()).len());
        let stem = if GREEK.contains(&stem) {
            format!("\\{stem}")
        } else if stem.chars().count() == 1 {
            stem.to_owned()
        } else {
            format!("\\mathrm{{{}}}", stem.replace('_', "\\_"))
        };
        match digits {
            "" => stem,
            digits => format!("{stem}_{{{digits}}}"),
        }
    }

    fn number(&self, value: &Rational) -> String {
        if value.is_integer() {
            value.to_string()
        } else {
            format!("\\tfrac{{{}}}{{{}}}", value.numer(), value.denom())
        }
    }

    fn fraction(&self, above: &str, below: &[String]) -> String {
        format!("\\frac{{{above}}}{{{}}}", below.join("\\,"))
    }

    fn power(&self, base: &str, exponent: &Rational) -> String {
        // n'²
        if let Some(name) = base.strip_suffix("^{\\prime}") {
            return format!("{name}^{{\\prime {}}}", self.number(exponent));
        }
        // A symbol that has a superscript already.
        let base = match base.contains('^') && !base.ends_with("\\right)") {
            true => self.brackets(base),
            false => base.to_owned(),
        };
        let sign = if exponent.is_negative() { "-" } else { "" };
        format!("{base}^{{{sign}{}}}", self.number(&exponent.abs()))
    }

    fn root(&self, of: &str) -> String {
        format!("\\sqrt{{{of}}}")
    }

    fn call(&self, function: &str, argument: &str) -> String {
        let name = match function {
            "exp" | "log" | "sin" | "cos" | "tan" | "sinh" | "cosh" | "tanh" => {
                format!("\\{function}")
            }
            "atan" => "\\arctan".to_owned(),
            other => format!("\\mathrm{{{other}}}"),
        };
        format!("{name}{}", self.brackets(argument))
    }

    fn brackets(&self, inside: &str) -> String {
        format!("\\left({inside}\\right)")
    }

    fn square_brackets(&self, inside: &str) -> String {
        format!("\\left[{inside}\\right]")
    }

    fn choice(&self, switch: &str, branches: &[String]) -> String {
        let switch = self.letter(switch);
        format!(
            "\\left\\{{{}\\right\\}}_{{{switch}}}",
            branches.join(",\\; ")
        )
    }

    fn integral(&self, integrand: &str, variable: &str) -> String {
        let variable = self.letter(variable);
        format!("\\int {integrand}\\,\\mathrm{{d}}{variable}")
    }
}
