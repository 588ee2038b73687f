//! A formula in LaTeX, without packages beyond amsmath.

use super::{Binding, Formula, Mark, signed_sum};
use crate::graph::Rational;
use landau_contract::{greek, names_a_letter, small_greek};
use num_traits::Signed;

/// Words as LaTeX sets them inside a formula; what is no Latin letter is set between them.
pub fn latex_words(text: &str) -> String {
    let mut set = String::new();
    let mut words = String::new();
    let end = |words: &mut String, set: &mut String| {
        if !words.is_empty() {
            *set += &format!("\\text{{{words}}}");
            words.clear();
        }
    };
    for letter in text.chars() {
        let command = match letter {
            '→' => Some("\\to".to_owned()),
            '†' => Some("{}^{\\dagger}".to_owned()),
            '_' => {
                words.push(' ');
                continue;
            }
            letter => greek_command(letter),
        };
        match command {
            Some(command) => {
                end(&mut words, &mut set);
                set += &command;
            }
            None => words.push(letter),
        }
    }
    end(&mut words, &mut set);
    set
}

/// n^{0}_{y} v^{\prime} + \tfrac{1}{2} \sqrt{T^{0}}
pub fn latex(formula: &Formula) -> String {
    match formula {
        Formula::Number(value) => number(value),
        Formula::Letter(name) => letter(name),
        Formula::Symbol { name, mark, below } => symbol(name, *mark, "", below),
        Formula::Partial(coordinate, power) => {
            format!(
                "\\partial_{{{}}}{}",
                letter(coordinate),
                superscript(*power)
            )
        }
        Formula::Modulus(coordinate, power) => {
            let below = letter(coordinate);
            format!("|\\partial_{{{below}}}|{}", superscript(*power))
        }
        Formula::Of(operator, what) => latex(operator) + &at(what, Binding::Atom),
        Formula::Negative(inside) => format!("-{}", at(inside, Binding::Product)),
        Formula::Sum(_) => signed_sum(formula, at),
        Formula::Product(factors) => product(factors),
        // The bar of a fraction is bracket enough.
        Formula::Fraction(above, below) => {
            format!("\\frac{{{}}}{{{}}}", latex(above), latex(below))
        }
        Formula::Power(base, exponent) => power(base, exponent),
        Formula::Root(inside) => format!("\\sqrt{{{}}}", latex(inside)),
        Formula::Call(function, argument) => call(function, argument),
        Formula::Choice(switch, branches) => {
            let branches: Vec<String> = branches.iter().map(latex).collect();
            let (branches, switch) = (branches.join(",\\; "), letter(switch));
            format!("\\left\\{{{branches}\\right\\}}_{{{switch}}}")
        }
        Formula::Integral(integrand, variable) => {
            let (integrand, variable) = (latex(integrand), letter(variable));
            format!("\\int {integrand}\\,\\mathrm{{d}}{variable}")
        }
        Formula::Lines(lines) => aligned(lines),
        Formula::Equation(left, right) => format!("{} = {}", latex(left), latex(right)),
    }
}

/// In brackets where it holds less tightly than its surroundings.
fn at(formula: &Formula, context: Binding) -> String {
    let text = latex(formula);
    if formula.binding() < context {
        bracketed(&text)
    } else {
        text
    }
}

/// Round brackets; square ones around round ones and around operators.
fn bracketed(inside: &str) -> String {
    if inside.contains("\\left(") || inside.contains("\\partial") {
        format!("\\left[{inside}\\right]")
    } else {
        format!("\\left({inside}\\right)")
    }
}

/// Factors side by side, with a space where names of several letters would run together.
fn product(factors: &[Formula]) -> String {
    let mut text = String::new();
    for (index, factor) in factors.iter().enumerate() {
        let long = |f: &Formula| matches!(f, Formula::Letter(name) | Formula::Symbol { name, .. } if is_word(name));
        if index > 0 {
            text += if long(factor) || long(&factors[index - 1]) {
                "\\, "
            } else {
                " "
            };
        }
        text += &at(factor, Binding::Product);
    }
    text
}

/// Whether a name is set upright, as a word.
fn is_word(name: &str) -> bool {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    stem.chars().count() > 1 && !names_a_letter(stem)
}

/// A sum that goes on from line to line, its signs below one another.
fn aligned(lines: &[Formula]) -> String {
    let mut text = String::from("\\begin{aligned}");
    for (index, line) in lines.iter().enumerate() {
        let line = latex(line);
        let line = match line.strip_prefix('-') {
            Some(size) => format!("-\\,{size}"),
            None if index > 0 => format!("+\\,{line}"),
            None => line,
        };
        let end = if index > 0 { " \\\\ " } else { " " };
        text += &format!("{end}& {line}");
    }
    text + " \\end{aligned}"
}

