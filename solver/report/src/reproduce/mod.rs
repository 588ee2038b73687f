//! A study file worked through: figures, numbers beside the printed ones, a report.
//!
//! `study` (the file) → `task` (what is computed) → `outcome` (pictures, tables, numbers) →
//! `page` (HTML), lists (JSON). A task that is finished is kept beside the report, so that an
//! interrupted run goes on where it was.

mod claim;
mod errata;
mod feasible;
mod files;
mod keep;
mod ledger;
mod needs;
mod outcome;
mod page;
mod run;
mod sources;
mod study;
mod symbols;
mod table;
mod task;
mod workshop;

pub use claim::{Claim, Verdict};
pub use errata::{Errata, Judgement, Remark, all_explained};
pub use outcome::{Beside, Number, Outcome, Picture};
pub use page::Formulas;
pub use study::Study;
pub use table::Table;
pub use workshop::{Provenance, Workshop};
