//! What can go wrong, in the user's words: each kind with its advice.

use crate::model::C64;
use thiserror::Error;

/// An error of the solver.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// A bad option, parameter or file: exit status 2.
    #[error("{0}")]
    Input(String),

    /// No base state was found.
    #[error(
        "{spec}: Newton's method for the base state failed {trouble} at {parameters}; try parameters nearer the defaults, or \
         another `guess`"
    )]
    BaseState {
        /// Where the spec speaks of it.
        spec: String,
        /// Where, and how.
        trouble: String,
        /// With their values.
        parameters: String,
    },

    /// A coefficient has no value at the base state.
    #[error(
        "a coefficient of the balance `{balance}` is not finite at {coordinate} = {place}: a law is singular at the \
         base state there"
    )]
    Singular {
        /// Its name.
        balance: String,
        /// The name of the cross-stream coordinate.
        coordinate: String,
        /// Its value.
        place: f64,
    },

    /// A mode could not be followed.
    #[error(
        "the mode was lost at k = {k}: none has its shape (best overlap {overlap:.2}); try smaller steps"
    )]
    Lost {
        /// The wavenumber.
        k: f64,
        /// |cosine| of the angle to the nearest shape.
        overlap: f64,
    },

    /// An eigenvalue has no mode of its own.
    #[error(
        "the eigenvalue {c:.6e} at k = {k} is not simple: another one lies {gap:.1e} from it, so that no single mode \
         has an amplitude equation of its own; break the symmetry that makes them equal, or name another mode with \
         --near"
    )]
    NotSimple {
        /// The eigenvalue.
        c: C64,
        /// The wavenumber.
        k: f64,
        /// The distance to the next one.
        gap: f64,
    },

    /// Inverse iteration does not settle on an eigenvalue.
    #[error(
        "the eigenvalue {c:.6e} at k = {k} was not confirmed by inverse iteration, the next one being {gap:.1e} away; \
         {advice}"
    )]
    Unconfirmed {
        /// The eigenvalue.
        c: C64,
        /// The wavenumber.
        k: f64,
        /// The distance to the next one.
        gap: f64,
        /// What it may be, and what to try.
        advice: &'static str,
    },

    /// A coefficient, root or eigenvalue that another collocation moves too far.
    #[error("{what} is not converged{}: {how_far}; try {advice}", at_resolution(*resolution))]
    Unresolved {
        /// `c2`, or what else.
        what: String,
        /// M, where there is one.
        resolution: Option<usize>,
        /// How large the error is.
        how_far: String,
        /// What to try.
        advice: String,
    },

    /// A problem of the expansion meets a mode, exactly or nearly.
    #[error("{}", resonance(of, *q, modes, *distance))]
    Resonance {
        /// The coefficient that it is the problem of.
        of: String,
        /// The wavenumber of the mode that is met.
        q: f64,
        /// Those of the modes that have amplitudes.
        modes: Vec<f64>,
        /// How far the mode is; nothing where the problem is singular.
        distance: Option<f64>,
    },

    /// A problem at k = 0 leaves a mean open, exactly or nearly.
    #[error("{}", open_mean(of, *distance))]
    OpenMean {
        /// The coefficient that it is the problem of.
        of: String,
        /// How far an eigenvalue is; nothing where the problem is singular.
        distance: Option<f64>,
    },

    /// A multiplier that has to vanish does not: a mean is not kept beyond first order.
    #[error("{}", not_kept(closure, *order, *relative))]
    NotKept {
        /// The closure, in words.
        closure: String,
        /// Degree in the amplitudes.
        order: usize,
        /// The multiplier's part of the terms beside it.
        relative: f64,
    },

    /// A quantity does not do what is asked of it in an interval.
    #[error("{0}")]
    NoCriticalPoint(String),

    /// Parts of a certificate that do not hold.
    #[error("the certificate does not hold: {}", .0.join("; "))]
    Certificate(Vec<String>),

    /// Another computation without an answer.
    #[error("{0}")]
    Computation(String),
}

