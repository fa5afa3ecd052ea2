//! Spheres that move along prescribed paths.
//!
//! Such a sphere has infinite inertia, so that forces leave its velocity alone. In every step it
//! has the velocity that takes it to where its path is at the end of the step.

use super::System;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Gives driven spheres their mean velocity between two moments of the present step: 0 is its
    /// start, 1 its end.
    pub(super) fn drive(&mut self, from: f64, to: f64) {
        if self.setup.driven.is_empty() {
            return;
        }
        let (steps, dt) = ((self.step.number - 1) as f64, self.setup.dt);
        // There is no path before the start.
        let time = |part: f64| (steps + part).max(0.0) * dt;
        for (sphere, path) in &self.setup.driven {
            self.particles.velocity[*sphere] = path.mean_velocity(time(from), time(to));
        }
    }
}
