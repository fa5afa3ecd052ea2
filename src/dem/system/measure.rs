//! Energies and number of the contacts.

use super::{Contacts, System};
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
            domain,
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
            .map(|wall| (&wall.wall, wall.near.iter().zip(&wall.histories).peekable()))
            .collect();
        for i in 0..radius.len() {
            let (centre, ri) = (position[i], radius[i]);
            while let Some((pair, history)) = pairs.next_if(|(pair, _)| pair.i() as usize == i) {
                let j = pair.j() as usize;
                let sum = ri + radius[j];
                let distance_squared = domain.offset(centre, position[j]).norm_squared();
                if distance_squared < sum * sum {
                    let overlap = sum - distance_squared.sqrt();
                    let effective_radius = ri * radius[j] / sum;
                    let law = &self.tangential;
                    let [elastic, spring] = self.energies(law, overlap, effective_radius, history);
                    contacts.elastic_energy += elastic;
                    contacts.spring_energy += spring;
                    if self.ledger.is_some() {
                        contacts.spring_energy +=
                            self.rolling_energy([i, j], overlap, effective_radius);
                    }
                    contacts.of_moving_spheres += i64::from(i >= *fixed) + i64::from(j >= *fixed);
                }
            }
            for (place, (wall, near)) in walls.iter_mut().enumerate() {
                let Some((_, history)) = near.next_if(|(sphere, _)| sphere.i as usize == i) else {
                    continue;
                };
                let contact = wall.contact(centre, ri);
                if contact.touches {
                    let law = &self.laws().at_wall(wall).tangential;
                    let [elastic, spring] = self.energies(law, contact.overlap, ri, history);
                    contacts.elastic_energy += elastic * wall.weight;
                    contacts.spring_energy += spring * wall.weight;
                    if self.ledger.is_some() {
                        contacts.spring_energy += wall.weight
                            * self.rolling_energy_at_wall((i, place), contact.overlap, ri);
                    }
                    contacts.of_moving_spheres += wall.weight as i64;
                }
            }
        }
        contacts
    }

    /// The energies (J) of a contact of this overlap (m) and effective radius (m): elastic, and of
    /// its tangential spring, if a ledger is kept.
    fn energies(
        &self,
        law: &T,
        overlap: f64,
        effective_radius: f64,
        history: &T::History,
    ) -> [f64; 2] {
        let elastic = self.normal.elastic_energy(overlap, effective_radius);
        let spring = match Self::HAS_HISTORY && self.ledger.is_some() {
            true => law.energy(history, overlap, effective_radius),
            false => 0.0,
        };
        [elastic, spring]
    }
}
