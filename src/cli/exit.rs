//! How the program ends.

use phase::refusal::Refusal;
use std::fmt::Display;
use std::path::Path;
use std::process::ExitCode;

/// Exit codes. Scripts rely on them, and `phase --help` lists them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    Done = 0,
    /// Something failed: a job, the disk, a file.
    Failed = 1,
    /// Refused before anything was done.
    Refused = 2,
    /// Stopped by a signal.
    Interrupted = 130,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// Why a command ends early.
#[derive(Debug)]
pub(crate) struct Failure {
    pub(crate) exit: Exit,
    pub(crate) message: String,
}

impl Failure {
    /// Something failed.
    pub(crate) fn failed(error: impl Display) -> Self {
        Self {
            exit: Exit::Failed,
            message: error.to_string(),
        }
    }

    /// The same failure, of a file or folder.
    pub(crate) fn at(self, path: impl AsRef<Path>) -> Self {
        Self {
            message: format!("{}: {}", path.as_ref().display(), self.message),
            ..self
        }
    }

    /// The command cannot begin.
    pub(crate) fn refused(error: impl Display) -> Self {
        Self {
            exit: Exit::Refused,
            message: error.to_string(),
        }
    }
}

impl<E: Refusal> From<E> for Failure {
    fn from(error: E) -> Self {
        match error.is_refusal() {
            true => Self::refused(error),
            false => Self::failed(error),
        }
    }
}
