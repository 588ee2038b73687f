//! Which files of a report's folder the report wrote: a list of names and hashes in the file that marks the folder.
//!
//! Most files of a report have no place for a seal. A line is added before its file is written, so that a run that is
//! killed in between leaves no file without a line; a name then has several hashes, and each of them is the report's.

use super::files::hash_of;
use landau_solver::error::{Error, Result};
use landau_solver::file::part::{is_part, remove_abandoned};
use landau_solver::file::seal::is_sealed;
use landau_solver::file::{Overwrite, read_bounded, refused, write_whole};
use landau_solver::words::shown_path;
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;

/// The file by which a folder is known as one of a report.
pub const MARK: &str = landau_solver::file::part::REPORT_MARK;
const MARK_TEXT: &str =
    "landau reproduce writes its report here, and replaces files of an earlier one.\n";

/// Largest file that is hashed, in bytes.
const LIMIT: u64 = 4 << 30;
/// How the names of files begin that a report draws or computes, and how they end.
const DRAWN: &str = "figure";
const EXTENSIONS: [&str; 5] = ["svg", "csv", "json", "npz", "nc"];
/// Files that every report has, and the folder of what it was made from.
const FIXED: [&str; 3] = ["index.html", "numbers.json", "claims.json"];
const SOURCES: &str = "sources/";

/// Hashes by the name of a file, the latest last.
#[derive(Default)]
struct Ledger(BTreeMap<String, Vec<String>>);

impl Ledger {
    fn read(folder: &Path) -> Self {
        let text = read_bounded(&folder.join(MARK), LIMIT).unwrap_or_default();
        let mut ledger = Ledger::default();
        for line in String::from_utf8_lossy(&text).lines() {
            if let Some((hash, name)) = line.split_once("  ") {
                let hashes = ledger.0.entry(name.to_owned()).or_default();
                hashes.push(hash.to_owned());
            }
        }
        ledger
    }

    /// Whether the report wrote these bytes under this name.
    fn wrote(&self, name: &str, bytes: &[u8]) -> bool {
        let hashes = self.0.get(name);
        is_sealed(bytes) || hashes.is_some_and(|hashes| hashes.contains(&hash_of(bytes)))
    }
}

/// Marks a folder as one of a report.
///
/// # Errors
/// Permissions, a full disk.
pub fn mark(folder: &Path) -> Result<()> {
    let mark = folder.join(MARK);
    if mark.is_file() {
        return Ok(());
    }
    write_whole(&mark, MARK_TEXT.as_bytes())
}

/// Adds a file that is about to be written.
///
/// # Errors
/// Permissions, a full disk.
pub fn add(folder: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    let mark = folder.join(MARK);
    let line = format!("{}  {name}\n", hash_of(bytes));
    let opened = OpenOptions::new().append(true).open(&mark);
    opened
        .and_then(|mut file| file.write_all(line.as_bytes()))
        .map_err(|e| Error::input(format!("{} cannot be written: {e}", shown_path(&mark))))
}

/// Keeps the latest line of every file: nothing is on its way any more.
///
/// # Errors
/// Permissions, a full disk.
pub fn settle(folder: &Path) -> Result<()> {
    let ledger = Ledger::read(folder);
    let latest = |(name, hashes): (&String, &Vec<String>)| {
        let hash = hashes.last().map_or("", String::as_str);
        format!("{hash}  {name}\n")
    };
    let lines: String = ledger.0.iter().map(latest).collect();
    write_whole(&folder.join(MARK), format!("{MARK_TEXT}{lines}").as_bytes())
}

