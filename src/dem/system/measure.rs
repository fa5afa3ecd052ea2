//! What the contacts hold.

use super::{Contacts, System};
use crate::dem::walls::Wall;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::Particles;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Reads positions alone, and builds the list at most earlier than a step would: bits of
    /// the motion do not depend on when the list is built.
    pub(super) fn measure_contacts(&mut self) -> Contacts {
        let mut contacts = Contacts::default();
        if !N::ACTS || self.neighbours.list.is_none() {
            return contacts;
        }
        if self.neighbours.stale && self.refresh().is_err() {
            return contacts;
        }
        let Particles {
            position,
            radius,
            fixed,
            ..
        } = &self.particles;
        let (mut energy, mut springs) = (0.0, 0.0);
        let with_springs = Self::HAS_HISTORY && self.ledger.is_some();
        let spring = |history: &[T::History], at: usize, overlap: f64, effective_radius: f64| {
            match with_springs {
                true => self
                    .tangential
                    .energy(&history[at], overlap, effective_radius),
                false => 0.0,
            }
        };
        let count = &mut contacts.of_moving_spheres;
        let mut pairs = self.neighbours.near.pairs().iter().enumerate().peekable();
        let mut walls: Vec<_> = self
            .walls
            .iter()
            .map(|it| (it, it.near.iter().peekable()))
            .collect();
        for i in 0..radius.len() {
            let (centre, ri) = (position[i], radius[i]);
            while let Some((entry, pair)) = pairs.next_if(|(_, pair)| pair.i() as usize == i) {
                let j = pair.j() as usize;
                let rj = radius[j];
                let distance_squared = (centre - position[j]).norm_squared();
                if distance_squared < (ri + rj) * (ri + rj) {
                    let overlap = ri + rj - distance_squared.sqrt();
                    let effective_radius = ri * rj / (ri + rj);
                    energy += self.normal.elastic_energy(overlap, effective_radius);
                    springs += spring(&self.pair_history, entry, overlap, effective_radius);
                    *count += usize::from(i >= *fixed) + usize::from(j >= *fixed);
                }
            }
            for (wall, near) in &mut walls {
                let Some(sphere) = near.next_if(|sphere| sphere.i as usize == i) else {
                    continue;
                };
                let contact = wall.wall.contact(centre, ri);
                if contact.touches {
                    energy += self.normal.elastic_energy(contact.overlap, ri);
                    springs += spring(&wall.histories, sphere.entry as usize, contact.overlap, ri);
                    *count += 1;
                }
            }
        }
        contacts.elastic_energy = energy;
        contacts.spring_energy = springs;
        contacts
    }
}
