//! Integration schemes: one function each, from kicks and drifts.

use super::contact_block::EarlierRows;
use super::contact_laws::Loading;
use super::division::threads;
use super::moves::{FirstTooFast, Motion, Moves};
use super::{System, SystemSetup};
use crate::dem::bodies::SphereRows;
use crate::dem::profile::{self, StepPart};
use crate::forces::contact::NormalLaw;
use crate::forces::friction::TangentialLaw;
use crate::particles::Particles;
use crate::particles::bodies::Bodies;
use crate::particles::vector::Vector;
use crate::scene::Integrator;
use crate::simulation::Instability;
use std::ops::Range;

/// What follows a step.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Next {
    /// Another step, at once.
    Step,
    /// A pause, in which the spheres may be read.
    Pause,
}

/// Velocities and spins before a prediction.
#[derive(Default)]
pub(super) struct MotionBefore {
    velocity: Vec<Vector>,
    spin: Vec<Vector>,
}

impl MotionBefore {
    fn keep(&mut self, particles: &Particles) {
        self.velocity.clone_from(&particles.velocity);
        self.spin.clone_from(&particles.spin);
    }

    /// Writes them in rows, for spheres that rotate.
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
    /// Applies `effects`, then moves all spheres. Notes whether a sphere went farther than the near
    /// pairs allow. Returns the first sphere beyond its speed limit. Not inlined: all schemes call
    /// it several times, and each is compiled for all laws.
    #[inline(never)]
    pub(super) fn move_all(&mut self, effects: Range<usize>, motion: Motion<'_>) -> FirstTooFast {
        let Motion {
            kicks,
            drift,
            clear,
        } = motion;
        let neighbours = &mut self.neighbours;
        neighbours.let_pass(drift.unwrap_or(0.0));
        let moves = Moves {
            effects: &self.setup.effects[effects],
            kicks,
            drift: drift.map(|dt| neighbours.drift(dt)),
            clear,
            limits: &self.setup.limits,
            dt: self.setup.dt,
        };
        let reference = match neighbours.list.is_some() && drift.is_some() {
            true => neighbours.near.anchor().position(),
            false => &[],
        };
        self.bodies
            .resize_with(threads(self.division.as_ref()), Bodies::new);
        let found = moves.apply(
            SphereRows::new(&mut self.particles, reference),
            &mut self.bodies,
            self.level,
            &mut self.profile,
        );
        // The near pairs may be stale already, if a sphere came or went.
        neighbours.stale |= found.far;
        found.too_fast
    }

    /// v += a dt for a time (s), and the same for spins. Returns the first sphere beyond its speed
    /// limit.
    pub(super) fn kick(&mut self, dt: f64) -> FirstTooFast {
        let motion = Motion {
            kicks: &[dt],
            ..Motion::NONE
        };
        self.move_all(0..0, motion)
    }

    /// x += v dt for a time (s).
    fn drift(&mut self, dt: f64) {
        let motion = Motion {
            drift: Some(dt),
            ..Motion::NONE
        };
        self.move_all(0..0, motion);
    }

