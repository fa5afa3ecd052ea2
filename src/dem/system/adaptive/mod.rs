//! Velocity Verlet with sub-steps where spheres touch.

mod grouping;
mod islands;
mod sub_steps;
mod workspace;

pub(super) use self::islands::IslandContacts;
pub(super) use self::workspace::Workspace;

use self::workspace::StepStart;
use super::moves::without_least;
use super::{Engine, System, SystemSetup};
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::Particles;
use crate::simulation::Instability;

/// How often a step is tried, each time with larger groups. A step that needs more attempts will
/// break a guard.
const ATTEMPTS: u32 = 20;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// One step of synchronised Verlet, cut into as many sub-steps as the contacts need, for each
    /// group of touching spheres by itself. All other spheres move in one step. All forces but
    /// contact forces are evaluated in the middle of the whole step.
    ///
    /// A sphere belongs to a group if it touches another one, or may do so within the step
    /// according to its predicted displacement. If contacts move a sphere farther, the step is
    /// repeated with twice that distance. So no contact is missed.
    pub(super) fn adaptive_verlet(&mut self) -> Result<(), Instability> {
        // Taken out, because the methods of a step borrow the whole system.
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
        if self.loads_springs() {
            // The motion of fixed spheres stays zero.
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
            // The lists may be built again, and histories with them.
            self.hold_for(reach)?;
            self.keep_histories(&mut work.start);
        }
        self.neighbours.let_pass(dt);
        self.check_all_speeds()
    }

    fn check_all_speeds(&mut self) -> Result<(), Instability> {
        let SystemSetup { limits, dt, .. } = &self.setup;
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
            let sub_steps = work.sub_steps(island, self.setup.dt, self.setup.resolution);
            self.move_island(island, sub_steps, work)
        });
        work.islands = islands;
        outcome
    }

    /// Evaluates the forces and torques of the effects at the predicted middle of the step, and how
    /// far the spheres may move in the step. Leaves the spheres where they were.
    fn slow_forces(&mut self, work: &mut Workspace<T::History>) -> Result<(), Instability> {
        let dt = self.setup.dt;
        if self.neighbours.stale {
            self.refresh()?;
        }
        self.clear_contacts_in_books();
        self.evaluate_effects(0.0);
        let reach = work.find_reach(&self.particles, dt);
        self.hold_for(reach)?;
        let Particles {
            position, velocity, ..
        } = &mut self.particles;
        for (position, &velocity) in position.iter_mut().zip(velocity.iter()) {
            *position += velocity * (0.5 * dt);
        }
        self.kick(0.5 * dt);
        self.evaluate_effects(0.5);
        work.force.clone_from(&self.particles.force);
        work.torque.clone_from(&self.particles.torque);
        work.start.put_back(&mut self.particles);
        Ok(())
    }

    /// Makes the near pairs hold while no sphere moves farther than `reach` (m).
    fn hold_for(&mut self, reach: f64) -> Result<(), Instability> {
        let Some(list) = &mut self.neighbours.list else {
            return Ok(());
        };
        // Twice what is needed, so that they hold for more than one step.
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

    fn keep_histories(&self, start: &mut StepStart<T::History>) {
        if Self::HAS_HISTORY {
            start.pair_history.clone_from(&self.pair_history);
            start.wall_history.resize_with(self.walls.len(), Vec::new);
            for (kept, wall) in start.wall_history.iter_mut().zip(&self.walls) {
                kept.clone_from(&wall.histories);
            }
        }
        if let Some(rolling) = &self.rolling {
            start.rolling.clone_from(&rolling.springs);
        }
    }

    fn put_back_histories(&mut self, start: &StepStart<T::History>) {
        if Self::HAS_HISTORY {
            self.pair_history.copy_from_slice(&start.pair_history);
            for (wall, kept) in self.walls.iter_mut().zip(&start.wall_history) {
                wall.histories.copy_from_slice(kept);
            }
        }
        if let Some(rolling) = &mut self.rolling {
            rolling.springs.clone_from(&start.rolling);
        }
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
}

/// v += a dt and the same for the spin, of one sphere.
fn kick(particles: &mut Particles, i: usize, dt: f64) {
    particles.velocity[i] += particles.force[i] * (particles.inverse_mass[i] * dt);
    if particles.rotate() {
        let change = particles.torque[i] * (particles.inverse_inertia[i] * dt);
        particles.spin[i] = without_least(particles.spin[i] + change);
    }
}
