//! The spheres of a simulation, one array per quantity, and blocks of them.

pub(crate) mod block;
pub(crate) mod bodies;
pub(crate) mod domain;
pub mod math;
pub(crate) mod reorder;
pub mod vector;

pub use domain::Domain;

use reorder::reorder;
use serde::{Deserialize, Serialize};
use vector::Vector;

/// The spheres. Every array has one entry per sphere, or is empty if the scene does not need it:
/// spins, torques and moments of inertia exist only with friction.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Particles {
    /// The space in which they move. A checkpoint does not hold it, as the scene says it.
    #[serde(skip)]
    pub domain: Domain,
    /// Number of fixed spheres, which come first.
    pub fixed: usize,
    /// Number of each sphere in the scene, counted from 0, fixed spheres separately. Empty if no
    /// sphere comes or goes and there are too few to be sorted: numbers and indices are then equal.
    pub number: Vec<u32>,
    /// Centres (m).
    pub position: Vec<Vector>,
    /// Velocities (m/s).
    pub velocity: Vec<Vector>,
    /// Forces of the latest evaluation (N); meaningless once a guard is broken.
    pub force: Vec<Vector>,
    /// Spins (rad/s); empty without rotation.
    pub spin: Vec<Vector>,
    /// Torques of the latest evaluation (N m); empty without rotation.
    pub torque: Vec<Vector>,
    /// Radii (m).
    pub radius: Vec<f64>,
    /// Masses (kg), without added mass of a fluid.
    pub mass: Vec<f64>,
    /// Inertial mass over mass: more than 1 if a fluid moves with the spheres.
    pub inertial_factor: f64,
    /// Inverse [inertial masses](Self::inertial_mass) (1/kg); zero holds a sphere in place.
    pub inverse_mass: Vec<f64>,
    /// Moments of inertia (kg m2); empty without rotation.
    pub inertia: Vec<f64>,
    /// Inverse moments of inertia; empty without rotation.
    pub inverse_inertia: Vec<f64>,
}

impl Default for Particles {
    fn default() -> Self {
        Self {
            domain: Domain::default(),
            fixed: 0,
            number: Vec::new(),
            position: Vec::new(),
            velocity: Vec::new(),
            force: Vec::new(),
            spin: Vec::new(),
            torque: Vec::new(),
            radius: Vec::new(),
            mass: Vec::new(),
            inertial_factor: 1.0,
            inverse_mass: Vec::new(),
            inertia: Vec::new(),
            inverse_inertia: Vec::new(),
        }
    }
}

impl Particles {
    /// Inertial mass of a sphere (kg): its own mass and the mass of the fluid that moves with it.
    pub fn inertial_mass(&self, sphere: usize) -> f64 {
        self.mass[sphere] * self.inertial_factor
    }

    /// Forgets the forces and torques of the latest evaluation.
    pub(crate) fn clear_forces(&mut self) {
        self.force.fill(Vector::ZERO);
        self.torque.fill(Vector::ZERO);
    }

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

    /// Whether every array has an entry per sphere or, if it is optional, is empty.
    pub(crate) fn fits_together(&self) -> bool {
        let all = self.len();
        let turning = if self.rotate() { all } else { 0 };
        let vectors = [&self.position, &self.velocity, &self.force];
        let scalars = [&self.mass, &self.inverse_mass];
        self.fixed <= all
            && (self.number.is_empty() || self.number.len() == all)
            && vectors.iter().all(|vectors| vectors.len() == all)
            && scalars.iter().all(|scalars| scalars.len() == all)
            && [&self.spin, &self.torque]
                .iter()
                .all(|it| it.len() == turning)
            && [&self.inertia, &self.inverse_inertia]
                .iter()
                .all(|it| it.len() == turning)
    }