/// Refuses a folder in which a file has the name of a report's, and the report did not write it or it was changed since.
///
/// # Errors
/// Such a file, unless `overwrite` allows it.
pub fn check(folder: &Path, overwrite: Overwrite) -> Result<()> {
    if overwrite == Overwrite::Anything {
        return Ok(());
    }
    let ledger = Ledger::read(folder);
    for name in names(folder) {
        let path = folder.join(&name);
        let is_file = fs::symlink_metadata(&path).is_ok_and(|info| info.is_file());
        // A file on its way is nobody's: the run that writes it goes on, or was killed.
        if !is_file || !is_of_a_report(&name) || is_part(&path) {
            continue;
        }
        if !ledger.wrote(&name, &read_bounded(&path, LIMIT)?) {
            return Err(refused(
                &path,
                "this report did not write it, or it was changed since",
            ));
        }
    }
    Ok(())
}

/// Removes what killed runs left half written in a folder of a report and below.
pub fn clean(folder: &Path) {
    contents(folder)
        .1
        .iter()
        .for_each(|below| remove_abandoned(&folder.join(below)));
}

/// Names in a folder of a report, and in its folder of sources one and two levels below, in order.
fn names(folder: &Path) -> Vec<String> {
    contents(folder).0
}

/// Names of the files in a folder of a report and in its folders of sources, in order, and those of these folders.
fn contents(folder: &Path) -> (Vec<String>, Vec<String>) {
    let (mut names, mut searched) = (Vec::new(), Vec::new());
    let mut folders = vec![String::new()];
    while let Some(below) = folders.pop() {
        for entry in fs::read_dir(folder.join(&below)).into_iter().flatten() {
            let Ok(entry) = entry else { continue };
            let name = format!("{below}{}", entry.file_name().to_string_lossy());
            let is_folder = entry.file_type().is_ok_and(|kind| kind.is_dir());
            if is_folder && format!("{name}/").starts_with(SOURCES) {
                folders.push(format!("{name}/"));
            } else {
                names.push(name);
            }
        }
        searched.push(below);
    }
    names.sort();
    (names, searched)
}

/// Whether a report may give a file this name.
pub fn is_of_a_report(name: &str) -> bool {
    let extension = Path::new(name).extension().and_then(|e| e.to_str());
    let is_drawn = name.starts_with(DRAWN) && extension.is_some_and(|e| EXTENSIONS.contains(&e));
    FIXED.contains(&name) || is_drawn || name.starts_with(SOURCES)
}

#[cfg(test)]
mod tests {
    use super::{MARK, MARK_TEXT, add, check, mark, settle};
    use landau_solver::file::Overwrite::{Anything, Recognised};
    use std::fs;

    /// A file is the report's with the hash of any of its lines; the latest line stays.
    #[test]
    fn files_of_a_report_are_told_from_others() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = folder.path();
        let write = |name: &str, text: &str| fs::write(at.join(name), text).expect("written");
        mark(at).expect("marked");
        add(at, "index.html", b"one").expect("added");
        write("index.html", "one");
        write("notes.txt", "mine");
        check(at, Recognised).expect("as it was written");
        // Killed between the line and the file, and after the file.
        add(at, "index.html", b"two").expect("added");
        check(at, Recognised).expect("still the earlier one");
        write("index.html", "two");
        check(at, Recognised).expect("the later one");
        settle(at).expect("settled");
        // The 64-bit FNV-1a of `two`, by hand.
        let hash = b"two".iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3)
        });
        let expected = format!("{MARK_TEXT}{hash:016x}  index.html\n");
        assert_eq!(fs::read_to_string(at.join(MARK)).expect("read"), expected);
        for (name, text) in [
            ("index.html", "one"),
            ("figure1-1.svg", "mine"),
            ("numbers.json", "[]"),
        ] {
            let earlier = fs::read(at.join(name)).ok();
            write(name, text);
            let message = check(at, Recognised).expect_err(name).to_string();
            assert!(message.contains(name), "{message}");
            assert!(message.contains("give --force"), "{message}");
            check(at, Anything).expect("allowed");
            match earlier {
                Some(bytes) => fs::write(at.join(name), bytes).expect("written"),
                None => fs::remove_file(at.join(name)).expect("removed"),
            }
        }
        fs::create_dir_all(at.join("sources/errata")).expect("made");
        write("sources/errata/a.toml", "mine");
        assert!(check(at, Recognised).is_err());
    }
}
