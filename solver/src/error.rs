//! What can go wrong, in the user's words.

use thiserror::Error;

/// An error of the solver.
#[derive(Debug, Clone, Error)]
pub enum Error {
    /// A bad option, parameter or file: exit status 2.
    #[error("{0}")]
    Input(String),
    /// A computation that did not converge, or has no answer: exit status 3.
    #[error("{0}")]
    Computation(String),
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

    /// The process exit status that belongs to it.
    pub fn status(&self) -> u8 {
        match self {
            Error::Input(_) => 2,
            Error::Computation(_) => 3,
        }
    }
}

/// What fails with an [`Error`].
pub type Result<T> = std::result::Result<T, Error>;
