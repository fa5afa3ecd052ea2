//! The common part of scene files and sweep files: TOML text with the place of every key, a
//! description of allowed keys, and errors that point into the text.

mod check;
mod difference;
pub(crate) mod kind;
mod lasting;
mod load_error;
mod problem;
pub(crate) mod quantities;
mod quantity;
mod schema;
mod shown;
mod spelling;
mod suggestion;
pub(crate) mod text;
mod tree;

pub use difference::differing_keys;
pub(crate) use lasting::lasting;
pub use load_error::{LineSpan, LoadError, LocatedProblem};
pub use problem::Problem;
pub(crate) use quantity::{Attribute, KeyQuantity, quantity, unit};
pub(crate) use schema::Schema;
pub use shown::shown;
pub(crate) use spelling::{any_of, number, one_of, quoted, suggest};
pub(crate) use suggestion::{accepted, at_least, at_most, rounded_down, rounded_up};
pub use text::advice;

use serde_json::Value;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::de::DeTable;

/// A TOML file as read, with the place of every key.
#[derive(Debug)]
pub(crate) struct Document {
    path: PathBuf,
    text: String,
    tree: Value,
    places: BTreeMap<String, SourcePlace>,
}

/// Where a key is in the text, in bytes.
#[derive(Clone, Debug)]
struct SourcePlace {
    /// The key itself; an entry of a list has none.
    key: Option<Range<usize>>,
    /// Its value; for a table, the header.
    value: Range<usize>,
}

impl Document {
    /// Reads a file.
    ///
    /// # Errors
    /// If it cannot be read, or is not TOML.
    pub(crate) fn read(path: &Path) -> Result<Self, LoadError> {
        let bytes = std::fs::read(path).map_err(|source| LoadError::Read {
            path: path.to_owned(),
            source,
        })?;
        let text = String::from_utf8(bytes).map_err(|error| {
            let start = error.utf8_error().valid_up_to();
            let text = String::from_utf8_lossy(error.as_bytes());
            let help = "save the file as UTF-8 text".to_owned();
            let message = "this is not UTF-8 text".to_owned();
            let finding = LocatedProblem::new(message, path, &text, Some(start..start), Some(help));
            LoadError::Invalid(vec![finding])
        })?;
        Self::parse(text, path)
    }

    /// Parses `text` as the content of the file `path`.
    ///
    /// # Errors
    /// If it is not TOML.
    pub(crate) fn parse(text: String, path: &Path) -> Result<Self, LoadError> {
        let mut document = Self {
            path: path.to_owned(),
            text,
            tree: Value::Null,
            places: BTreeMap::new(),
        };
        match DeTable::parse(&document.text) {
            Ok(table) => {
                document.tree = tree::of_table(table.get_ref(), "", &mut document.places);
                Ok(document)
            }
            Err(error) => {
                let message = format!("this is not TOML: {}", error.message());
                // The most frequent mistake, which the parser reports as a misspelt `true`.
                let word = error
                    .span()
                    .and_then(|span| document.text[span.start..].chars().next());
                let help = word
                    .filter(|character| character.is_alphabetic())
                    .filter(|_| error.message() != "duplicate key")
                    .map(|_| "a text needs quotes, and a line its `=`".to_owned());
                let finding = document.finding(message, error.span(), help);
                Err(LoadError::Invalid(vec![finding]))
            }
        }
    }

    /// The content, with null for numbers that are not finite.
    pub(crate) fn tree(&self) -> &Value {
        &self.tree
    }

    /// The top-level keys and tables, with their values.
    pub(crate) fn entries(&self) -> Vec<(String, Value)> {
        let table = self.tree.as_object().into_iter().flatten();
        table
            .map(|(key, value)| (key.clone(), value.clone()))
            .collect()
    }

    /// Whether the file has a key or table of this path.
    pub(crate) fn holds(&self, path: &str) -> bool {
        self.places.contains_key(path)
    }

    /// The file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The folder that paths in the file are relative to.
    pub(crate) fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// An error that points to the places of `problems` in this file.
    pub(crate) fn refuse(&self, problems: &[Problem]) -> LoadError {
        let mut placed: Vec<_> = problems
            .iter()
            .map(|problem| (self.span(problem), problem))
            .collect();
        placed.sort_by_key(|(span, _)| span.as_ref().map(|span| span.start));
        let findings = placed.into_iter().map(|(span, problem)| {
            self.finding(problem.message.clone(), span, problem.help.clone())
        });
        LoadError::Invalid(findings.collect())
    }

    /// Nothing if there are no problems, else an error that points to their places.
    pub(crate) fn accept(&self, problems: &[Problem]) -> Result<(), LoadError> {
        if problems.is_empty() {
            Ok(())
        } else {
            Err(self.refuse(problems))
        }
    }

    /// The place of a problem: its key, or the nearest enclosing table in the file.
    fn span(&self, problem: &Problem) -> Option<Range<usize>> {
        let mut path = problem.path.as_str();
        loop {
            if let Some(place) = self.places.get(path) {
                let is_its_own = path == problem.path;
                let key = place.key.clone().filter(|_| problem.at_key && is_its_own);
                let part = problem.part.clone().filter(|_| is_its_own);
                let part = part.and_then(|part| self.part_of_text(place.value.clone(), part));
                return key.or(part).or_else(|| Some(place.value.clone()));
            }
            path = &path[..path.rfind(['.', '['])?];
        }
    }

    /// The place of a part of a text, if the file has the text as it is read: on one line, without
    /// escapes.
    fn part_of_text(&self, value: Range<usize>, part: Range<usize>) -> Option<Range<usize>> {
        let written = &self.text[value.clone()];
        let quote = written.chars().next().filter(|it| "\"'".contains(*it))?;
        let inner = written.strip_prefix(quote)?.strip_suffix(quote)?;
        let is_plain = !inner.contains(['\\', '\n']) && !inner.starts_with(quote);
        let first = value.start + 1;
        is_plain.then(|| first + part.start.min(inner.len())..first + part.end.min(inner.len()))
    }

    fn finding(
        &self,
        message: String,
        span: Option<Range<usize>>,
        help: Option<String>,
    ) -> LocatedProblem {
        LocatedProblem::new(message, &self.path, &self.text, span, help)
    }
}
