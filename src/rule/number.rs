//! Checked numbers.

use crate::rule::evaluate::{Formula, Frames, Needs, Reduction};
use crate::rule::{Unit, Values};
use std::ops::Range;

/// A number of a run whose names and units are checked.
#[derive(Clone, Debug)]
pub struct Number {
    pub(in crate::rule) formula: Formula<Reduction>,
    pub(in crate::rule) unit: Unit,
    pub(in crate::rule) needs: Needs,
}

impl Number {
    /// The columns that it needs, in alphabetic order.
    pub fn columns(&self) -> &[String] {
        &self.needs.columns
    }

    /// The keys that it needs, in alphabetic order.
    pub fn keys(&self) -> &[String] {
        &self.needs.keys
    }

    /// Its unit.
    pub fn unit(&self) -> Unit {
        self.unit
    }

    /// Its value for a run, from the frames of the window `window`; not a number if it is
    /// undefined.
    pub fn evaluate(&self, run: &dyn Values, window: Range<usize>) -> f64 {
        Frames::new(run, &self.needs, window).value(&self.formula)
    }
}
