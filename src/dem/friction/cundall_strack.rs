//! Friction by a tangential spring and dashpot.

use super::{Spring, TangentialLaw, Touch, Traction};

/// A spring of constant stiffness k_t and a dashpot b_t along the contact, together capped at mu F_n
/// (Cundall and Strack, Geotechnique 29, 47 (1979)): df = -k_t du and f - b_t u while it sticks. A
/// contact that slides keeps the spring at the length with which it would go on sticking from there
/// (Luding, Granular Matter 10, 235 (2008), section 2.3).
#[derive(Clone, Copy, Debug)]
pub struct CundallStrack {
    coefficient: f64,
    /// k_t dt (N s/m).
    loading: f64,
    /// b_t (N s/m).
    damping: f64,
}

impl CundallStrack {
    /// The law with coefficient mu, tangential stiffness k_t (N/m) and drag constant b_t (N s/m), for
    /// time steps of `dt` (s).
    pub fn new(coefficient: f64, stiffness: f64, damping: f64, dt: f64) -> Self {
        Self {
            coefficient,
            loading: stiffness * dt,
            damping,
        }
    }
}

impl TangentialLaw for CundallStrack {
    type History = Spring;

    #[inline(always)]
    fn traction(&self, touch: &Touch, spring: &mut Spring) -> Traction {
        let sliding = touch.sliding_velocity();
        let drag = sliding * self.damping;
        let elastic = spring.turned(touch.normal) - sliding * self.loading;
        let mut force = elastic - drag;
        spring.force = elastic;
        let limit = self.coefficient * touch.normal_force;
        let norm = force.norm();
        if norm > limit {
            force = force * (limit / norm);
            spring.force = force + drag;
        }
        touch.traction(force)
    }
}
