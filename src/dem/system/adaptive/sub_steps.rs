//! The motion of one island: a step in sub-steps.

use super::islands::{Island, IslandContacts};
use super::kick;
use super::workspace::Workspace;
use crate::dem::bodies::SphereRows;
use crate::dem::system::System;
use crate::dem::system::candidates::{AtWall, Candidates};
use crate::dem::system::contact_laws::Loading;
use crate::dem::system::contact_task::{ContactSlice, ContactTask};
use crate::dem::system::partners::Partners;
use crate::dem::system::sums::Sums;
use crate::dem::system::wall_contacts::WallContacts;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::vector::Vector;
use crate::simulation::Instability;
use crate::walls::Wall;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Moves the spheres of an island by a step, in this number of sub-steps.
    pub(super) fn move_island(
        &mut self,
        island: &Island,
        sub_steps: u64,
        work: &mut Workspace<T::History>,
    ) -> Result<(), Instability> {
        let time = self.setup.dt / sub_steps as f64;
        let half = 0.5 * time;
        self.step.moves += sub_steps * island.spheres.len() as u64;
        for &i in &island.spheres {
            let (i, particles) = (i as usize, &mut self.particles);
            particles.force[i] = work.start.force[i];
            if particles.rotate() {
                particles.torque[i] = work.start.torque[i];
            }
        }
        let mut histories = IslandHistories::of(&island.contacts, &self.pair_history, &self.walls);
        for sub_step in 0..sub_steps {
            // Springs are loaded from one middle to the next, and at first from the start to the
            // middle.
            let duration = if sub_step == 0 { half } else { time };
            self.loading = Loading::earlier(duration, half);
            for &i in &island.spheres {
                self.predict(i as usize, half, work);
            }
            if let Some(ledger) = &mut self.ledger {
                let spheres = island.spheres.iter();
                spheres.for_each(|&i| ledger.books.clear_sphere(i));
            }
            self.note_island(&island.contacts);
            self.mark_ledger();
            self.add_island_forces(&island.contacts, &mut histories);
            self.check_overlaps()?;
            if self.ledger.is_some() {
                histories.put_back(&island.contacts, &mut self.pair_history, &mut self.walls);
            }
            for &i in &island.spheres {
                self.finish(i as usize, time, work);
            }
        }
        if self.loads_springs() {
            self.load_springs(island, &mut histories, half, work);
        }
        histories.put_back(&island.contacts, &mut self.pair_history, &mut self.walls);
        Ok(())
    }

    /// Loads the springs of an island over the last `time` (s) of its step.
    fn load_springs(
        &mut self,
        island: &Island,
        histories: &mut IslandHistories<T::History>,
        time: f64,
        work: &mut Workspace<T::History>,
    ) {
        self.loading = Loading::just_now(time);
        let spheres = || island.spheres.iter().map(|&i| i as usize);
        let particles = &self.particles;
        for i in spheres() {
            self.earlier[i] = [particles.velocity[i].row(), particles.spin[i].row()];
        }
        work.held.force.clear();
        work.held
            .force
            .extend(spheres().map(|i| particles.force[i]));
        work.held.torque.clear();
        if particles.rotate() {
            let torques = spheres().map(|i| particles.torque[i]);
            work.held.torque.extend(torques);
        }
        self.add_island_forces(&island.contacts, histories);
        // Forces must remain as evaluated at the last middle. The next step finds an overlap that
        // is too deep.
        let particles = &mut self.particles;
        for (i, &force) in spheres().zip(&work.held.force) {
            particles.force[i] = force;
        }
        for (i, &torque) in spheres().zip(&work.held.torque) {
            particles.torque[i] = torque;
        }
        self.step.too_deep = None;
    }

    /// Moves a sphere to the middle of a sub-step, and gives it the velocity and spin that the
    /// latest forces predict there. Its own velocity and spin are held.
    fn predict(&mut self, i: usize, half: f64, work: &mut Workspace<T::History>) {
        let loads_springs = self.loads_springs();
        let particles = &mut self.particles;
        particles.position[i] += particles.velocity[i] * half;
        work.held.velocity[i] = particles.velocity[i];
        if particles.rotate() {
            work.held.spin[i] = particles.spin[i];
        }
        if loads_springs {
            self.earlier[i] = [particles.velocity[i].row(), particles.spin[i].row()];
        }
        kick(particles, i, half);
        particles.force[i] = Vector::ZERO;
        if particles.rotate() {
            particles.torque[i] = Vector::ZERO;
        }
    }

    /// Moves a sphere from the middle to the end of a sub-step.
    fn finish(&mut self, i: usize, time: f64, work: &mut Workspace<T::History>) {
        let particles = &mut self.particles;
        particles.velocity[i] = work.held.velocity[i];
        particles.force[i] += work.force[i];
        if particles.rotate() {
            particles.spin[i] = work.held.spin[i];
            particles.torque[i] += work.torque[i];
        }
        kick(particles, i, time);
        if let Some(ledger) = &mut self.ledger {
            ledger.books.note_kick(i, particles, time);
        }
        particles.position[i] += particles.velocity[i] * (0.5 * time);
        work.note_way(i, particles);
    }

    /// Adds the forces and torques of an island's contacts.
    fn add_island_forces(
        &mut self,
        contacts: &IslandContacts,
        histories: &mut IslandHistories<T::History>,
    ) {
        let settings = self.settings();
        let mut spheres = SphereRows::new(&mut self.particles, &[]);
        let (partners, [force, torque]) = Partners::of(&mut spheres, &self.earlier);
        let sums = Sums {
            first: 0,
            clear: false,
            force,
            torque,
        };
        let walls = self.walls.iter().map(|wall| &wall.wall);
        let candidates = histories.candidates(contacts, walls);
        let mut task = ContactTask::of_all(partners, sums, candidates, &mut self.buffers);
        task.add_contacts(self.level, &settings, &mut self.profile);
        let too_deep = task.too_deep.map(|(_, found)| found);
        drop(task);
        self.step.too_deep = self.step.too_deep.or(too_deep);
        self.add_rolling_of_island(contacts);
    }
}

