//! The force and torques at one contact, of two spheres or of a sphere and a wall.
//!
//! These functions have no branches, because loops over blocks of contacts call them, and some of
//! these contacts do not touch.

use super::contact_geometry::{ContactGeometry, Roots};
use super::contact_state::ContactState;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{
    ForceChange, History, LoadedSpring, Spring, TangentialLaw, Touch, Traction, Turning,
    sliding_velocity,
};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;
use crate::walls::Wall;

/// The time over which springs are loaded until an evaluation of forces, with the mean velocities
/// of that time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loading {
    /// How long it is (s).
    pub(super) duration: f64,
    /// How long before the evaluation the spheres had the velocities that load springs (s). These
    /// are then kept in separate rows. Zero if the velocities of the evaluation load springs.
    pub(super) age: f64,
}

impl Loading {
    /// Over a time (s), by the velocities of the evaluation.
    pub(super) fn present(duration: f64) -> Self {
        Self { duration, age: 0.0 }
    }

    /// As [`earlier`](Self::earlier), by the velocities of the evaluation: turning and sliding are
    /// then of second order, and the age is negligible.
    pub(super) fn just_now(duration: f64) -> Self {
        let age = duration / 1024.0;
        Self { duration, age }
    }

    /// Over a time (s), by velocities of this age (s).
    pub(super) fn earlier(duration: f64, age: f64) -> Self {
        Self { duration, age }
    }
}

/// The laws of a step's contacts.
#[derive(Clone, Copy)]
pub(super) struct Laws<N, T> {
    pub(super) normal: N,
    pub(super) tangential: T,
    pub(super) loading: Loading,
    /// Largest overlap, in radii of the smaller partner.
    pub(super) overlap_limit: f64,
}

/// A contact, its force and its torques.
pub(super) struct ContactForce {
    /// Whether the two touch. If not, all else is meaningless.
    pub(super) touches: bool,
    /// Whether the overlap is beyond the limit.
    pub(super) too_deep: bool,
    /// Unit normal, towards the sphere that the force acts on.
    pub(super) normal: Vector,
    /// Velocity of its centre relative to the other (m/s).
    pub(super) velocity: Vector,
    /// Overlap (m).
    pub(super) overlap: f64,
    /// Contact radius (m), if a law needs it.
    pub(super) contact_radius: f64,
    /// Force (N).
    pub(super) force: Vector,
    /// Torques on both (N m), zero without rotation.
    pub(super) torque: [Vector; 2],
}

/// A contact with its tangential spring loaded, before the limit of friction applies.
pub(super) struct LoadedContact {
    /// As in a [`ContactForce`].
    pub(super) touches: bool,
    pub(super) too_deep: bool,
    pub(super) overlap: f64,
    /// Contact radius (m), if a law needs it.
    pub(super) contact_radius: f64,
    /// The force (N) without friction.
    pub(super) force: Vector,
    /// Distances of both centres from the contact point, in radii.
    pub(super) lever: f64,
    pub(super) spring: LoadedSpring,
}

/// The force at a contact without friction (N).
struct NormalForce {
    /// Its component along the normal.
    along: f64,
    /// The whole force, with the sideways drag of the normal law.
    total: Vector,
}

impl<N: NormalLaw, T: TangentialLaw> Laws<N, T> {
    pub(super) const HAS_HISTORY: bool = size_of::<T::History>() > 0;
    /// Whether a law needs the contact radius.
    pub(super) const USES_CONTACT_RADIUS: bool = N::USES_CONTACT_RADIUS | T::USES_CONTACT_RADIUS;
    /// Whether a law needs the effective mass.
    pub(super) const NEEDS_EFFECTIVE_MASS: bool =
        N::NEEDS_EFFECTIVE_MASS || T::NEEDS_EFFECTIVE_MASS;

    /// The laws at a wall, whose coefficient of friction may differ.
    #[inline(always)]
    pub(super) fn at_wall(&self, wall: &Wall) -> Self {
        match wall.friction_coefficient {
            Some(coefficient) => Self {
                tangential: self.tangential.with_coefficient(coefficient),
                ..*self
            },
            None => *self,
        }
    }