    /// Reports a sphere beyond its speed limit in this step, or in the next one if that has begun.
    pub(super) fn check_speeds(&mut self, too_fast: FirstTooFast) -> Result<(), Instability> {
        let mut steps = (self.step.number..).zip(too_fast);
        let Some((step, it)) = steps.find_map(|(step, it)| Some((step, it?))) else {
            return Ok(());
        };
        // The guard was broken in the middle of a step.
        (self.step.number, self.step.first_half_done) = (step, false);
        let SystemSetup { limits, dt, .. } = &self.setup;
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
            let next = if left > 0 { Next::Step } else { Next::Pause };
            match self.setup.integrator {
                Integrator::SymplecticEuler => self.symplectic_euler(next)?,
                Integrator::VelocityVerlet => self.velocity_verlet(next)?,
                Integrator::SynchronisedVerlet => self.synchronised_verlet()?,
                Integrator::AdaptiveVerlet => self.adaptive_verlet()?,
            }
            self.mark(StepPart::Rest);
        }
        Ok(())
    }

    /// Counts a step.
    pub(super) fn begin_step(&mut self) {
        self.step.number += 1;
        self.neighbours.age.steps += 1;
        self.neighbours.near_age.steps += 1;
        self.drive(0.0, 1.0);
    }

    /// Evaluates the forces at the start, before which there are no latest ones. No time passes, so
    /// that contacts do not load their springs.
    fn evaluate_start(&mut self) -> Result<(), Instability> {
        let loading = std::mem::replace(&mut self.loading, Loading::present(0.0));
        let result = self.evaluate(0.0);
        self.loading = loading;
        result
    }

    /// One step of symplectic Euler: v += a(x, v) dt, then x += v dt.
    fn symplectic_euler(&mut self, next: Next) -> Result<(), Instability> {
        self.begin_step();
        let dt = self.setup.dt;
        let too_fast = if self.ledger.is_some() {
            // The energy balance reads the spheres between kick and drift.
            self.evaluate(0.0)?;
            let too_fast = self.kick(dt);
            self.note_kick(dt);
            self.drift(dt);
            too_fast
        } else {
            let motion = Motion {
                kicks: &[dt],
                drift: Some(dt),
                // Others read the forces of the last step.
                clear: next == Next::Step && self.neighbours.list.is_some(),
            };
            self.evaluate_and_move(0.0, motion)?
        };
        self.check_speeds(too_fast)
    }

    /// One step of velocity Verlet, with forces from the new positions and the half-step
    /// velocities. Its first half uses the forces of the step before. If another step follows at
    /// once, its first half is joined with the second half of this one.
    fn velocity_verlet(&mut self, next: Next) -> Result<(), Instability> {
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
            self.evaluate(1.0)?;
            let too_fast = self.kick(half);
            self.note_kick(half);
            return self.check_speeds(too_fast);
        }
        // The order of spheres follows from where they are after whole steps.
        let begins_next = next == Next::Step && !self.checks_order() && self.driven.is_empty();
        let motion = match begins_next {
            true => Motion {
                kicks: &[half, half],
                drift: Some(dt),
                clear: self.neighbours.list.is_some(),
            },
            false => Motion {
                kicks: &[half],
                ..Motion::NONE
            },
        };
        let too_fast = self.evaluate_and_move(1.0, motion)?;
        self.step.first_half_done = begins_next;
        self.check_speeds(too_fast)
    }

    /// One step of velocity Verlet with forces from the middle of the step: half a drift, a kick,
    /// half a drift (position Verlet: Tuckerman, Berne and Martyna, J. Chem. Phys. 97, 1990
    /// (1992)). The latest forces predict the velocities there, to first order, which makes the
    /// step one of second order.
    ///
    /// Places and velocities of a contact then belong together, which Vyas et al., Comput. Phys.
    /// Commun. 310, 109524 (2025), achieve in another way. If normals and velocities belong to
    /// different moments, the approach of a small sphere that rolls along a large one is taken for
    /// sliding and loads its spring until it sticks.
    fn synchronised_verlet(&mut self) -> Result<(), Instability> {
        self.begin_step();
        if self.step.number == 1 {
            self.evaluate_start()?;
        }
        let (dt, half) = (self.setup.dt, 0.5 * self.setup.dt);
        // Springs are loaded from one middle to the next by the velocity between them.
        let duration = if self.step.number == 1 { half } else { dt };
        self.loading = Loading::earlier(duration, half);
        self.drift(half);
        self.drive(-0.5, 0.5);
        self.before.keep(&self.particles);
        if self.loads_springs() {
            self.before.to_rows(&mut self.earlier);
        }
        self.drive(0.0, 1.0);
        self.kick(half);
        self.evaluate(0.5)?;
        self.before.put_back(&mut self.particles);
        self.drive(0.0, 1.0);
        let too_fast = self.kick(dt);
        self.note_kick(dt);
        self.check_speeds(too_fast)?;
        self.drift(half);
        Ok(())
    }
}
