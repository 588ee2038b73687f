//! Commands and options.

use crate::values::{beside, mode, near};
use clap::{Args, Parser, Subcommand, ValueEnum};
use landau_report::data::csvw::path_beside;
use landau_solver::model::C64;
use landau_solver::study::amplitudes::ModeChoice;
use landau_solver::study::journal_path;
use std::path::PathBuf;

/// From balance equations to amplitude equations.
#[derive(Parser)]
#[command(name = "landau", version, about, max_term_width = 100)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// List the models that are built in.
    Models {
        /// Print one JSON array.
        #[arg(long)]
        json: bool,
    },
    /// Diagnose a spec without building it.
    #[command(after_help = "Example: landau check my.model")]
    Check { file: PathBuf },
    /// Print the derived operators.
    #[command(
        after_help = "Examples:\n  landau explain my.model --operator adjoint\n  landau explain my.model --format latex\n  landau explain my.model --against errata/mine.toml"
    )]
    Explain {
        /// A built model, or the path of a .model file.
        model: String,
        /// Which operator; all of them by default.
        #[arg(long, value_enum, ignore_case = true)]
        operator: Option<OperatorName>,
        #[arg(long, value_enum, default_value = "text")]
        format: Format,
        /// Compare the printed formulas of this file with the derivation, term by term.
        #[arg(long, value_name = "FILE", conflicts_with = "operator")]
        against: Option<PathBuf>,
    },
    /// Solve for the base state and print its profiles.
    #[command(
        after_help = "Examples:\n  landau base my.model --set S=400 --set H=auto --points 21\n  landau base my.model --points 401 --plot base.svg --out base.nc"
    )]
    Base {
        /// A built model, or the path of a .model file.
        model: String,
        /// Number of heights to print, evenly spaced.
        #[arg(long, default_value_t = 41)]
        points: usize,
        #[command(flatten)]
        files: Files,
        #[command(flatten)]
        common: Common,
    },
    /// Direct and adjoint eigenvalues at one wavenumber.
    #[command(
        after_help = "Examples:\n  landau spectrum my.model --k 0.16 -M 100\n  landau spectrum my.model --k 0.16 --plot spectrum.svg --out spectrum.npz"
    )]
    Spectrum {
        /// A built model, or the path of a .model file.
        model: String,
        /// Wavenumber; the model's typical one by default.
        #[arg(long, allow_negative_numbers = true)]
        k: Option<f64>,
        #[command(flatten)]
        files: Files,
        #[command(flatten)]
        common: Common,
    },
    /// Landau coefficients, kind of bifurcation, amplitude, error, resonances at one wavenumber.
    #[command(
        after_help = "Example: landau point my.model --k 0.16\n         landau point my.model --k 1 --set r=0.1 --json\n         landau point my.model --k 0.16 --order 7\n         landau point my.model --k 0.16 --plot modes.svg --out modes.npz"
    )]
    Point {
        /// A built model, or the path of a .model file.
        model: String,
        /// Wavenumber; the model's typical one by default.
        #[arg(long, allow_negative_numbers = true)]
        k: Option<f64>,
        /// Order of the expansion: 3 gives c2, 5 c4, and so on.
        #[arg(long, default_value_t = 3)]
        order: usize,
        #[command(flatten)]
        files: Files,
        #[command(flatten)]
        mode: OfMode,
        #[command(flatten)]
        common: Common,
    },
    /// Amplitude equations of several modes: coefficients, equilibria with their stability, certificate.
    #[command(
        after_help = "Examples:\n  landau amplitudes my.model --mode k=0.054 --mode k=0.108\n  landau amplitudes my.model --mode k=1 --mode k=-1 --order 5\n  landau amplitudes my.model --mode k=1,near=0 --mode k=1,near=0:2 --json\n\nWaves to the right and to the left are modes at k and −k."
    )]
    Amplitudes {
        /// A built model, or the path of a .model file.
        model: String,
        /// A mode with an amplitude of its own (repeatable): its wavenumber, and where it is not the leading one the
        /// eigenvalue that it is near to.
        #[arg(long = "mode", value_name = "k=K[,near=RE[:IM]]", required = true, value_parser = mode)]
        modes: Vec<ModeChoice>,
        /// Order of the expansion.
        #[arg(long, default_value_t = 3)]
        order: usize,
        #[command(flatten)]
        common: Common,
    },
    /// Where growth or c2 changes sign, or c2 jumps through infinity.
    #[command(
        after_help = "Examples:\n  landau critical my.model --vary k --from 0.1 --to 0.2\n  landau critical my.model --vary k --from 0.06 --to 0.1 --of c2\n  landau critical my.model --vary S --from 50 --to 100 --k 0.16\n  landau critical my.model --vary R --from 5000 --to 6500 --minimize k=0.9:1.1\n  landau critical my.model --vary k --from 0.1 --to 0.2 --plot growth.svg"
    )]
    Critical {
        /// A built model, or the path of a .model file.
        model: String,
        #[command(flatten)]
        options: CriticalOptions,
        #[command(flatten)]
        mode: OfMode,
        #[command(flatten)]
        common: Common,
    },
    /// Landau points over ranges of k and parameters, as CSV; resumes where it was interrupted.
    #[command(
        after_help = "Examples:\n  landau sweep my.model --over k=0.03:0.18:151 --follow --out figure6.csv --plot figure6.svg\n  landau sweep my.model --over S=50:800:16 --set H=auto --k 0.16 --out figure11.csv\n  landau sweep my.model --over k=0.03:0.18:151 --over S=50:800:300 --out atlas.csv.shard-3 --shard 3/16\n  landau sweep my.model --over k=0.03:0.18:151 --over S=50:800:300 --out atlas.csv --emit slurm --tasks 64"
    )]
    Sweep {
        /// A built model, or the path of a .model file.
        model: String,
        #[command(flatten)]
        options: SweepOptions,
        #[command(flatten)]
        mode: OfMode,
        #[command(flatten)]
        common: Common,
    },
    /// Put the shares of a sweep together: the table that one machine would have written, byte for byte.
    #[command(after_help = "Example: landau merge atlas.csv.shard-* --out atlas.csv")]
    Merge {
        #[command(flatten)]
        options: MergeOptions,
    },
    /// The fields over the (x, y)-plane, as pictures and as data.
    #[command(
        after_help = "Examples:\n  landau pattern my.model --k 0.16 --out pattern.svg --out pattern.npz\n  landau pattern my.model --k 0.16 --amplitude 0.1 --shade T --arrows u,v --out pattern.vtk\n  landau pattern my.model --k 3 --shade \"1 - y + theta\" --perturbation --out heat.svg"
    )]
    Pattern {
        /// A built model, or the path of a .model file.
        model: String,
        #[command(flatten)]
        options: PatternOptions,
        #[command(flatten)]
        mode: OfMode,
        #[command(flatten)]
        common: Common,
    },
    /// Work through a study file: figures, numbers beside the printed ones, a report in HTML.
    #[command(
        after_help = "Examples:\n  landau reproduce --out report\n  landau reproduce my/studies/mine.toml --out report\n  landau reproduce --out report --shard 1/8\n\nWithout a file, the only one in a folder `studies` here or one level below is taken.\nAn interrupted run goes on with the task where it was."
    )]
    Reproduce {
        /// A study file.
        study: Option<PathBuf>,
        /// The folder of the report; finished tasks are kept beside it, in a folder with `.kept` at its end.
        #[arg(long, default_value = "report")]
        out: PathBuf,
        /// Compute one share of the tasks and keep them, for the same command without it to put together; `slurm` takes
        /// that of the task of a job array.
        #[arg(long, value_name = "I/N")]
        shard: Option<String>,
        /// Replace files of the report that were changed since, or that it did not write.
        #[arg(long)]
        force: bool,
        /// Print one JSON object alone on standard output.
        #[arg(long)]
        json: bool,
    },
    /// Print the certificate of a model; fails when it does not hold.
    #[command(
        after_help = "Examples:\n  landau verify my.model --k 0.16\n  landau verify my.model --k 0.16 --order 7"
    )]
    Verify {
        /// A built model, or the path of a .model file.
        model: String,
        /// Wavenumber; the model's typical one by default.
        #[arg(long, allow_negative_numbers = true)]
        k: Option<f64>,
        /// Order of the expansion whose defect is looked at.
        #[arg(long, default_value_t = 3)]
        order: usize,
        #[command(flatten)]
        mode: OfMode,
        #[command(flatten)]
        common: Common,
    },
}

