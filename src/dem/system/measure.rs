//! Energies and number of the contacts.

use super::{Contacts, System};
use crate::dem::walls::Wall;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::Particles;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Energies and number of the contacts. The list may be built earlier than a step would build
    /// it, but no bit of the motion depends on that.
    pub(super) fn measure_contacts(&mut self) -> Contacts {
        if !N::ACTS || self.neighbours.list.is_none() {
            return Contacts::default();
        }
        if self.neighbours.stale && self.refresh().is_err() {
            return Contacts::default();
        }
        self.sum_of_contacts()
    }

    /// Sums over all contacts, sphere by sphere: first its pairs, then its walls. The order of the
    /// sums is part of their bits.
    fn sum_of_contacts(&self) -> Contacts {
        let Particles {
            position,
            radius,
            fixed,
            ..
        } = &self.particles;
        let mut contacts = Contacts::default();
        let pairs = self.neighbours.near.pairs().iter();
        let mut pairs = pairs.zip(&self.pair_history).peekable();
        let walls = self.walls.iter();
        let mut walls: Vec<_> = walls
            .map(|wall| (wall.wall, wall.near.iter().zip(&wall.histories).peekable()))
            .collect();
        for i in 0..radius.len() {
            let (centre, ri) = (position[i], radius[i]);
            while let Some((pair, history)) = pairs.next_if(|(pair, _)| pair.i() as usize == i) {
                let j = pair.j() as usize;
                let sum = ri + radius[j];
                let distance_squared = (centre - position[j]).norm_squared();
                if distance_squared < sum * sum {
                    let overlap = sum - distance_squared.sqrt();
                    let effective_radius = ri * radius[j] / sum;
                    let law = &self.tangential;
                    self.add_contact(&mut contacts, law, overlap, effective_radius, history);
                    if self.ledger.is_some() {
                        contacts.spring_energy +=
                            self.rolling_energy([i, j], overlap, effective_radius);
                    }
                    contacts.of_moving_spheres +=
                        usize::from(i >= *fixed) + usize::from(j >= *fixed);
                }
            }
            for (place, (wall, near)) in walls.iter_mut().enumerate() {
                let Some((_, history)) = near.next_if(|(sphere, _)| sphere.i as usize == i) else {
                    continue;
                };
                let contact = wall.contact(centre, ri);
                if contact.touches {
                    let law = &self.tangential_at_walls;
                    self.add_contact(&mut contacts, law, contact.overlap, ri, history);
                    if self.ledger.is_some() {
                        contacts.spring_energy +=
                            self.rolling_energy_at_wall((i, place), contact.overlap, ri);
                    }
                    contacts.of_moving_spheres += 1;
                }
            }
        }
        contacts
    }

    /// Adds the energies of a contact of this overlap (m) and effective radius (m).
    fn add_contact(
        &self,
        contacts: &mut Contacts,
        law: &T,
        overlap: f64,
        effective_radius: f64,
        history: &T::History,
    ) {
        contacts.elastic_energy += self.normal.elastic_energy(overlap, effective_radius);
        if Self::HAS_HISTORY && self.ledger.is_some() {
            contacts.spring_energy += law.energy(history, overlap, effective_radius);
        }
    }
}
