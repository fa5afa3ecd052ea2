//! The force and torques at one contact, of two spheres or of a sphere and a wall.
//!
//! Free of branches, as it stands in loops over blocks of contacts, which touch or not.

use super::contact_state::{ContactState, SphereProperties};
use crate::dem::walls::{Wall, WallContact};
use crate::forces::contact::{NormalLaw, contact_radius};
use crate::forces::friction::{
    LoadedSpring, Spring, TangentialLaw, Touch, Traction, sliding_velocity,
};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;

/// The time that springs are loaded over until an evaluation of forces, with the mean velocities of
/// that time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loading {
    /// How long it is (s).
    pub(super) duration: f64,
    /// How long before the evaluation the spheres had the velocities that load springs (s): these
    /// are then kept in rows of their own. Zero if they are those of the evaluation.
    pub(super) age: f64,
}

impl Loading {
    /// Over a time (s), by the velocities of the evaluation.
    pub(super) fn present(duration: f64) -> Self {
        Self { duration, age: 0.0 }
    }

    /// Over a time (s), by velocities that are that old (s).
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
    /// As those of a [`ContactForce`].
    pub(super) touches: bool,
    pub(super) too_deep: bool,
    pub(super) overlap: f64,
    /// The force (N) without friction.
    pub(super) force: Vector,
    /// Distances of both centres from the contact point, in radii.
    pub(super) lever: f64,
    pub(super) spring: LoadedSpring,
}

/// The force at a contact without friction (N).
struct NormalForce {
    along: f64,
    /// With what drags sideways.
    total: Vector,
}

/// Where the two touch, and what of it the laws need. The second may be a wall.
struct ContactGeometry {
    touches: bool,
    too_deep: bool,
    normal: Vector,
    overlap: f64,
    contact_radius: f64,
    /// Zero where no law needs it.
    effective_mass: f64,
    /// Of friction alone, in radii.
    lever: f64,
    lesser_mass: f64,
    /// Sliding velocity (m/s) and contact radius (m) by which a spring is loaded, if not those of
    /// now.
    loading: Option<(Vector, f64)>,
}

/// What of a contact takes longest to compute, and waits for nothing but places: a loop over many
/// contacts finds these first, each in a loop of its own, so that the processor need not wait for
/// one after the other.
#[derive(Clone, Copy, Default)]
pub(super) struct Roots {
    /// 1 / the distance of the centres (1/m).
    pub(super) inverse_distance: f64,
    /// The contact radius (m), if a law needs it.
    pub(super) contact_radius: f64,
    /// The effective mass (kg), if a law needs it.
    pub(super) effective_mass: f64,
}

impl<N: NormalLaw, T: TangentialLaw> Laws<N, T> {
    const HAS_HISTORY: bool = size_of::<T::History>() > 0;
    const WIDENS: bool = N::WIDENS | T::WIDENS;
    /// Whether a law needs the effective mass.
    pub(super) const NEEDS_EFFECTIVE_MASS: bool =
        N::NEEDS_EFFECTIVE_MASS || T::NEEDS_EFFECTIVE_MASS;

    /// Two spheres.
    #[inline(always)]
    pub(super) fn pair_force(&self, state: &ContactState, spring: Spring) -> ContactForce {
        let inverse_distance = inverse_square_root(state.offset.norm_squared());
        let roots = Roots {
            inverse_distance,
            contact_radius: self.contact_radius(state, inverse_distance),
            effective_mass: Self::effective_mass(state.properties),
        };
        let normal = state.offset * inverse_distance;
        self.pair_force_with(state, roots, Self::turned(spring, normal))
    }

    /// The contact radius of two spheres (m).
    #[inline(always)]
    pub(super) fn contact_radius(&self, state: &ContactState, inverse_distance: f64) -> f64 {
        if !Self::WIDENS {
            return 0.0;
        }
        let [one, other] = state.properties;
        let distance = state.offset.norm_squared() * inverse_distance;
        let overlap = one.radius + other.radius - distance;
        contact_radius(overlap, state.effective_radius())
    }

    /// A spring across a normal, if a law has springs.
    #[inline(always)]
    pub(super) fn turned(spring: Spring, normal: Vector) -> Spring {
        match Self::HAS_HISTORY {
            true => spring.turned(normal),
            false => spring,
        }
    }

    /// Two spheres whose roots are known, with a spring across their normal.
    #[inline(always)]
    pub(super) fn pair_force_with(
        &self,
        state: &ContactState,
        roots: Roots,
        spring: Spring,
    ) -> ContactForce {
        self.force(state, &self.geometry(state, roots), spring)
    }

    /// The same up to the limit of friction, which is applied later.
    #[inline(always)]
    pub(super) fn load_pair(
        &self,
        state: &ContactState,
        roots: Roots,
        spring: Spring,
    ) -> LoadedContact {
        self.load(state, &self.geometry(state, roots), spring)
    }

