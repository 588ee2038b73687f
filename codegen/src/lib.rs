//! From balance equations to operators, at build time, symbolically and exactly.
//!
//! The pipeline, one module a stage and one type a stage:
//!
#![doc = include_str!("../STAGES.md")]
//!
//! [`generate`] is the whole of it on a screen; [`build`] wraps it for a build script.

#![warn(missing_docs)]

pub mod build;
pub mod derive;
pub mod diagnostic;
pub mod emit;
pub mod errata;
pub mod expression;
pub mod formula;
pub mod graph;
pub mod kernel;
pub mod model;
mod syntax;

use diagnostic::{Diagnostics, SourceFile};
use landau_contract::TapeModel;
use std::collections::BTreeMap;

/// Truncation order of the expansion: N2 and N3, which give the first Landau coefficient.
pub const ORDER: usize = 3;

/// A spec and the law files it may import.
#[derive(Clone, Debug)]
pub struct Sources {
    /// The text of the model.
    pub spec: SourceFile,
    /// Law files by name.
    pub laws: BTreeMap<String, SourceFile>,
}

/// Spec → operators → kernels.
///
/// # Errors
/// Everything that is wrong with the form of the spec, in one run.
pub fn generate(
    sources: &Sources,
) -> Result<(derive::Derivation, kernel::ModelKernels), Diagnostics> {
    let model = model::resolve(sources)?;
    let mut derivation = derive::derive(model, ORDER)?;
    let kernels = kernel::kernels(&mut derivation);
    Ok((derivation, kernels))
}

/// A spec as a model that interprets its kernels, without a build.
///
/// # Errors
/// As [`generate`].
pub fn tape(sources: &Sources) -> Result<TapeModel, Diagnostics> {
    let (derivation, kernels) = generate(sources)?;
    let texts = |files: &mut dyn Iterator<Item = &SourceFile>| -> Vec<(String, String)> {
        files.map(|f| (f.path.clone(), f.text.clone())).collect()
    };
    let own = texts(&mut derivation.model.sources.iter());
    let laws = texts(&mut sources.laws.values());
    Ok(TapeModel::new(kernels, own, laws))
}
