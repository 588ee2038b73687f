//! The driver for a build script: every `.model` file of a folder becomes a Rust module.

use crate::diagnostic::{Diagnostics, SourceFile};
use crate::emit::{self, name::Identifiers};
use crate::generate::generate;
use crate::sources::{LARGEST_FILE, Sources};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Paths of open descriptors: what they lead to has been opened already, so that reading does not wait for it.
const DESCRIPTORS: [&str; 3] = ["/dev/stdin", "/dev/fd", "/proc/self/fd"];

/// The variable that names a folder for a second copy of the generated code, where a person can read it.
const EMIT_DIR: &str = "LANDAU_EMIT_DIR";

/// Generates `$OUT_DIR/models.rs` from `models/*.model` and `laws/*.law` of the crate being built; and in
/// `$LANDAU_EMIT_DIR`, if that is set, for reading.
///
/// Mistakes are printed as `cargo::error=` lines and end the build script.
pub fn run() {
    println!("cargo::rerun-if-changed=models");
    println!("cargo::rerun-if-changed=laws");
    println!("cargo::rerun-if-env-changed={EMIT_DIR}");
    if let Err(mistakes) = generate_from_environment() {
        for line in mistakes.lines() {
            println!("cargo::error={line}");
        }
        std::process::exit(1);
    }
}

fn generate_from_environment() -> Result<(), String> {
    let directory = |name: &str| {
        env::var_os(name)
            .map(PathBuf::from)
            .ok_or_else(|| format!("{name} is not set: run this from a build script"))
    };
    let root = directory("CARGO_MANIFEST_DIR")?;
    generate_folder(&root, &directory("OUT_DIR")?)?;
    match env::var_os(EMIT_DIR) {
        Some(folder) => generate_readable(&root, Path::new(&folder)),
        None => Ok(()),
    }
}

/// Generates the code of the crate at `root` in a folder where a person can read it; makes the folder.
///
/// # Errors
/// A folder that cannot be made or written to; the mistakes of all specs.
pub fn generate_readable(root: &Path, folder: &Path) -> Result<(), String> {
    let name = folder.display();
    fs::create_dir_all(folder).map_err(|e| format!("{EMIT_DIR}={name}: {e}"))?;
    generate_folder(root, folder)
}

