//! The pipeline on a screen.

use crate::diagnostic::{Diagnostics, SourceFile};
use crate::sources::Sources;
use crate::{derive, kernel, model};
use landau_contract::TapeModel;

/// Truncation order of the expansion: N2 and N3, which give the first Landau coefficient.
pub const ORDER: usize = 3;

/// Spec → operators → kernels.
///
/// # Errors
/// Everything that is wrong with the form of the spec, in one run.
pub fn generate(
    sources: &Sources,
) -> Result<(derive::Derivation, kernel::ModelKernels), Diagnostics> {
    let (graph, model) = model::resolve(sources)?;
    let mut derivation = derive::derive(graph, model, ORDER)?;
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
    let spec = texts(&mut derivation.model.sources.iter());
    let laws = texts(&mut sources.laws.values());
    Ok(TapeModel::new(kernels, spec, laws, crate::BUILD))
}
