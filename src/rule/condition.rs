//! Checked conditions.

use crate::rule::Values;
use crate::rule::evaluate::{Evidence, Frames, Needs, Reduction, Test, evidence};
use std::ops::Range;

/// A condition whose names and units are checked.
#[derive(Clone, Debug)]
pub struct Condition {
    pub(in crate::rule) test: Test<Reduction>,
    pub(in crate::rule) needs: Needs,
}

impl Condition {
    /// The columns that it needs, in alphabetic order.
    pub fn columns(&self) -> &[String] {
        &self.needs.columns
    }

    /// The keys that it needs, in alphabetic order.
    pub fn keys(&self) -> &[String] {
        &self.needs.keys
    }

    /// Its evidence for a run, from the frames of the window `window`.
    pub fn evaluate(&self, run: &dyn Values, window: Range<usize>) -> Evidence {
        evidence(&self.test, &Frames::new(run, &self.needs, window))
    }
}
