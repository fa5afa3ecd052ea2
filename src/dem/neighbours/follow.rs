//! A Verlet list that follows a few spheres which come, go or stray, and stays valid for the
//! others. In a silo most grains lie still while a few fall.

use super::{Reach, VerletList};
use crate::particles::Particles;

/// At most one in this number of spheres may have left its margin. Each stray is compared with all
/// spheres, so following more strays takes as long as building the list again.
const FEW_OF: usize = 24;

/// At most this number of spheres may have left their margins.
const MOST: usize = 64;

/// The new reference of a stray lies ahead of it, by this share of the allowed displacement. A
/// falling sphere then strays half as often.
const AHEAD: f64 = 0.8;

impl VerletList {
    /// Notes that a sphere was added at the end. It is a stray until the list follows it.
    pub fn add_sphere(&mut self) {
        if self.builds > 0 {
            self.anchor.add_stray();
            self.end_entries();
        }
    }

    /// Notes that the spheres not marked in `keep` were removed and that the others have new
    /// indices.
    pub fn remove_spheres(&mut self, keep: &[bool]) {
        if self.builds == 0 {
            return;
        }
        self.anchor.remove_spheres(keep);
        let index = indices_of_kept(keep);
        self.rewrite(|i, entries, list| {
            if keep[i] {
                let kept = entries.iter().filter(|&&j| keep[j as usize]);
                list.extend(kept.map(|&j| index[j as usize]));
            }
            keep[i]
        });
    }

    /// Follows the spheres that left their margins, if they are few. Positions must be finite.
    /// Returns whether the list holds again, as [`Self::holds`] says.
    pub fn follow(&mut self, particles: &Particles, time: f64, margin: f64) -> bool {
        if self.builds == 0 || self.outdated || !self.can_follow() {
            return false;
        }
        let allowance = self.allowance(time, margin);
        let places = particles.position.iter().zip(self.anchor.position());
        let is_stray: Vec<bool> = (places.map(|(&at, &from)| !allowance.holds(at, from))).collect();
        let strays = || (0..is_stray.len()).filter(|&i| is_stray[i]);
        if strays().count() > (is_stray.len() / FEW_OF).min(MOST) {
            return false;
        }
        for stray in strays() {
            let (position, velocity) = (particles.position[stray], particles.velocity[stray]);
            let speed = velocity.norm();
            let place = match speed > 0.0 {
                true => position + velocity * (1.0 / speed) * (AHEAD * allowance.displacement()),
                false => position,
            };
            self.anchor.replace(stray, place, time);
        }
        let mut pairs = Vec::new();
        for stray in strays() {
            self.anchored_partners(particles, stray, |other| {
                // A pair of two strays is found from both.
                if !is_stray[other] || other > stray {
                    pairs.push((stray.min(other) as u32, stray.max(other) as u32));
                }
            });
        }
        pairs.sort_unstable();
        let mut pairs = pairs.into_iter().peekable();
        self.rewrite(|i, entries, list| {
            let first = list.len();
            if !is_stray[i] {
                list.extend(entries.iter().filter(|&&j| !is_stray[j as usize]));
            }
            let stay = list.len();
            while let Some((_, j)) = pairs.next_if(|&(one, _)| one as usize == i) {
                list.push(j);
            }
            if first < stay && stay < list.len() {
                list[first..].sort_unstable();
            }
            true
        });
        self.holds(particles, time, margin)
    }

    /// Whether the list can be updated for a few strays. Not with a shield, whose box depends on
    /// all spheres; not with sorted spheres, whose order depends on their cells.
    fn can_follow(&self) -> bool {
        self.reach == Reach::Contact && !self.sorted && self.search.may_be_replaced()
    }

    /// Calls `visit` with every other sphere whose reference is within the skin of the stray's
    /// reference.
    fn anchored_partners(&self, particles: &Particles, stray: usize, mut visit: impl FnMut(usize)) {
        let references = self.anchor.position();
        let (centre, radius) = (references[stray].place(), particles.radius[stray]);
        // Both references are rounded; the allowance covers the displacement of one sphere only.
        let reach = radius + self.skin + 2.0 * self.anchor.rounding();
        let spheres = references.iter().zip(&particles.radius).enumerate();
        for (i, (reference, radius)) in spheres {
            let distance = reach + radius;
            let offset = particles.domain.offset(reference.place(), centre);
            let near = offset.norm_squared() < distance * distance;
            if near && i != stray && i.max(stray) >= particles.first_partner(i.min(stray)) {
                visit(i);
            }
        }
    }

    /// Rewrites the entries of every sphere that stays.
    fn rewrite(&mut self, mut follow: impl FnMut(usize, &[u32], &mut Vec<u32>) -> bool) {
        let start = std::mem::replace(&mut self.start, vec![0]);
        let before = Vec::with_capacity(self.neighbour.capacity());
        let neighbour = std::mem::replace(&mut self.neighbour, before);
        self.owner.clear();
        for (i, bounds) in start.windows(2).enumerate() {
            let entries = &neighbour[bounds[0] as usize..bounds[1] as usize];
            if follow(i, entries, &mut self.neighbour) {
                self.end_entries();
            }
        }
    }
}

