//! Everything that a study was made from, as the report delivers it.

use super::workshop::Workshop;
use landau_solver::error::Result;
use std::path::Path;

/// Where printed formulas stand: their file may have the name of the study.
const ERRATA: &str = "errata";

/// Files by the names that they are delivered under, none twice.
#[derive(Default)]
struct Delivered(Vec<(String, String)>);

impl Delivered {
    /// Adds a file; one of the same name and another text gets a number.
    fn add(&mut self, folder: &str, path: &Path, text: String) {
        let stem = plain(&path.file_stem().unwrap_or_default().to_string_lossy());
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        let extension = if extension.is_empty() {
            String::new()
        } else {
            format!(".{}", plain(&extension))
        };
        for number in 1.. {
            let apart = if number == 1 {
                String::new()
            } else {
                format!("-{number}")
            };
            let name = format!("{folder}{stem}{apart}{extension}");
            match self.0.iter().find(|(delivered, _)| *delivered == name) {
                None => return self.0.push((name, text)),
                Some((_, delivered)) if *delivered == text => return,
                Some(_) => {}
            }
        }
    }
}

/// A name as a report's file has it.
fn plain(name: &str) -> String {
    let kept = |c: char| {
        if c.is_alphanumeric() || matches!(c, '-' | '_' | '.') {
            c
        } else {
            '-'
        }
    };
    let name: String = name.chars().map(kept).take(100).collect();
    let name = name.trim_start_matches('.');
    if name.is_empty() { "file" } else { name }.to_owned()
}

impl Workshop<'_> {
    /// The study, its printed formulas, its references, the specs of its models and their laws: names below `sources`,
    /// and texts.
    pub(super) fn sources(&self) -> Result<Vec<(String, String)>> {
        let study = self.study;
        let mut files = Delivered::default();
        let source = &study.read_from;
        files.add("", &source.path, source.text.clone());
        if let Some(errata) = &study.errata {
            let text = study.read_beside(errata)?;
            files.add(&format!("{ERRATA}/"), Path::new(errata), text);
        }
        let tasks = || study.figure.iter().flat_map(|figure| &figure.task);
        for reference in tasks().flat_map(|task| task.kind().references()) {
            let (path, text) = (
                Path::new(&reference.file),
                study.read_beside(&reference.file)?,
            );
            files.add("", path, text);
        }
        let names = tasks().flat_map(|task| task.kind().cases());
        let names = names.filter_map(|case| case.model.as_ref());
        for name in [&study.model].into_iter().chain(names) {
            for (path, text) in self.model_named(name)?.sources() {
                files.add("", Path::new(&path), text);
            }
        }
        Ok(files.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Delivered;
    use std::path::Path;

    #[test]
    fn no_file_replaces_another() {
        let mut files = Delivered::default();
        for (folder, path, text) in [
            ("", "studies/a.toml", "study"),
            ("errata/", "../errata/a.toml", "errata"),
            ("", "one/flow.model", "one"),
            ("", "two/flow.model", "two"),
            ("", "three/flow.model", "one"),
            ("", "/x/..", "none"),
        ] {
            files.add(folder, Path::new(path), text.to_owned());
        }
        let names: Vec<&str> = files.0.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(
            names,
            [
                "a.toml",
                "errata/a.toml",
                "flow.model",
                "flow-2.model",
                "file"
            ]
        );
    }
}
