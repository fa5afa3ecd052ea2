//! The only place that knows all models.

use super::external::ExternalModel;
use super::packed::Packed;
use crate::dem::Dem;
use crate::scene::{Scene, Start};
use crate::simulation::Model;
use crate::spot::SpotModel;

/// The model of a scene.
pub fn model_of(scene: &Scene) -> &'static dyn Model {
    if scene.is_external() {
        return &ExternalModel;
    }
    let is_packed = matches!(scene.start, Start::Packing {});
    match (scene.spot.is_some(), is_packed) {
        (true, true) => &Packed(&SpotModel),
        (true, false) => &SpotModel,
        (false, true) => &Packed(&Dem),
        (false, false) => &Dem,
    }
}
