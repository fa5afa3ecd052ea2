//! Errors that show the line of the file they are about.

use std::fmt::{Display, Formatter, Result};
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// Why a scene file or sweep file is refused.
///
/// The text has several lines: for each problem the message, file, line and column, the line
/// itself with a caret, and what to do. It is meant to follow the word `error: `; all problems
/// but the first bring their own.
#[derive(Debug)]
pub enum LoadError {
    /// The file cannot be read.
    Read {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The file has errors.
    Invalid(Vec<LocatedProblem>),
}

crate::refusal::always!(true: LoadError);

impl Display for LoadError {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        match self {
            Self::Read { path, source } => {
                let advice = match source.kind() {
                    io::ErrorKind::NotFound => "; check the path",
                    io::ErrorKind::InvalidData => "; save the file as UTF-8 text",
                    _ => "",
                };
                write!(
                    formatter,
                    "cannot read {}: {source}{advice}",
                    path.display()
                )
            }
            Self::Invalid(findings) => {
                for (index, finding) in findings.iter().enumerate() {
                    let start = if index == 0 { "" } else { "\n\nerror: " };
                    write!(formatter, "{start}{finding}")?;
                }
                Ok(())
            }
        }
    }
}

impl std::error::Error for LoadError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Read { source, .. } => Some(source),
            Self::Invalid(_) => None,
        }
    }
}

/// One problem and its place in the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LocatedProblem {
    /// What is wrong.
    pub message: String,
    /// The file.
    pub path: PathBuf,
    /// Where in the file; `None` for the file as a whole.
    pub spot: Option<LineSpan>,
    /// What to do about it.
    pub help: Option<String>,
}

/// A part of one line of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LineSpan {
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Number of characters, at least 1.
    pub width: usize,
    /// The line.
    pub text: String,
}

impl LocatedProblem {
    pub(super) fn new(
        message: String,
        path: &Path,
        text: &str,
        span: Option<Range<usize>>,
        help: Option<String>,
    ) -> Self {
        Self {
            message,
            path: path.to_owned(),
            spot: span.map(|span| LineSpan::new(text, span)),
            help,
        }
    }
}

impl LineSpan {
    fn new(text: &str, span: Range<usize>) -> Self {
        // An error at the end of a file belongs to its last line, not to the line after it.
        let end = text.trim_end_matches(['\n', '\r']).len();
        let from = span.start.min(end);
        let start = text[..from].rfind('\n').map_or(0, |newline| newline + 1);
        let line = text[start..].lines().next().unwrap_or("");
        let stop = span.end.clamp(from, start + line.len().max(from - start));
        Self {
            line: text[..start].matches('\n').count() + 1,
            column: text[start..from].chars().count() + 1,
            width: text[from..stop].chars().count().max(1),
            text: line.to_owned(),
        }
    }
}

impl Display for LocatedProblem {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        let Self {
            message,
            path,
            spot,
            help,
        } = self;
        writeln!(formatter, "{message}")?;
        let mut gutter = 1;
        if let Some(spot) = spot {
            let LineSpan {
                line,
                column,
                width,
                text,
            } = spot;
            gutter = line.to_string().len();
            // A tab moves the caret as it moves the text above it.
            let indent: String = text
                .chars()
                .take(column - 1)
                .map(|character| if character == '\t' { '\t' } else { ' ' })
                .collect();
            writeln!(
                formatter,
                "{:gutter$}--> {}:{line}:{column}",
                "",
                path.display()
            )?;
            writeln!(formatter, "{:gutter$} |", "")?;
            writeln!(formatter, "{line} | {text}")?;
            write!(formatter, "{:gutter$} | {indent}{}", "", "^".repeat(*width))?;
        } else {
            write!(formatter, "{:gutter$}--> {}", "", path.display())?;
        }
        match help {
            Some(help) => write!(formatter, "\n{:gutter$} = help: {help}", ""),
            None => Ok(()),
        }
    }
}
