//! The geometry of one contact: overlap, normal and levers, of two spheres or of a sphere and a
//! wall.
//!
//! These functions have no branches, because loops over blocks of contacts call them.

use super::contact_laws::Laws;
use super::contact_state::{ContactState, SphereProperties};
use crate::forces::contact::{NormalLaw, contact_radius};
use crate::forces::friction::{TangentialLaw, sliding_velocity};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;
use crate::walls::WallContact;

/// 1 / x, or 0 for x = 0. Two driven or fixed partners have infinite mass: their contact moves
/// nothing, but its force must stay finite.
#[inline(always)]
pub(super) fn inverse_or_zero(x: f64) -> f64 {
    if x > 0.0 { 1.0 / x } else { 0.0 }
}

/// What the laws need of the geometry of a contact. The second partner may be a wall.
pub(super) struct ContactGeometry {
    /// Whether the two touch. If not, all else is meaningless.
    pub(super) touches: bool,
    /// Whether the overlap is beyond the limit.
    pub(super) too_deep: bool,
    /// Unit normal, towards the first partner.
    pub(super) normal: Vector,
    /// Overlap (m).
    pub(super) overlap: f64,
    /// Contact radius (m), zero if no law needs it.
    pub(super) contact_radius: f64,
    /// Effective mass (kg), zero if no law needs it.
    pub(super) effective_mass: f64,
    /// Distances of both centres from the contact point, in radii.
    pub(super) lever: f64,
    /// Mass of the lighter partner (kg).
    pub(super) lesser_mass: f64,
    /// The earlier contact that loads the spring, if the present one does not.
    pub(super) loading: Option<EarlierContact>,
}

/// A contact half way between two evaluations of its forces.
#[derive(Clone, Copy)]
pub(super) struct EarlierContact {
    /// Sliding velocity (m/s).
    pub(super) sliding: Vector,
    /// Contact radius (m).
    pub(super) radius: f64,
    /// How much the normal changes from one evaluation to the next, to first order.
    pub(super) turn: Vector,
}

/// Roots and quotients of the positions alone. They take longest to compute. So a loop over many
/// contacts computes each of them in a loop of its own, and the processor overlaps them.
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
    /// The contact radius of two spheres (m).
    #[inline(always)]
    pub(super) fn contact_radius(&self, state: &ContactState, inverse_distance: f64) -> f64 {
        if !Self::USES_CONTACT_RADIUS {
            return 0.0;
        }
        let [one, other] = state.properties;
        let distance = state.offset.norm_squared() * inverse_distance;
        let overlap = one.radius + other.radius - distance;
        contact_radius(overlap, state.effective_radius())
    }

    /// 1 / (1 / m1 + 1 / m2) (kg), if a law needs it; zero if forces move neither partner.
    #[inline(always)]
    pub(super) fn effective_mass([one, other]: [SphereProperties; 2]) -> f64 {
        match Self::NEEDS_EFFECTIVE_MASS {
            true => inverse_or_zero(one.inverse_mass + other.inverse_mass),
            false => 0.0,
        }
    }

    /// Two spheres whose roots are known.
    #[inline(always)]
    pub(super) fn geometry(&self, state: &ContactState, roots: Roots) -> ContactGeometry {
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
            let distance = distance_squared * inverse_distance;
            // The lever must also be taken at the earlier moment: with the present lever, spins
            // load springs with an error of first order in the time step.
            let lever = distance * state.inverse_sum;
            let levers = state.properties.map(|it| it.radius * lever);
            let sliding = sliding_velocity(normal, earlier.velocity, earlier.spin, levers);
            let radius = contact_radius(sum - distance, state.effective_radius());
            geometry.loading = Some(EarlierContact {
                sliding,
                radius,
                turn: self.turn_of_pair(state, roots.inverse_distance),
            });
        }
        geometry
    }

    /// A sphere whose contact with a wall is known, with the earlier contact if this loads springs.
    #[inline(always)]
    pub(super) fn geometry_at_wall(
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
            contact_radius: match Self::USES_CONTACT_RADIUS {
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
            geometry.loading = Some(EarlierContact {
                sliding: sliding_velocity(contact.normal, earlier.velocity, earlier.spin, lever),
                radius: contact_radius(contact.overlap, radius),
                turn: self.turn_at_wall(normal, contact.normal),
            });
        }
        geometry
    }

    /// How much the normal of a pair changes while springs are loaded, up to a part along the
    /// normal. Takes 1 / distance (1/m).
    #[inline(always)]
    pub(super) fn turn_of_pair(&self, state: &ContactState, inverse_distance: f64) -> Vector {
        match &state.earlier {
            Some(earlier) => earlier.velocity * (self.loading.duration * inverse_distance),
            None => Vector::ZERO,
        }
    }

    /// How much the normal at a wall changes, from the normals now and half way.
    #[inline(always)]
    pub(super) fn turn_at_wall(&self, normal: Vector, earlier: Vector) -> Vector {
        (normal - earlier) * (self.loading.duration / self.loading.age)
    }

    /// Where a sphere was when it had an earlier velocity (m/s).
    #[inline(always)]
    pub(super) fn earlier_position(&self, position: Vector, velocity: Vector) -> Vector {
        position - velocity * self.loading.age
    }
}

/// The minimum as a select, which loops over contacts turn into vector instructions.
#[inline(always)]
fn lesser(one: f64, other: f64) -> f64 {
    if one < other { one } else { other }
}
