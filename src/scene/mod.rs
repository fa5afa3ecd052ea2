//! What a scene file may say.
//!
//! A [`Scene`] is one simulation, fully specified: the spheres, the effects
//! that act on them, the walls, the start, and time. SI units throughout,
//! angles in radians, z up; the tank's axis is the z axis. An effect whose table
//! is absent from the file does not exist in the simulation.

mod drag;
mod identity;
mod keys;
mod load;
mod neighbours;
mod radius;
pub(crate) mod schema;
mod silo;
mod step;
mod validate;

pub use drag::{Drag, DragForm, DragLaw};
pub(crate) use keys::leaf;
pub(crate) use load::{Reading, base_of_tree, load_base_with};
pub use load::{from_str, load, load_base};
pub use neighbours::Neighbours;
pub use radius::{Radii, RadiusShare};
pub use silo::{Door, FixedSphere, FixedSpheres, Geometry, Hopper, LengthUnit, Outlet, Rest};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// One simulation, fully specified.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Free text, shown in figures and reports.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Seed of everything random in this run (default 1).
    #[serde(default = "default_seed")]
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
    /// When the spheres count as at rest. With it a run ends as soon as they are, all are in, and no
    /// door is left to open. Absent: a run ends at its duration, or when all spheres have left.
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
    ///         Start::List { spheres: vec![StartSphere::at([0.0, 0.0, 1.0])] },
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

fn default_seed() -> u64 {
    1
}

/// The spheres: how many, how large, how heavy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spheres {
    /// Number of spheres, n.
    pub count: usize,
    /// Radius r (m): one value, a list of `{ radius, share }`, or `{ file = "radii.txt" }`.
    pub radius: Radii,
    /// Density rho: of spheres that of the solid (kg/m3), of discs in kg/m2.
    pub density: f64,
    /// What the mass of one is.
    #[serde(default, skip_serializing_if = "is_default")]
    pub shape: Shape,
}

/// What the mass of a sphere is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// A sphere in space: 4/3 pi rho r^3.
    #[default]
    Sphere,
    /// A disc in the plane y = 0: rho r^2 (Remmers, 2009), and a moment of inertia of half that
    /// times r^2.
    Disc,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl Shape {
    /// Mass (kg) of one of this density and radius (m).
    pub fn mass(self, density: f64, radius: f64) -> f64 {
        match self {
            Self::Sphere => density * (4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius),
            Self::Disc => density * radius * radius,
        }
    }

    /// Moment of inertia about the centre, over mass times squared radius.
    pub fn inertia_factor(self) -> f64 {
        match self {
            Self::Sphere => 0.4,
            Self::Disc => 0.5,
        }
    }
}

/// Normal contact law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Contact {
    /// Viscoelastic Hertz contact (Brilliantov et al., 1996), never attractive.
    Hertz {
        /// Young's modulus Y (Pa).
        young_modulus: f64,
        /// Poisson's ratio nu.
        poisson_ratio: f64,
        /// Dissipation time A (s). Give this or `restitution`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        dissipation_time: Option<f64>,
        /// Restitution of a head-on pair at `restitution_speed`, from which A follows for
        /// the scene's (mean) radius. Give this or `dissipation_time`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        restitution: Option<f64>,
        /// Relative speed at which `restitution` holds (m/s, default 1).
        #[serde(default = "one")]
        restitution_speed: f64,
        /// Factor c of the dissipative term: 1 as the thesis prints it (default), 3/2 as
        /// Brilliantov et al. derive it.
        #[serde(default = "one")]
        dissipation_factor: f64,
    },
    /// Spring and dashpot, both linear (Cundall and Strack, 1979; Remmers, 2009): F = k delta + b times
    /// the rate of the overlap. Attractive at the end of a contact.
    Linear {
        /// Spring constant k (N/m).
        stiffness: f64,
        /// Drag constant b (N s/m).
        damping: f64,
        /// Which part of the relative velocity the drag acts on.
        #[serde(default)]
        drag: ContactDrag,
    },
}

/// Which part of the relative velocity of two partners a contact's drag acts on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ContactDrag {
    /// The part along the line of centres.
    #[default]
    Normal,
    /// All of it (Remmers, 2009), which also slows spheres that slide along each other. Spins do not
    /// count.
    Whole,
}

fn one() -> f64 {
    1.0
}