/// A name with its mark and an exponent above it, and subscripts below it.
fn symbol(name: &str, mark: Mark, exponent: &str, below: &[String]) -> String {
    let (name, dagger) = match name.strip_suffix('†') {
        Some(name) => (name, "\\dagger"),
        None => (name, ""),
    };
    let mark = match mark {
        Mark::None => "",
        Mark::Base => "0",
        Mark::Prime => "\\prime",
    };
    let mut text = letter(name);
    let above = format!("{mark}{dagger}{exponent}");
    if !above.is_empty() {
        text += &format!("^{{{above}}}");
    }
    if !below.is_empty() {
        let below: Vec<String> = below.iter().map(|s| letter(s)).collect();
        text += &format!("_{{{}}}", below.join(" "));
    }
    text
}

fn superscript(power: u8) -> String {
    match power {
        1 => String::new(),
        n => format!("^{{{n}}}"),
    }
}

/// A name as a letter: Greek, one letter, or upright; digits at its end below it.
fn letter(name: &str) -> String {
    let (stem, digits) = name.split_at(name.trim_end_matches(|c: char| c.is_ascii_digit()).len());
    let mut characters = stem.chars();
    let stem = if names_a_letter(stem) {
        format!("\\{stem}")
    } else if let (Some(only), None) = (characters.next(), characters.next()) {
        greek_command(only).unwrap_or_else(|| stem.to_owned())
    } else {
        format!("\\mathrm{{{}}}", stem.replace('_', "\\_"))
    };
    match digits {
        "" => stem,
        digits => format!("{stem}_{{{digits}}}"),
    }
}

/// The command of a Greek letter that is no Latin one.
fn greek_command(letter: char) -> Option<String> {
    const CURLY: [(char, &str); 4] = [
        ('ε', "varepsilon"),
        ('φ', "varphi"),
        ('ϑ', "vartheta"),
        ('ς', "varsigma"),
    ];
    let name = match CURLY.iter().find(|(curly, _)| *curly == letter) {
        Some((_, name)) => *name,
        None => greek(letter)?,
    };
    match small_greek(letter) {
        Some(_) => Some(format!("\\{name}")),
        // Capitals that look like Latin ones have no command.
        None if "ΓΔΘΛΞΠΣΥΦΨΩ".contains(letter) => {
            let (initial, ending) = name.split_at(1);
            Some(format!("\\{}{ending}", initial.to_uppercase()))
        }
        None => None,
    }
}

fn number(value: &Rational) -> String {
    if value.is_integer() {
        value.to_string()
    } else {
        format!("\\tfrac{{{}}}{{{}}}", value.numer(), value.denom())
    }
}

fn power(base: &Formula, exponent: &Rational) -> String {
    let sign = if exponent.is_negative() { "-" } else { "" };
    let exponent = format!("{sign}{}", number(&exponent.abs()));
    match base {
        // n'²
        Formula::Symbol {
            name,
            mark: Mark::Prime,
            below,
        } if below.is_empty() => symbol(name, Mark::Prime, &format!(" {exponent}"), &[]),
        // A symbol that has a superscript already.
        Formula::Symbol { name, mark, .. } if *mark != Mark::None || name.ends_with('†') => {
            format!("{}^{{{exponent}}}", bracketed(&latex(base)))
        }
        _ => format!("{}^{{{exponent}}}", at(base, Binding::Atom)),
    }
}

fn call(function: &str, argument: &Formula) -> String {
    let name = match function {
        "exp" | "log" | "sin" | "cos" | "tan" | "sinh" | "cosh" | "tanh" => format!("\\{function}"),
        "atan" => "\\arctan".to_owned(),
        operator => match operator.strip_prefix('∂') {
            Some(coordinate) => format!("\\partial_{{{}}}", letter(coordinate)),
            None => format!("\\mathrm{{{operator}}}"),
        },
    };
    format!("{name}{}", bracketed(&latex(argument)))
}

#[cfg(test)]
mod tests {
    use super::{latex_words, letter};

    #[test]
    fn letters() {
        let written = ["phi", "φ", "ϕ2", "Γ", "Α", "theta_w", "eta1"].map(letter);
        let expected = [
            "\\phi",
            "\\varphi",
            "\\phi_{2}",
            "\\Gamma",
            "Α",
            "\\mathrm{theta\\_w}",
            "\\eta_{1}",
        ];
        assert_eq!(written, expected);
    }

    #[test]
    fn words() {
        assert_eq!(latex_words("order_of"), "\\text{order of}");
        assert_eq!(
            latex_words("L†: ξ → y"),
            "\\text{L}{}^{\\dagger}\\text{: }\\xi\\text{ }\\to\\text{ y}"
        );
    }
}
