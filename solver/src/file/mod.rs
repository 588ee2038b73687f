//! Files written whole or not at all, and never over what is somebody else's; files read with bounds.

pub mod part;
pub mod seal;

use crate::error::{Error, Result};
use crate::words::shown_path;
use std::fs::{self, File};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// Which files a command may replace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overwrite {
    /// Only those that Landau wrote for the same thing, and that nobody changed since.
    Recognised,
    /// Any file: the user says so, as with `--force`.
    Anything,
}

impl Overwrite {
    /// `--force` or not.
    pub fn forced(force: bool) -> Self {
        if force {
            Overwrite::Anything
        } else {
            Overwrite::Recognised
        }
    }
}

/// Largest file that is looked at for a seal, in bytes.
const SEALED_LIMIT: u64 = 4 << 30;
/// Largest file of text that a person writes, in bytes: a study, printed formulas, points of a curve.
pub const TEXT_LIMIT: u64 = 16 << 20;

/// Where a result goes: a plain file, links followed.
///
/// # Errors
/// A folder, a device, a folder that does not exist: before anything is computed.
pub fn destination(path: &Path) -> Result<PathBuf> {
    let refuse = |what: &str| Err(Error::input(format!("{}: {what}", shown_path(path))));
    if path.file_name().is_none() {
        return refuse("this is no name of a file");
    }
    let target = match fs::symlink_metadata(path) {
        Ok(info) if info.file_type().is_symlink() => match fs::canonicalize(path) {
            Ok(target) => target,
            Err(error) => return refuse(&format!("a link that leads nowhere: {error}")),
        },
        _ => path.to_owned(),
    };
    match fs::metadata(&target) {
        Ok(info) if info.is_dir() => return refuse("this is a folder: name a file in it"),
        Ok(info) if !info.is_file() => return refuse("this is a device, not a file"),
        Ok(info) if info.permissions().readonly() => return refuse("this file is read-only"),
        _ => {}
    }
    let folder = folder_of(&target);
    if !folder.is_dir() {
        return refuse(&format!("there is no folder {}", shown_path(folder)));
    }
    Ok(target)
}

/// The folder of a file.
fn folder_of(target: &Path) -> &Path {
    match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Where a result goes, if it may go there: nothing stands there yet, or what stands there is sealed, or `overwrite`
/// allows anything. Asked before anything is computed.
///
/// # Errors
/// As [`destination`]; a folder in which no file can be made; a file that Landau did not write, or that was changed since.
pub fn check_replaceable(path: &Path, overwrite: Overwrite) -> Result<PathBuf> {
    let target = destination(path)?;
    check_folder(path, &target)?;
    if overwrite == Overwrite::Recognised && target.exists() && !is_sealed(&target) {
        return Err(refused(
            path,
            "Landau did not write it, or it was changed since",
        ));
    }
    Ok(target)
}

/// Refuses the name of a file that is made beside a result without being named by the user, such as a journal. It is
/// never written through a link, whatever the user allows.
///
/// # Errors
/// A link, a folder, a device; a sealed file is wanted and what stands there is none.
pub fn check_companion(path: &Path, overwrite: Overwrite) -> Result<()> {
    if !has_plain_file(path)? {
        return Ok(());
    }
    if overwrite == Overwrite::Recognised && !is_sealed(path) {
        return Err(refused(
            path,
            "Landau did not write it, or it was changed since",
        ));
    }
    Ok(())
}

/// Whether a plain file stands there; `false` where nothing does.
///
/// # Errors
/// A link, a folder, a device.
pub fn has_plain_file(path: &Path) -> Result<bool> {
    match fs::symlink_metadata(path) {
        Err(_) => Ok(false),
        Ok(info) if info.is_file() => Ok(true),
        Ok(info) => {
            let what = if info.file_type().is_symlink() {
                "a link"
            } else if info.is_dir() {
                "a folder"
            } else {
                "a device"
            };
            Err(Error::input(format!(
                "{} is {what}, where a file has to be written: remove it, or choose another name for the result",
                shown_path(path)
            )))
        }
    }
}

/// The refusal to replace a file, with its reason.
pub fn refused(path: &Path, reason: &str) -> Error {
    Error::input(format!(
        "{} exists and is not replaced: {reason}. Remove it, choose another name, or give --force",
        shown_path(path)
    ))
}

/// Whether Landau wrote a file, and nobody changed it since.
pub fn is_sealed(path: &Path) -> bool {
    read_bounded(path, SEALED_LIMIT).is_ok_and(|bytes| seal::is_sealed(&bytes))
}

/// Removes what killed runs left half written in the folder of a file.
pub fn remove_abandoned_beside(target: &Path) {
    part::remove_abandoned(folder_of(target));
}

/// Makes a file in the folder and removes it again.
fn check_folder(path: &Path, target: &Path) -> Result<()> {
    remove_abandoned_beside(target);
    match part::begin(folder_of(target), |_| ()) {
        Ok(_) => Ok(()),
        Err(error) => Err(Error::input(format!(
            "{} cannot be written: {error}",
            shown_path(path)
        ))),
    }
}

/// Reads a plain file of bounded size: a pipe would never end, a device neither.
///
/// # Errors
/// What is no plain file, is larger than `limit` bytes, or cannot be read.
pub fn read_bounded(path: &Path, limit: u64) -> Result<Vec<u8>> {
    let wrong = |what: &str| Error::input(format!("{} cannot be read: {what}", shown_path(path)));
    let failure = |error: std::io::Error| wrong(&error.to_string());
    // Look at the file before opening it: opening a pipe waits for a process at its far end.
    if !fs::metadata(path).map_err(failure)?.is_file() {
        return Err(wrong("it is no plain file"));
    }
    let file = File::open(path).map_err(failure)?;
    let mut bytes = Vec::new();
    file.take(limit.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(failure)?;
    if bytes.len() as u64 > limit {
        return Err(wrong(&format!("it is larger than {limit} bytes")));
    }
    Ok(bytes)
}

/// Reads a plain file of text.
///
/// # Errors
/// As [`read_bounded`]; bytes that are not UTF-8.
pub fn read_text(path: &Path, limit: u64) -> Result<String> {
    String::from_utf8(read_bounded(path, limit)?).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        Error::input(format!(
            "{} cannot be read: it is not UTF-8 text, from byte {} on",
            shown_path(path),
            place + 1
        ))
    })
}