/// Tangential contact law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Friction {
    /// The thesis's rule (Rice, 2012, eqs. 10 to 14): from spins alone, an impulse per step.
    /// Depends on the time step, knows no sliding, does not conserve angular momentum.
    Spin {
        /// Coefficient mu.
        coefficient: f64,
    },
    /// Sliding friction capped at mu F_n, from the velocity of the contact point.
    Coulomb {
        /// Coefficient mu.
        coefficient: f64,
        /// Sliding speed below which the force falls linearly to zero (m/s).
        regularisation: f64,
    },
    /// A tangential spring and dashpot, together capped at mu F_n (Cundall and Strack, 1979); needs
    /// the linear contact. A pile holds still, and grains can arch.
    CundallStrack {
        /// Coefficient mu.
        coefficient: f64,
        /// Tangential spring constant k_t (N/m).
        stiffness: f64,
        /// Tangential drag constant b_t (N s/m).
        #[serde(default)]
        damping: f64,
    },
    /// Mindlin's history spring by increments, capped at mu F_n; needs the Hertz contact.
    Mindlin {
        /// Coefficient mu.
        coefficient: f64,
    },
}

/// The tank's walls, of the same material as the spheres.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tank {
    /// Radius R of the cylindrical wall (m). Absent: no cylinder.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Height of the floor (m). Absent: no floor.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor: Option<f64>,
}

/// Where and how the spheres start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Start {
    /// Random positions without overlap, inside the tank's cylinder.
    Random {
        /// Lowest start height of a centre (m).
        z_min: f64,
        /// Highest start height of a centre (m).
        z_max: f64,
        /// Each velocity component is uniform in plus or minus this (m/s).
        #[serde(default)]
        speed: f64,
        /// Each spin component is uniform in plus or minus this (rad/s); no effect
        /// in a scene without friction.
        #[serde(default)]
        spin: f64,
    },
    /// Every sphere listed in the scene.
    List {
        /// One entry per sphere; their number must equal `spheres.count`.
        spheres: Vec<StartSphere>,
    },
    /// One sphere after the other, all at one place and with one velocity, from time zero on.
    Feed {
        /// Centre of a sphere when it comes in (m).
        position: [f64; 3],
        /// Its velocity (m/s).
        #[serde(default)]
        velocity: [f64; 3],
        /// Time between two spheres (s); a whole number of steps. One that finds its place taken
        /// waits for the next of these times.
        interval: f64,
        /// The place is moved along x by a random length, uniform in plus or minus this (m).
        #[serde(default)]
        spread: f64,
    },
    /// Every sphere from a CSV file: x, y, z, then optionally vx, vy, vz, wx, wy, wz, radius,
    /// named by its header line.
    File {
        /// Path of the file, relative to the scene file.
        path: PathBuf,
    },
}

/// One sphere of a start list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StartSphere {
    /// Centre (m).
    pub position: [f64; 3],
    /// Velocity (m/s).
    #[serde(default)]
    pub velocity: [f64; 3],
    /// Spin (rad/s).
    #[serde(default)]
    pub spin: [f64; 3],
    /// Radius (m), if it differs from `spheres.radius`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
}

impl StartSphere {
    /// A sphere at rest at a place (m), with the radius that the scene gives it.
    pub fn at(position: [f64; 3]) -> Self {
        Self {
            position,
            velocity: [0.0; 3],
            spin: [0.0; 3],
            radius: None,
        }
    }
}

/// Gravity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gravity {
    /// Acceleration g (m/s2).
    pub acceleration: f64,
    /// Angle by which it leans from straight down towards +x (rad, default 0): the floor is then
    /// an incline that descends along x.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub tilt: f64,
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl Gravity {
    /// Components along x and z (m/s2); there is none along y.
    pub fn components(&self) -> [f64; 2] {
        // Exact without a tilt.
        let (sine, cosine) = libm::sincos(self.tilt);
        [self.acceleration * sine, -self.acceleration * cosine]
    }

    /// Gravitational energy (J) of a mass (kg) at x and z (m): m g z without a tilt.
    pub fn energy(&self, mass: f64, x: f64, z: f64) -> f64 {
        let [gx, gz] = self.components();
        -(mass * gx * x) - mass * gz * z
    }
}

/// Air in rigid rotation about the axis (Rice, 2012, eqs. 21 to 27).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Swirl {
    /// Angular velocity Omega of the air (rad/s), counter-clockwise seen from above.
    pub omega: f64,
}

/// Rising air with the rectangular counting shield (Rice, 2012, eq. 24).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Updraught {
    /// Speed v_z of the rising air (m/s).
    pub speed: f64,
    /// Factor s on the force.
    #[serde(default = "one")]
    pub strength: f64,
    /// Decay beta of the force with height (1/m).
    pub decay: f64,
    /// Height z0 at which the decay is 1 (m).
    pub origin: f64,
    /// Factor alpha per shielding sphere below, 0 to 1.
    pub alpha: f64,
    /// Rotation Omega_0 (rad/s) of the swirl at which the force is as given; at another Omega it is
    /// (Omega / Omega_0)^2 times that (Rice, 2012, eq. 44). Absent: the swirl does not matter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_omega: Option<f64>,
}

