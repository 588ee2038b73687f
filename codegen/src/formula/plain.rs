//! A formula on one line of text.

use super::{Binding, Formula, Mark, signed_sum};

/// n⁰_y v' + √T⁰/2
pub fn plain(formula: &Formula) -> String {
    match formula {
        Formula::Number(value) => value.to_string(),
        Formula::Letter(name) => name.clone(),
        Formula::Symbol { name, mark, below } => {
            let mark = match mark {
                Mark::None => "",
                Mark::Base => "⁰",
                Mark::Prime => "'",
            };
            match below.concat().as_str() {
                "" => format!("{name}{mark}"),
                below => format!("{name}{mark}_{below}"),
            }
        }
        Formula::Partial(coordinate, power) => match power {
            1 => format!("∂{coordinate}"),
            2 => format!("∂{coordinate}²"),
            3 => format!("∂{coordinate}³"),
            4 => format!("∂{coordinate}⁴"),
            n => format!("∂{coordinate}^{n}"),
        },
        Formula::Modulus(coordinate, power) => match power {
            1 => format!("|∂{coordinate}|"),
            n => format!("|∂{coordinate}|^{n}"),
        },
        Formula::Of(operator, what) => plain(operator) + &at(what, Binding::Atom),
        Formula::Negative(inside) => format!("-{}", at(inside, Binding::Product)),
        Formula::Sum(_) => signed_sum(formula, at),
        Formula::Product(factors) => product(factors),
        Formula::Fraction(above, below) => {
            format!(
                "{}/{}",
                at(above, Binding::Product),
                at(below, Binding::Power)
            )
        }
        Formula::Power(base, exponent) => {
            let base = at(base, Binding::Atom);
            if exponent.is_integer() {
                format!("{base}^{exponent}")
            } else {
                format!("{base}^({exponent})")
            }
        }
        Formula::Root(inside) => format!("√{}", at(inside, Binding::Atom)),
        Formula::Call(function, argument) => format!("{function}({})", plain(argument)),
        Formula::Choice(switch, branches) => {
            let branches: Vec<String> = branches.iter().map(plain).collect();
            format!("select({switch}; {})", branches.join(", "))
        }
        Formula::Integral(integrand, variable) => format!("∫ {} d{variable}", plain(integrand)),
        Formula::Lines(lines) => signed_sum(&Formula::Sum(lines.clone()), at),
        Formula::Equation(left, right) => format!("{} = {}", plain(left), plain(right)),
    }
}

/// In brackets where it holds less tightly than its surroundings.
fn at(formula: &Formula, context: Binding) -> String {
    let text = plain(formula);
    if formula.binding() < context {
        format!("({text})")
    } else {
        text
    }
}

fn product(factors: &[Formula]) -> String {
    let factors: Vec<String> = factors.iter().map(|f| at(f, Binding::Product)).collect();
    factors.join(" ")
}
