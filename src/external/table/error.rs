//! Why a file cannot be read as a table.

use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};

/// Why a file cannot be read as a table.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{}: {message}; {help}", path.display(), LinePlace(*line))]
pub struct TableError {
    /// The file.
    pub path: PathBuf,
    /// The line at fault, from 1, if it is one line of a text.
    pub line: Option<u64>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: String,
}

impl TableError {
    /// A line is wrong.
    pub(super) fn in_line(
        path: &Path,
        line: u64,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            line: Some(line),
            ..Self::in_file(path, message, help)
        }
    }

    /// The file is wrong.
    pub(super) fn in_file(
        path: &Path,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Self {
        Self {
            path: path.to_owned(),
            line: None,
            message: message.into(),
            help: help.into(),
        }
    }
}

/// The line behind the path of a file.
struct LinePlace(Option<u64>);

impl Display for LinePlace {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        match self.0 {
            Some(line) => write!(formatter, ":{line}"),
            None => Ok(()),
        }
    }
}

/// Most characters of a file that a message repeats.
const LONGEST_QUOTE: usize = 100;

/// What a file says, between quotation marks, fit for a message.
pub(super) fn quote(text: &str) -> String {
    match text.char_indices().nth(LONGEST_QUOTE) {
        Some((end, _)) => format!("{:?}...", &text[..end]),
        None => format!("{text:?}"),
    }
}

/// Most names that a message repeats.
const MOST_NAMES: usize = 20;

/// Names as a list, fit for a message.
pub(in crate::external) fn list<S: AsRef<str>>(names: &[S]) -> String {
    let shown: Vec<_> = names
        .iter()
        .take(MOST_NAMES)
        .map(|name| quote(name.as_ref()))
        .collect();
    match names.len().saturating_sub(MOST_NAMES) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// A number of things, such as `1 name` and `2 names`.
pub(super) fn count(number: usize, thing: &str) -> String {
    match (number, thing.strip_suffix('y')) {
        (1, _) => format!("1 {thing}"),
        (_, Some(stem)) => format!("{number} {stem}ies"),
        (_, None) => format!("{number} {thing}s"),
    }
}
