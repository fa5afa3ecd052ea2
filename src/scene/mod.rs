//! What a scene file may say.
//!
//! A [`Scene`] is one simulation, fully specified: the spheres, the effects
//! that act on them, the walls, the start, and time. SI units throughout,
//! angles in radians, z up; the tank's axis is the z axis. An effect whose table
//! is absent from the file does not exist in the simulation.

mod accuracy;
mod change;
mod columns;
mod dem;
mod file_kind;
mod files;
mod fluid;
mod identity;
mod keys;
mod output;
mod profiles;
mod program;
mod radius;
mod rules;
pub(crate) mod settings;
mod simplified;
mod spheres;
mod spot;
mod start;
mod steady;
mod tank;
mod time;
mod tree;
mod units;
mod validate;
mod vary;
mod wall_columns;

pub use accuracy::Accuracy;
pub use change::Change;
pub(crate) use change::is_within;
pub use columns::FurtherColumn;
pub(crate) use dem::MOST_HOPPER_SPHERES;
pub use dem::{
    ConeWall, Contact, ContactDrag, Coulomb, CundallStrack, CylinderWall, DemScene, DiscWall, Door,
    Driven, FixedSphere, FixedSpheres, Friction, Geometry, Guards, Hertz, Hooke, HookeFriction,
    Hopper, LengthUnit, Linear, Mindlin, MindlinDeresiewicz, Neighbours, Outlet, Periodic,
    PlaneWall, PlateWall, Rest, Rolling, SceneWall, Silbert, SilbertFriction, Spin, Tsuji,
};
pub use file_kind::FileKind;
pub(crate) use files::in_start_file;
pub use keys::Notation;
pub(crate) use keys::{leaf, may_hold};
pub use output::{Layer, Output, UsualChoice, UsualColumns};
pub use profiles::{ColumnProfile, ProfileAxis, ProfiledQuantity};
use program::absent;
pub use program::{
    DescribedColumn, ExternalProgram, FilledProgram, Keep, ProgramColumn, ProgramParameters,
    ProgramResume, ProgramStates, ProgramTable, TableFormat, TemplateFile, TemplateText,
};
pub(crate) use program::{Marks, TextPiece};
pub use radius::{Radii, RadiusShare};
pub use rules::{LabelRule, MeasureRule, RuleWindow};
pub use spheres::{Shape, Spheres};
pub(crate) use spot::STICKING_OUT;
pub use spot::{RelaxationMethod, Spot, SpotRelaxation, SpotSchedule, SpotWalk, SpotWeighting};
pub(crate) use start::LIST_KEY;
use start::START_SPHERE;
pub use start::{Start, StartSphere};
pub use steady::Steady;
pub use tank::Tank;
pub(crate) use time::AUTO;
pub use time::{Integrator, Time};
pub use units::Units;
pub(crate) use validate::{multiple, plural, rounded};
pub(crate) use vary::Template;
pub use wall_columns::WallColumn;

// All tables of effects.
pub use crate::forces::effects::*;

use crate::document::{Schema, quantity};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::sync::LazyLock;

/// The keys of a scene file.
pub(crate) static SCENE: LazyLock<Schema> = LazyLock::new(Schema::of::<Scene>);

/// One simulation, fully specified: what all models share, and the part of its model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(transform = needed_without_program)]
pub struct Scene {
    /// Free text, shown in figures and reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Seed of everything random in this run (default 1).
    #[serde(default = "default_seed")]
    #[schemars(transform = quantity("seed", "", "seed"))]
    pub seed: u64,
    /// The spheres: how many, how large, how heavy.
    #[serde(
        default = "absent::spheres",
        skip_serializing_if = "absent::are_spheres"
    )]
    pub spheres: Spheres,
    /// The tank's walls. Absent: unbounded space.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tank: Option<Tank>,
    /// Where and how the spheres start.
    #[serde(default = "absent::start", skip_serializing_if = "absent::is_start")]
    pub start: Start,
    /// The part of the discrete element model.
    #[serde(flatten)]
    pub dem: DemScene,
    /// Use the spot model instead of the discrete element model. Absent: discrete element model.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spot: Option<Spot>,
    /// Another program in place of a model of this one. Absent: a model of this one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub program: Option<ExternalProgram>,
    /// What the program of the scene is given, by name: numbers, which may be axes; texts; true or
    /// false.
    #[serde(default, skip_serializing_if = "ProgramParameters::is_empty")]
    pub parameters: ProgramParameters,
    /// Required accuracy of the numerics: chooses `integrator`, `dt = "auto"` with its
    /// `safety_factor`, and `frame_interval` of `time`, unless the file gives them. The scene of a
    /// run has the chosen settings instead of this key.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy: Option<Accuracy>,
    /// Time step, duration, frames, integrator.
    #[serde(default = "absent::time", skip_serializing_if = "absent::is_time")]
    pub time: Time,
    /// When the run counts as steady and ends. Absent: it ends at its duration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steady: Option<Steady>,
    /// Labels by rules, in place of those of the sieves: the first whose condition holds is the
    /// run's.
    #[serde(default, rename = "label", skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<LabelRule>,
    /// What is measured of the run besides, by rules.
    #[serde(default, rename = "measure", skip_serializing_if = "Vec::is_empty")]
    pub measures: Vec<MeasureRule>,
    /// Data stored in addition to the observables of every frame. Never changes the motion.
    #[serde(default)]
    pub output: Output,
}

