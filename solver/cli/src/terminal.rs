//! Standard output, where answers go, and standard error, where all other words go.

use landau_solver::error::{Error, Result};
use std::fmt::Arguments;
use std::io::{self, ErrorKind, Write};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The first failure to write an answer.
static FAILURE: Mutex<Option<io::Error>> = Mutex::new(None);

/// Whether the program was started without a standard output, as by `>&-`.
static CLOSED: AtomicBool = AtomicBool::new(false);

/// Looks at standard output before the standard library's start-up, which opens /dev/null in the place of a closed
/// stream: afterwards every answer would seem to be written.
#[cfg(any(target_os = "linux", target_os = "macos"))]
#[used]
#[cfg_attr(target_os = "linux", unsafe(link_section = ".init_array"))]
#[cfg_attr(target_os = "macos", unsafe(link_section = "__DATA,__mod_init_func"))]
static LOOK: extern "C" fn() = {
    extern "C" fn look() {
        // SAFETY: the call reads the flags of a descriptor, and fails where there is none.
        let flags = unsafe { libc::fcntl(libc::STDOUT_FILENO, libc::F_GETFD) };
        CLOSED.store(flags == -1, Ordering::Relaxed);
    }
    look
};

/// Prints a line of an answer. A failure is reported by [`finish`].
macro_rules! say {
    ($($argument:tt)*) => {
        $crate::terminal::answer(format_args!($($argument)*))
    };
}

/// Prints a line on standard error. A failure costs the line alone.
macro_rules! note {
    ($($argument:tt)*) => {
        $crate::terminal::remark(format_args!($($argument)*))
    };
}

/// Prints a line of an answer.
pub fn answer(line: Arguments) {
    let line = visible(&format!("{line}\n"));
    remember(io::stdout().lock().write_all(line.as_bytes()));
}

/// Prints a line on standard error.
pub fn remark(line: Arguments) {
    let line = visible(&format!("{line}\n"));
    let _ = io::stderr().lock().write_all(line.as_bytes());
}

/// Keeps the first failure to write an answer, to be reported at the end.
pub fn remember(written: io::Result<()>) {
    let Err(error) = written else { return };
    if let Ok(mut failure) = FAILURE.lock() {
        failure.get_or_insert(error);
    }
}

/// Reports whether every answer reached standard output. A reader that has gone away, as `head` does, wanted no more.
///
/// # Errors
/// Standard output could not be written.
pub fn finish() -> Result<()> {
    remember(io::stdout().lock().flush());
    if CLOSED.load(Ordering::Relaxed) {
        return Err(Error::input(
            "the answer could not be written to standard output: it is closed",
        ));
    }
    let failure = FAILURE.lock().ok().and_then(|mut failure| failure.take());
    match failure {
        Some(error) if error.kind() != ErrorKind::BrokenPipe => Err(Error::input(format!(
            "the answer could not be written to standard output: {error}"
        ))),
        _ => Ok(()),
    }
}

/// Text from a file may hold characters that command a terminal, or that turn its order around: they are printed as
/// `\u001b`, which JSON reads as the character itself. Line ends and tabs stay.
fn visible(text: &str) -> String {
    let mut visible = String::with_capacity(text.len());
    for character in text.chars() {
        let turns = matches!(character, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
        if turns || (character.is_control() && character != '\n' && character != '\t') {
            visible += &format!("\\u{:04x}", u32::from(character));
        } else {
            visible.push(character);
        }
    }
    visible
}

#[cfg(test)]
mod tests {
    use super::visible;

    #[test]
    fn no_character_commands_the_terminal() {
        let text = "\u{1b}[2J a\tb\n\u{7f}\u{9b}31m \u{202e}c\r";
        assert_eq!(
            visible(text),
            "\\u001b[2J a\tb\n\\u007f\\u009b31m \\u202ec\\u000d"
        );
        assert_eq!(
            visible("Rayleigh–Bénard, c₂ = ½\n"),
            "Rayleigh–Bénard, c₂ = ½\n"
        );
    }

    /// The escapes in a JSON text are the characters.
    #[test]
    fn escapes_are_json() {
        let title = "\u{9b}31m \u{202e} \u{7f}\u{1b}\n";
        let text = visible(&serde_json::json!(title).to_string());
        assert!(!text.chars().any(char::is_control));
        assert_eq!(
            serde_json::from_str::<String>(&text).ok().as_deref(),
            Some(title)
        );
    }
}
