//! Velocity Verlet with sub-steps where spheres touch.

mod islands;
mod workspace;

pub(super) use self::workspace::Workspace;

use self::islands::Island;
use self::workspace::Start;
use super::candidates::Candidates;
use super::contact_laws::Loading;
use super::wall_contacts::{NearSphere, WallContacts};
use super::{Engine, Setup, System};
use crate::dem::walls::Wall;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{Grip, TangentialLaw};
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::simulation::Instability;

/// How often a step is tried, each time with more room. One that needs more is on its way to a
/// guard.
const ATTEMPTS: u32 = 20;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// One step of synchronised Verlet, cut into as many sub-steps as the contacts need, for each
    /// group of touching spheres by itself: the others move in one go. What acts besides contacts
    /// is taken from the middle of the whole step.
    ///
    /// A sphere belongs to a group if it touches another one or might within the step, by its
    /// predicted displacement. If contacts move a sphere farther, the step is repeated with twice
    /// that distance. So no contact is missed.
    pub(super) fn adaptive_verlet(&mut self) -> Result<(), Instability> {
        let mut work = std::mem::take(&mut self.workspace);
        let result = self.adaptive_step(&mut work);
        self.workspace = work;
        result
    }

    fn adaptive_step(&mut self, work: &mut Workspace<T::History>) -> Result<(), Instability> {
        self.begin_step();
        self.check_all_speeds()?;
        let dt = self.setup.dt;
        work.start.keep(&self.particles);
        work.held.velocity.clone_from(&work.start.velocity);
        work.held.spin.clone_from(&work.start.spin);
        if Self::HAS_HISTORY {
            // Of fixed spheres it stays zero.
            self.earlier.clear();
            self.earlier
                .resize(self.particles.len(), Default::default());
        }
        self.slow_forces(work)?;
        self.keep_histories(&mut work.start);
        let books = self.work();
        for attempt in 1.. {
            let outcome = self.attempt(work);
            let Some(reach) = work.widen(dt).filter(|_| attempt < ATTEMPTS) else {
                outcome?;
                break;
            };
            work.start.put_back(&mut self.particles);
            self.put_back_histories(&work.start);
            if let (Some(ledger), Some(books)) = (&mut self.ledger, books) {
                ledger.books.work = books;
            }
            // The lists may be made anew, and histories with them.
            self.hold_for(reach)?;
            self.keep_histories(&mut work.start);
        }
        self.neighbours.age.time += dt;
        self.neighbours.near_age.time += dt;
        self.check_all_speeds()
    }

    fn check_all_speeds(&mut self) -> Result<(), Instability> {
        let Setup { limits, dt, .. } = &self.setup;
        let Particles {
            velocity, radius, ..
        } = &self.particles;
        self.check_speeds([limits.first_too_fast(0, velocity, radius, *dt), None])
    }

    /// Moves all spheres by a step.
    fn attempt(&mut self, work: &mut Workspace<T::History>) -> Result<(), Instability> {
        self.group(work);
        self.move_free_spheres(work);
        let islands = std::mem::take(&mut work.islands);
        let outcome = islands.all().iter().try_for_each(|island| {
            let sub_steps = work.sub_steps(island, self.setup.dt);
            self.move_island(island, sub_steps, work)
        });
        work.islands = islands;
        outcome
    }

    /// Forces and torques of all but contacts, in the middle of the step as predicted, and
    /// how far the spheres may get in the step. Leaves the spheres where they were.
    fn slow_forces(&mut self, work: &mut Workspace<T::History>) -> Result<(), Instability> {
        let dt = self.setup.dt;
        if self.neighbours.stale {
            self.refresh()?;
        }
        self.note_all_contacts(&Candidates::default());
        self.evaluate_effects();
        let reach = work.find_reach(&self.particles, dt);
        self.hold_for(reach)?;
        let Particles {
            position, velocity, ..
        } = &mut self.particles;
        for (position, &velocity) in position.iter_mut().zip(velocity.iter()) {
            *position += velocity * (0.5 * dt);
        }
        self.kick(0.5 * dt);
        self.evaluate_effects();
        work.force.clone_from(&self.particles.force);
        work.torque.clone_from(&self.particles.torque);
        work.start.put_back(&mut self.particles);
        Ok(())
    }

    /// Sees to it that the near pairs hold while no sphere goes farther than `reach` (m).
    fn hold_for(&mut self, reach: f64) -> Result<(), Instability> {
        let Some(list) = &mut self.neighbours.list else {
            return Ok(());
        };
        // Twice what is needed, to be of use for more than one step.
        let margin = 4.0 * reach;
        list.require(2.0 * margin);
        let wide = self.neighbours.near.require(margin);
        let particles = &self.particles;
        if wide
            && self
                .neighbours
                .near
                .holds(particles, self.neighbours.near_age.time, reach)
        {
            return Ok(());
        }
        self.refresh()
    }

    fn keep_histories(&self, start: &mut Start<T::History>) {
        if Self::HAS_HISTORY {
            start.pair_history.clone_from(&self.pair_history);
            for (kept, wall) in start.wall_history.iter_mut().zip(&self.walls) {
                kept.clone_from(&wall.histories);
            }
        }
    }

    fn put_back_histories(&mut self, start: &Start<T::History>) {
        if Self::HAS_HISTORY {
            self.pair_history.copy_from_slice(&start.pair_history);
            for (wall, kept) in self.walls.iter_mut().zip(&start.wall_history) {
                wall.histories.copy_from_slice(kept);
            }
        }
    }

    /// Finds the islands, and how stiff the contacts of their spheres may become.
    fn group(&self, work: &mut Workspace<T::History>) {
        let particles = &self.particles;
        let (count, fixed) = (particles.len(), particles.fixed);
        work.islands.reset(count);
        work.stiffness.clear();
        work.stiffness.resize(count, 0.0);
        work.damping.clear();
        work.damping.resize(count, 0.0);
        if !N::ACTS {
            return;
        }
        for pair in self.neighbours.near.pairs() {
            self.look_at_pair(pair.i() as usize, pair.j() as usize, work);
        }
        for wall in &self.walls {
            self.look_at_wall(wall, work);
        }
        let walls = self.walls.iter().map(|wall| &wall.near[..]);
        work.islands
            .collect(self.neighbours.near.pairs(), walls, fixed);
    }

    fn look_at_pair(&self, i: usize, j: usize, work: &mut Workspace<T::History>) {
        let Particles {
            position,
            velocity,
            radius,
            inverse_mass,
            fixed,
            ..
        } = &self.particles;
        let sum = radius[i] + radius[j];
        let way = work.reach[i] + work.reach[j];
        let squared = (position[i] - position[j]).norm_squared();
        if squared >= (sum + way) * (sum + way) {
            return;
        }
        work.islands.join(i as u32, j as u32, *fixed);
        let rates = self.rates(
            (sum - squared.sqrt()).max(0.0),
            (velocity[i] - velocity[j]).norm(),
            work.gain[i] + work.gain[j],
            radius[i] * radius[j] / sum,
            inverse_mass[i] + inverse_mass[j],
            self.turning(i) + self.turning(j),
        );
        work.add(i, rates);
        work.add(j, rates);
    }

    fn look_at_wall(&self, wall: &WallContacts<T::History>, work: &mut Workspace<T::History>) {
        let particles = &self.particles;
        for &NearSphere { i: sphere, .. } in &wall.near {
            let (wall, i) = (wall.wall, sphere as usize);
            let (centre, radius) = (particles.position[i], particles.radius[i]);
            if i < particles.fixed || !wall.is_near(centre, radius, work.reach[i]) {
                continue;
            }
            work.islands.touch(sphere);
            let contact = wall.contact(centre, radius);
            let rates = self.rates(
                if contact.touches {
                    contact.overlap
                } else {
                    0.0
                },
                particles.velocity[i].norm(),
                work.gain[i],
                radius,
                particles.inverse_mass[i],
                self.turning(i),
            );
            work.add(i, rates);
        }
    }

    /// How easily a force at its surface turns a sphere: r^2 / I (1/kg).
    fn turning(&self, i: usize) -> f64 {
        let particles = &self.particles;
        let radius = particles.radius[i];
        let inverse = particles.inverse_inertia.get(i).copied().unwrap_or(0.0);
        radius * radius * inverse
    }

    /// Squared frequency (1/s2) and damping rate (1/s) of an impact of that overlap (m) and speed
    /// (m/s) at its deepest, if it may gain so much speed (m/s). `yielding` is 1 / m_eff and
    /// `turning` what rotation adds to it (1/kg).
    fn rates(
        &self,
        overlap: f64,
        speed: f64,
        gain: f64,
        effective_radius: f64,
        yielding: f64,
        turning: f64,
    ) -> [f64; 2] {
        let (normal, tangential) = (&self.normal, &self.tangential);
        let effective_mass = 1.0 / yielding;
        let overlap =
            normal.deepest_overlap(overlap, speed + gain, effective_radius, effective_mass);
        let grip = Grip {
            overlap,
            effective_radius,
            effective_mass,
            normal_force: normal.elastic_force(overlap, effective_radius),
            speed,
        };
        let along = yielding + turning;
        let squared = (normal.stiffness(overlap, effective_radius) * yielding)
            .max(tangential.stiffness(overlap, effective_radius) * along);
        // Sliding that stops faster than the contact swings is not resolved: it trembles, within
        // what friction can carry.
        let friction = (tangential.damping(&grip) * along).min(squared.sqrt());
        let damping = normal.damping(overlap, effective_radius, effective_mass) * yielding;
        [squared, damping.max(friction)]
    }

    fn move_free_spheres(&mut self, work: &mut Workspace<T::History>) {
        let dt = self.setup.dt;
        let particles = &mut self.particles;
        particles.force.copy_from_slice(&work.force);
        particles.torque.copy_from_slice(&work.torque);
        for i in particles.fixed..particles.len() {
            if work.islands.is_free(i) {
                self.step.moves += 1;
                particles.position[i] += particles.velocity[i] * (0.5 * dt);
                kick(particles, i, dt);
                if let Some(ledger) = &mut self.ledger {
                    ledger.books.clear_sphere(i as u32);
                    ledger.books.note_kick(i, particles, dt);
                }
                particles.position[i] += particles.velocity[i] * (0.5 * dt);
                work.note_way(i, particles);
            }
        }
    }

    /// Moves the spheres of an island by a step, in that many parts.
    fn move_island(
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
        for sub_step in 0..sub_steps {
            // From one middle to the next, at first from the start to the middle.
            let duration = if sub_step == 0 { half } else { time };
            self.loading = Loading::earlier(duration, half);
            for &i in &island.spheres {
                self.foretell(i as usize, half, work);
            }
            if let Some(ledger) = &mut self.ledger {
                let spheres = island.spheres.iter();
                spheres.for_each(|&i| ledger.books.clear_sphere(i));
            }
            self.note_contacts(&island.candidates);
            self.mark_ledger();
            self.forces_of_candidates(&island.candidates, false);
            self.check_overlaps()?;
            for &i in &island.spheres {
                self.complete(i as usize, time, work);
            }
        }
        if Self::HAS_HISTORY {
            self.load_springs(island, half, work);
        }
        Ok(())
    }

    /// Loads the springs of an island over the last `time` (s) of its step.
    fn load_springs(&mut self, island: &Island, time: f64, work: &mut Workspace<T::History>) {
        self.loading = Loading::present(time);
        let spheres = || island.spheres.iter().map(|&i| i as usize);
        let particles = &self.particles;
        work.held.force.clear();
        work.held
            .force
            .extend(spheres().map(|i| particles.force[i]));
        work.held.torque.clear();
        if particles.rotate() {
            let torques = spheres().map(|i| particles.torque[i]);
            work.held.torque.extend(torques);
        }
        self.forces_of_candidates(&island.candidates, false);
        // Forces of spheres that move are those of the last middle still, and the next step finds
        // what is too deep, if it matters.
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
    /// latest forces predict there; its own are held.
    fn foretell(&mut self, i: usize, half: f64, work: &mut Workspace<T::History>) {
        let particles = &mut self.particles;
        particles.position[i] += particles.velocity[i] * half;
        work.held.velocity[i] = particles.velocity[i];
        if particles.rotate() {
            work.held.spin[i] = particles.spin[i];
        }
        if Self::HAS_HISTORY {
            self.earlier[i] = [particles.velocity[i].row(), particles.spin[i].row()];
        }
        kick(particles, i, half);
        particles.force[i] = Vector::ZERO;
        if particles.rotate() {
            particles.torque[i] = Vector::ZERO;
        }
    }

    /// Moves a sphere from the middle to the end of a sub-step.
    fn complete(&mut self, i: usize, time: f64, work: &mut Workspace<T::History>) {
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
}

/// v += a dt and the same for the spin, of one sphere.
fn kick(particles: &mut Particles, i: usize, dt: f64) {
    particles.velocity[i] += particles.force[i] * (particles.inverse_mass[i] * dt);
    if particles.rotate() {
        particles.spin[i] += particles.torque[i] * (particles.inverse_inertia[i] * dt);
    }
}
