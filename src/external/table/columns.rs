//! Columns that grow row by row.

use super::NumberTable;
use super::error::{TableError, count, quote};
use std::collections::HashSet;
use std::path::Path;

/// A table that is being read.
pub(super) struct RowReader<'p> {
    path: &'p Path,
    table: NumberTable,
}

/// Where a row stands.
#[derive(Clone, Copy)]
pub(super) struct RowPlace {
    /// The number of its line.
    pub(super) line: u64,
    /// Whether its line has an end.
    pub(super) is_ended: bool,
}

impl<'p> RowReader<'p> {
    /// Columns without rows. The names stand in `line`, if they stand in the file.
    pub(super) fn new(
        path: &'p Path,
        names: Vec<String>,
        line: Option<u64>,
    ) -> Result<Self, TableError> {
        check_names(&names).map_err(|(message, help)| TableError {
            line,
            ..TableError::in_file(path, message, help)
        })?;
        let columns = vec![Vec::new(); names.len()];
        let table = NumberTable { names, columns };
        Ok(Self { path, table })
    }

    /// The names of the columns.
    pub(super) fn names(&self) -> &[String] {
        &self.table.names
    }

    /// The last number of a column.
    pub(super) fn last(&self, column: usize) -> Option<f64> {
        self.table.columns.get(column)?.last().copied()
    }

    /// Adds a row. An empty entry is NaN.
    pub(super) fn push<'e>(
        &mut self,
        place: RowPlace,
        entries: impl Iterator<Item = &'e str> + Clone,
    ) -> Result<(), TableError> {
        let width = entries.clone().count();
        if width != self.table.names.len() {
            return Err(self.wrong_width(place, width));
        }
        let named = self.table.names.iter().zip(&mut self.table.columns);
        for (entry, (name, column)) in entries.zip(named) {
            let value = if entry.is_empty() {
                Some(f64::NAN)
            } else {
                number(entry)
            };
            let value = value.ok_or_else(|| {
                let message = format!(
                    "{} in the column {} is no number",
                    quote(entry),
                    quote(name)
                );
                let help = if !place.is_ended {
                    STOPPED
                } else if entry.contains(',') {
                    "write 0.5 with a point; if commas separate the entries, the format is `csv`"
                } else {
                    "write a number, or nan where there is none"
                };
                TableError::in_line(self.path, place.line, message, help)
            })?;
            column.push(value);
        }
        Ok(())
    }

    /// Removes the last row.
    pub(super) fn pop(&mut self) {
        for column in &mut self.table.columns {
            column.pop();
        }
    }

    /// The table.
    pub(super) fn finish(self) -> Result<NumberTable, TableError> {
        match self.table.rows() {
            0 => Err(no_rows(self.path)),
            _ => Ok(self.table),
        }
    }

    fn wrong_width(&self, place: RowPlace, width: usize) -> TableError {
        let expected = self.table.names.len();
        let (message, help) = if !place.is_ended && width < expected {
            let message =
                format!("the last line is unfinished: it has {width} of {expected} entries");
            (message, STOPPED)
        } else {
            let (entries, columns) = (count(width, "entry"), count(expected, "column"));
            let message = format!("this row has {entries}, but the table has {columns}");
            (message, "give every row one entry for each column")
        };
        TableError::in_line(self.path, place.line, message, help)
    }
}

/// What to do about a file that a program did not finish.
pub(super) const STOPPED: &str =
    "the program was stopped while it wrote: run it again, or remove this line";

/// The error of a table without rows.
pub(super) fn no_rows(path: &Path) -> TableError {
    let help = "check whether the program ran long enough to write one";
    TableError::in_file(path, "it has no rows", help)
}

/// The number that a word is.
pub(super) fn number(word: &str) -> Option<f64> {
    word.parse().ok()
}

/// Names for `width` columns that have none in the file.
pub(super) fn given_names(names: &[String], width: usize) -> Result<Vec<String>, String> {
    if names.len() == width {
        return Ok(names.to_vec());
    }
    let columns = count(width, "column");
    Err(match names.len() {
        0 => format!("the file has no names for its {columns}"),
        given => format!(
            "the file has {columns}, but `header` lists {}",
            count(given, "name")
        ),
    })
}

/// What to do about names that are missing.
pub(super) const NAMES_NEEDED: &str = "give `header = [...]` with one name for each column";

/// Checks that every name means one column.
pub(super) fn check_names(names: &[String]) -> Result<(), (String, &'static str)> {
    let mut seen = HashSet::new();
    let mut named = names.iter().filter(|name| !name.is_empty());
    match named.find(|name| !seen.insert(name.as_str())) {
        Some(twice) => Err((
            format!("two columns have the name {}", quote(twice)),
            "give each column a name of its own",
        )),
        None => Ok(()),
    }
}
