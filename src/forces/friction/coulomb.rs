//! Coulomb friction, regularised at rest.

use super::{Grip, Spring, TangentialLaw, Touch, Traction};
use crate::particles::math::inverse_square_root;

/// f = -mu F_n u / max(|u|, u_0), with the sliding velocity u of the contact point (translation
/// and spin). Below the regularisation speed u_0 it is viscous, so a pile at rest creeps.
#[derive(Clone, Copy, Debug)]
pub struct Coulomb {
    coefficient: f64,
    regularisation: f64,
}

impl Coulomb {
    /// The law with coefficient mu and regularisation speed u_0 (m/s).
    pub fn new(coefficient: f64, regularisation: f64) -> Self {
        Self {
            coefficient,
            regularisation,
        }
    }
}

impl TangentialLaw for Coulomb {
    type History = ();

    #[inline(always)]
    fn traction(&self, touch: &Touch, _: &mut Spring) -> Traction {
        let sliding = touch.sliding_velocity();
        let (squared, least) = (
            sliding.norm_squared(),
            self.regularisation * self.regularisation,
        );
        let squared = if squared < least { least } else { squared };
        let inverse_speed = inverse_square_root(squared);
        touch.traction(sliding * (-self.coefficient * touch.normal_force * inverse_speed))
    }

    fn damping(&self, grip: &Grip) -> f64 {
        self.coefficient * grip.normal_force / grip.speed.max(self.regularisation)
    }
}
