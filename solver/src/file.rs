//! Files written whole or not at all, and never over what is somebody else's.

use crate::error::{Error, Result};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Where a result goes: a plain file, links followed.
///
/// # Errors
/// A folder, a device, a folder that does not exist: before anything is computed.
pub fn destination(path: &Path) -> Result<PathBuf> {
    let refuse = |what: &str| Err(Error::input(format!("{}: {what}", path.display())));
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
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return refuse(&format!("there is no folder {}", folder.display()));
    }
    Ok(target)
}

/// Writes a file whole or not at all.
///
/// # Errors
/// Folders that do not exist, permissions.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    let target = destination(path)?;
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let failure =
        |e: std::io::Error| Error::input(format!("{} cannot be written: {e}", path.display()));
    // A temporary file of its own is removed where something fails on the way.
    let mut builder = tempfile::Builder::new();
    builder.prefix(".landau-");
    // Those of any new file, rather than those of a temporary one; the process's umask is applied.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut part = builder.tempfile_in(folder).map_err(failure)?;
    part.write_all(bytes).map_err(failure)?;
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
    use super::{destination, hash, write_whole};

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

    /// The published value of FNV-1a for `a`.
    #[test]
    fn published_hash() {
        assert_eq!(hash(*b"a"), 0xaf63_dc4c_8601_ec8c);
    }
}
