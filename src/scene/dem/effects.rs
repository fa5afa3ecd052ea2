//! What acts on single spheres: gravity, the air, the damping of spins.

use super::Drag;
use crate::document::quantity;
use crate::scene::one;
use crate::scene::quantities::{fraction, place};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The effects on single spheres. One that is absent does not exist in the simulation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Effects {
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
}

/// Gravity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gravity {
    /// Acceleration g (m/s2).
    #[schemars(transform = quantity("g", "m/s²", "acceleration of gravity").at_least(0.0))]
    pub acceleration: f64,
    /// Angle by which it leans from straight down towards +x (rad, default 0): the floor is then
    /// an incline that descends along x.
    #[serde(default, skip_serializing_if = "is_zero")]
    #[schemars(transform = quantity("θ", "rad", "tilt of gravity"))]
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
    #[schemars(transform = quantity("Ω", "rad/s", "angular velocity of the air"))]
    pub omega: f64,
}

/// Rising air with the rectangular counting shield (Rice, 2012, eq. 24).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Updraught {
    /// Speed v_z of the rising air (m/s).
    #[schemars(transform = quantity("v_z", "m/s", "speed of the rising air"))]
    pub speed: f64,
    /// Factor s on the force.
    #[serde(default = "one")]
    #[schemars(transform = quantity("s", "", "strength of the updraught").at_least(0.0))]
    pub strength: f64,
    /// Decay beta of the force with height (1/m).
    #[schemars(
        transform = quantity("β", "1/m", "decay of the updraught with height").at_least(0.0)
    )]
    pub decay: f64,
    /// Height z0 at which the decay is 1 (m).
    #[schemars(transform = place("z_0", "height where the decay begins"))]
    pub origin: f64,
    /// Factor alpha per shielding sphere below, 0 to 1.
    #[schemars(transform = fraction("α", "factor per shielding sphere"))]
    pub alpha: f64,
    /// Rotation Omega_0 (rad/s) of the swirl at which the force is as given; at another Omega it is
    /// (Omega / Omega_0)^2 times that (Rice, 2012, eq. 44). Absent: the swirl does not matter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("Ω_0", "rad/s", "rotation at which the updraught is as given")
            .above(0.0)
    )]
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
    #[schemars(transform = quantity("c_ω", "kg m²/s", "coefficient of spin damping").at_least(0.0))]
    pub coefficient: f64,
}
