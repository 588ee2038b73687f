//! Commands and options.

use clap::{Args, Parser, Subcommand, ValueEnum};
use landau_solver::model::C64;
use landau_solver::study::amplitudes::ModeChoice;
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
        common: Common,
    },
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
    /// Which mode: the one nearest to this eigenvalue; the leading one by default.
    #[arg(long, value_name = "RE[:IM]", value_parser = near, allow_hyphen_values = true)]
    pub near: Option<C64>,
    /// Print one JSON object alone on standard output.
    #[arg(long)]
    pub json: bool,
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

/// An eigenvalue, `RE[:IM]`; a comma is accepted in the place of the colon.
fn near(text: &str) -> Result<C64, String> {
    let number = |part: &str| {
        let value = part.trim().parse::<f64>().ok().filter(|v| v.is_finite());
        value.ok_or_else(|| format!("`{part}` is not a number; near accepts RE or RE:IM"))
    };
    match text.split_once([':', ',']) {
        Some((re, im)) => Ok(C64::new(number(re)?, number(im)?)),
        None => Ok(C64::new(number(text)?, 0.0)),
    }
}

/// `k=K[,near=RE[:IM]]`
fn mode(text: &str) -> Result<ModeChoice, String> {
    let wrong =
        |part: &str| format!("`{part}` is no part of a mode; --mode accepts k=K[,near=RE[:IM]]");
    let twice =
        |key: &str| format!("`{text}` names {key} twice; --mode accepts k=K[,near=RE[:IM]]");
    let (mut k, mut target) = (None, None);
    let mut parts = text.split(',').peekable();
    while let Some(part) = parts.next() {
        match part.trim().split_once('=') {
            Some(("k", value)) => {
                let value = value.trim().parse::<f64>().ok().filter(|v| v.is_finite());
                let value = value.ok_or_else(|| wrong(part))?;
                if k.replace(value).is_some() {
                    return Err(twice("k"));
                }
            }
            Some(("near", re)) => {
                // The comma of RE,IM separates parts of a mode too: a part without a name is IM.
                let im = parts.next_if(|next| !next.contains('='));
                let value = im.map_or(re.to_owned(), |im| format!("{re},{im}"));
                if target.replace(near(&value)?).is_some() {
                    return Err(twice("near"));
                }
            }
            _ => return Err(wrong(part)),
        }
    }
    let k =
        k.ok_or_else(|| format!("`{text}` has no wavenumber; --mode accepts k=K[,near=RE[:IM]]"))?;
    Ok(ModeChoice { k, near: target })
}

/// `NAME=A:B` or `NAME=A:B:N`
pub fn range(option: &str, text: &str, parts: usize) -> Result<(String, Vec<f64>), String> {
    let expected = if parts == 3 {
        "NAME=FROM:TO:COUNT"
    } else {
        "k=A:B"
    };
    let wrong = || format!("{option} {text}: {option} accepts {expected}");
    let (name, numbers) = text.split_once('=').ok_or_else(wrong)?;
    let numbers: Vec<f64> = numbers
        .split(':')
        .map(|n| n.trim().parse::<f64>())
        .collect::<Result<_, _>>()
        .map_err(|_| wrong())?;
    if numbers.len() != parts || numbers.iter().any(|n| !n.is_finite()) {
        return Err(wrong());
    }
    Ok((name.trim().to_owned(), numbers))
}

#[cfg(test)]
mod tests {
    use super::{mode, near};
    use landau_solver::model::C64;

    /// Both spellings of an eigenvalue, in both places.
    #[test]
    fn an_eigenvalue_has_two_spellings() {
        let expected = C64::new(-0.5, 2.0);
        for text in ["-0.5:2", "-0.5,2", " -0.5 : 2 "] {
            assert_eq!(near(text), Ok(expected), "{text}");
            for order in [format!("k=3,near={text}"), format!("near={text},k=3")] {
                let choice = mode(&order).expect("a mode");
                assert_eq!((choice.k, choice.near), (3.0, Some(expected)), "{order}");
            }
        }
        assert_eq!(near("0.1"), Ok(C64::new(0.1, 0.0)));
        let refused = "`x` is not a number; near accepts RE or RE:IM";
        for text in ["x", "1:x", "1,x"] {
            assert_eq!(near(text), Err(refused.to_owned()), "{text}");
        }
        for (text, words) in [
            ("k=1,k=2", "`k=1,k=2` names k twice"),
            ("k=1,near=1,near=2", "names near twice"),
            ("near=1", "has no wavenumber"),
            ("k=1,2", "`2` is no part of a mode"),
        ] {
            let message = mode(text).map(|_| ()).expect_err(text);
            assert!(message.contains(words), "{message}");
        }
    }
}