impl Command {
    /// The model that is asked for, where a command that writes files takes one.
    pub fn model(&self) -> Option<&str> {
        match self {
            Command::Base { model, .. }
            | Command::Spectrum { model, .. }
            | Command::Point { model, .. }
            | Command::Critical { model, .. }
            | Command::Sweep { model, .. }
            | Command::Pattern { model, .. } => Some(model),
            _ => None,
        }
    }

    /// Every file that the command may write, but for the files in the folder of a report.
    pub fn results(&self) -> Vec<PathBuf> {
        match self {
            Command::Base { files, .. }
            | Command::Spectrum { files, .. }
            | Command::Point { files, .. } => {
                files.plot.iter().chain(&files.out).cloned().collect()
            }
            Command::Critical { options, .. } => options.plot.iter().cloned().collect(),
            Command::Pattern { options, .. } => options.out.clone(),
            Command::Merge { options } => vec![options.out.clone(), path_beside(&options.out)],
            Command::Sweep { options, .. } => {
                let out = &options.out;
                let mut paths = vec![out.clone(), path_beside(out), journal_path(out)];
                paths
                    .extend([Engine::Hq, Engine::Slurm].map(|engine| beside(out, engine.ending())));
                paths.extend(options.plot.iter().cloned());
                paths
            }
            _ => Vec::new(),
        }
    }
}

