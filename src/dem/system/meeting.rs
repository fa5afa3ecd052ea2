//! What the laws answer at a contact, the same for pairs and walls.
//!
//! Free of branches, as it stands in loops over blocks of contacts, which touch or not.

use super::couple::{Couple, Solid};
use crate::dem::contact::{NormalLaw, contact_radius};
use crate::dem::friction::{
    LoadedSpring, Spring, TangentialLaw, Touch, Traction, sliding_velocity,
};
use crate::dem::math::inverse_square_root;
use crate::dem::vector::Vector;
use crate::dem::walls::{Wall, WallContact};

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

/// A contact and what its laws answered.
pub(super) struct Meeting {
    /// Whether the partners touch. If they do not, nothing else means anything.
    pub(super) touches: bool,
    /// Whether the overlap is beyond the limit.
    pub(super) too_deep: bool,
    /// Unit normal, towards the partner that the force acts on.
    pub(super) normal: Vector,
    /// Velocity of its centre relative to the other (m/s).
    pub(super) velocity: Vector,
    /// Overlap (m).
    pub(super) overlap: f64,
    /// Contact radius (m), if a law asks for it.
    pub(super) contact_radius: f64,
    /// Force (N).
    pub(super) force: Vector,
    /// Torques on both partners (N m), zero without rotation.
    pub(super) torque: [Vector; 2],
}

/// The answer to a contact with a spring before it is asked how much of that friction carries.
pub(super) struct Pressed {
    /// As those of a [`Meeting`].
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

/// Where and how partners meet, whatever the second one is.
struct Encounter {
    touches: bool,
    too_deep: bool,
    normal: Vector,
    overlap: f64,
    contact_radius: f64,
    /// Zero where no law asks for it.
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
    /// The contact radius (m), if a law asks for it.
    pub(super) contact_radius: f64,
    /// The effective mass (kg), if a law asks for it.
    pub(super) effective_mass: f64,
}

impl<N: NormalLaw, T: TangentialLaw> Laws<N, T> {
    const REMEMBERS: bool = size_of::<T::History>() > 0;
    const WIDENS: bool = N::WIDENS | T::WIDENS;
    /// Whether a law asks for the effective mass.
    pub(super) const NEEDS_EFFECTIVE_MASS: bool =
        N::NEEDS_EFFECTIVE_MASS || T::NEEDS_EFFECTIVE_MASS;

    /// Two spheres.
    #[inline(always)]
    pub(super) fn between(&self, couple: &Couple, spring: Spring) -> Meeting {
        let inverse_distance = inverse_square_root(couple.offset.norm_squared());
        let roots = Roots {
            inverse_distance,
            contact_radius: self.contact_radius(couple, inverse_distance),
            effective_mass: Self::effective_mass(couple.solid),
        };
        let normal = couple.offset * inverse_distance;
        self.between_with(couple, roots, Self::turned(spring, normal))
    }

    /// The contact radius of two spheres (m).
    #[inline(always)]
    pub(super) fn contact_radius(&self, couple: &Couple, inverse_distance: f64) -> f64 {
        if !Self::WIDENS {
            return 0.0;
        }
        let [one, other] = couple.solid;
        let distance = couple.offset.norm_squared() * inverse_distance;
        let overlap = one.radius + other.radius - distance;
        contact_radius(overlap, couple.effective_radius())
    }

    /// A spring across a normal, if a law has springs.
    #[inline(always)]
    pub(super) fn turned(spring: Spring, normal: Vector) -> Spring {
        match Self::REMEMBERS {
            true => spring.turned(normal),
            false => spring,
        }
    }

    /// Two spheres whose roots are known, with a spring across their normal.
    #[inline(always)]
    pub(super) fn between_with(&self, couple: &Couple, roots: Roots, spring: Spring) -> Meeting {
        self.answer(couple, &self.encounter(couple, roots), spring)
    }

    /// The same, until it is asked how much friction carries.
    #[inline(always)]
    pub(super) fn pressed_between(&self, couple: &Couple, roots: Roots, spring: Spring) -> Pressed {
        self.press(couple, &self.encounter(couple, roots), spring)
    }

    #[inline(always)]
    fn encounter(&self, couple: &Couple, roots: Roots) -> Encounter {
        let [one, other] = couple.solid;
        let sum = one.radius + other.radius;
        let distance_squared = couple.offset.norm_squared();
        let touches = distance_squared < sum * sum;
        let distance = distance_squared * roots.inverse_distance;
        let overlap = sum - distance;
        let smaller = lesser(one.radius, other.radius);
        let deep = overlap > self.overlap_limit * smaller;
        let concentric = distance == 0.0;
        // Both centres turn about the point where the surfaces meet, so that the pair keeps its
        // angular momentum.
        let lever = distance * couple.inverse_sum;
        let mut encounter = Encounter {
            touches,
            too_deep: touches & (deep | concentric),
            normal: couple.offset * roots.inverse_distance,
            overlap,
            contact_radius: roots.contact_radius,
            effective_mass: roots.effective_mass,
            lever,
            lesser_mass: lesser(one.mass, other.mass),
            loading: None,
        };
        if let (true, Some(earlier)) = (Self::REMEMBERS, &couple.earlier) {
            let offset = couple.offset - earlier.velocity * self.loading.age;
            let distance_squared = offset.norm_squared();
            let inverse_distance = inverse_square_root(distance_squared);
            let normal = offset * inverse_distance;
            let lever = couple.solid.map(|it| it.radius * lever);
            let sliding = sliding_velocity(normal, earlier.velocity, earlier.spin, lever);
            let overlap = sum - distance_squared * inverse_distance;
            encounter.loading = Some((sliding, contact_radius(overlap, couple.effective_radius())));
        }
        encounter
    }

