//! Where and how the spheres start.

use super::{Scene, Tank};
use crate::document::quantities::{length, place};
use crate::document::{Schema, quantity, unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};

/// The key of the spheres that a start lists.
pub(crate) const LIST_KEY: &str = "start.spheres";

/// The keys of a sphere that a start lists.
pub(super) static START_SPHERE: LazyLock<Schema> = LazyLock::new(Schema::of::<StartSphere>);

/// Where and how the spheres start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Start {
    /// Random positions without overlap, inside the tank's cylinder or its four sides or in a box,
    /// and clear of fixed spheres and of all walls.
    Random {
        /// Lowest start height of a centre (m).
        #[schemars(transform = place("z_{min}", "lowest start height"))]
        z_min: f64,
        /// Highest start height of a centre (m).
        #[schemars(transform = place("z_{max}", "highest start height"))]
        z_max: f64,
        /// Least and largest x of a centre (m). Default: as far as the tank reaches.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(transform = unit("m"))]
        x: Option<[f64; 2]>,
        /// Least and largest y of a centre (m). Default: as far as the tank reaches.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(transform = unit("m"))]
        y: Option<[f64; 2]>,
        /// Each velocity component is uniform in plus or minus this (m/s).
        #[serde(default)]
        #[schemars(
            transform = quantity("v_{start}", "m/s", "largest start velocity component")
                .at_least(0.0)
        )]
        speed: f64,
        /// Each spin component is uniform in plus or minus this (rad/s); no effect
        /// in a scene without friction.
        #[serde(default)]
        #[schemars(
            transform = quantity("ω_{start}", "rad/s", "largest start spin component").at_least(0.0)
        )]
        spin: f64,
    },
    /// A random dense packing on the floor of a tank with four sides, of spheres that touch without
    /// overlap, with a packing fraction of 0.64 in the bulk and less between close sides.
    Packing {},
    /// Every sphere listed in the scene. Spheres may overlap walls and each other, for example to
    /// continue an earlier run. Overlaps that push spheres apart faster than any impact of the
    /// scene cause a warning. Centres outside the tank or inside a fixed sphere, and overlaps
    /// beyond `guards.overlap`, are refused.
    List {
        /// One entry per sphere; their number must equal `spheres.count`.
        // Shared, because the scene is copied often and may list a million spheres.
        spheres: Arc<Vec<StartSphere>>,
    },
    /// One sphere after the other, all at the same place with the same velocity, from time zero on.
    /// The place must be free of walls and fixed spheres.
    Feed {
        /// Centre of a sphere when it comes in (m).
        #[schemars(transform = unit("m"))]
        position: [f64; 3],
        /// Its velocity (m/s).
        #[serde(default)]
        #[schemars(transform = unit("m/s"))]
        velocity: [f64; 3],
        /// Time between two spheres (s); a whole number of steps. A sphere whose place is occupied
        /// waits for the next such time.
        #[schemars(
            transform = quantity("Δt_{feed}", "s", "time between spheres that come in").above(0.0)
        )]
        interval: f64,
        /// The place is moved along x by a random length, uniform in plus or minus this (m).
        #[serde(default)]
        #[schemars(
            transform = quantity("Δx_{feed}", "m", "random shift of where spheres come in")
                .at_least(0.0)
        )]
        spread: f64,
    },
    /// Every sphere from a CSV file: x, y, z, then optionally vx, vy, vz, wx, wy, wz, radius,
    /// named by its header line.
    File {
        /// Path of the file, relative to the scene file.
        path: PathBuf,
    },
}

impl Start {
    /// These spheres.
    pub fn list(spheres: Vec<StartSphere>) -> Self {
        Self::List {
            spheres: Arc::new(spheres),
        }
    }

    /// The listed spheres, to be changed.
    pub fn list_mut(&mut self) -> Option<&mut Vec<StartSphere>> {
        match self {
            Self::List { spheres } => Some(Arc::make_mut(spheres)),
            _ => None,
        }
    }
}

/// Approximate packing fraction of a box of spheres, walls included.
const PACKING_FRACTION: f64 = 0.61;

impl Scene {
    /// Least and largest x, and y, of the centres of a random start (m), where `start` gives them.
    pub(crate) fn start_box(&self) -> [Option<[f64; 2]>; 2] {
        match &self.start {
            Start::Random { x, y, .. } => [*x, *y],
            _ => [None; 2],
        }
    }

    /// Area (m2) over which a random start spreads, if it is closed.
    pub(crate) fn start_area(&self) -> Option<f64> {
        let tank = self.tank.as_ref();
        let sides = self.start_box();
        if sides == [None; 2] {
            return self.cross_section();
        }
        // Centres keep away from plane sides, but not from the ends of the box.
        let diameter = 2.0 * self.radius_range().1;
        let reach = tank.map(Tank::reach).unwrap_or_default();
        let periods = self.domain().periods();
        let side = |axis: usize| {
            let whole = sides[axis].map(|[low, high]| high - low + diameter);
            let period = periods[axis];
            let whole = period
                .map(|period| whole.map_or(period, |it| it.min(period)))
                .or(whole);
            whole.or(reach[axis].map(|reach| 2.0 * reach))
        };
        Some(side(0)? * side(1)?)
    }
}

impl Scene {
    /// Approximate height (m) of the spheres at rest in the tank; 0 without walls all around.
    pub(crate) fn packed_height(&self) -> f64 {
        let volume = self.spheres.count as f64 * self.spheres.radius.mean_volume();
        let area = self.cross_section();
        area.map_or(0.0, |area| volume / (PACKING_FRACTION * area))
    }

    /// The scene without the spheres that its start lists, and these spheres; `None` if it lists
    /// none.
    pub(crate) fn apart_from_list(&self) -> Option<(Self, &[StartSphere])> {
        let Start::List { spheres } = &self.start else {
            return None;
        };
        let without_them = Self {
            start: Start::list(Vec::new()),
            ..self.clone()
        };
        Some((without_them, spheres))
    }

    /// The scene without the spheres that its start lists.
    pub(crate) fn without_list(&self) -> Self {
        let apart = self.apart_from_list();
        apart.map_or_else(|| self.clone(), |(without_list, _)| without_list)
    }
}

/// One sphere of a start list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StartSphere {
    /// Centre (m).
    #[schemars(transform = unit("m"))]
    pub position: [f64; 3],
    /// Velocity (m/s).
    #[serde(default)]
    #[schemars(transform = unit("m/s"))]
    pub velocity: [f64; 3],
    /// Spin (rad/s).
    #[serde(default)]
    #[schemars(transform = unit("rad/s"))]
    pub spin: [f64; 3],
    /// Radius (m), if it differs from `spheres.radius`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = length("", ""))]
    pub radius: Option<f64>,
}

impl StartSphere {
    /// A sphere at rest at a place (m), with the scene's radius.
    pub fn at(position: [f64; 3]) -> Self {
        Self {
            position,
            velocity: [0.0; 3],
            spin: [0.0; 3],
            radius: None,
        }
    }
}
