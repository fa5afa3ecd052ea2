//! The part of a scene that belongs to the discrete element model: laws of contact, effects, fixed
//! spheres, what ends a run, guards.

mod driven;
mod guards;
mod neighbours;
mod periodic;
mod silo;
mod walls;

pub use crate::forces::contact::{Contact, ContactDrag, Hertz, Hooke, Linear, Silbert, Tsuji};
pub use crate::forces::friction::{
    Coulomb, CundallStrack, Friction, HookeFriction, Mindlin, MindlinDeresiewicz, SilbertFriction,
    Spin,
};
pub use crate::forces::rolling::Rolling;
pub use driven::Driven;
pub use guards::Guards;
pub use neighbours::Neighbours;
pub use periodic::Periodic;
pub(crate) use silo::MOST_HOPPER_SPHERES;
pub use silo::{Door, FixedSphere, FixedSpheres, Geometry, Hopper, LengthUnit, Outlet, Rest};
pub use walls::{ConeWall, CylinderWall, DiscWall, PlaneWall, PlateWall, SceneWall};

use super::is_default;
use crate::forces::effects::Effects;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The part of a scene that only the discrete element model uses. By default spheres move freely,
/// without forces.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DemScene {
    /// Normal contact law, between spheres and with walls alike. Absent: spheres pass through
    /// each other and through walls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<Contact>,
    /// Tangential contact law. Absent: frictionless, and spheres have no spin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<Friction>,
    /// Resistance to rolling at contacts. Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rolling: Option<Rolling>,
    /// Walls of any shape, in addition to the tank. Absent: none.
    #[serde(default, rename = "wall", skip_serializing_if = "Vec::is_empty")]
    pub walls: Vec<SceneWall>,
    /// Periodic sides. Absent: the space is open.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub periodic: Option<Periodic>,
    /// Fixed spheres as the walls and the door of a silo. Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geometry: Option<Geometry>,
    /// The silo's door, which opens once. Absent: it stays closed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub door: Option<Door>,
    /// When the spheres count as at rest. A run then ends as soon as all spheres are in and at rest
    /// and no door is left to open. Absent: a run ends at its duration, or when all spheres have
    /// left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest: Option<Rest>,
    /// Where spheres leave the simulation. Absent: nowhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outlet: Option<Outlet>,
    /// Spheres that move along prescribed paths. Absent: none. The energy balance does not include
    /// the work that drives them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub driven: Vec<Driven>,
    /// The effects on single spheres.
    #[serde(flatten)]
    pub effects: Effects,
    /// How the pairs that may touch are found. Never changes the motion.
    #[serde(default, skip_serializing_if = "is_default")]
    pub neighbours: Neighbours,
    /// Limits beyond which a run is ended and reported as unstable.
    #[serde(default)]
    pub guards: Guards,
}
