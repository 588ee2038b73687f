//! Specs and law files as files: what is no text, what cannot be read, names that Rust keeps for itself.

use crate::support::{landau, written};
use landau_codegen::build::generate_folder;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const PLAIN: &str = "model m \"t\"; coordinates { x: periodic; } fields { u; } \
    balance { e: dt(u) = -u; } base { u = 0; }";

fn of_law(law: &str) -> String {
    PLAIN
        .replace(
            "coordinates",
            &format!("use laws::{law}::{{f}}; coordinates"),
        )
        .replace("= -u", "= -f")
}

/// A folder with a `laws` folder inside.
fn folder() -> std::path::PathBuf {
    let path = written("good.model", PLAIN);
    let folder = path.parent().expect("a folder").to_owned();
    fs::create_dir(folder.join("laws")).expect("a folder");
    fs::write(folder.join("laws/good.law"), "law f(u) = u;").expect("a file");
    folder
}

fn checked(folder: &Path, name: &str, text: &str) -> (i32, String) {
    let path = folder.join(name);
    fs::write(&path, text).expect("a file");
    let answer = landau(&["check", &path.to_string_lossy()]);
    (answer.status, answer.err)
}

#[test]
fn a_broken_law_file_is_a_mistake_of_those_that_use_it() {
    let folder = folder();
    fs::create_dir(folder.join("laws/folder.law")).expect("a folder");
    fs::write(folder.join("laws/latin.law"), b"law f(u) = u; // \xfcber").expect("a file");
    fs::write(folder.join("laws/huge.law"), "/".repeat(3 << 20)).expect("a file");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/dev/zero", folder.join("laws/zero.law")).expect("a link");
        std::os::unix::fs::symlink("nowhere", folder.join("laws/dangling.law")).expect("a link");
    }
    assert_eq!(checked(&folder, "plain.model", PLAIN).0, 0);
    assert_eq!(checked(&folder, "uses.model", &of_law("good")).0, 0);
    for (law, reason) in [
        ("latin", "latin.law: it is not UTF-8 text (byte 17)"),
        ("huge", "huge.law: it has more than 1048576 bytes"),
        ("folder", "there is no law file `folder`"),
        ("zero", "there is no law file `zero`"),
        ("dangling", "there is no law file `dangling`"),
    ] {
        let (status, said) = checked(&folder, &format!("uses_{law}.model"), &of_law(law));
        assert_eq!(status, 2, "{law}");
        assert!(
            said.contains(reason) && said.contains("--> "),
            "{law}: {said}"
        );
    }
    // A build script says the same, and builds what does not use them.
    let out = tempfile::tempdir().expect("a folder");
    let models = folder.join("models");
    fs::create_dir(&models).expect("a folder");
    fs::create_dir(models.join("folder.model")).expect("a folder");
    fs::write(models.join("plain.model"), PLAIN).expect("a file");
    generate_folder(&folder, out.path()).expect("a model that uses none of them");
    fs::write(
        models.join("uses.model"),
        of_law("latin").replace("model m", "model n"),
    )
    .expect("a file");
    let said = generate_folder(&folder, out.path()).expect_err("a law that cannot be read");
    assert!(said.contains("latin.law: it is not UTF-8 text"), "{said}");
}

/// What never ends, what never begins, and what is no file.
#[cfg(unix)]
#[test]
fn what_is_no_regular_file_is_refused_at_once() {
    let folder = folder();
    let pipe = folder.join("pipe.model");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|status| status.success()), "a pipe");
    std::os::unix::fs::symlink("/dev/zero", folder.join("zero.model")).expect("a link");
    fs::create_dir(folder.join("folder.model")).expect("a folder");
    fs::write(folder.join("latin.model"), b"model m; // \xfcber").expect("a file");
    fs::File::create(folder.join("huge.model"))
        .and_then(|file| file.set_len(1 << 40))
        .expect("a file with nothing in it");
    for (name, reason) in [
        ("pipe.model", "it is not a regular file"),
        ("zero.model", "it is not a regular file"),
        ("folder.model", "it is not a regular file"),
        ("latin.model", "it is not UTF-8 text (byte 12)"),
        ("huge.model", "it has more than 1048576 bytes"),
        ("missing.model", "No such file"),
    ] {
        let path = folder.join(name);
        let path = path.to_string_lossy();
        for command in [vec!["check", &path], vec!["point", &path, "--k", "1"]] {
            let answer = landau(&command);
            assert_eq!(answer.status, 2, "{name}: {}", answer.err);
            assert!(
                answer.err.contains(reason) && answer.err.contains(name),
                "{name}: {}",
                answer.err
            );
        }
    }
}

