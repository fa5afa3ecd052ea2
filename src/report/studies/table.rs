//! A table of a study, by the names of its columns.

use crate::store::StoreError;
use std::fmt::Display;
use std::path::Path;

/// A table of texts.
pub(super) struct Table {
    names: Vec<String>,
    rows: Vec<csv::StringRecord>,
}

impl Table {
    /// Reads a table.
    ///
    /// # Errors
    /// The file cannot be read, or is no table.
    pub(super) fn read(path: &Path) -> Result<Self, StoreError> {
        let fail = |error: &dyn Display| StoreError::content(path, error);
        let mut reader = csv::Reader::from_path(path).map_err(|error| fail(&error))?;
        let names = reader.headers().map_err(|error| fail(&error))?;
        let names = names.iter().map(str::to_owned).collect();
        let rows = reader.records().collect::<Result<_, _>>();
        Ok(Self {
            names,
            rows: rows.map_err(|error| fail(&error))?,
        })
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Names of the columns.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.names.iter().map(String::as_str)
    }

    /// Whether it has a column.
    pub(super) fn has(&self, name: &str) -> bool {
        self.names().any(|it| it == name)
    }

    /// A cell; empty if there is no such column.
    pub(super) fn text(&self, row: usize, name: &str) -> &str {
        let place = self.names().position(|it| it == name);
        place
            .and_then(|place| self.rows[row].get(place))
            .unwrap_or("")
    }

    /// A number, if the cell is one that is finite.
    pub(super) fn number(&self, row: usize, name: &str) -> Option<f64> {
        let number: Option<f64> = self.text(row, name).parse().ok();
        number.filter(|it| it.is_finite())
    }
}
