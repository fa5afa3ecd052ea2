//! Tables that programs left behind.

mod arrays;
mod bad;
mod good;
mod hdf5;
mod lammps;
mod random;

use phase::external::table::{NumberTable, TableError, read};
use phase::scene::TableFormat;
use std::path::Path;

/// Enough for every file here.
const MOST: u64 = 1 << 20;

/// Real files: of LAMMPS, shortened by lines outside of tables, and of NumPy, pandas and h5py.
fn data(name: &str) -> Vec<u8> {
    std::fs::read(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("tests/tables")
            .join(name),
    )
    .unwrap()
}

fn owned(names: &[&str]) -> Vec<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// Reads bytes as a file of that name in a folder of its own.
fn read_bytes(
    name: &str,
    bytes: &[u8],
    format: TableFormat,
    names: &[&str],
    most: u64,
) -> Result<NumberTable, TableError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    read(&path, format, &owned(names), most).map_err(|error| {
        assert_eq!(error.path, path);
        TableError {
            path: name.into(),
            ..error
        }
    })
}