fn at_resolution(resolution: Option<usize>) -> String {
    resolution.map_or(String::new(), |m| format!(" at M = {m}"))
}

fn resonance(of: &str, q: f64, modes: &[f64], distance: Option<f64>) -> String {
    let all = modes.iter().chain([&q]);
    let named: Vec<String> = all.map(|k| format!("--mode k={k}")).collect();
    let how = match distance {
        None => "singular".to_owned(),
        Some(distance) => format!("nearly singular ({distance:.1e} from an eigenvalue)"),
    };
    format!(
        "the problem for {of} is {how}, a resonance with a mode at k = {q}: try a wavenumber beside this one, or give \
         that mode an amplitude of its own: `landau amplitudes` with {}",
        named.join(" ")
    )
}

fn not_kept(closure: &str, order: usize, relative: f64) -> String {
    let advice = match closure.strip_prefix("gauge ") {
        Some(field) => format!(
            "the constant of `{field}` is free to first order alone, and the balance that it stands for has a mean \
             source; leave that gauge out of the block `mean`, or mend the balance"
        ),
        None => "the balances do not keep this integral beyond first order; name the density that they keep in the \
                 block `mean`, its products included, such as `conserved integral(rho*u)` in place of \
                 `conserved integral(u)`"
            .to_owned(),
    };
    format!(
        "the multiplier of `{closure}` does not vanish at order {order} in the amplitude, where it is {relative:.1e} of \
         the terms beside it: {advice}"
    )
}

fn open_mean(of: &str, distance: Option<f64>) -> String {
    let accepts = "the block `mean` accepts `gauge` for a field that is determined up to a constant and `conserved` for \
                   an integral that does not change";
    match distance {
        None => format!("the problem for {of} is singular, a mean is left open: {accepts}"),
        Some(distance) => format!(
            "the problem for {of} is nearly singular: an eigenvalue of the mean problem lies {distance:.1e} from 2 a0. \
             Does the model conserve an integral, or leave the constant of a field open, that the spec does not name? \
             ({accepts})"
        ),
    }
}

impl Error {
    /// A bad option, parameter or file.
    pub fn input(message: impl Into<String>) -> Self {
        Error::Input(message.into())
    }

    /// A computation without an answer.
    pub fn computation(message: impl Into<String>) -> Self {
        Error::Computation(message.into())
    }

    /// Something that another M moves by a good part of its size.
    pub fn unresolved(
        what: impl Into<String>,
        resolution: Option<usize>,
        how_far: impl Into<String>,
    ) -> Self {
        Error::Unresolved {
            what: what.into(),
            resolution,
            how_far: how_far.into(),
            advice: match resolution {
                None => "parameters off this place".to_owned(),
                Some(m) => format!("a larger M, such as -M {}", 2 * m),
            },
        }
    }

    /// The process exit status that belongs to it.
    pub fn status(&self) -> u8 {
        match self {
            Error::Input(_) => 2,
            _ => 3,
        }
    }

    /// The kind in one word, for other languages.
    pub fn kind(&self) -> &'static str {
        match self {
            Error::Input(_) => "input",
            Error::BaseState { .. } => "base_state",
            Error::Singular { .. } => "singular",
            Error::Lost { .. } => "lost",
            Error::NotSimple { .. } => "not_simple",
            Error::Unconfirmed { .. } => "unconfirmed",
            Error::Unresolved { .. } => "unresolved",
            Error::Resonance { .. } => "resonance",
            Error::OpenMean { .. } => "open_mean",
            Error::NotKept { .. } => "not_kept",
            Error::NoCriticalPoint(_) => "no_critical_point",
            Error::Certificate(_) => "certificate",
            Error::Computation(_) => "computation",
        }
    }
}

/// What fails with an [`Error`].
pub type Result<T> = std::result::Result<T, Error>;
