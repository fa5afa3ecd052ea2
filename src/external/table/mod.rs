//! Tables of numbers that simulation programs leave behind.
//!
//! Programs are stopped while they write, so a file that is cut short is refused wherever this
//! shows. Numbers in headers are believed only if the bytes that follow bear them out: no file
//! makes its reader ask for more memory than a fixed multiple of its size and of the limit.

mod ave_time;
mod bytes;
mod columns;
mod csv;
mod error;
mod hdf5;
mod npy;
mod npz;
mod text;
mod thermo;

pub use error::TableError;
pub(in crate::external) use error::list;

use crate::scene::TableFormat;
use std::path::Path;

/// Columns of numbers that a program left behind: one at least, all of equal length, with a row
/// at least.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberTable {
    /// The name of each column. No two are equal, except that a CSV file may leave out the names of
    /// columns such as the row numbers that pandas writes; these are empty.
    pub names: Vec<String>,
    /// The numbers of each column. What is missing or no number is NaN.
    pub columns: Vec<Vec<f64>>,
}

impl NumberTable {
    /// The numbers of the column of that name.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let index = self.names.iter().position(|known| known == name)?;
        self.columns.get(index).map(Vec::as_slice)
    }

    /// The number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }
}

/// Reads a table. `names` name the columns if the file has no names of its own, which happens
/// with [`TableFormat::Csv`], [`TableFormat::Text`] and [`TableFormat::Numpy`]. With
/// [`TableFormat::Hdf5`] they are the paths of the data sets to read. Otherwise they are not used.
///
/// # Errors
/// If the file has more than `most_bytes`, packed or unpacked, or is no whole table of that format.
pub fn read(
    path: &Path,
    format: TableFormat,
    names: &[String],
    most_bytes: u64,
) -> Result<NumberTable, TableError> {
    let bytes = bytes::read(path, most_bytes)?;
    match format {
        TableFormat::Csv => csv::read(path, bytes::text(path, &bytes)?, names),
        TableFormat::Text => text::read(path, bytes::text(path, &bytes)?, names),
        // Comments of the input, in whatever encoding, are repeated in the log.
        TableFormat::LammpsLog => thermo::read(path, &String::from_utf8_lossy(&bytes)),
        TableFormat::LammpsAverage => ave_time::read(path, bytes::text(path, &bytes)?),
        TableFormat::Numpy if npz::is_archive(&bytes) => npz::read(path, &bytes, most_bytes),
        TableFormat::Numpy => npy::read(path, &bytes, names),
        TableFormat::Hdf5 => hdf5::read(path, bytes, names, most_bytes),
    }
}
