//! The energy balance: the work of damping, of tangential forces, of the air and of shaking.
//!
//! A kick by a force F turns v into v' and adds F (v + v') / 2 dt to the kinetic energy, exactly.
//! So the work is summed kick by kick, from the forces that the kicks use. The residual of the
//! balance is then the error of the scheme for conservative forces, not an error of the sum.

use super::adaptive::IslandContacts;
use super::contact_block::EarlierRows;
use super::contact_laws::Laws;
use super::contact_state::ContactState;
use super::partners::Partners;
use super::wall_contacts::NearSphere;
use super::{Engine, System};
use crate::dem::neighbours::NearPair;
use crate::dem::profile::StepPart;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::reorder::reorder;
use crate::particles::vector::Vector;
use crate::particles::{Particles, retain};
use crate::walls::Wall;
use serde::{Deserialize, Serialize};

/// Work since the start (J).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::dem) struct LedgerWork {
    /// Of the damping of contacts, negative where it dissipates.
    pub(in crate::dem) damping: f64,
    /// Of tangential forces.
    pub(in crate::dem) tangential: f64,
    /// Of the air, including the damping of spins.
    pub(in crate::dem) air: f64,
    /// Of the shaking.
    pub(in crate::dem) shaking: f64,
    /// Of walls that move in themselves. Damping and tangential forces do the rest of the work at
    /// these walls.
    pub(in crate::dem) walls: f64,
    /// Energy of spheres that came in, minus the energy of spheres that left.
    pub(in crate::dem) brought: f64,
}

/// The work so far, and the components of the latest forces that do it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Books {
    pub(super) work: LedgerWork,
    /// Components of the latest force on each sphere (N) and of its torque (N m).
    damping: Vec<Vector>,
    tangential: Vec<Vector>,
    tangential_torque: Vec<Vector>,
    air: Vec<Vector>,
    air_torque: Vec<Vector>,
    /// The latest acceleration by the shaking (m/s2).
    shaking: Vector,
    /// Power (W) of moving walls by the damping of their contacts with each sphere, and by
    /// tangential forces.
    walls: Vec<[f64; 2]>,
}

impl Books {
    /// The components of contacts, and of the air.
    fn components(&mut self) -> ([&mut Vec<Vector>; 3], [&mut Vec<Vector>; 2]) {
        let contacts = [
            &mut self.damping,
            &mut self.tangential,
            &mut self.tangential_torque,
        ];
        (contacts, [&mut self.air, &mut self.air_torque])
    }

    /// Whether the books may belong to these spheres. Before the first step they are empty.
    pub(super) fn fit(&self, particles: &Particles) -> bool {
        let parts = [
            &self.damping,
            &self.tangential,
            &self.tangential_torque,
            &self.air,
        ];
        let first = self.damping.len();
        (first == particles.len() || first == 0)
            && self.walls.len() == first
            && parts.iter().all(|part| part.len() == first)
            && (self.air_torque.len() == first || !particles.rotate())
    }

    /// Makes room for this number of spheres.
    pub(super) fn resize(&mut self, spheres: usize) {
        self.walls.resize(spheres, [0.0; 2]);
        let (contacts, air) = self.components();
        for forces in contacts.into_iter().chain(air) {
            forces.resize(spheres, Vector::ZERO);
        }
    }

    /// Clears the contact forces of all spheres.
    fn clear(&mut self) {
        self.walls.fill([0.0; 2]);
        for forces in self.components().0 {
            forces.fill(Vector::ZERO);
        }
    }

    /// Clears the contact forces of one sphere.
    pub(super) fn clear_sphere(&mut self, i: u32) {
        for forces in self.components().0 {
            forces[i as usize] = Vector::ZERO;
        }
    }

    /// Adds a sphere at the end, which touches nothing.
    pub(super) fn add_sphere(&mut self) {
        self.resize(self.damping.len() + 1);
    }

    pub(super) fn retain(&mut self, keep: &[bool]) {
        self.resize(keep.len());
        let (contacts, air) = self.components();
        for forces in contacts.into_iter().chain(air) {
            retain(forces, keep);
        }
        retain(&mut self.walls, keep);
    }

