//! Time step, duration, frames, integrator.

use crate::document::quantities::seconds;
use crate::document::quantity;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Value of `time.dt` with which the program chooses the time step.
pub(crate) const AUTO: &str = "auto";

/// Time step, duration, frames, integrator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// Time step dt (s); or "auto", which chooses the largest that is at most `safety_factor` times
    /// every limit of the scene and that divides `frame_interval` and the interval of a feed.
    #[schemars(transform = seconds("Δt", "time step").or(AUTO))]
    pub dt: f64,
    /// With `dt = "auto"` only: the step is at most this times the smallest limit, advised limits
    /// included (default 0.2). Absent once the step is chosen.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("f", "", "time step over its least limit").above(0.0).at_most(1.0)
    )]
    pub safety_factor: Option<f64>,
    /// Duration of the run (s).
    #[schemars(transform = seconds("T", "duration"))]
    pub duration: f64,
    /// Time between frames (s); a whole number of steps.
    #[schemars(transform = seconds("Δt_{frame}", "time between frames"))]
    pub frame_interval: f64,
    /// Integration scheme.
    #[serde(default)]
    pub integrator: Integrator,
    /// With `adaptive-verlet` only: the largest h (w + g) of a sub-step h, with angular frequency w
    /// and damping rate g of the fastest oscillation in its group (default 0.15, 27 sub-steps or
    /// more per impact). Smaller is more accurate and costs more; above 1 contacts may gain energy.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("ε", "rad", "resolution of adaptive Verlet")
            .at_least(1e-4)
            .at_most(1.0)
    )]
    pub resolution: Option<f64>,
}

/// The default resolution of adaptive Verlet (rad).
const RESOLUTION: f64 = 0.15;

impl Time {
    /// The largest h (w + g) of a sub-step of adaptive Verlet (rad).
    pub(crate) fn resolution(&self) -> f64 {
        self.resolution.unwrap_or(RESOLUTION)
    }

    /// Steps between two frames.
    pub fn steps_per_frame(&self) -> u64 {
        (self.frame_interval / self.dt).round() as u64
    }

    /// Frames of a whole run, the start not counted.
    pub fn frames(&self) -> u64 {
        (self.duration / self.frame_interval).round() as u64
    }
}

/// Integration scheme.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// Symplectic (semi-implicit) Euler, as in the thesis: first order.
    #[default]
    SymplecticEuler,
    /// Velocity Verlet, forces at the half-step velocity: second order without
    /// velocity-dependent forces, first order with them.
    VelocityVerlet,
    /// Velocity Verlet with forces from positions and velocities of the same moment, the middle of
    /// the step: second order, and no sticking between spheres of very different sizes (Vyas et
    /// al., 2025).
    SynchronisedVerlet,
    /// As `synchronised-verlet`, with sub-steps for spheres that touch, as many as their impacts
    /// need. The time step need not resolve contacts.
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

    /// Lag, in steps, of the velocities behind the positions at which forces are evaluated.
    pub(crate) const fn lag(self) -> f64 {
        match self {
            Self::SymplecticEuler | Self::VelocityVerlet => 0.5,
            Self::SynchronisedVerlet | Self::AdaptiveVerlet => 0.0,
        }
    }

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
