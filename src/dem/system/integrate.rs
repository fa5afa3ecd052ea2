//! Integration schemes: one function each, from kicks and drifts.

use super::{Parts, System};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
use crate::dem::particles::Particles;
use crate::record::Instability;
use crate::scene::Integrator;

impl<N: NormalLaw, T: TangentialLaw> System<N, T> {
    /// v += a dt for a time `dt`, and the same for spins. True if a sphere is too fast.
    fn kick(&mut self, dt: f64) -> bool {
        let level = self.level;
        fearless_simd::dispatch!(level, simd => {
            let _ = simd;
            self.kick_all(dt)
        })
    }

    #[inline(always)]
    fn kick_all(&mut self, dt: f64) -> bool {
        let Particles {
            velocity,
            force,
            spin,
            torque,
            inverse_mass,
            inverse_inertia,
            ..
        } = &mut self.parts.particles;
        let mut too_fast = false;
        let limits = &self.parts.limits.speed_squared;
        for (((velocity, &force), inverse), &limit) in velocity
            .iter_mut()
            .zip(force.iter())
            .zip(inverse_mass.iter())
            .zip(limits)
        {
            *velocity += force * (inverse * dt);
            // Written so that a speed which is not a number counts.
            too_fast |= !(velocity.norm_squared() <= limit);
        }
        for ((spin, &torque), inverse) in spin
            .iter_mut()
            .zip(torque.iter())
            .zip(inverse_inertia.iter())
        {
            *spin += torque * (inverse * dt);
        }
        too_fast
    }

    /// x += v dt. Notes whether a sphere went farther than the near pairs allow.
    fn drift(&mut self) {
        let level = self.level;
        fearless_simd::dispatch!(level, simd => {
            let _ = simd;
            self.drift_all();
        });
    }

    #[inline(always)]
    fn drift_all(&mut self) {
        let dt = self.parts.dt;
        let Particles {
            position, velocity, ..
        } = &mut self.parts.particles;
        self.age += 1;
        self.near_age += 1;
        if self.list.is_none() {
            for (position, &velocity) in position.iter_mut().zip(velocity.iter()) {
                *position += velocity * dt;
            }
            return;
        }
        let allowance = self.near.allowance(self.near_age as f64 * dt);
        let mut moved = false;
        for ((position, &velocity), &reference) in position
            .iter_mut()
            .zip(velocity.iter())
            .zip(self.near.anchor().position())
        {
            *position += velocity * dt;
            moved |= !allowance.holds(*position, reference);
        }
        // It may be so already: a sphere came or went.
        self.stale |= moved;
    }

    fn check_speeds(&self, too_fast: bool) -> Result<(), Instability> {
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
        for _ in 0..steps {
            match self.parts.integrator {
                Integrator::SymplecticEuler => self.symplectic_euler()?,
                Integrator::VelocityVerlet => self.velocity_verlet()?,
            }
        }
        Ok(())
    }

    /// One step of symplectic Euler: v += a(x, v) dt, then x += v dt.
    fn symplectic_euler(&mut self) -> Result<(), Instability> {
        self.step += 1;
        self.evaluate()?;
        let too_fast = self.kick(self.parts.dt);
        self.check_speeds(too_fast)?;
        self.drift();
        Ok(())
    }

    /// One step of velocity Verlet, with forces from the new positions and the half-step
    /// velocities. The forces of the step before serve its first half.
    fn velocity_verlet(&mut self) -> Result<(), Instability> {
        self.step += 1;
        if self.step == 1 {
            self.evaluate()?;
        }
        let half = 0.5 * self.parts.dt;
        let too_fast = self.kick(half);
        self.check_speeds(too_fast)?;
        self.drift();
        self.evaluate()?;
        let too_fast = self.kick(half);
        self.check_speeds(too_fast)
    }
}