    /// Puts the spheres into a new order.
    pub(super) fn reorder(&mut self, order: &[u32]) {
        self.resize(order.len());
        let (contacts, air) = self.components();
        for forces in contacts.into_iter().chain(air) {
            reorder(forces, order);
        }
        reorder(&mut self.walls, order);
    }

    /// Adds the force of a contact on sphere `i`, without its elastic part, and its torque.
    pub(super) fn add(&mut self, i: u32, damping: Vector, tangential: Vector, torque: Vector) {
        let i = i as usize;
        self.damping[i] += damping;
        self.tangential[i] += tangential;
        self.tangential_torque[i] += torque;
    }

    /// Notes the acceleration (m/s2) of all spheres by the shaking.
    pub(super) fn note_shaking(&mut self, acceleration: Vector) {
        self.shaking = acceleration;
    }

    /// Adds the power (W) of a moving wall by its contact with sphere `i`: by damping, and by
    /// tangential forces.
    pub(super) fn add_power_of_wall(&mut self, i: u32, [damping, tangential]: [f64; 2]) {
        let [by_damping, by_friction] = &mut self.walls[i as usize];
        *by_damping += damping;
        *by_friction += tangential;
    }

    /// Notes what the effects of the air added to forces and torques.
    pub(super) fn note_air(&mut self, before: [&[Vector]; 2], particles: &Particles) {
        let after = [&particles.force, &particles.torque];
        for ((air, before), after) in self.components().1.into_iter().zip(before).zip(after) {
            air.clear();
            let added = after.iter().zip(before);
            air.extend(added.map(|(&after, &before)| after - before));
        }
    }

    /// Adds the work of a kick of `dt` (s) that sphere `i` has just got.
    pub(super) fn note_kick(&mut self, i: usize, particles: &Particles, dt: f64) {
        let half = 0.5 * dt;
        let back = particles.force[i] * (particles.inverse_mass[i] * half);
        let way = (particles.velocity[i] - back) * dt;
        self.work.damping += self.damping[i].dot(way);
        self.work.tangential += self.tangential[i].dot(way);
        self.work.air += self.air[i].dot(way);
        self.work.shaking += particles.mass[i] * self.shaking.dot(way);
        let [by_damping, by_friction] = self.walls[i].map(|power| power * dt);
        self.work.damping -= by_damping;
        self.work.tangential -= by_friction;
        self.work.walls += by_damping + by_friction;
        if particles.rotate() {
            let back = particles.torque[i] * (particles.inverse_inertia[i] * half);
            let turn = (particles.spin[i] - back) * dt;
            self.work.tangential += self.tangential_torque[i].dot(turn);
            self.work.air += self.air_torque[i].dot(turn);
        }
    }
}

/// The energy balance of a system.
#[derive(Default)]
pub(super) struct EnergyBooks {
    pub(super) books: Books,
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Energy of the spheres and the tangential springs, and of the springs alone (J), if a ledger
    /// is kept.
    pub(super) fn energy_in_books(&mut self) -> Option<[f64; 2]> {
        self.ledger.as_ref()?;
        let contacts = self.contacts();
        let particles = &self.particles;
        let translation = particles.velocity.iter().enumerate();
        let translation = translation.map(|(i, rate)| (rate, particles.inertial_mass(i)));
        let rotation = particles.spin.iter().zip(particles.inertia.iter().copied());
        let kinetic: f64 = translation
            .chain(rotation)
            .map(|(rate, inertia)| 0.5 * inertia * rate.norm_squared())
            .sum();
        let effects = self.setup.effects.iter();
        let potential: f64 = effects
            .filter_map(|(_, effect)| effect.energy(particles))
            .sum();
        let springs = contacts.spring_energy;
        Some([
            kinetic + potential + contacts.elastic_energy + springs,
            springs,
        ])
    }

    /// Notes that spheres came or left since the energy was measured as `before`.
    pub(super) fn note_exchange(&mut self, before: Option<[f64; 2]>) {
        let Some(before) = before else { return };
        let after = self.energy_in_books();
        if let (Some(ledger), Some(after)) = (&mut self.ledger, after) {
            ledger.books.work.brought += after[0] - before[0];
            // Friction did not dissipate the energy of springs that left with their spheres.
            ledger.books.work.tangential -= after[1] - before[1];
        }
    }

