//! A study file worked through: figures, numbers beside the printed ones, a report.
//!
//! `study` (the file) → `task` (what is computed) → `outcome` (pictures, tables, numbers) →
//! `page` (HTML), lists (JSON). A task that is finished is kept beside the report, so that an
//! interrupted run goes on where it was.

mod errata;
mod outcome;
mod page;
mod run;
mod study;
mod symbols;
mod task;
mod workshop;

pub use errata::{Errata, Judgement, Remark, all_explained};
pub use outcome::{Claim, Number, Outcome, Picture, Table, Verdict};
pub use page::Formulas;
pub use study::Study;
pub use workshop::{Provenance, Workshop, beside};
