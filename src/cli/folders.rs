//! Folders for what commands write.

use super::exit::Failure;
use std::path::Path;

/// Makes a folder and those above it, unless they are there.
pub(super) fn make(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Failure::failed(format_args!("{}: {error}", folder.display())))
}

/// Makes the folder of a file.
pub(super) fn make_for(file: &Path) -> Result<(), Failure> {
    make(file.parent().unwrap_or(Path::new("")))
}
