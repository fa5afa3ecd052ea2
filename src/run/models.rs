//! The one place that knows which models there are.

use crate::dem::Dem;
use crate::scene::Scene;
use crate::simulation::Model;

/// The model of a scene.
pub fn model_of(_scene: &Scene) -> &'static dyn Model {
    &Dem
}