    /// A sphere and a wall.
    pub(super) fn at_wall<W: Wall>(&self, wall: W, couple: &Couple, spring: Spring) -> Meeting {
        let radius = couple.solid[0].radius;
        let earlier = couple.earlier.as_ref();
        let earlier = earlier.map(|earlier| {
            wall.contact(self.earlier_place(couple.offset, earlier.velocity), radius)
        });
        let contact = wall.contact(couple.offset, radius);
        let spring = Self::turned(spring, contact.normal);
        self.at_contact(couple, contact, earlier.as_ref(), spring)
    }

    /// Where a sphere was that had a velocity (m/s) before.
    #[inline(always)]
    pub(super) fn earlier_place(&self, place: Vector, velocity: Vector) -> Vector {
        place - velocity * self.loading.age
    }

    /// A sphere and a wall that meet like this now, and like that before, with a spring across the
    /// normal.
    #[inline(always)]
    pub(super) fn at_contact(
        &self,
        couple: &Couple,
        contact: WallContact,
        earlier_contact: Option<&WallContact>,
        spring: Spring,
    ) -> Meeting {
        let encounter = self.encounter_at_wall(couple, contact, earlier_contact);
        self.answer(couple, &encounter, spring)
    }

    /// The same, until it is asked how much friction carries.
    #[inline(always)]
    pub(super) fn pressed_at_contact(
        &self,
        couple: &Couple,
        contact: WallContact,
        earlier_contact: Option<&WallContact>,
        spring: Spring,
    ) -> Pressed {
        let encounter = self.encounter_at_wall(couple, contact, earlier_contact);
        self.press(couple, &encounter, spring)
    }

    #[inline(always)]
    fn encounter_at_wall(
        &self,
        couple: &Couple,
        contact: WallContact,
        earlier_contact: Option<&WallContact>,
    ) -> Encounter {
        let Solid { radius, mass, .. } = couple.solid[0];
        let WallContact {
            touches,
            overlap,
            normal,
        } = contact;
        let mut encounter = Encounter {
            touches,
            too_deep: touches & (overlap > self.overlap_limit * radius),
            normal,
            overlap,
            contact_radius: match Self::WIDENS {
                true => contact_radius(overlap, radius),
                false => 0.0,
            },
            effective_mass: Self::effective_mass(couple.solid),
            lever: 1.0,
            lesser_mass: mass,
            loading: None,
        };
        if let (true, Some(earlier), Some(contact)) =
            (Self::REMEMBERS, &couple.earlier, earlier_contact)
        {
            let lever = [radius, 0.0];
            let sliding = sliding_velocity(contact.normal, earlier.velocity, earlier.spin, lever);
            encounter.loading = Some((sliding, contact_radius(contact.overlap, radius)));
        }
        encounter
    }

    /// 1 / (1 / m1 + 1 / m2) (kg), where a law asks for it.
    #[inline(always)]
    pub(super) fn effective_mass([one, other]: [Solid; 2]) -> f64 {
        match Self::NEEDS_EFFECTIVE_MASS {
            true => 1.0 / (one.inverse_mass + other.inverse_mass),
            false => 0.0,
        }
    }

    #[inline(always)]
    fn answer(&self, couple: &Couple, encounter: &Encounter, mut spring: Spring) -> Meeting {
        let mut force = self.normal_force(couple, encounter);
        let mut torque = [Vector::ZERO; 2];
        if T::ROTATES {
            let touch = self.touch(couple, encounter, &force);
            let Traction {
                force: sideways,
                torque: torques,
            } = self.tangential.traction(&touch, &mut spring);
            force.total += sideways;
            torque = torques;
        }
        let Encounter {
            touches,
            too_deep,
            normal,
            overlap,
            contact_radius,
            ..
        } = *encounter;
        Meeting {
            touches,
            too_deep,
            normal,
            velocity: couple.velocity,
            overlap,
            contact_radius,
            force: force.total,
            torque,
        }
    }

    /// Answers a contact with a spring, until it is asked how much of that friction carries.
    #[inline(always)]
    fn press(&self, couple: &Couple, encounter: &Encounter, spring: Spring) -> Pressed {
        let force = self.normal_force(couple, encounter);
        let touch = self.touch(couple, encounter, &force);
        Pressed {
            touches: encounter.touches,
            too_deep: encounter.too_deep,
            overlap: encounter.overlap,
            force: force.total,
            lever: encounter.lever,
            spring: self.tangential.load(&touch, spring),
        }
    }

    #[inline(always)]
    fn normal_force(&self, couple: &Couple, encounter: &Encounter) -> NormalForce {
        let Encounter {
            normal,
            overlap,
            contact_radius,
            effective_mass,
            ..
        } = *encounter;
        let velocity = couple.velocity;
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
    fn touch(&self, couple: &Couple, encounter: &Encounter, force: &NormalForce) -> Touch {
        let Couple { velocity, spin, .. } = *couple;
        let Encounter {
            normal,
            contact_radius,
            effective_mass,
            lever,
            lesser_mass,
            loading,
            ..
        } = *encounter;
        // A wall has no radius.
        let lever = couple.solid.map(|it| it.radius * lever);
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
            inertia: [couple.solid[0].inertia, couple.solid[1].inertia],
            lesser_mass,
            effective_mass,
            contact_radius,
            // Friction feels none where partners attract each other.
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
