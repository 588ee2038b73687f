//! Commands that compute nothing: models, check, explain.

use crate::arguments::{Format, OperatorName};
use landau_codegen::derive::Derivation;
use landau_codegen::emit::text::{self, Section, Typeset};
use landau_codegen::formula::{Arrangement, Formula, latex, latex_words, plain};
use landau_codegen::generate;
use landau_report::library::{Library, sources, taped};
use landau_report::reproduce::{Errata, Formulas, all_explained};
use landau_solver::error::{Error, Result};
use landau_solver::model::{CaseInfo, ClosureKind, Jet, Model};
use landau_solver::study::Setup;
use landau_solver::words;
use landau_solver::words::shown_path;
use serde_json::json;
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

pub fn models(models: &[Arc<dyn Model>], json: bool) -> Result<()> {
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

pub fn check(library: &Library, file: &Path) -> Result<()> {
    let sources = library.sources(file)?;
    let model: Arc<dyn Model> = Arc::new(taped(&sources)?);
    let notes = check_closed_base(&model)?;
    check_claims(&model)?;
    let structure = model.structure();
    let fields: Vec<&str> = structure.fields.iter().map(|f| f.name.as_str()).collect();
    say!(
        "{}: the model `{}` in {} is well formed",
        shown_path(file),
        structure.name,
        fields.join(", ")
    );
    for note in notes {
        say!("note: {note}");
    }
    let undeclared = structure
        .cases
        .ids()
        .flat_map(|case| model.undeclared(case));
    let mut undeclared: Vec<String> = undeclared.collect();
    undeclared.sort();
    undeclared.dedup();
    for integral in undeclared {
        say!("{}", words::undeclared(&integral));
    }
    Ok(())
}

/// Resolution at which a claim is tried.
const CLAIM_RESOLUTION: usize = 24;

/// Combinations of switches at which claims are tried.
const MOST_CASES: usize = 16;

/// What a spec calls conserved without a proof has to be, at the default parameters. Where switches change the walls, it
/// has to be conserved for one choice at least.
fn check_claims(model: &Arc<dyn Model>) -> Result<()> {
    let structure = model.structure();
    // An integral is known by the jets of its density, whatever the case.
    let claims = |case: &CaseInfo| -> BTreeSet<Vec<Jet>> {
        let claimed = case.closures.iter();
        let claimed = claimed.filter(|closure| closure.kind == ClosureKind::Claimed);
        claimed.map(|closure| closure.density.clone()).collect()
    };
    let mut doubtful: BTreeSet<Vec<Jet>> = structure.cases.iter().flat_map(&claims).collect();
    let only_case = structure.cases.len() == 1;
    let mut tried = 0;
    for case in structure.cases.iter().take(MOST_CASES) {
        if doubtful.is_empty() {
            return Ok(());
        }
        let mut setup = Setup::new(model.clone(), CLAIM_RESOLUTION)?;
        let choices = structure.switches.iter().zip(&case.choices);
        let choices = choices.map(|(&switch, &choice)| {
            let info = &structure.parameters[switch];
            format!("{}={}", info.name, info.choices[choice])
        });
        setup.set(&choices.collect::<Vec<_>>())?;
        let problem = setup.base(None).and_then(|base| setup.problem(&base));
        match problem {
            Ok(problem) => {
                tried += 1;
                for border in &problem.borders {
                    doubtful.remove(&case.closures[border.closure].density);
                }
            }
            Err(error) if only_case => return Err(error),
            // Another choice may have a base state at the default parameters.
            Err(_) => {}
        }
    }
    let complete = tried == structure.cases.len();
    match doubtful.first().filter(|_| complete) {
        None => Ok(()),
        Some(density) => {
            let fields = density.iter().map(|jet| &*structure.fields[jet.of].name);
            let fields: BTreeSet<&str> = fields.collect();
            let fields: Vec<&str> = fields.into_iter().collect();
            Err(Error::input(format!(
                "`conserved` in the block `mean`: the integral of {} is not conserved at the default parameters, for any \
                 choice of the switches; its density must change by a flux that vanishes at both ends",
                fields.join(", ")
            )))
        }
    }
}

/// Relative distances from the defaults at which a base state in closed form is tried.
const SAMPLES: [f64; 3] = [0.0, 0.0732, -0.0568];

/// A base state in closed form has to solve its balances at any parameters. Returns what it satisfies but nearly at
/// the defaults.
fn check_closed_base(model: &Arc<dyn Model>) -> Result<Vec<String>> {
    let structure = model.structure();
    let mut notes = Vec::new();
    if !structure.base.solved.is_empty() {
        return Ok(notes);
    }
    for sample in SAMPLES {
        let mut setup = Setup::new(model.clone(), 8)?;
        let mut shown = Vec::new();
        for (index, (id, info)) in structure.parameters.pairs().enumerate() {
            // Each by its own part, so that nothing cancels.
            let moved = match info.whole {
                true => {
                    info.default
                        + sample
                            .partial_cmp(&0.0)
                            .map_or(0.0, |side| f64::from(side as i8))
                }
                false => info.default * (1.0 + sample * (1.0 + 0.37 * index as f64).sin()),
            };
            if info.choices.is_empty() && moved >= info.lower && moved <= info.upper {
                setup.parameters.values[id] = moved;
                shown.push(format!("{} = {moved}", info.name));
            }
        }
        let place = match sample {
            0.0 => "the default parameters".to_owned(),
            _ => shown.join(", "),
        };
        let base = setup
            .base(None)
            .map_err(|error| Error::input(format!("{error} (at {place})")))?;
        if sample == 0.0 {
            notes = base.notes.clone();
        }
    }
    Ok(notes)
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
                    let row = match row {
                        Typeset::Formula(row) => row,
                        Typeset::Heading(words) | Typeset::Words(words) => latex_words(&words),
                    };
                    say!("\\[ {row} \\]");
                }
            }
        }
    }
    Ok(())
}

