//! A model that Python holds: built in, or run from the tape of its text.

use crate::raised;
use landau_codegen::diagnostic::SourceFile;
use landau_codegen::emit::text::{self, Section, Typeset};
use landau_codegen::{Sources, generate};
use landau_report::data::Fact;
use landau_report::data::csvw::meaning;
use landau_report::data::names::distinct;
use landau_report::data::plane::attributes;
use landau_report::library::Library;
use landau_solver::error::{Error, Result};
use landau_solver::model::{Model, Structure};
use landau_solver::study::Setup;
use pyo3::prelude::*;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// A model with its kernels.
#[pyclass(frozen, module = "stuart_landau._core")]
pub struct Core {
    pub model: Arc<dyn Model>,
    sources: Sources,
}

/// The models that are built in.
fn library() -> Library {
    Library {
        models: landau_spec::models(),
    }
}

fn taped(sources: Sources) -> Result<Core> {
    Ok(Core {
        model: Arc::new(landau_report::library::taped(&sources)?),
        sources,
    })
}

/// The sources of a built model, as it was built.
fn sources_of(model: &dyn Model) -> Sources {
    let file = |(path, text): (String, String)| SourceFile { path, text };
    let stem = |path: &str| {
        let stem = Path::new(path).file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    };
    let mut own = model.sources().into_iter().map(file);
    let empty = SourceFile {
        path: String::new(),
        text: String::new(),
    };
    Sources {
        spec: own.next().unwrap_or(empty),
        laws: model
            .laws()
            .into_iter()
            .map(|(p, t)| (stem(&p), file((p, t))))
            .collect(),
        unreadable: BTreeMap::new(),
    }
}

fn open(name: &str) -> Result<Core> {
    let library = library();
    let built = library.models.iter().any(|m| m.structure().name == name);
    let path = Path::new(name);
    if !built && (name.ends_with(".model") || path.is_file()) {
        return taped(library.sources(path)?);
    }
    let model = library.model(name)?;
    Ok(Core {
        sources: sources_of(model.as_ref()),
        model,
    })
}

fn from_text(text: String, laws: BTreeMap<String, String>) -> Result<Core> {
    let own = |(name, text): (String, String)| {
        let path = format!("{name}.law");
        (name, SourceFile { path, text })
    };
    let mut sources = Sources {
        spec: SourceFile {
            path: "text.model".to_owned(),
            text,
        },
        laws: laws.into_iter().map(own).collect(),
        unreadable: BTreeMap::new(),
    };
    for (path, text) in library().models.iter().flat_map(|model| model.laws()) {
        let stem = Path::new(&path).file_stem().unwrap_or_default();
        let stem = stem.to_string_lossy().into_owned();
        sources
            .laws
            .entry(stem)
            .or_insert(SourceFile { path, text });
    }
    taped(sources)
}

/// What Python shows of a structure; what has an order is a list of pairs.
fn info(structure: &Structure) -> serde_json::Value {
    let parameters = structure.parameters.iter().map(|p| {
        let default = match p.choices.get(p.default as usize) {
            Some(choice) => json!(choice),
            None => json!(p.default),
        };
        let value = json!({
            "default": default,
            "doc": p.doc,
            "choices": p.choices,
            "whole": p.whole,
            "automatic": p.automatic,
        });
        json!([p.name, value])
    });
    let fields = structure.fields.iter().map(|f| json!([f.name, f.doc]));
    let typical = structure.typical.as_ref();
    json!({
        "name": structure.name,
        "title": structure.title,
        "coordinate": structure.coordinate,
        "periodic": structure.periodic,
        "parameters": parameters.collect::<Vec<_>>(),
        "fields": fields.collect::<Vec<_>>(),
        "normalization": structure.amplitude.description,
        "typical_k": typical.map(|t| t.k),
        "typical_near": typical.map_or(&[][..], |t| &t.near),
    })
}

#[pymethods]
impl Core {
    /// A built model by name, or the spec of a file.
    #[staticmethod]
    fn open(py: Python<'_>, name: &str) -> PyResult<Self> {
        py.detach(|| open(name)).map_err(raised)
    }

    /// A spec from its text; `laws` by name, besides those that are built in.
    #[staticmethod]
    fn from_text(py: Python<'_>, text: String, laws: BTreeMap<String, String>) -> PyResult<Self> {
        py.detach(|| from_text(text, laws)).map_err(raised)
    }

    /// Names of the built models.
    #[staticmethod]
    fn built() -> Vec<String> {
        let models = landau_spec::models();
        models.iter().map(|m| m.structure().name.clone()).collect()
    }

    /// Name, title, parameters and fields, as JSON.
    fn info(&self) -> String {
        info(self.model.structure()).to_string()
    }

    /// What datasets are labelled with, as the files of the command line are: `parameters` is JSON, by name.
    fn attributes(
        &self,
        parameters: &str,
        resolution: usize,
        k: Option<f64>,
        amplitude: Option<f64>,
    ) -> PyResult<String> {
        let setup = Setup::new(self.model.clone(), resolution).map_err(raised)?;
        let parameters = serde_json::from_str(parameters)
            .map_err(|error| raised(Error::input(error.to_string())))?;
        let facts = attributes(&setup, &parameters, k, amplitude).into_iter();
        let facts = facts.map(|(name, fact)| match fact {
            Fact::Text(text) => json!([name, text]),
            Fact::Number(number) => json!([name, number]),
        });
        Ok(facts.collect::<serde_json::Value>().to_string())
    }

    /// Names as files have them: Latin letters, digits, underscores, each another.
    #[staticmethod]
    fn plain(names: Vec<String>) -> Vec<String> {
        distinct(names.iter().map(String::as_str))
    }

    /// What a column of a sweep is.
    #[staticmethod]
    fn meaning(column: &str) -> String {
        meaning(column)
    }

    /// Text of the spec, and of the laws by name: what a pickle holds.
    fn texts(&self) -> (String, BTreeMap<String, String>) {
        let laws = self.sources.laws.iter();
        let laws = laws.map(|(name, file)| (name.clone(), file.text.clone()));
        (self.sources.spec.text.clone(), laws.collect())
    }

    /// A derived operator, `base`, `L`, `adjoint`, `N2` or `N3`: lines of text, or of LaTeX.
    fn operator(&self, py: Python<'_>, name: &str, latex: bool) -> PyResult<Vec<String>> {
        py.detach(|| self.lines(name, latex)).map_err(raised)
    }
}

impl Core {
    fn lines(&self, name: &str, latex: bool) -> Result<Vec<String>> {
        let section = match name {
            "base" => Section::Base,
            "L" => Section::Linear,
            "adjoint" => Section::Adjoint,
            "N2" => Section::Nonlinear(2),
            "N3" => Section::Nonlinear(3),
            _ => {
                return Err(Error::input(format!(
                    "there is no operator `{name}`: there are base, L, adjoint, N2, N3"
                )));
            }
        };
        let (derivation, _) =
            generate(&self.sources).map_err(|mistakes| Error::input(mistakes.to_string()))?;
        if !latex {
            let text = text::print(&derivation, section).to_string();
            return Ok(text.lines().map(str::to_owned).collect());
        }
        let rows = text::latex(&derivation, section).into_iter();
        let formulas = rows.filter_map(|row| match row {
            Typeset::Formula(formula) => Some(formula),
            Typeset::Heading(_) | Typeset::Words(_) => None,
        });
        Ok(formulas.collect())
    }
}
