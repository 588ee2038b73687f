//! For the build scripts of the generator and the solver, which include this file: a hash of sources, by which builds
//! of one version are told apart.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Sets the environment variable `LANDAU_BUILD` of the crate to 16 hexadecimal digits: 64-bit FNV-1a over the names and
/// bytes of every `.rs` file below `folders` and of the workspace's lock file. Neither time, place nor git counts.
pub fn announce(folders: &[&str]) {
    let root = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for folder in folders {
        println!("cargo::rerun-if-changed={folder}");
        if let Err(error) = add_folder(&root.join(folder), folder, &mut hash) {
            println!("cargo::error={folder} cannot be read: {error}");
        }
    }
    // Digits depend on the versions of dependencies too. A packaged crate has no lock file above it.
    for lock in ["Cargo.lock", "../Cargo.lock"] {
        let path = root.join(lock);
        if path.is_file() {
            println!("cargo::rerun-if-changed={lock}");
            let _ = add_file(&path, "Cargo.lock", &mut hash);
        }
    }
    println!("cargo::rustc-env=LANDAU_BUILD={hash:016x}");
}

fn add_folder(folder: &Path, name: &str, hash: &mut u64) -> io::Result<()> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder)? {
        paths.push(entry?.path());
    }
    paths.sort();
    for path in paths {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let name = format!("{name}/{file}");
        if path.is_dir() {
            add_folder(&path, &name, hash)?;
        } else if name.ends_with(".rs") {
            add_file(&path, &name, hash)?;
        }
    }
    Ok(())
}

fn add_file(path: &Path, name: &str, hash: &mut u64) -> io::Result<()> {
    for byte in name.bytes().chain([0]).chain(fs::read(path)?).chain([0]) {
        *hash = (*hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    }
    Ok(())
}
