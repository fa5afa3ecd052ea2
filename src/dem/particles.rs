//! The spheres of a simulation, one array per quantity.

use super::vector::Vector;

/// The spheres. Every array has one entry per sphere, or none at all where the scene has no
/// use for it: spins, torques and moments of inertia exist only with friction.
#[derive(Clone, Debug, Default)]
pub struct Particles {
    /// Centres (m).
    pub position: Vec<Vector>,
    /// Velocities (m/s).
    pub velocity: Vec<Vector>,
    /// Forces of the latest evaluation (N).
    pub force: Vec<Vector>,
    /// Spins (rad/s); empty without rotation.
    pub spin: Vec<Vector>,
    /// Torques of the latest evaluation (N m); empty without rotation.
    pub torque: Vec<Vector>,
    /// Radii (m).
    pub radius: Vec<f64>,
    /// Masses (kg).
    pub mass: Vec<f64>,
    /// Inverse masses (1/kg); zero holds a sphere in place.
    pub inverse_mass: Vec<f64>,
    /// Moments of inertia (kg m2); empty without rotation.
    pub inertia: Vec<f64>,
    /// Inverse moments of inertia; empty without rotation.
    pub inverse_inertia: Vec<f64>,
}

impl Particles {
    /// Number of spheres.
    pub fn len(&self) -> usize {
        self.radius.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.radius.is_empty()
    }

    /// Whether the spheres have spins.
    pub fn rotate(&self) -> bool {
        !self.inertia.is_empty()
    }

    /// Largest radius (m).
    pub fn largest_radius(&self) -> f64 {
        self.radius.iter().copied().fold(0.0, f64::max)
    }
}
