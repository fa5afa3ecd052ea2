//! Errors of the library as exceptions of Python.

use phase::document::LoadError;
use phase::refusal::Refusal;
use pyo3::prelude::*;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Why a request ends early: made on any thread, raised where Python is.
#[derive(Debug)]
pub(crate) struct Failure {
    message: String,
    is_refusal: bool,
    place: Place,
    help: Option<String>,
}

/// What the error is about.
#[derive(Debug, Default)]
struct Place {
    file: Option<PathBuf>,
    line: Option<usize>,
    column: Option<usize>,
}

impl Failure {
    /// The request was at fault, and nothing was begun.
    pub(crate) fn refused(error: impl Display) -> Self {
        Self {
            message: error.to_string(),
            is_refusal: true,
            place: Place::default(),
            help: None,
        }
    }

    /// Something failed.
    pub(crate) fn failed(error: impl Display) -> Self {
        Self {
            is_refusal: false,
            ..Self::refused(error)
        }
    }

    /// A file or the text of a dict is refused: the place is that of the first problem that has
    /// one.
    pub(crate) fn of_text(error: LoadError) -> Self {
        let refused = Self::refused(&error);
        let mut problems = match error {
            LoadError::Read { path, .. } => return refused.of(&path),
            LoadError::Invalid(problems) => problems,
        };
        let first = problems.iter().position(|it| it.spot.is_some());
        if problems.is_empty() {
            return refused;
        }
        let first = problems.swap_remove(first.unwrap_or(0));
        Self {
            place: Place {
                line: first.spot.as_ref().map(|it| it.line),
                column: first.spot.as_ref().map(|it| it.column),
                file: Some(first.path),
            },
            help: first.help,
            ..refused
        }
    }

    /// The same with what to do about it.
    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        let help = help.into();
        self.message = format!("{}; {help}", self.message);
        self.help = Some(help);
        self
    }

    /// The same of a file or folder.
    pub(crate) fn of(mut self, file: &Path) -> Self {
        self.place.file = Some(file.to_owned());
        self
    }
}

/// Errors of the library know whose fault they are.
impl<E: Refusal> From<E> for Failure {
    fn from(error: E) -> Self {
        match error.is_refusal() {
            true => Self::refused(error),
            false => Self::failed(error),
        }
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        Python::attach(|py| failure.exception(py).unwrap_or_else(|error| error))
    }
}

impl Failure {
    /// The exception of the package.
    fn exception(self, py: Python<'_>) -> PyResult<PyErr> {
        let name = match self.is_refusal {
            true => "RefusalError",
            false => "FailureError",
        };
        let Place { file, line, column } = self.place;
        let file = file.map(|it| it.display().to_string());
        let class = py.import("phase.errors")?.getattr(name)?;
        let exception = class.call1((self.message, file, line, column, self.help))?;
        Ok(PyErr::from_value(exception))
    }
}