impl Scene {
    /// What effects may need to know of this scene.
    pub(crate) fn facts(&self) -> SceneFacts {
        SceneFacts {
            density: self.spheres.density,
            rotates: self.dem.friction.is_some(),
        }
    }

    /// The spheres that the start lists and that move freely, with their numbers; driven ones are
    /// left out.
    pub(crate) fn free_listed(&self) -> impl Iterator<Item = (usize, &StartSphere)> {
        let listed: &[StartSphere] = match &self.start {
            Start::List { spheres } => spheres,
            _ => &[],
        };
        let driven = &self.dem.driven;
        let is_free = |number: usize| driven.iter().all(|path| path.sphere != number);
        let numbered = listed.iter().enumerate();
        numbered.filter(move |(number, _)| is_free(*number))
    }

    /// Whether walls slide in themselves.
    pub fn has_moving_walls(&self) -> bool {
        self.dem.walls.iter().any(SceneWall::moves)
    }

    /// The friction law at the walls of the tank, whose coefficient may differ. `None` without
    /// friction.
    pub fn friction_at_walls(&self) -> Option<Friction> {
        let friction = self.dem.friction.as_ref()?;
        let tank = self.tank.as_ref();
        Some(match tank.and_then(|tank| tank.friction_coefficient) {
            Some(coefficient) => friction.with_coefficient(coefficient),
            None => friction.clone(),
        })
    }

    /// Height below which spheres of the discrete element model have left (m), if they can leave.
    /// The default for a tank with an opening is one diameter of the largest sphere below the
    /// floor, where spheres can no longer touch any above it.
    pub fn outlet_height(&self) -> Option<f64> {
        let outlet = self.dem.outlet.as_ref().map(|outlet| outlet.height);
        let tank = self.tank.as_ref().filter(|tank| tank.has_opening());
        let below_opening = || Some(tank?.floor? - 2.0 * self.radius_range().1);
        outlet.or_else(below_opening)
    }

    /// Spheres that move freely for a time: no contacts, no walls, no forces. Seed 1, default
    /// guards and output.
    ///
    /// ```
    /// use phase::scene::{
    ///     Gravity, Integrator, Radii, Scene, Shape, Spheres, Start, StartSphere, Time,
    /// };
    ///
    /// let mut falling = Scene::new(
    ///     Spheres { count: 1, radius: Radii::One(0.004), density: 2500.0, shape: Shape::Sphere },
    ///     Start::list(vec![StartSphere::at([0.0, 0.0, 1.0])]),
    ///     Time {
    ///         dt: 1e-4,
    ///         safety_factor: None,
    ///         resolution: None,
    ///         duration: 0.1,
    ///         frame_interval: 1e-2,
    ///         integrator: Integrator::VelocityVerlet,
    ///     },
    /// );
    /// falling.dem.effects.gravity = Some(Gravity { acceleration: 9.8, tilt: 0.0 });
    /// assert!(falling.problems().is_empty());
    /// ```
    pub fn new(spheres: Spheres, start: Start, time: Time) -> Self {
        Self {
            title: None,
            seed: default_seed(),
            spheres,
            tank: None,
            start,
            dem: DemScene::default(),
            spot: None,
            program: None,
            parameters: ProgramParameters::new(),
            accuracy: None,
            time,
            steady: None,
            labels: Vec::new(),
            measures: Vec::new(),
            output: Output::default(),
        }
    }
}

/// The largest seed: TOML has no larger whole number.
pub const LARGEST_SEED: u64 = i64::MAX as u64;

/// What every scene needs, unless another program runs it.
fn needed_without_program(schema: &mut schemars::Schema) {
    let unless = json!({ "not": { "required": ["program"] } });
    schema.insert("if".to_owned(), unless);
    let needed = json!({ "required": ["spheres", "start", "time"] });
    schema.insert("then".to_owned(), needed);
}

fn default_seed() -> u64 {
    1
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
