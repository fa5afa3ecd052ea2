//! What expressions ask of a run.

use crate::rule::Unit;
use std::borrow::Cow;

/// The names that an expression can use, with their units.
pub trait Names {
    /// The unit of the column `name`; none if the run has no such column. Every run has the column
    /// `time`, which is not asked for.
    fn column(&self, name: &str) -> Option<Unit>;

    /// The unit of the key `path`, such as `spheres.radius`; none if the scene has no such number.
    /// A column hides the key of the same name.
    fn key(&self, path: &str) -> Option<Unit>;

    /// The unit of the times of frames.
    fn time(&self) -> Unit {
        Unit::SECOND
    }

    /// Why the run has no column `name` that other runs have; none if no run has it.
    fn absent(&self, _name: &str) -> Option<String> {
        None
    }

    /// All names, for the help of an error.
    fn suggestions(&self) -> Vec<String>;
}

/// The values of a run.
pub trait Values {
    /// Times of the frames (s), which increase.
    fn time(&self) -> &[f64];

    /// The values of the column `name`, one per frame. Frames that it lacks are not numbers.
    fn column(&self, name: &str) -> Cow<'_, [f64]>;

    /// The value of the key `path`.
    fn key(&self, path: &str) -> f64;
}
