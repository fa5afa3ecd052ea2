//! The thesis's friction, from spins alone.

use super::{FrictionKeys, Spring, TangentialLaw, Touch, Traction};
use crate::document::quantities::fraction;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The thesis's rule (Rice, 2012, eqs. 10 to 14): from spins alone, an impulse per step. Depends on
/// the time step, ignores sliding, does not conserve angular momentum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spin {
    /// Coefficient mu.
    #[schemars(transform = fraction("μ", "coefficient of friction"))]
    pub coefficient: f64,
}

impl Spin {
    /// Name of the law, as in a scene file.
    pub(crate) const NAME: &'static str = "spin";
}

/// Its stability does not depend on the step; the range of its coefficient ensures it.
impl<C> FrictionKeys<C> for Spin {
    type Law = SpinLaw;

    fn law(&self, _: &C, dt: f64) -> SpinLaw {
        SpinLaw::new(self.coefficient, dt)
    }
}

/// Rice (2012), eqs. 10 to 14: f_i = -mu m dv_s / dt and tau_i = -mu I_i dw / dt, with dv_s the
/// difference of the surface velocities due to spin, dw the sum of the spins perpendicular to the
/// normal, and m the smaller mass (all masses are equal in the thesis), without an added mass.
///
/// An impulse per step: the law depends on the time step, ignores sliding and does not conserve
/// angular momentum. It is kept because the thesis used it.
#[derive(Clone, Copy, Debug)]
pub struct SpinLaw {
    /// mu / dt (1/s).
    rate: f64,
    /// Time step (s).
    dt: f64,
}

impl SpinLaw {
    /// The law with coefficient mu for time steps of `dt` (s).
    pub fn new(coefficient: f64, dt: f64) -> Self {
        Self {
            rate: coefficient / dt,
            dt,
        }
    }
}

impl TangentialLaw for SpinLaw {
    const WEIGHS: bool = true;
    type History = ();

    fn with_coefficient(self, coefficient: f64) -> Self {
        Self::new(coefficient, self.dt)
    }

    #[inline(always)]
    fn traction(&self, touch: &Touch, _: &mut Spring) -> Traction {
        let surface = touch.spin[0] * touch.lever[0] + touch.spin[1] * touch.lever[1];
        // A select, not a branch: whether a force is clipped to zero is hard to predict.
        let rate = if touch.normal_force > 0.0 {
            self.rate
        } else {
            0.0
        };
        let spin = (touch.spin[0] + touch.spin[1]).perpendicular_to(touch.normal);
        Traction {
            force: surface.cross(touch.normal) * (rate * touch.lesser_mass),
            torque: touch.inertia.map(|inertia| spin * (-rate * inertia)),
        }
    }
}
