//! Limits of the time step, as effects and laws state them.

use std::cell::LazyCell;

/// Name of the displacement limit. Advice for most integrators; decisive for adaptive Verlet.
pub(crate) const DISPLACEMENT: &str = "displacement";

/// Largest phase angle (rad) of a driven sphere's oscillation, or of the shaking, in one step. A
/// ball thrown up by a plate at four times gravity bounces 5 % lower on average with steps of this
/// angle and 20 % lower with twice the angle; with steps of half a period it stays at rest
/// (restitution 0.8).
pub(crate) const LARGEST_SWING: f64 = 0.5;

/// A limit of the time step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// What sets it.
    pub name: &'static str,
    /// Largest time step (s).
    pub seconds: f64,
    /// Whether a larger step is unstable and refused. The others are advice.
    pub decisive: bool,
    /// Formula and meaning, in one line.
    pub explanation: &'static str,
    /// Warning text, if there is one: what happens close to a decisive limit, or above an advised
    /// one.
    pub consequence: Option<&'static str>,
}

impl Limit {
    /// The consequence of coarse steps for a relaxing velocity or spin, for example towards the
    /// air's.
    pub(crate) const PASSES_ITS_END: Option<&str> =
        Some("stable, but relaxing velocities overshoot and oscillate in every step");

    /// The consequence of coarse steps for a contact.
    pub(crate) const COARSE: Option<&str> = Some(
        "stable for a pair, but coarse: with few steps per contact restitutions are off, and \
         several contacts at once may gain energy",
    );
}

/// The quantities from which limits of effects and laws are computed.
pub(crate) struct Regime<'a> {
    /// How stable the integrator keeps an oscillator.
    pub(crate) scheme: Scheme,
    /// Radius of the smallest sphere (m).
    pub(crate) smallest_radius: f64,
    /// Radius of the largest sphere (m).
    pub(crate) largest_radius: f64,
    /// Mean radius (m).
    pub(crate) mean_radius: f64,
    /// Inertial mass of the smallest sphere (kg).
    pub(crate) smallest_mass: f64,
    /// Inertial mass of the largest sphere (kg).
    pub(crate) largest_mass: f64,
    /// Inertial mass of a sphere of the mean radius (kg).
    pub(crate) mean_mass: f64,
    /// Inertial mass over mass.
    pub(crate) inertial_factor: f64,
    /// Density (kg/m3).
    pub(crate) density: f64,
    /// I / (m r^2).
    pub(crate) inertia_factor: f64,
    /// Whether there are walls or fixed spheres.
    pub(crate) has_walls: bool,
    /// Whether spheres move along prescribed paths, as if infinitely heavy.
    pub(crate) drives: bool,
    /// The fastest relative speed (m/s) to expect at an impact.
    pub(crate) fastest_impact: f64,
    /// The fastest speed (m/s) of a sphere to expect, at impacts and between them.
    pub(crate) fastest_motion: f64,
    /// The fastest spin (rad/s) to expect.
    pub(crate) fastest_spin: f64,
    /// The lowest height (m) of a centre.
    pub(crate) lowest_height: f64,
    /// The guard on displacements in a step, in radii.
    pub(crate) displacement_guard: f64,
    /// The deepest overlap (m) at the start, computed when it is first used.
    pub(crate) deepest_at_start: LazyCell<f64, Box<dyn FnOnce() -> f64 + 'a>>,
}

impl Regime<'_> {
    /// Moment of inertia of the smallest sphere (kg m2).
    pub(crate) fn smallest_inertia(&self) -> f64 {
        let mass = self.smallest_mass / self.inertial_factor;
        self.inertia_factor * mass * self.smallest_radius * self.smallest_radius
    }

    /// 1 + m r^2 / I, with the inertial mass m: a force at the surface accelerates the contact
    /// point this many times more than the centre.
    pub(crate) fn surface_factor(&self) -> f64 {
        1.0 + self.inertial_factor / self.inertia_factor
    }

    /// The limit at which the fastest sphere reaches the displacement guard: the smallest sphere,
    /// hit by the largest at the fastest speed, or at this one (m/s) if it is faster.
    pub(crate) fn displacement(&self, speed: f64) -> Limit {
        let speed = speed.max(self.fastest_motion);
        let (light, heavy) = (self.smallest_mass, self.largest_mass);
        let knocked_on = match self.drives {
            true => 2.0,
            false => 2.0 * heavy / (heavy + light),
        };
        Limit {
            name: DISPLACEMENT,
            seconds: self.displacement_guard * self.smallest_radius / (speed * knocked_on),
            decisive: false,
            explanation: "the fastest sphere stays below the displacement guard: the smallest, hit \
                by the largest (fastest speed times 2 M / (M + m)) or by a driven one (times 2)",
            consequence: Some(
                "the fastest sphere may pass the displacement guard, which ends the run",
            ),
        }
    }
}

/// How stable an integrator keeps an oscillator: the criterion of symplectic Euler, with the
/// damping rate multiplied by a factor.
#[derive(Clone, Copy)]
pub(crate) struct Scheme {
    /// Factor on damping rates.
    pub(crate) damping: f64,
}

impl Scheme {
    /// Largest step (s) at which an oscillator x'' = -w^2 x - g x' of angular frequency w (1/s) and
    /// damping rate g (1/s) stays bounded.
    pub(crate) fn oscillator(self, frequency: f64, rate: f64) -> f64 {
        // The positive root of (w dt)^2 + 2 g dt = 4, in the form that does not cancel.
        let rate = self.damping * rate;
        4.0 / (rate + (rate * rate + 4.0 * frequency * frequency).sqrt())
    }
}
