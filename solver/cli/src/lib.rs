//! The command line.
//!
//! Exit status 0: an answer. 2: bad input. 3: a computation without an answer.

#![warn(missing_docs)]

#[macro_use]
mod terminal;

mod arguments;
mod asked;
mod cluster;
mod inspect;
mod interrupt;
mod outputs;
mod pattern;
mod picture;
mod progress;
mod reproduce;
mod script;
mod solve;
mod values;

use arguments::{Arguments, Command, Common};
use clap::Parser;
use landau_report::library::Library;
use landau_solver::error::Result;
use landau_solver::file::Overwrite;
use landau_solver::model::Model;
use landau_solver::study::Setup;
use std::process::ExitCode;
use std::sync::Arc;
use values::joined_numbers;

/// Runs the command line for the models of a crate.
pub fn run(models: Vec<Arc<dyn Model>>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(joined_numbers(std::env::args_os())) {
        Ok(arguments) => arguments,
        Err(error) => {
            // --help and --version are answers.
            let status = if error.use_stderr() { 2 } else { 0 };
            let printed = error.print();
            if status == 2 {
                return ExitCode::from(status);
            }
            terminal::remember(printed);
            return ended(terminal::finish());
        }
    };
    ended(dispatch(&Library { models }, arguments.command).and_then(|()| terminal::finish()))
}

fn ended(outcome: Result<()>) -> ExitCode {
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            note!("error: {error}");
            ExitCode::from(error.status())
        }
    }
}

/// Refuses results that would replace what a command reads.
fn check_inputs(library: &Library, command: &Command) -> Result<()> {
    let results = command.results();
    match command {
        Command::Merge { options } => {
            // The table has a message for itself.
            outputs::check_inputs(&results[1..], &options.shards)
        }
        _ => match command.model() {
            Some(model) => outputs::check_inputs(&results, &library.inputs(model)),
            None => Ok(()),
        },
    }
}

fn dispatch(library: &Library, command: Command) -> Result<()> {
    check_inputs(library, &command)?;
    match command {
        Command::Models { json } => inspect::models(&library.models, json),
        Command::Check { file } => inspect::check(library, &file),
        Command::Explain {
            model,
            operator,
            format,
            against,
        } => {
            let model = library.model(&model)?;
            match &against {
                Some(file) => inspect::explain_against(model.as_ref(), file, format),
                None => inspect::explain(model.as_ref(), operator, format),
            }
        }
        Command::Base {
            model,
            points,
            files,
            common,
        } => {
            let setup = &setup(library, &model, &common)?;
            solve::base(setup, points, &files, &common)
        }
        Command::Spectrum {
            model,
            k,
            files,
            common,
        } => {
            let setup = &setup(library, &model, &common)?;
            solve::spectrum(setup, k, &files, &common)
        }
        Command::Point {
            model,
            k,
            order,
            files,
            mode,
            common,
        } => {
            let setup = &setup(library, &model, &common)?;
            picture::modes(setup, k, &files, &mode)?;
            solve::point(setup, k, order, &mode, &common)
        }
        Command::Amplitudes {
            model,
            modes,
            order,
            common,
        } => {
            let setup = &setup(library, &model, &common)?;
            solve::amplitudes(setup, &modes, order, &common)
        }
        Command::Critical {
            model,
            options,
            mode,
            common,
        } => {
            let setup = &setup(library, &model, &common)?;
            solve::critical(setup, &options, &mode, &common)
        }
        Command::Sweep {
            model,
            options,
            mode,
            common,
        } => {
            let setup = &setup(library, &model, &common)?;
            solve::sweep(setup, &options, &mode, &common)
        }
        Command::Merge { options } => cluster::merge(&options),
        Command::Pattern {
            model,
            options,
            mode,
            common,
        } => {
            let setup = &setup(library, &model, &common)?;
            pattern::pattern(setup, &options, &mode, &common)
        }
        Command::Reproduce {
            study,
            out,
            shard,
            force,
            json,
        } => {
            let overwrite = Overwrite::forced(force);
            reproduce::reproduce(
                library,
                study.as_deref(),
                &out,
                shard.as_deref(),
                overwrite,
                json,
            )
        }
        Command::Verify {
            model,
            k,
            order,
            mode,
            common,
        } => {
            let setup = &setup(library, &model, &common)?;
            solve::verify(setup, k, order, &mode, &common)
        }
    }
}

/// A model with the parameters and the resolution that are asked for.
fn setup(library: &Library, name: &str, common: &Common) -> Result<Setup> {
    let model = library.model(name)?;
    let mut setup = Setup::new(model, common.resolution)?;
    setup.set(&common.set)?;
    Ok(setup)
}
