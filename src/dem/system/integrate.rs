//! Integration schemes: one function each, from kicks and drifts.

use super::contact_block::EarlierRows;
use super::contact_laws::Loading;
use super::division::threads;
use super::moves::{Drift, FirstTooFast, Moves};
use super::{Setup, System};
use crate::dem::bodies::Spheres;
use crate::dem::profile::{self, Part};
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::Particles;
use crate::particles::bodies::Bodies;
use crate::particles::vector::Vector;
use crate::scene::Integrator;
use crate::simulation::Instability;
use std::ops::Range;

/// Velocities and spins before a prediction.
#[derive(Default)]
pub(super) struct Before {
    velocity: Vec<Vector>,
    spin: Vec<Vector>,
}

impl Before {
    fn keep(&mut self, particles: &Particles) {
        self.velocity.clone_from(&particles.velocity);
        self.spin.clone_from(&particles.spin);
    }

    /// Writes them in rows, of spheres that turn.
    fn to_rows(&self, rows: &mut Vec<EarlierRows>) {
        rows.clear();
        let spheres = self.velocity.iter().zip(&self.spin);
        rows.extend(spheres.map(|(velocity, spin)| [velocity.row(), spin.row()]));
    }

    fn put_back(&self, particles: &mut Particles) {
        particles.velocity.copy_from_slice(&self.velocity);
        particles.spin.copy_from_slice(&self.spin);
    }
}

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// Applies `effects`, kicks for these times (s), drifts for a time (s), and clears the forces,
    /// as far as each is asked for. Notes whether a sphere went farther than the near pairs allow.
    /// Returns the first sphere beyond its speed limit. Not inlined: all schemes call it several
    /// times, and each is compiled for all laws.
    #[inline(never)]
    pub(super) fn move_all(
        &mut self,
        effects: Range<usize>,
        kicks: &[f64],
        drift: Option<f64>,
        clear: bool,
    ) -> FirstTooFast {
        let elapsed = drift.unwrap_or(0.0);
        self.neighbours.age.time += elapsed;
        self.neighbours.near_age.time += elapsed;
        let is_listed = self.neighbours.list.is_some() && drift.is_some();
        let Setup {
            effects: all,
            limits,
            dt,
            ..
        } = &self.setup;
        let moves = Moves {
            effects: &all[effects],
            kicks,
            drift: drift.map(|dt| Drift {
                dt,
                allowance: is_listed.then(|| {
                    self.neighbours
                        .near
                        .allowance(self.neighbours.near_age.time)
                }),
            }),
            clear,
            limits,
            dt: *dt,
        };
        let reference = match is_listed {
            true => self.neighbours.near.anchor().position(),
            false => &[],
        };
        self.bodies
            .resize_with(threads(self.division.as_ref()), Bodies::new);
        let found = moves.of_all(
            Spheres::new(&mut self.particles, reference),
            &mut self.bodies,
            self.level,
            &mut self.profile,
        );
        // It may be so already: a sphere came or went.
        self.neighbours.stale |= found.far;
        found.too_fast
    }

    /// v += a dt for a time (s), and the same for spins. Returns the first sphere beyond its speed limit.
    pub(super) fn kick(&mut self, dt: f64) -> FirstTooFast {
        self.move_all(0..0, &[dt], None, false)
    }

    /// x += v dt for a time (s).
    fn drift(&mut self, dt: f64) {
        self.move_all(0..0, &[], Some(dt), false);
    }

    /// Reports a sphere beyond its speed limit in this step, or else in the next one if it has begun.
    pub(super) fn check_speeds(&mut self, too_fast: FirstTooFast) -> Result<(), Instability> {
        let mut steps = (self.step.number..).zip(too_fast);
        let Some((step, it)) = steps.find_map(|(step, it)| Some((step, it?))) else {
            return Ok(());
        };
        // The state belongs to no whole step: the guard was broken part-way.
        (self.step.number, self.step.first_half_done) = (step, false);
        let Setup { limits, dt, .. } = &self.setup;
        Err(limits.speed_broken(step, *dt, it))
    }

    pub(super) fn steps(&mut self, steps: u64) -> Result<(), Instability> {
        let spheres = (self.particles.len() - self.particles.fixed) as u64;
        if self.setup.integrator != Integrator::AdaptiveVerlet {
            self.step.moves += steps * spheres;
        }
        for left in (0..steps).rev() {
            self.keep_in_order()?;
            profile::begin(&mut self.profile, self.step.number, spheres as usize);
            match self.setup.integrator {
                Integrator::SymplecticEuler => self.symplectic_euler(left > 0)?,
                Integrator::VelocityVerlet => self.velocity_verlet(left > 0)?,
                Integrator::SynchronisedVerlet => self.synchronised_verlet()?,
                Integrator::AdaptiveVerlet => self.adaptive_verlet()?,
            }
            self.mark(Part::Rest);
        }
        Ok(())
    }

    /// Counts a step.
    pub(super) fn begin_step(&mut self) {
        self.step.number += 1;
        self.neighbours.age.steps += 1;
        self.neighbours.near_age.steps += 1;
    }

    /// Forces at the start, where no scheme has a latest one. No time goes by, so that contacts do
    /// not load their springs.
    fn evaluate_start(&mut self) -> Result<(), Instability> {
        let loading = std::mem::replace(&mut self.loading, Loading::present(0.0));
        let result = self.evaluate();
        self.loading = loading;
        result
    }

    /// One step of symplectic Euler: v += a(x, v) dt, then x += v dt. `goes_on` says whether
    /// another follows at once.
    fn symplectic_euler(&mut self, goes_on: bool) -> Result<(), Instability> {
        self.begin_step();
        let dt = self.setup.dt;
        let too_fast = if self.ledger.is_some() {
            // The energy balance looks at the spheres in between.
            self.evaluate()?;
            let too_fast = self.kick(dt);
            self.note_kick(dt);
            self.drift(dt);
            too_fast
        } else {
            // After the last step forces stay, to be read.
            let clear = goes_on && self.neighbours.list.is_some();
            self.evaluate_and_move(&[dt], Some(dt), clear)?
        };
        self.check_speeds(too_fast)
    }

    /// One step of velocity Verlet, with forces from the new positions and the half-step
    /// velocities. The forces of the step before serve its first half. `goes_on` says whether
    /// another follows at once: its first half then comes with the second one of this.
    fn velocity_verlet(&mut self, goes_on: bool) -> Result<(), Instability> {
        self.begin_step();
        if self.step.number == 1 {
            self.evaluate_start()?;
        }
        let (dt, half) = (self.setup.dt, 0.5 * self.setup.dt);
        if !std::mem::take(&mut self.step.first_half_done) {
            let too_fast = self.kick(half);
            self.note_kick(half);
            self.check_speeds(too_fast)?;
            self.drift(dt);
        }
        if self.ledger.is_some() {
            self.evaluate()?;
            let too_fast = self.kick(half);
            self.note_kick(half);
            return self.check_speeds(too_fast);
        }
        // The order of spheres follows from where they are after whole steps.
        let begins_next = goes_on && !self.looks_at_order();
        let too_fast = match begins_next {
            true => {
                self.evaluate_and_move(&[half, half], Some(dt), self.neighbours.list.is_some())?
            }
            false => self.evaluate_and_move(&[half], None, false)?,
        };
        self.step.first_half_done = begins_next;
        self.check_speeds(too_fast)
    }

    /// One step of velocity Verlet with forces from the middle of the step: half a drift, a kick,
    /// half a drift (position Verlet: Tuckerman, Berne and Martyna, J. Chem. Phys. 97, 1990
    /// (1992)). The latest forces predict the velocities there, to first order, which makes the
    /// step one of second order.
    ///
    /// Places and velocities of a contact then belong together, which Vyas et al., Comput. Phys.
    /// Commun. 310, 109524 (2025), reach by other means: with normals of one moment and velocities
    /// of another, the approach of a small sphere to a large one that it rolls along is taken for
    /// sliding, and loads its spring until it sticks.
    fn synchronised_verlet(&mut self) -> Result<(), Instability> {
        self.begin_step();
        if self.step.number == 1 {
            self.evaluate_start()?;
        }
        let (dt, half) = (self.setup.dt, 0.5 * self.setup.dt);
        // From one middle to the next springs are loaded by the velocity between them.
        let duration = if self.step.number == 1 { half } else { dt };
        self.loading = Loading::earlier(duration, half);
        self.drift(half);
        self.before.keep(&self.particles);
        if Self::HAS_HISTORY {
            self.before.to_rows(&mut self.earlier);
        }
        self.kick(half);
        self.evaluate()?;
        self.before.put_back(&mut self.particles);
        let too_fast = self.kick(dt);
        self.note_kick(dt);
        self.check_speeds(too_fast)?;
        self.drift(half);
        Ok(())
    }
}