    /// Notes the work of a kick of `dt` (s) that all spheres have just got.
    pub(super) fn note_kick(&mut self, dt: f64) {
        let Some(ledger) = &mut self.ledger else {
            return;
        };
        let particles = &self.particles;
        for i in particles.fixed..particles.len() {
            ledger.books.note_kick(i, particles, dt);
        }
        self.mark(StepPart::Ledger);
    }

    /// Notes all contacts, before their forces are evaluated: histories are only read.
    pub(super) fn note_all_contacts(&mut self) {
        self.clear_contacts_in_books();
        let laws = self.laws();
        let (true, Some(ledger)) = (N::ACTS, &mut self.ledger) else {
            return;
        };
        let mut notes = Notes::new(laws, &self.particles, &self.earlier, &mut ledger.books);
        let pairs = self.neighbours.near.pairs().iter();
        for (&pair, history) in pairs.zip(&self.pair_history) {
            notes.add_pair(pair, *history);
        }
        for wall in &self.walls {
            for (sphere, history) in wall.near.iter().zip(&wall.histories) {
                notes.add_at_wall(&wall.wall, sphere.i, *history);
            }
        }
    }

    /// Clears the contact forces of all spheres, if a ledger is kept.
    pub(super) fn clear_contacts_in_books(&mut self) {
        if let Some(ledger) = &mut self.ledger {
            ledger.books.resize(self.particles.len());
            ledger.books.clear();
        }
    }

    /// Notes the contacts of an island, as [`note_all_contacts`](Self::note_all_contacts) does.
    pub(super) fn note_island(&mut self, contacts: &IslandContacts) {
        let laws = self.laws();
        let (true, Some(ledger)) = (N::ACTS, &mut self.ledger) else {
            return;
        };
        let mut notes = Notes::new(laws, &self.particles, &self.earlier, &mut ledger.books);
        for (&pair, &entry) in contacts.pairs.iter().zip(&contacts.entries) {
            notes.add_pair(pair, self.pair_history[entry as usize]);
        }
        for (wall, near) in self.walls.iter().zip(&contacts.walls) {
            for &NearSphere { i, entry } in near {
                notes.add_at_wall(&wall.wall, i, wall.histories[entry as usize]);
            }
        }
    }
}

/// Adds contacts to the books.
struct Notes<'a, N, T> {
    laws: Laws<N, T>,
    spheres: Partners<'a>,
    books: &'a mut Books,
}

impl<'a, N: NormalLaw, T: TangentialLaw> Notes<'a, N, T> {
    fn new(
        laws: Laws<N, T>,
        particles: &'a Particles,
        earlier: &'a [EarlierRows],
        books: &'a mut Books,
    ) -> Self {
        let earlier = match laws.loading.age > 0.0 {
            true => earlier,
            false => &[],
        };
        Self {
            laws,
            spheres: Partners::all(particles, earlier),
            books,
        }
    }

    fn add_pair(&mut self, pair: NearPair, history: T::History) {
        let (i, j) = (pair.i(), pair.j());
        let state = ContactState::of_pair(&self.spheres, i, j);
        let contact = self.laws.pair_force(&state, history);
        if contact.touches {
            let [damping, tangential] = self.laws.damping_and_friction(&contact);
            let [one, other] = contact.torque;
            self.books.add(i, damping, tangential, one);
            self.books.add(j, -damping, -tangential, other);
        }
    }

    fn add_at_wall(&mut self, wall: &Wall, i: u32, history: T::History) {
        let state = ContactState::at_wall(&self.spheres, i);
        let contact = self.laws.wall_force(wall, &state, history);
        if contact.touches {
            let parts = self.laws.damping_and_friction(&contact);
            let [damping, tangential] = parts.map(|force| force * wall.weight);
            self.books
                .add(i, damping, tangential, contact.torque[0] * wall.weight);
            if wall.motion.is_some() {
                let of_wall = state.velocity - contact.velocity;
                self.books
                    .add_power_of_wall(i, [damping.dot(of_wall), tangential.dot(of_wall)]);
            }
        }
    }
}