/// The printed formulas of a file beside the derivation.
///
/// # Errors
/// A difference that the file does not explain.
pub fn explain_against(model: &dyn Model, file: &Path, format: Format) -> Result<()> {
    let (arrangement, written): (_, fn(&Formula) -> String) = match format {
        Format::Text => (Arrangement::Flat, plain),
        Format::Latex => (Arrangement::Grouped, latex),
    };
    let errata = Errata::read(file)?;
    let judgements = errata.judge(&mut derive(model)?, arrangement)?;
    say!("{}", errata.source);
    for judgement in &judgements {
        let (terms, wrong) = (judgement.terms, judgement.differences.len());
        let verdict = match judgement.agrees {
            true => "agrees".to_owned(),
            false => format!("{wrong} of {terms} terms differ"),
        };
        say!("{} ({}): {verdict}", judgement.number, judgement.about);
        for [printed, derived] in &judgement.differences {
            let [printed, derived] = [printed, derived].map(written);
            say!("    printed {printed}, derived {derived}");
        }
        for slip in &judgement.slips {
            let why = match slip.why.as_str() {
                "" => String::new(),
                why => format!(": {why}"),
            };
            let verdict = slip.verdict.words();
            say!(
                "  `{}` for `{}`, {verdict}{why}",
                slip.printed,
                slip.derived
            );
        }
        if let Some(open) = &judgement.unexplained {
            say!("  not explained: {open}");
        }
    }
    let agree = judgements.iter().filter(|j| j.agrees);
    say!("{} of {} formulas agree", agree.count(), judgements.len());
    for remark in &errata.remark {
        say!("{}, not compared: {}", remark.number, remark.why);
    }
    all_explained(&judgements)
}

/// The derivation of a model from the sources that it carries.
fn derive(model: &dyn Model) -> Result<Derivation> {
    let (derivation, _) = generate(&sources(model)?)
        .map_err(|mistakes| Error::input(format!("the spec has mistakes\n\n{mistakes}")))?;
    Ok(derivation)
}

/// All sections of the derived operators in LaTeX, and printed formulas beside them.
pub fn formulas(model: &dyn Model, errata: Option<&Errata>) -> Result<Formulas> {
    let mut derivation = derive(model)?;
    let judged = errata.map(|errata| errata.judge(&mut derivation, Arrangement::Grouped));
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
        source: errata.map_or(String::new(), |errata| errata.source.clone()),
        errata: judged.transpose()?.unwrap_or_default(),
        remarks: errata.map_or(Vec::new(), |errata| errata.remark.clone()),
    })
}
