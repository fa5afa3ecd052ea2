//! The thesis's friction, from spins alone.

use super::{Spring, TangentialLaw, Touch, Traction};

/// Rice (2012), eqs. 10 to 14: f_i = -mu m dv_s / dt and tau_i = -mu I_i dw / dt, with dv_s the
/// difference of the surface velocities due to spin, dw the sum of the spins perpendicular to the
/// normal, and m the smaller mass (all masses are equal in the thesis).
///
/// An impulse per step: the law depends on the time step, knows no sliding and does not conserve
/// angular momentum. It is kept because it is what the thesis ran.
#[derive(Clone, Copy, Debug)]
pub struct SpinFriction {
    /// mu / dt (1/s).
    rate: f64,
}

impl SpinFriction {
    /// The law with coefficient mu for time steps of `dt` (s).
    pub fn new(coefficient: f64, dt: f64) -> Self {
        Self {
            rate: coefficient / dt,
        }
    }
}

impl TangentialLaw for SpinFriction {
    const WEIGHS: bool = true;
    type History = ();

    #[inline(always)]
    fn traction(&self, touch: &Touch, _: &mut Spring) -> Traction {
        let surface = touch.spin[0] * touch.lever[0] + touch.spin[1] * touch.lever[1];
        // A select, not a branch: whether a force is clipped to zero is hard to foresee.
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
