//! Tangential contact laws, one file each: keys, formula, limit of the time step. Pairs and walls
//! go through the same code.

mod coulomb;
mod cundall_strack;
mod hooke;
mod keeps;
mod keys;
mod mindlin;
mod mindlin_deresiewicz;
mod silbert;
mod spin;
mod spring;

pub use coulomb::{Coulomb, CoulombLaw};
pub use cundall_strack::{CundallStrack, CundallStrackLaw};
pub use hooke::{HookeFriction, HookeFrictionLaw};
pub(crate) use keeps::ForceChange;
pub use keeps::{Keeps, SpringAtRadius};
pub use keys::Friction;
pub(crate) use keys::{FrictionKeys, with_pairs_of_laws};
pub use mindlin::{Mindlin, MindlinLaw};
pub use mindlin_deresiewicz::{MindlinDeresiewicz, MindlinDeresiewiczLaw, SlipHistory};
pub use silbert::{SilbertFriction, SilbertFrictionLaw};
pub use spin::{Spin, SpinLaw};
pub use spring::{LoadedSpring, Spring};

use crate::particles::block::VectorRow;
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// A touching pair, or a sphere touching a wall, in the form that tangential laws take. The first
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
    /// m1 m2 / (m1 + m2) (kg); the mass of the moving partner if the other is fixed.
    pub effective_mass: f64,
    /// The [contact radius](super::contact::contact_radius) (m), if a law uses it.
    pub contact_radius: f64,
    /// Normal force (N). Zero where partners attract each other or part faster than their
    /// elasticity recovers; most laws then have no tangential force.
    pub normal_force: f64,
    /// The contact force along the normal (N), negative where partners attract each other.
    pub force_along_normal: f64,
    /// The mean sliding velocity since the last evaluation of this contact (m/s). It loads springs.
    pub loading_velocity: Vector,
    /// The mean [contact radius](super::contact::contact_radius) since then (m).
    pub loading_radius: f64,
    /// The time since then (s).
    pub loading_time: f64,
}

impl Touch {
    /// Velocity of this surface relative to the other at the contact point (m/s), tangential part.
    #[inline(always)]
    pub fn sliding_velocity(&self) -> Vector {
        sliding_velocity(self.normal, self.velocity, self.spin, self.lever)
    }

    /// The traction of a tangential force on this partner at the contact point: by reaction
    /// the opposite force acts on the other, and both get a torque of the same sense.
    #[inline(always)]
    pub fn traction(&self, force: Vector) -> Traction {
        let arm = arm(force, self.normal);
        Traction {
            force,
            torque: [arm * self.lever[0], arm * self.lever[1]],
        }
    }
}

/// The torque of a tangential force (N) on either partner, divided by its lever.
#[inline(always)]
pub(crate) fn arm(force: Vector, normal: Vector) -> Vector {
    force.cross(normal)
}

/// Velocity of one surface relative to the other at the contact point (m/s), tangential part, from
/// the relative velocity of the centres.
#[inline(always)]
pub(crate) fn sliding_velocity(
    normal: Vector,
    velocity: Vector,
    spin: [Vector; 2],
    lever: [f64; 2],
) -> Vector {
    let surface = spin[0] * lever[0] + spin[1] * lever[1];
    velocity.perpendicular_to(normal) - surface.cross(normal)
}

/// A contact at its deepest: the numbers from which its sub-steps are chosen.
#[derive(Clone, Copy, Debug)]
pub struct Grip {
    /// Overlap (m).
    pub overlap: f64,
    /// Effective radius (m).
    pub effective_radius: f64,
    /// Effective mass (kg).
    pub effective_mass: f64,
    /// Normal force (N).
    pub normal_force: f64,
    /// Relative speed (m/s).
    pub speed: f64,
}

/// Force and torques of a tangential law.
#[derive(Clone, Copy, Debug)]
pub struct Traction {
    /// Tangential force on this partner (N); the other gets the opposite.
    pub force: Vector,
    /// Torques on both partners (N m).
    pub torque: [Vector; 2],
}

/// Turning point of a contact with partial slip.
#[derive(Clone, Copy, Debug, Default, Serialize, Deserialize)]
pub struct Turning {
    /// The tangential force at the latest turning point (N); zero before the first one.
    pub(crate) force: Vector,
    /// The normal force to which spring and turning point belong (N).
    pub(crate) normal_force: f64,
    /// The tangential force at which the contact was first unloaded (N).
    pub(crate) peak: f64,
}

/// What a contact remembers: nothing, a spring, or a spring and either the contact radius at which
/// it had its force or its latest turning point.
pub trait History: Copy + Default + Send + Sync + Serialize + DeserializeOwned {
    /// Whether it has a turning point.
    const TURNS: bool = false;
    /// Whether it has the contact radius at which the spring had its force.
    const HAS_RADIUS: bool = false;

    /// Its spring.
    fn spring(self) -> Spring;

    /// The history of a contact with this spring.
    fn of_spring(spring: Spring) -> Self;

    /// Its turning point.
    #[inline(always)]
    fn turning(self) -> Turning {
        Turning::default()
    }