impl Updraught {
    /// The factor on the force at the height z0, without shield: s, or s (Omega / Omega_0)^2.
    pub fn strength_in(&self, swirl: Option<&Swirl>) -> f64 {
        let rotation = match (self.reference_omega, swirl) {
            (Some(reference), Some(swirl)) => swirl.omega / reference,
            _ => 1.0,
        };
        self.strength * rotation * rotation
    }
}

/// Viscous damping of spins.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpinDamping {
    /// Torque per spin, c (kg m2/s).
    pub coefficient: f64,
}

/// Time step, duration, frames, integrator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Time step dt (s); or "auto", which chooses the largest that is at most `safety_factor` times
    /// every limit of the scene and that divides `frame_interval` and the interval of a feed.
    pub dt: f64,
    /// With `dt = "auto"` only: the largest step over the least limit, advised limits included
    /// (default 0.2). A scene that runs has a number for its step, and none here.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub safety_factor: Option<f64>,
    /// Duration of the run (s).
    pub duration: f64,
    /// Time between frames (s); a whole number of steps.
    pub frame_interval: f64,
    /// Integration scheme.
    #[serde(default)]
    pub integrator: Integrator,
}

/// Integration scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// Symplectic (semi-implicit) Euler, as the thesis: first order.
    #[default]
    SymplecticEuler,
    /// Velocity Verlet, forces at the half-step velocity: second order without
    /// velocity-dependent forces, first order with them.
    VelocityVerlet,
    /// Velocity Verlet with forces from places and velocities of one moment, the middle of the step:
    /// second order, and no sticking between spheres of very different sizes (Vyas et al., 2025).
    SynchronisedVerlet,
    /// The same with sub-steps for spheres that touch, as many as their impacts need: the time step
    /// has to resolve all but the contacts.
    AdaptiveVerlet,
}

impl Integrator {
    /// All schemes.
    pub const ALL: [Self; 4] = [
        Self::SymplecticEuler,
        Self::VelocityVerlet,
        Self::SynchronisedVerlet,
        Self::AdaptiveVerlet,
    ];

    /// Names of all schemes.
    pub(crate) const NAMES: [&str; 4] = [
        Self::ALL[0].name(),
        Self::ALL[1].name(),
        Self::ALL[2].name(),
        Self::ALL[3].name(),
    ];

    /// Name, as in a scene file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SymplecticEuler => "symplectic-euler",
            Self::VelocityVerlet => "velocity-verlet",
            Self::SynchronisedVerlet => "synchronised-verlet",
            Self::AdaptiveVerlet => "adaptive-verlet",
        }
    }
}

/// Limits beyond which a run is ended and reported as unstable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Guards {
    /// Largest overlap, in radii of the smaller partner.
    pub overlap: f64,
    /// Largest displacement in one step, in radii of the sphere.
    pub displacement: f64,
    /// Largest |x| and |y| of a centre (m). Default: twice the tank's radius, if there is a tank.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub horizontal: Option<f64>,
    /// Largest |z| of a centre (m). Default, if there is a floor: ten times the largest of the
    /// floor's depth, the start height, and the tank's radius (1 m without one).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vertical: Option<f64>,
}

impl Default for Guards {
    fn default() -> Self {
        Self {
            overlap: 1.5,
            displacement: 1.0,
            horizontal: None,
            vertical: None,
        }
    }
}

/// What is stored besides the observables of every frame. Never changes the motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Time between snapshots of all spheres (s); 0 for none but the last.
    pub snapshot_interval: f64,
    /// Store position, velocity and spin of every sphere at every frame.
    pub trajectory: bool,
    /// Keep the books of energy: what damping and friction dissipate, what the air does, and what the
    /// integrator gets wrong.
    #[serde(skip_serializing_if = "is_default")]
    pub ledger: bool,
    /// Radial bins of the surface profile. Default: round(R / 2r).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub profile_bins: Option<usize>,
    /// Rise speeds, in radii per second above the mean, for which rising spheres are counted.
    pub rise_speeds: Vec<f64>,
    /// Distances from the axis, over R, within which rising spheres are counted.
    pub rise_radii: Vec<f64>,
}

impl Default for Output {
    fn default() -> Self {
        Self {
            snapshot_interval: 1.0,
            trajectory: false,
            ledger: false,
            profile_bins: None,
            rise_speeds: vec![5.0, 10.0, 20.0],
            rise_radii: vec![0.5, 0.75, 1.0],
        }
    }
}