/// Writes a file whole or not at all. A file that was there keeps its permissions.
///
/// # Errors
/// Folders that do not exist, permissions.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let target = destination(path)?;
    let failure =
        |e: std::io::Error| Error::input(format!("{} cannot be written: {e}", shown_path(path)));
    // The temporary file is removed where something fails on the way.
    let permissions = fs::metadata(&target).ok().map(|info| info.permissions());
    let begun = part::begin(folder_of(&target), |builder| {
        #[cfg(unix)]
        if permissions.is_none() {
            // Those of any new file, rather than those of a temporary one; the process's umask is applied.
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        }
    });
    let mut part = begun.map_err(failure)?;
    part.write_all(bytes).map_err(failure)?;
    if let Some(permissions) = permissions {
        part.as_file()
            .set_permissions(permissions)
            .map_err(failure)?;
    }
    part.persist(&target).map_err(|e| failure(e.error))?;
    Ok(())
}

/// 64-bit FNV-1a: enough to tell one text from another.
pub fn hash(bytes: impl IntoIterator<Item = u8>) -> u64 {
    bytes.into_iter().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

#[cfg(test)]
mod tests {
    use super::seal::{BLANK, sealed};
    use super::{
        Overwrite, check_companion, check_replaceable, destination, hash, read_bounded, read_text,
        write_whole,
    };
    use std::fs;
    use std::os::unix::fs::{PermissionsExt, symlink};

    #[test]
    fn folders_devices_and_links() {
        let folder = tempfile::tempdir().expect("a folder");
        assert!(destination(folder.path()).is_err());
        assert!(destination(std::path::Path::new("/dev/null")).is_err());
        assert!(destination(&folder.path().join("missing/table.csv")).is_err());
        let (file, link) = (folder.path().join("a.csv"), folder.path().join("b.csv"));
        write_whole(&file, b"one").expect("written");
        std::os::unix::fs::symlink(&file, &link).expect("a link");
        write_whole(&link, b"two").expect("written through the link");
        assert_eq!(std::fs::read(&file).expect("read"), b"two");
        assert!(
            std::fs::symlink_metadata(&link)
                .expect("there")
                .is_symlink()
        );
        assert_eq!(std::fs::read_dir(folder.path()).expect("listed").count(), 2);
    }

    #[test]
    fn a_file_keeps_its_mode() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.csv");
        write_whole(&file, b"one").expect("written");
        for mode in [0o600, 0o640, 0o666] {
            fs::set_permissions(&file, fs::Permissions::from_mode(mode)).expect("set");
            write_whole(&file, b"two").expect("written");
            let kept = fs::metadata(&file).expect("there").permissions().mode();
            assert_eq!(kept & 0o777, mode);
        }
    }

    /// Only sealed files are replaced, and a file that no command names is never replaced through a link.
    #[test]
    fn what_may_be_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        let (ours, foreign, link) = (path("ours"), path("foreign"), path("link"));
        write_whole(&ours, &sealed(format!("x {BLANK} y").into_bytes())).expect("written");
        write_whole(&foreign, b"x").expect("written");
        symlink(&ours, &link).expect("a link");
        let (recognised, anything) = (Overwrite::Recognised, Overwrite::Anything);
        assert!(check_replaceable(&path("new"), recognised).is_ok());
        assert!(check_replaceable(&ours, recognised).is_ok());
        assert!(check_replaceable(&link, recognised).is_ok());
        assert!(check_replaceable(&foreign, recognised).is_err());
        assert!(check_replaceable(&foreign, anything).is_ok());
        assert!(check_companion(&ours, recognised).is_ok());
        assert!(check_companion(&foreign, recognised).is_err());
        assert!(check_companion(&foreign, anything).is_ok());
        assert!(check_companion(&link, anything).is_err());
        assert!(check_companion(folder.path(), anything).is_err());
        let left = fs::read_dir(folder.path()).expect("listed").count();
        assert_eq!(left, 3);
    }

    #[test]
    fn what_is_no_plain_file_is_not_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("file");
        fs::write(&file, b"ab\xff").expect("written");
        assert_eq!(read_bounded(&file, 3).expect("read"), b"ab\xff");
        assert!(read_bounded(&file, 2).is_err());
        let said = read_text(&file, 3).expect_err("not UTF-8").to_string();
        assert!(said.contains("byte 3"), "{said}");
        assert!(read_bounded("/dev/zero".as_ref(), 3).is_err());
        assert!(read_bounded(folder.path(), 3).is_err());
        let pipe = folder.path().join("pipe");
        let made = std::process::Command::new("mkfifo").arg(&pipe).status();
        assert!(made.is_ok_and(|status| status.success()));
        assert!(read_bounded(&pipe, 3).is_err());
    }

    /// The published value of FNV-1a for `a`.
    #[test]
    fn published_hash() {
        assert_eq!(hash(*b"a"), 0xaf63_dc4c_8601_ec8c);
    }
}