    /// The same history with a turning point, if it has one.
    #[inline(always)]
    fn with_turning(self, _: Turning) -> Self {
        self
    }

    /// The contact radius (m) at which the spring had its force, if it is stored.
    #[inline(always)]
    fn radius(self) -> f64 {
        0.0
    }

    /// The row of the spring's force and the contact radius. The last number has no meaning without
    /// the radius.
    #[inline(always)]
    fn row(self) -> VectorRow {
        self.spring().force.row()
    }

    /// The history of a contact with this row.
    #[inline(always)]
    fn of_row(row: VectorRow) -> Self {
        Self::of_spring(Spring {
            force: Vector::of_row(row),
        })
    }

    /// The history of the same contact as the other partner sees it.
    fn turned_round(self) -> Self {
        let force = -self.spring().force;
        Self::of_spring(Spring { force })
    }

    /// Whether the contact is new. Compares bits: 0 and -0 are equal numbers, but may lead to
    /// different motions.
    fn is_new(self) -> bool {
        let Vector { x, y, z, .. } = self.spring().force;
        [x, y, z].iter().all(|value| value.to_bits() == 0)
    }
}

impl History for () {
    #[inline(always)]
    fn spring(self) -> Spring {
        Spring::default()
    }

    #[inline(always)]
    fn of_spring(_: Spring) {}
}

impl History for Spring {
    #[inline(always)]
    fn spring(self) -> Spring {
        self
    }

    #[inline(always)]
    fn of_spring(spring: Spring) -> Self {
        spring
    }
}

/// A tangential contact law. The engine is compiled for each law by itself.
pub trait TangentialLaw: Copy + Send + Sync + 'static {
    /// Whether spheres rotate, which costs spins and torques.
    const ROTATES: bool = true;
    /// Whether the law uses masses and moments of inertia. If not, a [`Touch`] need not have them.
    const WEIGHS: bool = false;
    /// Whether the law uses the [contact radius](super::contact::contact_radius).
    const USES_CONTACT_RADIUS: bool = false;
    /// Whether the law uses the effective mass. If not, a [`Touch`] need not have it.
    const NEEDS_EFFECTIVE_MASS: bool = false;
    /// Whether a dashpot acts in parallel with the spring of a law with history.
    const DRAGS: bool = false;
    /// Whether the force of a sliding contact is a spring that is loaded by increments and capped.
    const BY_INCREMENTS: bool = true;
    /// What a contact remembers from step to step; `()` costs nothing. A checkpoint stores it.
    type History: History;

    /// Traction at a contact over the coming step; zero if the normal force is zero. Without
    /// branches, because it is applied to blocks of contacts. The `spring` is already [across the
    /// normal](Spring::turned). A law without history does not change it. A law with a history
    /// implements [`load`](Self::load) instead.
    #[inline(always)]
    fn traction(&self, touch: &Touch, spring: &mut Spring) -> Traction {
        let loaded = self.load(touch, *spring);
        let squared = loaded.squared();
        let (force, left) = loaded.capped(squared, inverse_square_root(squared));
        *spring = left;
        touch.traction(force)
    }

    /// The same law with another coefficient of friction, for a wall.
    #[must_use]
    fn with_coefficient(self, coefficient: f64) -> Self;

    /// What its spring keeps while the contact radius changes. All but [`Keeps::Force`] need a
    /// history that [has the radius](History::HAS_RADIUS). The `spring` of
    /// [`load`](Self::load) has changed already.
    #[inline(always)]
    fn keeps(&self) -> Keeps {
        Keeps::Force
    }

    /// The spring of a law with history, loaded over the coming step.
    #[inline(always)]
    fn load(&self, _touch: &Touch, _spring: Spring) -> LoadedSpring {
        LoadedSpring::default()
    }

    /// The same for a law whose history has a turning point, which it moves.
    #[inline(always)]
    fn load_and_turn(&self, touch: &Touch, spring: Spring, _: &mut Turning) -> LoadedSpring {
        self.load(touch, spring)
    }

    /// Energy (J) stored in the history of a contact, at an overlap and effective radius (m).
    fn energy(&self, _history: &Self::History, _overlap: f64, _effective_radius: f64) -> f64 {
        0.0
    }

    /// Tangential stiffness (N/m) at an overlap and effective radius (m).
    fn stiffness(&self, _overlap: f64, _effective_radius: f64) -> f64 {
        0.0
    }

    /// Force per sliding velocity (N s/m).
    fn damping(&self, _grip: &Grip) -> f64 {
        0.0
    }
}

/// No friction: spheres do not rotate.
#[derive(Clone, Copy, Debug)]
pub struct Frictionless;

impl TangentialLaw for Frictionless {
    const ROTATES: bool = false;
    type History = ();

    fn with_coefficient(self, _: f64) -> Self {
        self
    }

    #[inline(always)]
    fn traction(&self, _: &Touch, _: &mut Spring) -> Traction {
        Traction {
            force: Vector::ZERO,
            torque: [Vector::ZERO; 2],
        }
    }
}