/// Escapes and direction marks would pass from titles and notes into pictures, pages and terminals.
#[test]
fn control_characters_are_refused() {
    let spec = |title: &str, note: &str, comment: &str| {
        format!(
            "model m \"{title}\"; coordinates {{ x: periodic; }} fields {{ u \"{note}\"; }} // {comment}\n\
                 balance {{ e: dt(u) = -u \"{note}\"; }} base {{ u = 0; }}"
        )
    };
    let mut characters: Vec<char> = (0..32).chain(127..160).filter_map(char::from_u32).collect();
    characters.retain(|c| !"\n\r\t".contains(*c));
    characters
        .extend("\u{61c}\u{200e}\u{200f}\u{2028}\u{2029}\u{202a}\u{202e}\u{2066}\u{2069}".chars());
    let folder = folder();
    for character in characters {
        let code = format!("U+{:04X}", u32::from(character));
        let written = format!("a{character}b");
        let escaped = format!("a\\u{{{:x}}}b", u32::from(character));
        for text in [
            spec(&written, "", ""),
            spec("", &written, ""),
            spec("", "", &written),
            spec(&escaped, "", ""),
            spec("", &escaped, ""),
        ] {
            let (status, said) = checked(&folder, "control.model", &text);
            assert_eq!(status, 2, "{code}");
            assert!(
                said.contains(&format!("the control character {code}")),
                "{code}: {said}"
            );
            let shown = |c: char| c == character && c != '\n';
            assert!(!said.contains(shown), "{code} is shown");
        }
    }
    // Letters of any script stay, and a text written over two lines is one line.
    let text = spec("Größe, 宽度, عرض", "one\n        line", "∂u/∂t ≤ 1");
    assert_eq!(checked(&folder, "letters.model", &text), (0, String::new()));
    let sources =
        landau_codegen::build::read_sources(&folder.join("letters.model")).expect("a spec");
    let model = landau_codegen::tape(&sources).expect("a model");
    let structure = landau_solver::model::Model::structure(&model);
    assert_eq!(structure.title, "Größe, 宽度, عرض");
    assert_eq!(
        structure.fields.iter().next().map(|f| f.doc.as_str()),
        Some("one line")
    );
}

/// Names that Rust keeps for itself, names that hide others, names that differ in case alone: the code parses,
/// and no two items have one name. (`tests/outside` compiles two such models.)
#[test]
fn any_name_is_a_name_in_rust() {
    let root = tempfile::tempdir().expect("a folder");
    let models = root.path().join("models");
    fs::create_dir(&models).expect("a folder");
    let names = [
        "fn",
        "type",
        "async",
        "dyn",
        "gen",
        "try",
        "abstract",
        "self",
        "Self",
        "super",
        "crate",
        "_",
        "models",
        "std",
        "core",
        "alloc",
        "str",
        "u8",
        "f64",
        "usize",
        "Vec",
        "landau_contract",
        "landau_cli",
        "Foo",
        "foo",
        "fn_",
        "FOO",
        "größe",
        "GRÖSSE",
        "union",
        "macro_rules",
    ];
    for (index, name) in names.iter().enumerate() {
        let text = format!(
            "model {name}; coordinates {{ x: periodic; }} fields {{ u; v; w; }} parameters {{ fn = 1; Vec = 2; s = match in {{match, loop}}; }}\n\
             let self = select s {{ match: fn, loop: Vec }};\n\
             balance {{ mass: dt(u) = -u + v*w*self; Mass: dt(v) = -v + u^2*fn; fn: dt(w) = -w + u^2*Vec; }}\n\
             base {{ u = 0; v = 0; w = 0; }}"
        );
        fs::write(models.join(format!("m{index}.model")), text).expect("a file");
    }
    let out = tempfile::tempdir().expect("a folder");
    generate_folder(root.path(), out.path()).expect("models");
    let index = fs::read_to_string(out.path().join("models.rs")).expect("the index");
    let items = |text: &str| -> Vec<String> {
        let file = syn::parse_file(text).unwrap_or_else(|e| panic!("{e} in {text}"));
        let name = |item: &syn::Item| match item {
            syn::Item::Fn(item) => Some(item.sig.ident.to_string()),
            syn::Item::Mod(item) => Some(item.ident.to_string()),
            syn::Item::Static(item) => Some(item.ident.to_string()),
            _ => None,
        };
        file.items.iter().filter_map(name).collect()
    };
    let modules = items(&index);
    assert_eq!(modules.len(), names.len() + 1, "every model, and `models`");
    let folded: BTreeSet<String> = modules.iter().map(|name| name.to_lowercase()).collect();
    assert_eq!(
        folded.len(),
        modules.len(),
        "files that differ in case alone"
    );
    for module in modules.iter().filter(|name| *name != "models") {
        let code = fs::read_to_string(out.path().join(format!("{module}.rs"))).expect("a module");
        let functions = items(&code);
        let distinct: BTreeSet<&String> = functions.iter().collect();
        assert_eq!(distinct.len(), functions.len(), "{module}: {functions:?}");
    }
    for hidden in [
        "std",
        "core",
        "str",
        "Vec",
        "u8",
        "landau_contract",
        "landau_cli",
    ] {
        assert!(!modules.iter().any(|name| name == hidden), "{hidden}");
    }
}