    /// Adds a sphere that moves, at the end.
    pub fn push(&mut self, sphere: &Sphere) {
        let Sphere {
            number,
            position,
            velocity,
            radius,
            mass,
            inertia,
            force,
        } = *sphere;
        self.number.push(number);
        self.position.push(position);
        self.velocity.push(velocity);
        self.force.push(force);
        self.radius.push(radius);
        self.mass.push(mass);
        self.inverse_mass.push(1.0 / (mass * self.inertial_factor));
        if let Some(inertia) = inertia {
            self.spin.push(Vector::ZERO);
            self.torque.push(Vector::ZERO);
            self.inertia.push(inertia);
            self.inverse_inertia.push(1.0 / inertia);
        }
    }

    /// Adds the spheres of `others`, which all move, at the end.
    pub fn append(&mut self, mut others: Self) {
        if self.is_empty() {
            // Avoids a second copy of many spheres in memory.
            *self = others;
            return;
        }
        self.position.append(&mut others.position);
        self.velocity.append(&mut others.velocity);
        self.force.append(&mut others.force);
        self.spin.append(&mut others.spin);
        self.torque.append(&mut others.torque);
        self.radius.append(&mut others.radius);
        self.mass.append(&mut others.mass);
        self.inverse_mass.append(&mut others.inverse_mass);
        self.inertia.append(&mut others.inertia);
        self.inverse_inertia.append(&mut others.inverse_inertia);
    }

    /// Removes the spheres that are not marked in `keep`; the others stay in order.
    pub fn retain(&mut self, keep: &[bool]) {
        self.fixed = keep[..self.fixed].iter().filter(|keep| **keep).count();
        retain(&mut self.number, keep);
        retain(&mut self.position, keep);
        retain(&mut self.velocity, keep);
        retain(&mut self.force, keep);
        retain(&mut self.spin, keep);
        retain(&mut self.torque, keep);
        retain(&mut self.radius, keep);
        retain(&mut self.mass, keep);
        retain(&mut self.inverse_mass, keep);
        retain(&mut self.inertia, keep);
        retain(&mut self.inverse_inertia, keep);
    }

    /// Puts the spheres into a new order.
    pub(crate) fn reorder(&mut self, order: &[u32]) {
        reorder(&mut self.number, order);
        let vectors = [
            &mut self.position,
            &mut self.velocity,
            &mut self.force,
            &mut self.spin,
            &mut self.torque,
        ];
        for vectors in vectors {
            reorder(vectors, order);
        }
        let scalars = [
            &mut self.radius,
            &mut self.mass,
            &mut self.inverse_mass,
            &mut self.inertia,
            &mut self.inverse_inertia,
        ];
        for scalars in scalars {
            reorder(scalars, order);
        }
    }

    /// The number in the scene's start of the sphere at an index. Fixed spheres have no number.
    pub(crate) fn number_in_scene(&self, index: usize) -> usize {
        match self.number.get(index) {
            Some(&number) => number as usize,
            None => index.saturating_sub(self.fixed),
        }
    }

    /// Whether the sphere at an index is fixed or driven, so that forces do not move it.
    #[inline(always)]
    pub(crate) fn is_prescribed(&self, index: usize) -> bool {
        self.inverse_mass[index] == 0.0
    }

    /// The least index of a partner of sphere `i` in a list of pairs: the lower index comes first,
    /// and two fixed spheres form no pair.
    #[inline]
    pub(crate) fn first_partner(&self, i: usize) -> usize {
        (i + 1).max(self.fixed)
    }

    /// Largest radius (m).
    pub fn largest_radius(&self) -> f64 {
        self.radius.iter().copied().fold(0.0, f64::max)
    }
}

/// A sphere that comes in.
#[derive(Clone, Copy, Debug)]
pub struct Sphere {
    /// Its number in the scene.
    pub number: u32,
    /// Centre (m).
    pub position: Vector,
    /// Velocity (m/s).
    pub velocity: Vector,
    /// Radius (m).
    pub radius: f64,
    /// Mass (kg).
    pub mass: f64,
    /// Moment of inertia (kg m2), in a scene with rotation.
    pub inertia: Option<f64>,
    /// The force on it at entry (N), with which velocity Verlet begins its step.
    pub force: Vector,
}

/// Keeps the entries that are marked; leaves an empty array alone.
pub(crate) fn retain<T>(entries: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    entries.retain(|_| keep.next().is_none_or(|keep| *keep));
}
