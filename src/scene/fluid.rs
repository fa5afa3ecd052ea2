//! What a fluid about the spheres makes of their weight and their inertia.

use super::{Gravity, Scene};

impl Scene {
    /// Gravity, less the buoyancy: what a sphere weighs in its fluid over its mass. Negative where
    /// it is lighter than the fluid.
    pub fn gravity_in_fluid(&self) -> Option<Gravity> {
        self.dem.effects.gravity_in_fluid(self.spheres.density)
    }

    /// Mass that a force must accelerate over the mass of a sphere: 1, or more with an added mass.
    pub fn inertial_factor(&self) -> f64 {
        1.0 + self.dem.effects.added_mass_ratio(self.spheres.density)
    }
}
