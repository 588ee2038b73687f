//! Commands that compute nothing: models, check, explain.

use super::arguments::{Format, OperatorName};
use crate::error::{Error, Result};
use crate::model::Model;
use crate::reproduce::Formulas;
use landau_codegen::Sources;
use landau_codegen::build::read_sources;
use landau_codegen::derive::Derivation;
use landau_codegen::diagnostic::SourceFile;
use landau_codegen::emit::text::{self, Section};
use landau_codegen::generate;
use serde_json::json;
use std::path::Path;

pub fn models(models: &[Box<dyn Model>], json: bool) -> Result<()> {
    if json {
        let list: Vec<_> = models
            .iter()
            .map(|m| {
                let s = m.structure();
                json!({"name": s.name, "title": s.title, "operations": s.operations})
            })
            .collect();
        say!("{}", json!(list));
        return Ok(());
    }
    let width = models
        .iter()
        .map(|m| m.structure().name.len())
        .max()
        .unwrap_or(0);
    for model in models {
        say!(
            "{:width$}  {}",
            model.structure().name,
            model.structure().title
        );
    }
    Ok(())
}

pub fn check(file: &Path) -> Result<()> {
    let sources = read_sources(file)
        .map_err(|e| Error::input(format!("{} cannot be read: {e}", file.display())))?;
    match generate(&sources) {
        Ok((derivation, _)) => {
            let fields = derivation.model.field_names().join(", ");
            say!(
                "{}: the model `{}` in {fields} is well formed",
                file.display(),
                derivation.model.name
            );
            Ok(())
        }
        Err(mistakes) => Err(Error::input(format!("the spec has mistakes\n\n{mistakes}"))),
    }
}

pub fn explain(model: &dyn Model, operator: Option<OperatorName>, format: Format) -> Result<()> {
    let derivation = derive(model)?;
    let chosen = operator.map(|name| match name {
        OperatorName::Base => Section::Base,
        OperatorName::Linear => Section::Linear,
        OperatorName::Adjoint => Section::Adjoint,
        OperatorName::N2 => Section::Nonlinear(2),
        OperatorName::N3 => Section::Nonlinear(3),
    });
    for section in text::sections(&derivation) {
        if chosen.is_some_and(|c| c != section) {
            continue;
        }
        match format {
            Format::Text => say!("{}", text::print(&derivation, section)),
            Format::Latex => {
                for row in text::latex(&derivation, section) {
                    say!("\\[ {row} \\]");
                }
            }
        }
    }
    Ok(())
}

/// The derivation of a model from the sources that it carries.
fn derive(model: &dyn Model) -> Result<Derivation> {
    let mut files = model
        .sources()
        .into_iter()
        .map(|(path, text)| SourceFile { path, text });
    let spec = files
        .next()
        .ok_or_else(|| Error::input("the model has no source"))?;
    let stem = |path: &str| {
        Path::new(path)
            .file_stem()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned()
    };
    let laws = files.map(|file| (stem(&file.path), file)).collect();
    let (derivation, _) = generate(&Sources { spec, laws })
        .map_err(|mistakes| Error::input(format!("the spec has mistakes\n\n{mistakes}")))?;
    Ok(derivation)
}

/// All sections of the derived operators in LaTeX.
pub fn formulas(model: &dyn Model) -> Result<Formulas> {
    let derivation = derive(model)?;
    let title = |section: &Section| match section {
        Section::Base => "Base state".to_owned(),
        Section::Linear => "Linear operator".to_owned(),
        Section::Adjoint => "Adjoint operator".to_owned(),
        Section::Nonlinear(degree) => format!("Nonlinear operator of degree {degree}"),
    };
    let sections = text::sections(&derivation).into_iter();
    let sections = sections.map(|s| (title(&s), text::latex(&derivation, s)));
    Ok(Formulas {
        sections: sections.collect(),
    })
}
