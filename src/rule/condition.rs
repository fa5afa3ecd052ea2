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

    /// Its evidence for a run from each of several windows, whose columns are read once.
    pub fn evaluate_each<'a>(
        &'a self,
        run: &'a dyn Values,
        windows: impl IntoIterator<Item = Range<usize>> + 'a,
    ) -> impl Iterator<Item = Evidence> + 'a {
        let mut frames = Frames::new(run, &self.needs, 0..0);
        windows.into_iter().map(move |window| {
            frames.look_at(window);
            evidence(&self.test, &frames)
        })
    }
}
