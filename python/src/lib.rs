//! The library `phase` as the Python module `phase._lib`.
//!
//! Functions take texts, numbers and paths, and return what a data set of xarray is made of. The
//! package in `phase/` gives them their names, defaults and documentation.

mod classify;
mod error;
mod folder;
mod record;
mod refine;
mod run;
mod sweep;
mod table;
mod text;
mod watch;

use pyo3::prelude::*;

/// What the package `phase` is made of.
#[pymodule]
mod _lib {
    #[pymodule_export]
    use crate::classify::{classify_folder, classify_record};
    #[pymodule_export]
    use crate::folder::open_folder;
    #[pymodule_export]
    use crate::record::{Record, is_record, read_record};
    #[pymodule_export]
    use crate::refine::Refinement;
    #[pymodule_export]
    use crate::run::run;
    #[pymodule_export]
    use crate::sweep::sweep;
    #[pymodule_export]
    use crate::text::to_toml;
}
