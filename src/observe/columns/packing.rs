//! How densely spheres fill a layer.

use super::mean;
use crate::measure::LayerOfScene;
use crate::simulation::Frame;

/// Share of the layer's volume that is inside spheres.
pub(super) fn fraction(frame: &dyn Frame, layer: &LayerOfScene) -> f64 {
    let layer = layer.at(mean(frame, |block| [block.position[2]], |[z]| z));
    let part = |[z, radius]: [f64; 2]| layer.part_of_sphere(z, radius);
    let volume = mean(frame, |block| [block.position[2], block.radius], part);
    volume * frame.count() as f64 / layer.volume()
}
