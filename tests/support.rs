//! What the families share: the command line, models, files.

use landau_solver::Model;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

pub struct Answer {
    pub status: i32,
    pub out: String,
    pub err: String,
}

/// Runs the command line.
pub fn landau(arguments: &[&str]) -> Answer {
    let output = Command::new(env!("CARGO_BIN_EXE_landau-under-test"))
        .args(arguments)
        .current_dir(root())
        .output()
        .expect("the binary under test runs");
    Answer {
        status: output.status.code().unwrap_or(-1),
        out: String::from_utf8_lossy(&output.stdout).into_owned(),
        err: String::from_utf8_lossy(&output.stderr).into_owned(),
    }
}

/// Runs a command given as one line, and reads its JSON object.
pub fn json(line: &str) -> Value {
    let arguments: Vec<&str> = line.split_whitespace().chain(["--json"]).collect();
    let answer = landau(&arguments);
    assert_eq!(answer.status, 0, "{line}: {}", answer.err);
    serde_json::from_str(&answer.out).unwrap_or_else(|e| panic!("{line}: {e} in {}", answer.out))
}

/// A number of a JSON object by path.
pub fn number(value: &Value, path: &str) -> f64 {
    value
        .pointer(path)
        .and_then(Value::as_f64)
        .unwrap_or_else(|| panic!("{path} in {value}"))
}

/// A file of a test's own, in a folder of its own below the target folder.
pub fn written(name: &str, text: &str) -> PathBuf {
    static COUNT: AtomicUsize = AtomicUsize::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("spec{number}"));
    // An earlier run of the tests may have left files that are another's.
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    let path = folder.join(name);
    std::fs::write(&path, text).expect("a file");
    path
}

/// The workspace.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// A built model.
pub fn built(name: &str) -> Arc<dyn Model> {
    let models = landau_spec::models();
    models
        .into_iter()
        .find(|m| m.structure().name == name)
        .expect("a built model")
}

/// The same model from its tape.
pub fn tape(name: &str) -> Arc<dyn Model> {
    let path = root().join(format!("spec/models/{name}.model"));
    let sources = landau_codegen::build::read_sources(&path).expect("the spec can be read");
    Arc::new(landau_codegen::tape(&sources).expect("the spec is well formed"))
}

/// |a − b| ≤ tolerance, with a message.
pub fn close(what: &str, found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: {found} instead of {expected}, {:.2e} apart where {tolerance:.0e} is allowed",
        (found - expected).abs()
    );
}