    /// Two spheres.
    #[inline(always)]
    pub(super) fn pair_force(&self, state: &ContactState, history: T::History) -> ContactForce {
        let geometry = self.pair_geometry(state);
        self.force(state, &geometry, self.brought_here(history, &geometry))
    }

    /// The geometry of two spheres.
    #[inline(always)]
    pub(super) fn pair_geometry(&self, state: &ContactState) -> ContactGeometry {
        let inverse_distance = inverse_square_root(state.offset.norm_squared());
        let roots = Roots {
            inverse_distance,
            contact_radius: self.contact_radius(state, inverse_distance),
            effective_mass: Self::effective_mass(state.properties),
        };
        self.geometry(state, roots)
    }

    /// The forces of a history, if it has any, turned into the plane of a contact and adjusted to
    /// its radius.
    #[inline(always)]
    fn brought_here(&self, history: T::History, geometry: &ContactGeometry) -> T::History {
        if !Self::HAS_HISTORY {
            return history;
        }
        let turned = |force: Vector, change: ForceChange| {
            let spring = Spring { force };
            match geometry.loading {
                Some(earlier) => spring.turned_by(geometry.normal, earlier.turn, change),
                None => spring.turned_to(geometry.normal, change),
            }
        };
        let change = match T::History::HAS_RADIUS {
            true => (self.tangential.keeps()).change(history.radius(), geometry.contact_radius),
            false => ForceChange::NONE,
        };
        let now = T::History::of_spring(turned(history.spring().force, change));
        if !T::History::TURNS {
            return now;
        }
        let turning = history.turning();
        now.with_turning(Turning {
            force: turned(turning.force, ForceChange::NONE).force,
            ..turning
        })
    }

    /// A sphere and a wall.
    pub(super) fn wall_force(
        &self,
        wall: &Wall,
        state: &ContactState,
        history: T::History,
    ) -> ContactForce {
        let (state, geometry) = self.meeting_at_wall(wall, state);
        let laws = self.at_wall(wall);
        laws.force(&state, &geometry, laws.brought_here(history, &geometry))
    }

    /// The contact of a sphere with a wall: its motion relative to the wall, and its geometry.
    pub(super) fn meeting_at_wall(
        &self,
        wall: &Wall,
        state: &ContactState,
    ) -> (ContactState, ContactGeometry) {
        let (radius, mut state) = (state.properties[0].radius, *state);
        let contact = wall.contact(state.offset, radius);
        state.spin[1] = wall.spin();
        let place = state.offset;
        let earlier = state.earlier.as_mut().map(|earlier| {
            let position = self.earlier_position(place, earlier.velocity);
            let contact = wall.contact(position, radius);
            earlier.velocity -= wall.velocity(position, radius, &contact);
            earlier.spin[1] = wall.spin();
            contact
        });
        state.velocity -= wall.velocity(state.offset, radius, &contact);
        let geometry = self.geometry_at_wall(&state, contact, earlier.as_ref());
        (state, geometry)
    }

    /// Force and torques of a contact, whose history is in the plane across the normal.
    #[inline(always)]
    pub(super) fn force(
        &self,
        state: &ContactState,
        geometry: &ContactGeometry,
        history: T::History,
    ) -> ContactForce {
        let mut force = self.normal_force(state, geometry);
        let mut torque = [Vector::ZERO; 2];
        if T::ROTATES {
            let touch = self.touch(state, geometry, &force);
            let Traction {
                force: sideways,
                torque: torques,
            } = match Self::HAS_HISTORY {
                true => {
                    let mut turning = history.turning();
                    let spring = self.loaded(&touch, geometry, history.spring(), &mut turning);
                    spring.traction(&touch)
                }
                false => self.tangential.traction(&touch, &mut Spring::default()),
            };
            force.total += sideways;
            torque = torques;
        }
        let ContactGeometry {
            touches,
            too_deep,
            normal,
            overlap,
            contact_radius,
            ..
        } = *geometry;
        ContactForce {
            touches,
            too_deep,
            normal,
            velocity: state.velocity,
            overlap,
            contact_radius,
            force: force.total,
            torque,
        }
    }

