//! Checked formulas, and their values for a run.

mod evidence;
mod formula;
mod frames;
mod reduction;
mod repeats;
mod summary;

pub(in crate::rule) use evidence::evidence;
pub use evidence::{ComparisonEvidence, Evidence};
pub(in crate::rule) use formula::{ColumnPlace, Comparison, Formula, Nothing, Reduction, Test};
pub(in crate::rule) use frames::{Frames, Needs};
