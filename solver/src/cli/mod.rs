//! The command line.
//!
//! Exit status 0: an answer. 2: bad input. 3: a computation without an answer.

/// Prints a line; a reader that has gone away is no error.
macro_rules! say {
    ($($argument:tt)*) => {{
        use std::io::Write;
        let _ = writeln!(std::io::stdout(), $($argument)*);
    }};
}

mod arguments;
mod inspect;
mod pattern;
mod picture;
mod report;
mod solve;

use crate::error::{Error, Result};
use crate::model::{Model, TapeModel};
use crate::study::Setup;
use arguments::{Arguments, Command, Common};
use clap::Parser;
use landau_codegen::build::read_sources;
use landau_codegen::diagnostic::nearest;
use std::path::Path;
use std::process::ExitCode;

/// Runs the command line for the models of a crate.
pub fn run(models: Vec<Box<dyn Model>>) -> ExitCode {
    // Parallelism is over points; a matrix belongs to one thread.
    faer::set_global_parallelism(faer::Par::Seq);
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // --help and --version are answers.
            let status = if error.use_stderr() { 2 } else { 0 };
            let _ = error.print();
            return ExitCode::from(status);
        }
    };
    match dispatch(&models, arguments.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(error.status())
        }
    }
}

fn dispatch(models: &[Box<dyn Model>], command: Command) -> Result<()> {
    match command {
        Command::Models { json } => inspect::models(models, json),
        Command::Check { file } => inspect::check(&file),
        Command::Explain {
            model,
            operator,
            format,
        } => with_model(models, &model, |model| {
            inspect::explain(model, operator, format)
        }),
        Command::Base {
            model,
            points,
            common,
        } => with_setup(models, &model, &common, |setup| {
            solve::base(setup, points, &common)
        }),
        Command::Spectrum { model, k, common } => with_setup(models, &model, &common, |setup| {
            solve::spectrum(setup, k, &common)
        }),
        Command::Point {
            model,
            k,
            order,
            common,
        } => with_setup(models, &model, &common, |setup| {
            solve::point(setup, k, order, &common)
        }),
        Command::Critical {
            model,
            options,
            common,
        } => with_setup(models, &model, &common, |setup| {
            solve::critical(setup, &options, &common)
        }),
        Command::Sweep {
            model,
            options,
            common,
        } => with_setup(models, &model, &common, |setup| {
            solve::sweep(setup, &options, &common)
        }),
        Command::Pattern {
            model,
            options,
            common,
        } => with_setup(models, &model, &common, |setup| {
            pattern::pattern(setup, &options, &common)
        }),
        Command::Verify { model, k, common } => with_setup(models, &model, &common, |setup| {
            solve::verify(setup, k, &common)
        }),
    }
}

/// A built model by name, or one run from the tape of its `.model` file.
fn with_model<R>(
    models: &[Box<dyn Model>],
    name: &str,
    action: impl FnOnce(&dyn Model) -> Result<R>,
) -> Result<R> {
    if let Some(model) = models.iter().find(|m| m.structure().name == name) {
        return action(model.as_ref());
    }
    let path = Path::new(name);
    if name.ends_with(".model") || path.is_file() {
        let sources =
            read_sources(path).map_err(|e| Error::input(format!("{name} cannot be read: {e}")))?;
        let model = TapeModel::new(&sources)
            .map_err(|mistakes| Error::input(format!("the spec has mistakes\n\n{mistakes}")))?;
        return action(&model);
    }
    let names: Vec<&str> = models.iter().map(|m| m.structure().name.as_str()).collect();
    let near = nearest(name, names.iter().copied())
        .map_or(String::new(), |n| format!("; did you mean `{n}`?"));
    Err(Error::input(format!(
        "there is no model `{name}`: built are {}; the path of a .model file is accepted too{near}",
        names.join(", ")
    )))
}

fn with_setup<R>(
    models: &[Box<dyn Model>],
    name: &str,
    common: &Common,
    action: impl FnOnce(&Setup) -> Result<R>,
) -> Result<R> {
    with_model(models, name, |model| {
        let structure = model.structure();
        if !(4..=1000).contains(&common.resolution) {
            return Err(Error::input(format!(
                "-M {} is out of range: -M accepts 4 to 1000",
                common.resolution
            )));
        }
        let mut setup = Setup::new(model, common.resolution);
        for assignment in &common.set {
            let (name, value) = assignment.split_once('=').ok_or_else(|| {
                Error::input(format!("--set {assignment}: --set accepts NAME=VALUE"))
            })?;
            setup
                .parameters
                .set_text(structure, name.trim(), value.trim())?;
        }
        action(&setup)
    })
}
