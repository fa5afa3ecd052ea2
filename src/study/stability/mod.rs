//! Phase diagrams of the numerics: over any two keys of a scene, and for each integrator, whether
//! its runs are stable, gain energy, lose a sphere, or end in what is not a number.
//!
//! A study differs from a sweep in that the time step may be above the limit at which scenes are
//! refused: that is what it looks at. Nothing else that is wrong with a scene is let through.

mod finding;
mod load;

pub use finding::Tried;
pub(crate) use load::{STABILITY, of_document};
pub use load::{from_str, load};

use crate::study::comparison::Comparison;

/// A study of stability, fully resolved.
#[derive(Clone, Debug)]
pub struct StabilityStudy {
    /// The integrators, as settings over two axes, the horizontal one first.
    pub comparison: Comparison,
}
