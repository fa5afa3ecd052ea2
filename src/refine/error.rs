//! What can be wrong with axes, settings, observations and maps.

use std::path::PathBuf;

/// Why a diagram cannot be refined or a map cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum RefineError {
    /// An axis has no usable values.
    #[error("axis `{name}`: {reason}")]
    Axis {
        /// Name of the axis.
        name: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A setting is out of its range.
    #[error("`refine.{key}` {reason}")]
    Setting {
        /// Key in the table `[refine]`.
        key: &'static str,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// A place has another number of values than the lattice has axes, or one that is not finite
    /// on an axis.
    #[error("the place {values:?} does not lie on the {axes} axes")]
    Place {
        /// Value on each axis.
        values: Vec<f64>,
        /// Number of axes.
        axes: usize,
    },
    /// One place and one seed have two different labels.
    #[error("the run at {values:?} with seed {seed} has the labels {first} and {second}")]
    Contradiction {
        /// Value on each axis.
        values: Vec<f64>,
        /// Seed of the run.
        seed: u64,
        /// Label given first.
        first: i8,
        /// Label given later.
        second: i8,
    },
    /// There are no runs, so nothing can be fitted.
    #[error(
        "there are no runs to learn from: no run of this sweep has a label; `phase sweep` makes \
         them"
    )]
    NoRuns,
    /// A map has no column of this name.
    #[error("{}: no column `{column}`", path.display())]
    Column {
        /// The file.
        path: PathBuf,
        /// The name that is missing.
        column: &'static str,
    },
    /// A cell of a map is not a number.
    #[error("{}: row {row}: `{text}` is not a number", path.display())]
    Number {
        /// The file.
        path: PathBuf,
        /// Row, from 1, without the header.
        row: usize,
        /// What the cell holds.
        text: String,
    },
    /// A file cannot be read as a table.
    #[error("{}: {source}", path.display())]
    Table {
        /// The file.
        path: PathBuf,
        /// Why.
        source: csv::Error,
    },
}
