//! How far heights are apart.

use super::mean;
use crate::simulation::Frame;

/// Root mean square distance of the heights of the centres from their mean (m).
pub(super) fn height_deviation(frame: &dyn Frame) -> f64 {
    let middle = mean(frame, |block| [block.position[2]], |[z]| z);
    let square = |[z]: [f64; 1]| (z - middle) * (z - middle);
    mean(frame, |block| [block.position[2]], square).sqrt()
}
