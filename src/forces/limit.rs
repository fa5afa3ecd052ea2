//! Limits of the time step, as effects and laws state them.

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
}

/// What the limits of effects depend on.
pub(crate) struct Regime {
    /// What the integrator makes of an oscillator.
    pub(crate) scheme: Scheme,
    /// Radius of the smallest sphere (m).
    pub(crate) smallest_radius: f64,
    /// Mass of the smallest sphere (kg).
    pub(crate) smallest_mass: f64,
    /// Moment of inertia of the smallest sphere (kg m2).
    pub(crate) smallest_inertia: f64,
    /// The fastest relative speed (m/s) to expect.
    pub(crate) fastest_impact: f64,
    /// The lowest height (m) of a centre.
    pub(crate) lowest_height: f64,
}

/// What an integrator makes of an oscillator: it stays bounded as one would of which symplectic
/// Euler makes the same, with another damping.
#[derive(Clone, Copy)]
pub(crate) struct Scheme {
    /// Factor on damping rates.
    pub(crate) damping: f64,
}

impl Scheme {
    /// Largest step (s) at which an oscillator of that angular frequency w (1/s) and damping rate g
    /// (1/s) stays bounded.
    pub(crate) fn oscillator(self, frequency: f64, rate: f64) -> f64 {
        // The positive root of (w dt)^2 + 2 g dt = 4, in the form that does not cancel.
        let rate = self.damping * rate;
        4.0 / (rate + (rate * rate + 4.0 * frequency * frequency).sqrt())
    }
}
