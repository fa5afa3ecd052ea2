//! Weight and inertia of spheres in a fluid.

use super::{Gravity, Scene};

impl Scene {
    /// Gravity minus buoyancy: the weight of a sphere in its fluid, over its mass. Negative if the
    /// sphere is lighter than the fluid.
    pub fn gravity_in_fluid(&self) -> Option<Gravity> {
        self.dem.effects.gravity_in_fluid(self.spheres.density)
    }

    /// Mass of the fluid that a sphere displaces and of its added mass, over its mass.
    pub fn pressed_mass_ratio(&self) -> f64 {
        self.dem.effects.pressed_mass_ratio(self.spheres.density)
    }

    /// Inertial mass over mass of a sphere: 1, or more with an added mass.
    pub fn inertial_factor(&self) -> f64 {
        1.0 + self.dem.effects.added_mass_ratio(self.spheres.density)
    }
}
