//! One job of a sweep: a point of the grid with one seed.

use crate::scene::Scene;

/// One job of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Job {
    /// Identity of the run (see [`Scene::identity`]): the name of its record.
    pub id: String,
    /// Value on each axis, in the sweep's order.
    pub values: Vec<f64>,
    /// Seed.
    pub seed: u64,
    /// The resolved scene.
    pub scene: Scene,
}
