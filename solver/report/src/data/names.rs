//! Names that every format takes: Latin letters, digits, underscores.

use landau_solver::model::greek;

/// `X13` for `X[1;3]`, `theta1y` for theta + 1 − y, `phi` for φ.
pub fn plain(name: &str) -> String {
    let mut text = String::new();
    for letter in name.chars() {
        match greek(letter) {
            Some(name) => text += name,
            None if letter.is_ascii_alphanumeric() || letter == '_' => text.push(letter),
            // Other alphabets; signs are left out.
            None if letter.is_alphabetic() => {
                let latin = deunicode::deunicode_char(letter).unwrap_or_default();
                text.extend(latin.chars().filter(char::is_ascii_alphanumeric));
            }
            None => {}
        }
    }
    text
}

/// Plain names of several things, all different: what comes again is numbered.
pub fn distinct<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for name in names {
        let plain = plain(name);
        let stem = if plain.is_empty() { "q" } else { &plain };
        let numbered = (2..).map(|n| format!("{stem}_{n}"));
        let mut candidates = std::iter::once(stem.to_owned()).chain(numbered);
        found.extend(candidates.find(|candidate| !found.contains(candidate)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{distinct, plain};

    #[test]
    fn names() {
        assert_eq!(
            ["X[1;3]", "theta + 1 - y", "φ", "Δρ_0", "ж"].map(plain),
            ["X13", "theta1y", "phi", "deltarho_0", "zh"]
        );
        let found = distinct(["a + b", "a - b", "ab", "+", "−", "θ", "ϑ"]);
        assert_eq!(
            found,
            ["ab", "ab_2", "ab_3", "q", "q_2", "theta", "theta_2"]
        );
    }
}