/// Generates `out/models.rs` from the `models/` and `laws/` of the crate at `root`.
///
/// # Errors
/// The mistakes of all specs, as text.
pub fn generate_folder(root: &Path, out: &Path) -> Result<(), String> {
    let (laws, unreadable) = read_laws(&root.join("laws")).map_err(|e| e.to_string())?;
    let (mut index, mut list, mut errors) = (String::new(), String::new(), String::new());
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    let mut identifiers = Identifiers::default();
    for path in files(&root.join("models"), "model").map_err(|e| e.to_string())? {
        let spec = read(&path, root).map_err(|e| e.to_string())?;
        let file = spec.path.clone();
        let (name, title, code) = match generate_module(Sources {
            spec,
            laws: laws.clone(),
            unreadable: unreadable.clone(),
        }) {
            Ok(module) => module,
            Err(mistakes) => {
                errors += &mistakes.render();
                continue;
            }
        };
        if let Some(namesake) = names.insert(name.clone(), file.clone()) {
            let _ = writeln!(
                errors,
                "the model `{name}` stands in {namesake} and in {file}"
            );
            continue;
        }
        let name = identifiers.module(&name);
        fs::write(out.join(format!("{name}.rs")), code).map_err(|e| e.to_string())?;
        let _ = writeln!(
            index,
            "// Lints are for code that people write: straight-line code has thousands of names.\n#[allow(clippy::all)]\n#[doc = {title:?}]\npub mod {name} {{ include!(concat!(env!(\"OUT_DIR\"), \"/{name}.rs\")); }}"
        );
        let _ = writeln!(list, "    std::sync::Arc::new({name}::Generated::new()),");
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let shelf: String = laws
        .values()
        .map(|file| format!("    ({:?}, {:?}),\n", file.path, file.text))
        .collect();
    let _ = writeln!(
        index,
        "/// Path and text of every law file of this crate.\npub const LAWS: &[(&str, &str)] = &[\n{shelf}];"
    );
    let _ = writeln!(
        index,
        "/// Every model of this crate.\npub fn models() -> Vec<std::sync::Arc<dyn landau_contract::Model>> {{\n    vec![\n{list}    ]\n}}"
    );
    fs::write(out.join("models.rs"), index).map_err(|e| e.to_string())
}

/// Name, title and Rust module of a spec.
pub fn generate_module(sources: Sources) -> Result<(String, String, String), Diagnostics> {
    let (derivation, kernels) = generate(&sources)?;
    let code = emit::rust::module(&derivation, &kernels);
    Ok((
        derivation.model.name.clone(),
        derivation.model.title.clone(),
        code,
    ))
}

/// The law files of a folder by name, and those that cannot be read, with the reason; none where there is no
/// such folder.
///
/// # Errors
/// A folder that cannot be listed.
pub fn read_laws(
    folder: &Path,
) -> io::Result<(BTreeMap<String, SourceFile>, BTreeMap<String, String>)> {
    let (mut laws, mut unreadable) = (BTreeMap::new(), BTreeMap::new());
    if !folder.is_dir() {
        return Ok((laws, unreadable));
    }
    let root = folder.parent().unwrap_or(folder);
    for path in files(folder, "law")? {
        let stem = path.file_stem().unwrap_or_default();
        let name = stem.to_string_lossy().into_owned();
        match read(&path, root) {
            Ok(file) => drop(laws.insert(name, file)),
            Err(reason) => drop(unreadable.insert(name, format!("{}: {reason}", path.display()))),
        }
    }
    Ok((laws, unreadable))
}

/// A spec with the law files beside it: in `laws/` next to it, or next to its folder.
///
/// # Errors
/// A spec that is no text of at most 1 MiB in a regular file, or behind an open descriptor such as `/dev/stdin`.
pub fn read_sources(path: &Path) -> io::Result<Sources> {
    let spec = SourceFile {
        path: path.display().to_string(),
        text: read_text(path)?,
    };
    let folder = path.parent().unwrap_or(Path::new("."));
    let (mut laws, mut unreadable) = read_laws(&folder.join("laws"))?;
    if laws.is_empty() && unreadable.is_empty() {
        (laws, unreadable) = read_laws(&folder.join("..").join("laws"))?;
    }
    Ok(Sources {
        spec,
        laws,
        unreadable,
    })
}

/// The regular files of a folder whose names have the given ending.
fn files(folder: &Path, extension: &str) -> io::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == extension) && path.is_file() {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}

fn read(path: &Path, root: &Path) -> io::Result<SourceFile> {
    let text = read_text(path)?;
    let shown = path.strip_prefix(root).unwrap_or(path);
    Ok(SourceFile {
        path: shown.display().to_string(),
        text,
    })
}

/// The text of a spec or a law file. It stops reading just beyond the largest size of such a file.
fn read_text(path: &Path) -> io::Result<String> {
    let refuse = |reason: String| io::Error::new(io::ErrorKind::InvalidData, reason);
    let is_open = DESCRIPTORS.iter().any(|place| path.starts_with(place));
    if !is_open && !fs::metadata(path)?.is_file() {
        return Err(refuse("it is not a regular file".into()));
    }
    let mut bytes = Vec::new();
    let most = LARGEST_FILE as u64 + 1;
    fs::File::open(path)?.take(most).read_to_end(&mut bytes)?;
    if bytes.len() > LARGEST_FILE {
        return Err(refuse(format!("it has more than {LARGEST_FILE} bytes")));
    }
    String::from_utf8(bytes).map_err(|error| {
        let place = error.utf8_error().valid_up_to();
        refuse(format!("it is not UTF-8 text (byte {place})"))
    })
}
