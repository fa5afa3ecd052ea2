//! The geometry of one contact: overlap, normal and levers, of two spheres or of a sphere and a
//! wall.
//!
//! These functions have no branches, because loops over blocks of contacts call them.

use super::contact_laws::Laws;
use super::contact_state::{ContactState, SphereProperties};
use crate::dem::walls::WallContact;
use crate::forces::contact::{NormalLaw, contact_radius};
use crate::forces::friction::{TangentialLaw, sliding_velocity};
use crate::particles::math::inverse_square_root;
use crate::particles::vector::Vector;

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
    /// Sliding velocity (m/s) and contact radius (m) by which a spring is loaded, if these are not
    /// the present ones.
    pub(super) loading: Option<(Vector, f64)>,
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

    /// 1 / (1 / m1 + 1 / m2) (kg), if a law needs it.
    #[inline(always)]
    pub(super) fn effective_mass([one, other]: [SphereProperties; 2]) -> f64 {
        match Self::NEEDS_EFFECTIVE_MASS {
            true => 1.0 / (one.inverse_mass + other.inverse_mass),
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
            let lever = state.properties.map(|it| it.radius * lever);
            let sliding = sliding_velocity(normal, earlier.velocity, earlier.spin, lever);
            let overlap = sum - distance_squared * inverse_distance;
            geometry.loading = Some((sliding, contact_radius(overlap, state.effective_radius())));
        }
        geometry
    }

    /// A sphere whose contact with a wall is known, and the earlier one if that loads springs.
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
            let sliding = sliding_velocity(contact.normal, earlier.velocity, earlier.spin, lever);
            geometry.loading = Some((sliding, contact_radius(contact.overlap, radius)));
        }
        geometry
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
