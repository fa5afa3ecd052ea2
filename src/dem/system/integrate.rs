//! Integration schemes: one function each, from kicks and drifts.

use super::division::threads;
use super::meeting::Loading;
use super::moves::{self, Drift, Kick};
use super::pair_block::EarlierRows;
use super::{Parts, System};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
use crate::dem::particles::Particles;
use crate::dem::profile::{self, Part};
use crate::dem::vector::Vector;
use crate::record::Instability;
use crate::scene::Integrator;

/// Velocities and spins before forces foretell them.
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
    /// v += a dt for a time `dt`, and the same for spins. True if a sphere may be too fast.
    pub(super) fn kick(&mut self, dt: f64) -> bool {
        let level = self.level;
        let Particles {
            velocity,
            force,
            spin,
            torque,
            inverse_mass,
            inverse_inertia,
            ..
        } = &mut self.parts.particles;
        let kick = Kick {
            velocity,
            force,
            spin,
            torque,
            inverse_mass,
            inverse_inertia,
            slow: self.parts.limits.slow,
        };
        let threads = threads(&self.division);
        let too_fast = moves::by(kick, threads, level, dt);
        self.mark(Part::Kick);
        too_fast
    }

    /// x += v dt for a time `dt`. Notes whether a sphere went farther than the near pairs allow.
    fn drift(&mut self, dt: f64) {
        let level = self.level;
        self.age.time += dt;
        self.near_age.time += dt;
        let Particles {
            position, velocity, ..
        } = &mut self.parts.particles;
        let is_listed = self.list.is_some();
        let drift = Drift {
            position,
            velocity,
            reference: if is_listed {
                self.near.anchor().position()
            } else {
                &[]
            },
            allowance: is_listed.then(|| self.near.allowance(self.near_age.time)),
        };
        let threads = threads(&self.division);
        let moved = moves::by(drift, threads, level, dt);
        // It may be so already: a sphere came or went.
        self.stale |= moved;
        self.mark(Part::Drift);
    }

    pub(super) fn check_speeds(&self, too_fast: bool) -> Result<(), Instability> {
        if too_fast {
            let Parts {
                particles,
                limits,
                dt,
                ..
            } = &self.parts;
            limits.check_speeds(particles, self.step, *dt)?;
        }
        Ok(())
    }

    pub(super) fn steps(&mut self, steps: u64) -> Result<(), Instability> {
        let spheres = (self.parts.particles.len() - self.parts.particles.fixed) as u64;
        if self.parts.integrator != Integrator::AdaptiveVerlet {
            self.moves += steps * spheres;
        }
        for _ in 0..steps {
            self.keep_in_order()?;
            profile::begin(&mut self.profile, self.step, spheres as usize);
            match self.parts.integrator {
                Integrator::SymplecticEuler => self.symplectic_euler()?,
                Integrator::VelocityVerlet => self.velocity_verlet()?,
                Integrator::SynchronisedVerlet => self.synchronised_verlet()?,
                Integrator::AdaptiveVerlet => self.adaptive_verlet()?,
            }
            self.mark(Part::Rest);
        }
        Ok(())
    }

    /// Counts a step.
    pub(super) fn begin_step(&mut self) {
        self.step += 1;
        self.age.steps += 1;
        self.near_age.steps += 1;
    }

    /// Forces at the start, where no scheme has a latest one. No time goes by, so that contacts do not
    /// load their springs.
    fn evaluate_start(&mut self) -> Result<(), Instability> {
        let loading = std::mem::replace(&mut self.loading, Loading::present(0.0));
        let result = self.evaluate();
        self.loading = loading;
        result
    }

    /// One step of symplectic Euler: v += a(x, v) dt, then x += v dt.
    fn symplectic_euler(&mut self) -> Result<(), Instability> {
        self.begin_step();
        self.evaluate()?;
        let too_fast = self.kick(self.parts.dt);
        self.note_kick(self.parts.dt);
        self.check_speeds(too_fast)?;
        self.drift(self.parts.dt);
        Ok(())
    }

    /// One step of velocity Verlet, with forces from the new positions and the half-step
    /// velocities. The forces of the step before serve its first half.
    fn velocity_verlet(&mut self) -> Result<(), Instability> {
        self.begin_step();
        if self.step == 1 {
            self.evaluate_start()?;
        }
        let half = 0.5 * self.parts.dt;
        let too_fast = self.kick(half);
        self.note_kick(half);
        self.check_speeds(too_fast)?;
        self.drift(self.parts.dt);
        self.evaluate()?;
        let too_fast = self.kick(half);
        self.note_kick(half);
        self.check_speeds(too_fast)
    }

    /// One step of velocity Verlet with forces from the middle of the step: half a drift, a kick, half a
    /// drift (position Verlet: Tuckerman, Berne and Martyna, J. Chem. Phys. 97, 1990 (1992)). The latest
    /// forces foretell the velocities there, to first order, which makes the step one of second order.
    ///
    /// Places and velocities of a contact then belong together, which Vyas et al., Comput. Phys. Commun.
    /// 310, 109524 (2025), reach by other means: with normals of one moment and velocities of another,
    /// the approach of a small sphere to a large one that it rolls along is taken for sliding, and loads
    /// its spring until it sticks.
    fn synchronised_verlet(&mut self) -> Result<(), Instability> {
        self.begin_step();
        if self.step == 1 {
            self.evaluate_start()?;
        }
        let (dt, half) = (self.parts.dt, 0.5 * self.parts.dt);
        // From one middle to the next springs are loaded by the velocity between them.
        let duration = if self.step == 1 { half } else { dt };
        self.loading = Loading::earlier(duration, half);
        self.drift(half);
        self.before.keep(&self.parts.particles);
        if Self::REMEMBERS {
            self.before.to_rows(&mut self.earlier);
        }
        self.kick(half);
        self.evaluate()?;
        self.before.put_back(&mut self.parts.particles);
        let too_fast = self.kick(dt);
        self.note_kick(dt);
        self.check_speeds(too_fast)?;
        self.drift(half);
        Ok(())
    }
}