    #[inline(always)]
    fn geometry(&self, state: &ContactState, roots: Roots) -> ContactGeometry {
        let [one, other] = state.properties;
        let sum = one.radius + other.radius;
        let distance_squared = state.offset.norm_squared();
        let touches = distance_squared < sum * sum;
        let distance = distance_squared * roots.inverse_distance;
        let overlap = sum - distance;
        let smaller = lesser(one.radius, other.radius);
        let deep = overlap > self.overlap_limit * smaller;
        let concentric = distance == 0.0;
        // Both centres turn about the point where the surfaces meet, so that the pair keeps its
        // angular momentum.
        let lever = distance * state.inverse_sum;
        let mut geometry = ContactGeometry {
            touches,
            too_deep: touches & (deep | concentric),
            normal: state.offset * roots.inverse_distance,
            overlap,
            contact_radius: roots.contact_radius,
            effective_mass: roots.effective_mass,
            lever,
            lesser_mass: lesser(one.mass, other.mass),
            loading: None,
        };
        if let (true, Some(earlier)) = (Self::HAS_HISTORY, &state.earlier) {
            let offset = state.offset - earlier.velocity * self.loading.age;
            let distance_squared = offset.norm_squared();
            let inverse_distance = inverse_square_root(distance_squared);
            let normal = offset * inverse_distance;
            let lever = state.properties.map(|it| it.radius * lever);
            let sliding = sliding_velocity(normal, earlier.velocity, earlier.spin, lever);
            let overlap = sum - distance_squared * inverse_distance;
            geometry.loading = Some((sliding, contact_radius(overlap, state.effective_radius())));
        }
        geometry
    }

    /// A sphere and a wall.
    pub(super) fn wall_force<W: Wall>(
        &self,
        wall: W,
        state: &ContactState,
        spring: Spring,
    ) -> ContactForce {
        let radius = state.properties[0].radius;
        let earlier = state.earlier.as_ref();
        let earlier = earlier.map(|earlier| {
            wall.contact(self.earlier_place(state.offset, earlier.velocity), radius)
        });
        let contact = wall.contact(state.offset, radius);
        let spring = Self::turned(spring, contact.normal);
        self.wall_force_at(state, contact, earlier.as_ref(), spring)
    }

    /// Where a sphere was that had a velocity (m/s) before.
    #[inline(always)]
    pub(super) fn earlier_place(&self, place: Vector, velocity: Vector) -> Vector {
        place - velocity * self.loading.age
    }

    /// The force of a wall, of its contact now and the one before, with a spring across the
    /// normal.
    #[inline(always)]
    pub(super) fn wall_force_at(
        &self,
        state: &ContactState,
        contact: WallContact,
        earlier_contact: Option<&WallContact>,
        spring: Spring,
    ) -> ContactForce {
        let geometry = self.geometry_at_wall(state, contact, earlier_contact);
        self.force(state, &geometry, spring)
    }

    /// The same up to the limit of friction, which is applied later.
    #[inline(always)]
    pub(super) fn load_at_wall(
        &self,
        state: &ContactState,
        contact: WallContact,
        earlier_contact: Option<&WallContact>,
        spring: Spring,
    ) -> LoadedContact {
        let geometry = self.geometry_at_wall(state, contact, earlier_contact);
        self.load(state, &geometry, spring)
    }

    #[inline(always)]
    fn geometry_at_wall(
        &self,
        state: &ContactState,
        contact: WallContact,
        earlier_contact: Option<&WallContact>,
    ) -> ContactGeometry {
        let SphereProperties { radius, mass, .. } = state.properties[0];
        let WallContact {
            touches,
            overlap,
            normal,
        } = contact;
        let mut geometry = ContactGeometry {
            touches,
            too_deep: touches & (overlap > self.overlap_limit * radius),
            normal,
            overlap,
            contact_radius: match Self::WIDENS {
                true => contact_radius(overlap, radius),
                false => 0.0,
            },
            effective_mass: Self::effective_mass(state.properties),
            lever: 1.0,
            lesser_mass: mass,
            loading: None,
        };
        if let (true, Some(earlier), Some(contact)) =
            (Self::HAS_HISTORY, &state.earlier, earlier_contact)
        {
            let lever = [radius, 0.0];
            let sliding = sliding_velocity(contact.normal, earlier.velocity, earlier.spin, lever);
            geometry.loading = Some((sliding, contact_radius(contact.overlap, radius)));
        }
        geometry
    }

    /// 1 / (1 / m1 + 1 / m2) (kg), where a law needs it.
    #[inline(always)]
    pub(super) fn effective_mass([one, other]: [SphereProperties; 2]) -> f64 {
        match Self::NEEDS_EFFECTIVE_MASS {
            true => 1.0 / (one.inverse_mass + other.inverse_mass),
            false => 0.0,
        }
    }

    #[inline(always)]
    fn force(
        &self,
        state: &ContactState,
        geometry: &ContactGeometry,
        mut spring: Spring,
    ) -> ContactForce {
        let mut force = self.normal_force(state, geometry);
        let mut torque = [Vector::ZERO; 2];
        if T::ROTATES {
            let touch = self.touch(state, geometry, &force);
            let Traction {
                force: sideways,
                torque: torques,
            } = self.tangential.traction(&touch, &mut spring);
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

    /// Normal force and loaded spring of a contact, before the limit of friction applies.
    #[inline(always)]
    fn load(
        &self,
        state: &ContactState,
        geometry: &ContactGeometry,
        spring: Spring,
    ) -> LoadedContact {
        let force = self.normal_force(state, geometry);
        let touch = self.touch(state, geometry, &force);
        LoadedContact {
            touches: geometry.touches,
            too_deep: geometry.too_deep,
            overlap: geometry.overlap,
            force: force.total,
            lever: geometry.lever,
            spring: self.tangential.load(&touch, spring),
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

    /// The contact as friction sees it.
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
            Some(loading) => loading,
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
            loading_velocity,
            loading_radius,
            loading_time: self.loading.duration,
        }
    }
}

/// Minima and the like as selects, which loops over contacts turn into vector instructions.
#[inline(always)]
fn lesser(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}

/// That, or zero if it is negative.
#[inline(always)]
fn or_zero(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}
