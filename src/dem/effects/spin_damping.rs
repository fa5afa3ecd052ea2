//! Viscous damping of spins: torque = -c w.

use super::OneBody;
use crate::dem::block::BLOCK;
use crate::dem::bodies::{Asked, Bodies};
use crate::dem::profile::Part;
use crate::scene;

pub(super) struct SpinDamping {
    coefficient: f64,
}

impl SpinDamping {
    pub(super) fn new(parameters: &scene::SpinDamping) -> Self {
        Self {
            coefficient: parameters.coefficient,
        }
    }
}

impl OneBody for SpinDamping {
    const PART: Part = Part::SpinDamping;
    const ASKS: Asked = Asked {
        motion: false,
        turn: true,
    };

    #[inline(always)]
    fn add(&self, bodies: &mut Bodies) {
        for (torque, spin) in bodies.torque.0.iter_mut().zip(&bodies.spin.0) {
            for k in 0..BLOCK {
                torque[k] -= spin[k] * self.coefficient;
            }
        }
    }
}
