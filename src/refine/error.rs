//! What can be wrong with axes, settings and observations.

/// Why a diagram cannot be refined.
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
    /// A place has the wrong number of values, or one that is not finite on an axis.
    #[error("the place {values:?} does not lie on the {axes} axes")]
    Place {
        /// Value on each axis.
        values: Vec<f64>,
        /// Number of axes.
        axes: usize,
    },
    /// A place and seed have two different labels.
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
}