/// Copies of the histories of an island's contacts. The kernels expect the history of each contact
/// at the index of the contact, while the originals are stored among the histories of all contacts.
struct IslandHistories<H> {
    pairs: Vec<H>,
    walls: Vec<Vec<H>>,
}

impl<H: Copy> IslandHistories<H> {
    fn of(contacts: &IslandContacts, pairs: &[H], walls: &[WallContacts<H>]) -> Self {
        let copy = |entry: u32, all: &[H]| all[entry as usize];
        let at_walls = walls.iter().zip(&contacts.walls).map(|(wall, near)| {
            let near = near.iter();
            near.map(|sphere| copy(sphere.entry, &wall.histories))
                .collect()
        });
        let entries = contacts.entries.iter();
        Self {
            pairs: entries.map(|&entry| copy(entry, pairs)).collect(),
            walls: at_walls.collect(),
        }
    }

    /// The contacts, each with its history.
    fn candidates<'a>(
        &'a mut self,
        contacts: &'a IslandContacts,
        walls: impl Iterator<Item = &'a Wall>,
    ) -> Candidates<'a, H> {
        let near = contacts.walls.iter().zip(&mut self.walls);
        let at_walls = walls.zip(near).map(|(wall, (contacts, histories))| AtWall {
            wall,
            near: ContactSlice {
                contacts: &contacts[..],
                histories: &mut histories[..],
            },
        });
        Candidates {
            pairs: ContactSlice {
                contacts: &contacts.pairs,
                histories: &mut self.pairs,
            },
            walls: at_walls.collect(),
        }
    }

    /// Writes the histories back to their entries.
    fn put_back(&self, contacts: &IslandContacts, pairs: &mut [H], walls: &mut [WallContacts<H>]) {
        for (&entry, &history) in contacts.entries.iter().zip(&self.pairs) {
            pairs[entry as usize] = history;
        }
        for ((copies, wall), near) in self.walls.iter().zip(walls).zip(&contacts.walls) {
            for (sphere, &history) in near.iter().zip(copies) {
                wall.histories[sphere.entry as usize] = history;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Symptom: contacts of an island of adaptive Verlet read the springs of other contacts. Cause:
    /// the histories of some contacts were read by their index in the island, not by their entry in
    /// the whole list.
    #[test]
    fn some_contacts_find_their_histories_among_all() {
        let contacts = IslandContacts {
            entries: vec![1, 4],
            ..IslandContacts::default()
        };
        let mut all = [10, 11, 12, 13, 14];
        let mut histories = IslandHistories::of(&contacts, &all, &[]);
        assert_eq!(histories.pairs, [11, 14]);
        histories.pairs[1] = 24;
        histories.put_back(&contacts, &mut all, &mut []);
        assert_eq!(all, [10, 11, 12, 13, 24]);
    }
}
