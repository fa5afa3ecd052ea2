//! Archives of arrays of NumPy (`.npz`).

use super::NumberTable;
use super::columns::{check_names, no_rows};
use super::error::{TableError, quote};
use super::npy;
use crate::store::zip;
use std::path::Path;

/// Whether a file is an archive.
pub(super) fn is_archive(bytes: &[u8]) -> bool {
    zip::is_archive(bytes)
}

/// Reads the arrays of one dimension as columns. Others belong to no table.
pub(super) fn read(path: &Path, bytes: &[u8], most_bytes: u64) -> Result<NumberTable, TableError> {
    let wrong = |(message, help)| TableError::in_file(path, message, help);
    let mut table = NumberTable {
        names: Vec::new(),
        columns: Vec::new(),
    };
    let mut left = usize::try_from(most_bytes).unwrap_or(usize::MAX);
    for entry in zip::entries(bytes).map_err(wrong)? {
        let of_entry = |(message, help)| {
            let name = quote(&entry.name);
            TableError::in_file(path, format!("the array {name} is wrong: {message}"), help)
        };
        let unpacked = entry.unpack(bytes, left).map_err(of_entry)?;
        left = left.saturating_sub(unpacked.len());
        let array = npy::decode(&unpacked).map_err(of_entry)?;
        if array.shape.len() != 1 {
            continue;
        }
        let name = entry.name.strip_suffix(".npy").unwrap_or(&entry.name);
        if let (Some(other), Some(first)) = (table.columns.first(), table.names.first())
            && other.len() != array.values.len()
        {
            let (length, expected) = (array.values.len(), other.len());
            let (name, first) = (quote(name), quote(first));
            let message =
                format!("the array {name} has the length {length}, but {first} has {expected}");
            let help = "save the arrays of one table, all of equal length";
            return Err(TableError::in_file(path, message, help));
        }
        table.names.push(name.to_owned());
        table.columns.push(array.values);
    }
    check_names(&table.names).map_err(wrong)?;
    if table.names.is_empty() {
        let help = "save each column as an array of its own, with `numpy.savez`";
        return Err(TableError::in_file(
            path,
            "it has no array of one dimension",
            help,
        ));
    }
    match table.rows() {
        0 => Err(no_rows(path)),
        _ => Ok(table),
    }
}
