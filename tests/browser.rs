//! A report in a browser.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Values of `name="…"` in a page.
pub fn attributes<'p>(page: &'p str, name: &str) -> Vec<&'p str> {
    let start = format!(" {name}=\"");
    let pieces = page.split(&start).skip(1);
    pieces.filter_map(|piece| piece.split('"').next()).collect()
}

/// A page in a browser, where there is one, 400 and 1400 pixels wide, light and dark: every picture loads and says
/// what is seen, nothing scrolls sideways, no label is printed on another, words stand out from the paper.
pub fn browse(out: &Path, pictures: usize) {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let works = |name: &&&str| Command::new(name).arg("--version").output().is_ok();
    let Some(browser) = names.iter().find(works) else {
        eprintln!("SKIPPED: the report was not opened in a browser, for there is no chromium");
        return;
    };
    let copy = out.join("look.html");
    fs::copy(
        crate::support::root().join("tests/browser/look.html"),
        &copy,
    )
    .expect("copied");
    let address = format!("file://{}", copy.display());
    let profile = format!("--user-data-dir={}", out.join("browser").display());
    for dark in [false, true] {
        let mode = if dark {
            "--blink-settings=preferredColorScheme=0"
        } else {
            "--blink-settings=preferredColorScheme=1"
        };
        let output = Command::new(browser)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                &profile,
                mode,
            ])
            .args([
                "--allow-file-access-from-files",
                "--virtual-time-budget=30000",
            ])
            .args(["--dump-dom", &address])
            .output()
            .expect("the browser runs");
        let dom = String::from_utf8_lossy(&output.stdout);
        let seen = attributes(&dom, "data-seen")
            .first()
            .map(|text| decoded(text));
        let seen: Value =
            serde_json::from_str(&seen.expect("the page is looked at")).expect("JSON");
        assert_eq!(seen["overprinted"], serde_json::json!([]), "{seen}");
        for width in ["400", "1400"] {
            let of = |what: &str| seen["widths"][width][what].as_f64().expect("a number");
            assert_eq!(of("loaded"), pictures as f64, "pictures that load: {seen}");
            assert_eq!(
                (of("sideways"), of("unsaid")),
                (0.0, 0.0),
                "{width}: {seen}"
            );
            assert!(of("contrast") >= 4.5, "{width}: {seen}");
            assert_eq!(seen["widths"][width]["dark"], dark, "{seen}");
        }
    }
}

/// A text in which what is no letter stands as %XX.
fn decoded(text: &str) -> String {
    let mut pieces = text.split('%');
    let mut bytes = pieces.next().unwrap_or_default().as_bytes().to_vec();
    for piece in pieces {
        bytes.push(u8::from_str_radix(&piece[..2], 16).expect("two digits"));
        bytes.extend(&piece.as_bytes()[2..]);
    }
    String::from_utf8(bytes).expect("UTF-8")
}
