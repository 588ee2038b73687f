//! The commit that the program is built from, where git knows it.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=../../.git/HEAD");
    println!("cargo::rerun-if-changed=../../.git/logs/HEAD");
    let asked = Command::new("git")
        .args(["rev-parse", "--short=12", "HEAD"])
        .output();
    if let Ok(answer) = asked
        && answer.status.success()
        && let Ok(commit) = String::from_utf8(answer.stdout)
    {
        println!("cargo::rustc-env=LANDAU_COMMIT={}", commit.trim());
    }
}
