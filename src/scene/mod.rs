//! What a scene file may say.
//!
//! A [`Scene`] is one simulation, fully specified: the spheres, the effects
//! that act on them, the walls, the start, and time. SI units throughout,
//! angles in radians, z up; the tank's axis is the z axis. An effect whose table
//! is absent from the file does not exist in the simulation.

mod contact;
mod drag;
mod file_kind;
mod files;
mod forces;
mod identity;
mod keys;
mod neighbours;
mod output;
mod quantities;
mod radius;
mod silo;
mod spheres;
mod start;
mod tank;
mod time;
mod tree;
mod validate;
mod vary;

pub use contact::{Contact, ContactDrag, Friction};
pub use drag::{Drag, DragForm, DragLaw};
pub use file_kind::FileKind;
pub use forces::{Gravity, SpinDamping, Swirl, Updraught};
pub use keys::Notation;
pub(crate) use keys::leaf;
pub use neighbours::Neighbours;
pub use output::{Guards, Output};
pub use radius::{Radii, RadiusShare};
pub(crate) use silo::MOST_HOPPER_SPHERES;
pub use silo::{Door, FixedSphere, FixedSpheres, Geometry, Hopper, LengthUnit, Outlet, Rest};
pub use spheres::{Shape, Spheres};
pub(crate) use start::LIST_KEY;
use start::START_SPHERE;
pub use start::{Start, StartSphere};
pub use tank::Tank;
pub(crate) use time::AUTO;
pub use time::{Integrator, Time};
pub(crate) use validate::{plural, rounded};
pub(crate) use vary::Template;

use crate::document::{Schema, quantity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::LazyLock;

/// The keys of a scene file.
pub(crate) static SCENE: LazyLock<Schema> = LazyLock::new(Schema::of::<Scene>);

/// One simulation, fully specified.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Free text, shown in figures and reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Seed of everything random in this run (default 1).
    #[serde(default = "default_seed")]
    #[schemars(transform = quantity("seed", "", "seed"))]
    pub seed: u64,
    /// The spheres: how many, how large, how heavy.
    pub spheres: Spheres,
    /// Normal contact law, between spheres and with walls alike. Absent: spheres pass through
    /// each other and through walls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub contact: Option<Contact>,
    /// Tangential contact law. Absent: frictionless, and spheres have no spin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<Friction>,
    /// The tank's walls. Absent: unbounded space.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tank: Option<Tank>,
    /// Fixed spheres as the walls and the door of a silo. Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub geometry: Option<Geometry>,
    /// The silo's door, which opens once. Absent: it stays closed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub door: Option<Door>,
    /// When the spheres count as at rest. With it a run ends as soon as they are, all are in, and
    /// no door is left to open. Absent: a run ends at its duration, or when all spheres have left.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rest: Option<Rest>,
    /// Where spheres leave the simulation. Absent: nowhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outlet: Option<Outlet>,
    /// Where and how the spheres start.
    pub start: Start,
    /// Gravity. Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity: Option<Gravity>,
    /// The drag law that `swirl` and `updraught` share. Needed by either.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drag: Option<Drag>,
    /// Drag toward air in rigid rotation about the axis. Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub swirl: Option<Swirl>,
    /// Rising air that lower spheres shield. Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub updraught: Option<Updraught>,
    /// Viscous damping of spins. Absent: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spin_damping: Option<SpinDamping>,
    /// How the pairs that may touch are found. Never changes the motion.
    #[serde(default, skip_serializing_if = "is_default")]
    pub neighbours: Neighbours,
    /// Time step, duration, frames, integrator.
    pub time: Time,
    /// Limits beyond which a run is ended and reported as unstable.
    #[serde(default)]
    pub guards: Guards,
    /// What is stored besides the observables of every frame. Never changes the motion.
    #[serde(default)]
    pub output: Output,
}

impl Scene {
    /// Spheres that start somewhere and move for a time, and nothing that acts on them: no
    /// contacts, no walls, no forces. Seed 1, and the default guards and output.
    ///
    /// ```
    /// use phase::scene::{
    ///     Gravity, Integrator, Radii, Scene, Shape, Spheres, Start, StartSphere, Time,
    /// };
    ///
    /// let falling = Scene {
    ///     gravity: Some(Gravity { acceleration: 9.8, tilt: 0.0 }),
    ///     ..Scene::new(
    ///         Spheres { count: 1, radius: Radii::One(0.004), density: 2500.0, shape: Shape::Sphere },
    ///         Start::list(vec![StartSphere::at([0.0, 0.0, 1.0])]),
    ///         Time {
    ///             dt: 1e-4,
    ///             safety_factor: None,
    ///             duration: 0.1,
    ///             frame_interval: 1e-2,
    ///             integrator: Integrator::VelocityVerlet,
    ///         },
    ///     )
    /// };
    /// assert!(falling.problems().is_empty());
    /// ```
    pub fn new(spheres: Spheres, start: Start, time: Time) -> Self {
        Self {
            title: None,
            seed: default_seed(),
            spheres,
            contact: None,
            friction: None,
            tank: None,
            geometry: None,
            door: None,
            rest: None,
            outlet: None,
            start,
            gravity: None,
            drag: None,
            swirl: None,
            updraught: None,
            spin_damping: None,
            neighbours: Neighbours::default(),
            time,
            guards: Guards::default(),
            output: Output::default(),
        }
    }
}

/// The largest seed: TOML has no larger whole number.
pub const LARGEST_SEED: u64 = i64::MAX as u64;

fn default_seed() -> u64 {
    1
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

fn one() -> f64 {
    1.0
}
