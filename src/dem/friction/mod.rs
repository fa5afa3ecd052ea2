//! Tangential contact laws: one file each. Pairs and walls go through the same code.

mod coulomb;
mod cundall_strack;
mod mindlin;
mod spin;
mod spring;

pub use coulomb::Coulomb;
pub use cundall_strack::CundallStrack;
pub use mindlin::Mindlin;
pub use spin::SpinFriction;
pub use spring::Spring;

use super::vector::Vector;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A touching pair, or a sphere touching a wall, as a tangential law sees it. The first
/// partner is the sphere that the force acts on; a wall is a partner at rest, of infinite mass.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Unit normal, from the other partner to this one.
    pub normal: Vector,
    /// Velocity of this centre relative to the other (m/s).
    pub velocity: Vector,
    /// Spins of both partners (rad/s).
    pub spin: [Vector; 2],
    /// Distances of both centres from the contact point (m); zero for a wall.
    pub lever: [f64; 2],
    /// Moments of inertia of both partners (kg m2); zero for a wall.
    pub inertia: [f64; 2],
    /// The smaller of the two masses (kg).
    pub lesser_mass: f64,
    /// Overlap (m).
    pub overlap: f64,
    /// Effective radius (m).
    pub effective_radius: f64,
    /// Normal force (N), zero where partners attract each other or part faster than their elasticity
    /// recovers: no tangential force acts then.
    pub normal_force: f64,
    /// The time that the contact's memory moves on by.
    pub increment: Increment,
}

/// The time that a contact's memory moves on by when its traction is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Increment {
    /// How long it is (s).
    pub duration: f64,
    /// The share of it that is over at the moment of the traction: all of it, or half where places and
    /// velocities are those of its middle.
    pub share: f64,
}

impl Increment {
    /// All of a time (s), for traction at its end.
    pub fn whole(duration: f64) -> Self {
        Self {
            duration,
            share: 1.0,
        }
    }

    /// A time (s), for traction in its middle.
    pub fn around(duration: f64) -> Self {
        Self {
            duration,
            share: 0.5,
        }
    }
}

impl Touch {
    /// Velocity of this surface relative to the other at the contact point (m/s), tangential part.
    #[inline(always)]
    pub fn sliding_velocity(&self) -> Vector {
        let surface = self.spin[0] * self.lever[0] + self.spin[1] * self.lever[1];
        self.velocity.perpendicular_to(self.normal) - surface.cross(self.normal)
    }

    /// The traction of a tangential force on this partner at the contact point: by reaction
    /// the opposite force acts on the other, and both get a torque of the same sense.
    #[inline(always)]
    pub fn traction(&self, force: Vector) -> Traction {
        let arm = force.cross(self.normal);
        Traction {
            force,
            torque: [arm * self.lever[0], arm * self.lever[1]],
        }
    }
}

/// What a tangential law answers.
#[derive(Clone, Copy, Debug)]
pub struct Traction {
    /// Tangential force on this partner (N); the other gets the opposite.
    pub force: Vector,
    /// Torques on both partners (N m).
    pub torque: [Vector; 2],
}

/// A tangential contact law. The engine is compiled for each law by itself.
pub trait TangentialLaw: Copy + Send + 'static {
    /// Whether spheres rotate, which costs spins and torques.
    const ROTATES: bool = true;
    /// What a contact remembers from step to step; `()` costs nothing. A checkpoint stores it.
    type History: Copy + Default + Send + Serialize + DeserializeOwned;

    /// Traction at a contact over the coming step; none where the normal force is zero.
    fn traction(&self, touch: &Touch, history: &mut Self::History) -> Traction;

    /// Energy (J) of what a contact remembers, at an overlap and effective radius (m).
    fn energy(&self, _history: &Self::History, _overlap: f64, _effective_radius: f64) -> f64 {
        0.0
    }

    /// Tangential stiffness (N/m) at an overlap and effective radius (m).
    fn stiffness(&self, _overlap: f64, _effective_radius: f64) -> f64 {
        0.0
    }

    /// Force per sliding velocity (N s/m) under a normal force (N) and at a speed (m/s).
    fn damping(&self, _normal_force: f64, _speed: f64) -> f64 {
        0.0
    }
}

/// No friction: spheres do not rotate.
#[derive(Clone, Copy, Debug)]
pub struct Frictionless;

impl TangentialLaw for Frictionless {
    const ROTATES: bool = false;
    type History = ();

    #[inline(always)]
    fn traction(&self, _: &Touch, (): &mut ()) -> Traction {
        Traction {
            force: Vector::ZERO,
            torque: [Vector::ZERO; 2],
        }
    }
}
