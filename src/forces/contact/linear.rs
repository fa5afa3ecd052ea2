//! Linear spring and dashpot.

use super::{ContactDrag, NormalLaw};

/// F = k delta + b d(delta)/dt along the line of centres, with overlap delta, spring constant k and
/// drag constant b (Cundall and Strack, 1979). With the drag on the whole relative velocity
/// (Remmers, 2009) also -b times its tangential part.
#[derive(Clone, Copy, Debug)]
pub struct Linear {
    /// k (N/m).
    stiffness: f64,
    /// b (N s/m).
    damping: f64,
    /// b of the tangential part (N s/m), which may be zero.
    sideways_drag: f64,
}

impl Linear {
    /// The law with a spring constant (N/m) and a drag constant (N s/m).
    pub fn new(stiffness: f64, damping: f64, drag: ContactDrag) -> Self {
        Self {
            stiffness,
            damping,
            sideways_drag: match drag {
                ContactDrag::Normal => 0.0,
                ContactDrag::Whole => damping,
            },
        }
    }
}

impl NormalLaw for Linear {
    const DRAGS_SIDEWAYS: bool = true;
    const ATTRACTS: bool = true;

    #[inline(always)]
    fn force(&self, overlap: f64, overlap_rate: f64, _: f64, _: f64) -> f64 {
        self.stiffness * overlap + self.damping * overlap_rate
    }

    #[inline(always)]
    fn sideways_drag(&self) -> f64 {
        self.sideways_drag
    }

    #[inline(always)]
    fn elastic_energy(&self, overlap: f64, _: f64) -> f64 {
        0.5 * self.stiffness * overlap * overlap
    }

    fn stiffness(&self, _: f64, _: f64) -> f64 {
        self.stiffness
    }

    fn damping(&self, _: f64, _: f64, _: f64) -> f64 {
        self.damping
    }

    fn deepest_overlap(&self, overlap: f64, speed: f64, _: f64, effective_mass: f64) -> f64 {
        (overlap * overlap + effective_mass * speed * speed / self.stiffness).sqrt()
    }
}