/// Options that every computation takes.
#[derive(Args)]
pub struct Common {
    /// Set a parameter (repeatable): a number, the name of a choice, or `auto`.
    #[arg(long, value_name = "NAME=VALUE")]
    pub set: Vec<String>,
    /// Chebyshev resolution M.
    #[arg(short = 'M', default_value_t = 50)]
    pub resolution: usize,
    /// Print one JSON object alone on standard output.
    #[arg(long)]
    pub json: bool,
}

/// An option of every computation that is about one mode.
#[derive(Args)]
pub struct OfMode {
    /// Which mode: the one nearest to this eigenvalue; the leading one by default.
    #[arg(long, value_name = "RE[:IM]", value_parser = near, allow_hyphen_values = true)]
    pub near: Option<C64>,
}

#[derive(Args)]
pub struct CriticalOptions {
    /// `k` or a parameter.
    #[arg(long, value_name = "NAME")]
    pub vary: String,
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    pub from: f64,
    #[arg(long, value_name = "B", allow_negative_numbers = true)]
    pub to: f64,
    /// What changes sign.
    #[arg(long, value_enum, default_value = "growth")]
    pub of: Of,
    /// The fixed wavenumber, when a parameter varies.
    #[arg(long, allow_negative_numbers = true)]
    pub k: Option<f64>,
    /// The extremum over a range of k.
    #[arg(long, value_name = "k=A:B")]
    pub minimize: Option<String>,
    /// Follow one mode by its shape: the one that grows fastest on the axis, or with --near the one named there; by
    /// default every place has its leading mode.
    #[arg(long)]
    pub follow: bool,
    /// A picture of the quantity over the range, and where it vanishes; with --minimize, of the growth rate over k.
    #[arg(long, value_name = "FILE.svg|png")]
    pub plot: Option<PathBuf>,
    /// Replace a picture that Landau did not write.
    #[arg(long)]
    pub force: bool,
}

/// Where an answer goes besides the screen.
#[derive(Args)]
pub struct Files {
    /// A picture: profiles of the base state, eigenvalues in the complex plane, modes with the adjoint one.
    #[arg(long, value_name = "FILE.svg|png")]
    pub plot: Option<PathBuf>,
    /// The same as data (repeatable).
    #[arg(long, value_name = "FILE.npz|nc")]
    pub out: Vec<PathBuf>,
    /// Replace files that Landau did not write, or that were changed since.
    #[arg(long)]
    pub force: bool,
}