/// The new index of every sphere that is kept.
pub(super) fn indices_of_kept(keep: &[bool]) -> Vec<u32> {
    let mut next = 0;
    let index = |&keep: &bool| {
        next += u32::from(keep);
        next.saturating_sub(1)
    };
    keep.iter().map(index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::particles::vector::Vector;
    use crate::scene::Neighbours;
    use proptest::prelude::*;

    const SKIN: f64 = 0.3;

    /// Centre and radius (m), and velocity (m/s).
    fn sphere() -> impl Strategy<Value = (Vector, f64, Vector)> {
        let vector = || {
            let number = || -2.0..2.0_f64;
            (number(), number(), number()).prop_map(|(x, y, z)| Vector::new(x, y, z))
        };
        (vector(), 0.2..0.5, vector())
    }

    fn add(particles: &mut Particles, (place, radius, velocity): (Vector, f64, Vector)) {
        particles.position.push(place);
        particles.radius.push(radius);
        particles.velocity.push(velocity);
    }

    fn kept<V: Copy>(values: &[V], keep: &[bool]) -> Vec<V> {
        let kept = values.iter().zip(keep).filter(|(_, keep)| **keep);
        kept.map(|(&value, _)| value).collect()
    }

    proptest! {
        /// After spheres leave, enter and jump elsewhere, the list has every pair within the skin
        /// once, in order.
        #[test]
        fn a_list_follows_a_few_spheres(
            first in prop::collection::vec(sphere(), 60..90),
            gone in prop::collection::vec(0..60_usize, 0..6),
            came in prop::collection::vec(sphere(), 0..2),
            strays in prop::collection::vec((0..50_usize, sphere()), 0..2),
            rotation in -1.0..1.0_f64,
        ) {
            let mut particles = Particles::default();
            for &sphere in &first {
                add(&mut particles, sphere);
            }
            for (velocity, &place) in particles.velocity.iter_mut().zip(&particles.position) {
                *velocity = Vector::new(-rotation * place.y, rotation * place.x, 0.0);
            }
            let mut list = VerletList::new(Reach::Contact, SKIN, Neighbours::VerletList);
            list.build(&particles, 1);
            // All turn a little.
            let time = 0.1;
            let (sine, cosine) = libm::sincos(rotation * time);
            for place in &mut particles.position {
                let Vector { x, y, z, .. } = *place;
                *place = Vector::new(cosine * x - sine * y, sine * x + cosine * y, z);
            }
            let keep: Vec<bool> = (0..first.len()).map(|i| !gone.contains(&i)).collect();
            particles.position = kept(&particles.position, &keep);
            particles.velocity = kept(&particles.velocity, &keep);
            particles.radius = kept(&particles.radius, &keep);
            list.remove_spheres(&keep);
            for sphere in came {
                add(&mut particles, sphere);
                list.add_sphere();
                prop_assert!(!list.holds(&particles, time, 0.0));
            }
            for (at, (place, ..)) in strays {
                particles.position[at] = place;
            }
            prop_assert!(list.holds(&particles, time, 0.1) || list.follow(&particles, time, 0.1));
            prop_assert!(list.holds(&particles, time, 0.1));
            prop_assert_eq!(list.builds(), 1);
            prop_assert_eq!(list.start().len(), particles.len() + 1);
            for i in 0..particles.len() {
                let bounds = list.start()[i] as usize..list.start()[i + 1] as usize;
                let partners = &list.neighbour()[bounds.clone()];
                prop_assert!(partners.is_sorted_by(|one, next| one < next));
                prop_assert!(list.owner[bounds].iter().all(|&owner| owner == i as u32));
                for j in i + 1..particles.len() {
                    let distance = (particles.position[i] - particles.position[j]).norm();
                    let gap = distance - particles.radius[i] - particles.radius[j];
                    // A listed pair is no farther apart than twice the skin, and a missing one
                    // farther than the gap for which the list holds.
                    let listed = partners.contains(&(j as u32));
                    prop_assert!(listed || gap > 0.1, "{i} and {j} are missing: {gap}");
                    prop_assert!(!listed || gap < 2.0 * SKIN, "{i} and {j} are listed: {gap}");
                }
            }
        }
    }

    /// If half of the spheres left their margins, the list is built again.
    #[test]
    fn many_are_not_followed() {
        let mut particles = Particles::default();
        for k in 0..20 {
            add(
                &mut particles,
                (Vector::new(f64::from(k), 0.0, 0.0), 0.5, Vector::ZERO),
            );
        }
        let mut list = VerletList::new(Reach::Contact, SKIN, Neighbours::VerletList);
        list.build(&particles, 1);
        for place in &mut particles.position[10..] {
            place.z += 1.0;
        }
        assert!(!list.holds(&particles, 0.0, 0.0));
        assert!(!list.follow(&particles, 0.0, 0.0));
    }
}
