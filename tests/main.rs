//! The test families. Adding a case is adding a file (diagnostics, golden text) or a function.

mod amplitudes;
mod architecture;
mod command_line;
mod coverage;
mod defects;
mod derivatives;
mod diagnostics;
mod errata;
mod formulas;
mod fuzz;
mod golden;
mod identities;
mod latex;
mod layout;
mod limits;
mod orders;
mod published;
mod published_bed;
mod recipes;
mod reproduce;
mod statements;
mod support;
mod sweeps;
mod tutorial;
mod units;
mod waves;
