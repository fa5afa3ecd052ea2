//! Thresholds of all sieves.

use super::drainage::{BlockedSieve, DrainedSieve, StagnantSieve};
use super::silo::{ArchingSieve, EmptiedSieve, FlowingSieve};
use super::tank::{FluidSieve, PinnedSieve, SettleSieve, SpoutSieve};
use super::{ClassifyError, Family};
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

// Tables of studies and results folders say which sieves they were judged by. What a family has of
// new ones does not concern the others.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Thresholds of all sieves; every default of a tank's is that of the thesis's listing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sieves {
    /// Tank: when a run counts as steady.
    pub settle: SettleSieve,
    /// Tank: when a surface counts as a fluid's.
    pub fluid: FluidSieve,
    /// Tank: when a hole counts as pinned.
    pub pinned: PinnedSieve,
    /// Tank: when rising spheres count as a spout.
    pub spout: SpoutSieve,
    /// Silo: when it counts as empty.
    pub emptied: EmptiedSieve,
    /// Silo: when an arch has stopped the outflow.
    pub arching: ArchingSieve,
    /// Silo: when grains are still leaving.
    pub flowing: FlowingSieve,
    /// Drainage: when a box counts as empty.
    #[serde(skip_serializing_if = "is_default")]
    pub drained: DrainedSieve,
    /// Drainage: when an opening counts as blocked.
    #[serde(skip_serializing_if = "is_default")]
    pub blocked: BlockedSieve,
    /// Drainage: when corners count as stagnant.
    #[serde(skip_serializing_if = "is_default")]
    pub stagnant: StagnantSieve,
}

impl Sieves {
    /// Whether these sieves can judge runs of this scene, which needs no run to tell. Those of
    /// other families do not matter.
    ///
    /// # Errors
    /// A threshold is out of range; a tank has no gravity to measure energy by, or does not count
    /// the rising spheres that the spout sieve asks for; a silo has no outlet.
    pub fn check(&self, scene: &Scene) -> Result<(), ClassifyError> {
        (Family::of(scene).check)(self, scene)
    }

    /// Sieves whose windows (s) are longer than a run of this scene, by their names: it can have
    /// none of their labels. Those of a silo take what there is of a window.
    pub fn without_room(&self, scene: &Scene) -> Vec<(&'static str, f64)> {
        let mut windows = (Family::of(scene).windows)(self);
        windows.retain(|(_, window)| *window > scene.time.duration);
        windows
    }
}
