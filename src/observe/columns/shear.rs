//! How fast a layer is sheared.

use super::mean;
use crate::measure::{LayerOfScene, ShearSums};
use crate::simulation::Frame;

/// Change of the horizontal velocity with height in the layer (1/s), by least squares.
pub(super) fn rate(frame: &dyn Frame, layer: &LayerOfScene) -> f64 {
    let layer = layer.at(mean(frame, |block| [block.position[2]], |[z]| z));
    let mut sums = ShearSums::default();
    frame.show(&mut |block| {
        let [vx, vy, _] = block.velocity;
        for ((&z, &vx), &vy) in block.position[2].iter().zip(vx).zip(vy) {
            if layer.contains(z) {
                sums.add(z - layer.bottom, [vx, vy]);
            }
        }
    });
    sums.rate()
}
