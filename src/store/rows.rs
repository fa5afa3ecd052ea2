//! Tables of anything: one row each, under the names of the fields.

use super::{StoreError, write_atomic};
use serde::Serialize;
use std::path::Path;

/// Writes a table as CSV. What is not known is empty.
///
/// # Errors
/// [`StoreError::DiskFull`], [`StoreError::Write`], or [`StoreError::Content`] if a row is no plain
/// list of fields.
pub fn write_rows(rows: &[impl Serialize], path: &Path) -> Result<(), StoreError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer
            .serialize(row)
            .map_err(|error| StoreError::content(path, error))?;
    }
    let bytes = writer
        .into_inner()
        .map_err(|error| StoreError::content(path, error))?;
    write_atomic(path, &bytes)
}
