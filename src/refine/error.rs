//! What can be wrong with axes, settings and observations.

use super::Code;
use std::fmt::Display;

/// Why a diagram cannot be refined.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct RefineError(String);

impl RefineError {
    pub(super) fn axis(name: &str, reason: &str) -> Self {
        Self(format!("axis `{name}`: {reason}"))
    }

    pub(super) fn setting(key: &str, reason: impl Display) -> Self {
        Self(format!("`refine.{key}` {reason}"))
    }

    /// A place does not lie on so many axes.
    pub fn place(values: &[f64], axes: usize) -> Self {
        Self(format!(
            "the place {values:?} does not lie on the {axes} axes"
        ))
    }

    /// One place and one seed have two different labels.
    pub(super) fn contradiction(values: &[f64], seed: u64, [first, second]: [Code; 2]) -> Self {
        Self(format!(
            "the run at {values:?} with seed {seed} has the labels {first} and {second}"
        ))
    }

    /// There are no runs, so nothing can be fitted.
    pub(super) fn no_runs() -> Self {
        Self(
            "there are no runs to learn from: no run of this sweep has a label; `phase sweep` \
             makes them"
                .to_owned(),
        )
    }
}