    /// Normal force and loaded spring of a contact, whose turning point moves with it. The limit of
    /// friction is applied later.
    #[inline(always)]
    pub(super) fn load(
        &self,
        state: &ContactState,
        geometry: &ContactGeometry,
        spring: Spring,
        turning: &mut Turning,
    ) -> LoadedContact {
        let force = self.normal_force(state, geometry);
        let touch = self.touch(state, geometry, &force);
        LoadedContact {
            touches: geometry.touches,
            too_deep: geometry.too_deep,
            overlap: geometry.overlap,
            contact_radius: geometry.contact_radius,
            force: force.total,
            lever: geometry.lever,
            spring: self.loaded(&touch, geometry, spring, turning),
        }
    }

    /// The loaded spring of a contact. The limit of friction is applied later.
    #[inline(always)]
    fn loaded(
        &self,
        touch: &Touch,
        geometry: &ContactGeometry,
        spring: Spring,
        turning: &mut Turning,
    ) -> LoadedSpring {
        let loaded = self.tangential.load_and_turn(touch, spring, turning);
        match geometry.loading {
            Some(_) if T::BY_INCREMENTS => loaded.turned_while_sliding(spring),
            _ => loaded,
        }
    }

    #[inline(always)]
    fn normal_force(&self, state: &ContactState, geometry: &ContactGeometry) -> NormalForce {
        let ContactGeometry {
            normal,
            overlap,
            contact_radius,
            effective_mass,
            ..
        } = *geometry;
        let velocity = state.velocity;
        let approach = -velocity.dot(normal);
        let along = (self.normal).force(overlap, approach, contact_radius, effective_mass);
        let mut total = normal * along;
        if N::DRAGS_SIDEWAYS {
            total -= (velocity + normal * approach) * self.normal.sideways_drag();
        }
        NormalForce { along, total }
    }

    /// The contact in the form that friction laws take.
    #[inline(always)]
    fn touch(
        &self,
        state: &ContactState,
        geometry: &ContactGeometry,
        force: &NormalForce,
    ) -> Touch {
        let ContactState { velocity, spin, .. } = *state;
        let ContactGeometry {
            normal,
            contact_radius,
            effective_mass,
            lever,
            lesser_mass,
            loading,
            ..
        } = *geometry;
        // A wall has no radius.
        let lever = state.properties.map(|it| it.radius * lever);
        let (loading_velocity, loading_radius) = match loading {
            Some(earlier) => (earlier.sliding, earlier.radius),
            None => (
                sliding_velocity(normal, velocity, spin, lever),
                contact_radius,
            ),
        };
        Touch {
            normal,
            velocity,
            spin,
            lever,
            inertia: [state.properties[0].inertia, state.properties[1].inertia],
            lesser_mass,
            effective_mass,
            contact_radius,
            // An attractive force carries no friction.
            normal_force: match N::ATTRACTS {
                true => or_zero(force.along),
                false => force.along,
            },
            force_along_normal: force.along,
            loading_velocity,
            loading_radius,
            loading_time: self.loading.duration,
        }
    }

    /// The parts of a contact force that the damping and the tangential law contribute.
    pub(super) fn damping_and_friction(&self, contact: &ContactForce) -> [Vector; 2] {
        let ContactForce {
            normal,
            velocity,
            force,
            ..
        } = *contact;
        let elastic = self
            .normal
            .force(contact.overlap, 0.0, contact.contact_radius, 0.0);
        if !T::ROTATES {
            return [force - normal * elastic, Vector::ZERO];
        }
        let along = force.dot(normal);
        let sideways = velocity.perpendicular_to(normal) * -self.normal.sideways_drag();
        let damping = normal * (along - elastic) + sideways;
        [damping, force - normal * along - sideways]
    }
}

/// The value, or zero if it is negative. A select, which loops over contacts turn into vector
/// instructions.
#[inline(always)]
fn or_zero(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}