#[derive(Args)]
pub struct SweepOptions {
    /// A range of k or of a parameter (repeatable; the first varies fastest).
    #[arg(long, value_name = "NAME=FROM:TO:COUNT", required = true)]
    pub over: Vec<String>,
    /// The fixed wavenumber, when no range varies k.
    #[arg(long, allow_negative_numbers = true)]
    pub k: Option<f64>,
    /// Follow one mode along the first axis, from where the leading growth rate is largest (or from the mode of --near).
    /// Without it each row holds the leading mode of its place.
    #[arg(long)]
    pub follow: bool,
    /// Where the table goes.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Replace files that are no table of this sweep, no journal of it, no picture that Landau wrote.
    #[arg(long)]
    pub force: bool,
    /// A picture of growth rate, c2 and amplitude over the first axis.
    #[arg(long, value_name = "FILE.svg|png")]
    pub plot: Option<PathBuf>,
    /// A further column (repeatable): an output of the model by name, at the equilibrium amplitude; or an expression in
    /// the base state, as `S*T at upper`, `T at lower`, `integral(n)`.
    #[arg(long, value_name = "COLUMN")]
    pub column: Vec<String>,
    /// Compute one share of the sweep into a file of its own, to be merged; `slurm` takes that of the task of a job array.
    #[arg(long, value_name = "I/N", conflicts_with_all = ["plot", "emit"])]
    pub shard: Option<String>,
    /// Write a script or job file that runs the sweep in shares, instead of running it.
    #[arg(long, value_enum, conflicts_with = "plot")]
    pub emit: Option<Engine>,
    /// Number of shares, with --emit.
    #[arg(long, default_value_t = 16, value_name = "N", requires = "emit")]
    pub tasks: usize,
    /// Cores of a share, with --emit.
    #[arg(long, default_value_t = 4, value_name = "N", requires = "emit")]
    pub cpus: usize,
}

/// What runs the shares of a sweep.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Engine {
    Hq,
    Slurm,
}

impl Engine {
    /// How the name of the file ends that an engine is given.
    pub fn ending(self) -> &'static str {
        match self {
            Engine::Hq => ".hq.toml",
            Engine::Slurm => ".slurm.sh",
        }
    }
}

#[derive(Args)]
pub struct MergeOptions {
    /// The files of all shares.
    #[arg(required = true, value_name = "SHARD")]
    pub shards: Vec<PathBuf>,
    /// Where the table goes.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// Replace a file that is no table of this sweep.
    #[arg(long)]
    pub force: bool,
}

#[derive(Args)]
pub struct PatternOptions {
    /// Wavenumber; the model's typical one by default.
    #[arg(long, allow_negative_numbers = true)]
    pub k: Option<f64>,
    /// A; the equilibrium amplitude by default.
    #[arg(long, value_name = "A", allow_negative_numbers = true)]
    pub amplitude: Option<f64>,
    /// Wavelengths along x.
    #[arg(long, default_value_t = 2.0)]
    pub wavelengths: f64,
    /// Points along x and y.
    #[arg(long, value_name = "NXxNY", default_value = "161x81")]
    pub points: String,
    /// What is shaded, a field or any expression of the spec language; the first field by default.
    #[arg(long, value_name = "EXPRESSION", allow_hyphen_values = true)]
    pub shade: Option<String>,
    /// Draw the perturbation alone, without the base state.
    #[arg(long)]
    pub perturbation: bool,
    /// The fields that are drawn as arrows, along and across; none by default.
    #[arg(long, value_name = "FIELD,FIELD")]
    pub arrows: Option<String>,
    /// Where it goes (repeatable): .svg and .png are pictures, .npz, .nc and .vtk are data.
    #[arg(long, value_name = "FILE", required = true)]
    pub out: Vec<PathBuf>,
    /// Replace files that Landau did not write, or that were changed since.
    #[arg(long)]
    pub force: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OperatorName {
    Base,
    #[value(name = "L")]
    Linear,
    Adjoint,
    #[value(name = "N2")]
    N2,
    #[value(name = "N3")]
    N3,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    Text,
    Latex,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Of {
    Growth,
    C2,
    Resonance,
}
