//! Values of options, and the words of the command line that hold them.

use landau_solver::model::C64;
use landau_solver::study::amplitudes::ModeChoice;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The words of a command line, a negative number with an exponent joined to its option: `--from=-1e-9`. The parser takes
/// `-1e-9` alone for an option.
pub fn joined_numbers(words: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut joined: Vec<OsString> = Vec::new();
    for word in words {
        let text = word.to_str().unwrap_or_default();
        let is_number = text.starts_with('-') && text.parse::<f64>().is_ok();
        let is_option = |word: &OsString| {
            let text = word.to_str().unwrap_or_default();
            text.len() > 2 && text.starts_with("--") && !text.contains('=')
        };
        match joined.last_mut() {
            Some(option) if is_number && is_option(option) => {
                option.push("=");
                option.push(&word);
            }
            _ => joined.push(word),
        }
    }
    joined
}

/// The name of a file with more at its end.
pub fn beside(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    PathBuf::from(name)
}

/// An eigenvalue, `RE[:IM]`; a comma is accepted in the place of the colon.
pub fn near(text: &str) -> Result<C64, String> {
    let number = |part: &str| {
        let value = part.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        value.ok_or_else(|| format!("`{part}` is not a number; near accepts RE or RE:IM"))
    };
    match text.split_once([':', ',']) {
        Some((re, im)) => Ok(C64::new(number(re)?, number(im)?)),
        None => Ok(C64::new(number(text)?, 0.0)),
    }
}

/// `k=K[,near=RE[:IM]]`
pub fn mode(text: &str) -> Result<ModeChoice, String> {
    let wrong =
        |part: &str| format!("`{part}` is no part of a mode; --mode accepts k=K[,near=RE[:IM]]");
    let twice =
        |key: &str| format!("`{text}` names {key} twice; --mode accepts k=K[,near=RE[:IM]]");
    let (mut k, mut target) = (None, None);
    let mut parts = text.split(',').peekable();
    while let Some(part) = parts.next() {
        match part.trim().split_once('=') {
            Some(("k", value)) => {
                let value = value.trim().parse::<f64>().ok().filter(|v| v.is_finite());
                let value = value.ok_or_else(|| wrong(part))?;
                if k.replace(value).is_some() {
                    return Err(twice("k"));
                }
            }
            Some(("near", re)) => {
                // The comma of RE,IM separates parts of a mode too: a part without a name is IM.
                let im = parts.next_if(|next| !next.contains('='));
                let value = im.map_or(re.to_owned(), |im| format!("{re},{im}"));
                if target.replace(near(&value)?).is_some() {
                    return Err(twice("near"));
                }
            }
            _ => return Err(wrong(part)),
        }
    }
    let k =
        k.ok_or_else(|| format!("`{text}` has no wavenumber; --mode accepts k=K[,near=RE[:IM]]"))?;
    Ok(ModeChoice { k, near: target })
}

/// `NAME=A:B` or `NAME=A:B:N`
pub fn range(option: &str, text: &str, parts: usize) -> Result<(String, Vec<f64>), String> {
    let expected = if parts == 3 {
        "NAME=FROM:TO:COUNT"
    } else {
        "k=A:B"
    };
    let wrong = || format!("{option} {text}: {option} accepts {expected}");
    let (name, numbers) = text.split_once('=').ok_or_else(wrong)?;
    let numbers: Vec<f64> = numbers
        .split(':')
        .map(|n| n.trim().parse::<f64>())
        .collect::<Result<_, _>>()
        .map_err(|_| wrong())?;
    if numbers.len() != parts || numbers.iter().any(|n| !n.is_finite()) {
        return Err(wrong());
    }
    Ok((name.trim().to_owned(), numbers))
}

#[cfg(test)]
mod tests {
    use super::{joined_numbers, mode, near};
    use landau_solver::model::C64;

    /// A negative number with an exponent belongs to the option before it; other words stay as they are.
    #[test]
    fn negative_numbers_with_an_exponent() {
        let line =
            "critical m --from -1e-9 --to -2 --k=1 -1e5 --json -M -3e1 -- -1e-9 --vary r-1e-9";
        let words = joined_numbers(line.split(' ').map(Into::into));
        let words: Vec<&str> = words.iter().filter_map(|word| word.to_str()).collect();
        assert_eq!(
            words.join(" "),
            "critical m --from=-1e-9 --to=-2 --k=1 -1e5 --json -M -3e1 -- -1e-9 --vary r-1e-9"
        );
    }

    /// Both spellings of an eigenvalue, in both places.
    #[test]
    fn an_eigenvalue_has_two_spellings() {
        let expected = C64::new(-0.5, 2.0);
        for text in ["-0.5:2", "-0.5,2", " -0.5 : 2 "] {
            assert_eq!(near(text), Ok(expected), "{text}");
            for order in [format!("k=3,near={text}"), format!("near={text},k=3")] {
                let choice = mode(&order).expect("a mode");
                assert_eq!((choice.k, choice.near), (3.0, Some(expected)), "{order}");
            }
        }
        assert_eq!(near("0.1"), Ok(C64::new(0.1, 0.0)));
        let refused = "`x` is not a number; near accepts RE or RE:IM";
        for text in ["x", "1:x", "1,x"] {
            assert_eq!(near(text), Err(refused.to_owned()), "{text}");
        }
        for (text, words) in [
            ("k=1,k=2", "`k=1,k=2` names k twice"),
            ("k=1,near=1,near=2", "names near twice"),
            ("near=1", "has no wavenumber"),
            ("k=1,2", "`2` is no part of a mode"),
        ] {
            let message = mode(text).map(|_| ()).expect_err(text);
            assert!(message.contains(words), "{message}");
        }
    }
}
