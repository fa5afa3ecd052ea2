//! Integration schemes: one function each, from kicks and drifts.

use super::meeting::Loading;
use super::pair_block::EarlierRows;
use super::{Parts, System};
use crate::dem::contact::NormalLaw;
use crate::dem::friction::TangentialLaw;
use crate::dem::neighbours::{Allowance, Reference};
use crate::dem::particles::Particles;
use crate::dem::profile::{self, Part};
use crate::dem::threads::{in_parallel, split, split_shared};
use crate::dem::vector::Vector;
use crate::record::Instability;
use crate::scene::Integrator;
use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x4, mask64x4};

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

/// A kick of some spheres, or of all.
struct Kick<'a> {
    velocity: &'a mut [Vector],
    force: &'a [Vector],
    spin: &'a mut [Vector],
    torque: &'a [Vector],
    inverse_mass: &'a [f64],
    inverse_inertia: &'a [f64],
    /// [`Limits::slow`](crate::dem::guard::Limits::slow).
    slow: f64,
    too_fast: bool,
}

impl<'a> Kick<'a> {
    /// Takes so many spheres from the front, or all that there are.
    fn split(&mut self, count: usize) -> Kick<'a> {
        Kick {
            velocity: split(&mut self.velocity, count),
            force: split_shared(&mut self.force, count),
            spin: split(&mut self.spin, count),
            torque: split_shared(&mut self.torque, count),
            inverse_mass: split_shared(&mut self.inverse_mass, count),
            inverse_inertia: split_shared(&mut self.inverse_inertia, count),
            slow: self.slow,
            too_fast: false,
        }
    }

    fn by(&mut self, level: Level, dt: f64) {
        fearless_simd::dispatch!(level, simd => self.all(simd, dt));
    }

    #[inline(always)]
    fn all<S: Simd>(&mut self, simd: S, dt: f64) {
        let most = f64x4::splat(simd, self.slow);
        let mut slow = mask64x4::splat(simd, true);
        for ((velocity, force), inverse) in (self.velocity.iter_mut())
            .zip(self.force)
            .zip(self.inverse_mass)
        {
            let row = velocity.simd(simd) + force.simd(simd) * (inverse * dt);
            *velocity = Vector::of_row(row.into());
            // What is not a number is not slow.
            slow &= row.abs().simd_le(most);
        }
        for ((spin, torque), inverse) in (self.spin.iter_mut())
            .zip(self.torque)
            .zip(self.inverse_inertia)
        {
            let row = spin.simd(simd) + torque.simd(simd) * (inverse * dt);
            *spin = Vector::of_row(row.into());
        }
        self.too_fast = !slow.all_true();
    }
}

/// A drift of some spheres, or of all.
struct Drift<'a> {
    position: &'a mut [Vector],
    velocity: &'a [Vector],
    /// Where they were when near pairs were looked for, and how far they may be from there; where none are
    /// looked for, nothing.
    reference: &'a [Reference],
    allowance: Option<Allowance>,
    moved: bool,
}

impl<'a> Drift<'a> {
    /// Takes so many spheres from the front, or all that there are.
    fn split(&mut self, count: usize) -> Drift<'a> {
        Drift {
            position: split(&mut self.position, count),
            velocity: split_shared(&mut self.velocity, count),
            reference: split_shared(&mut self.reference, count),
            allowance: self.allowance,
            moved: false,
        }
    }

    fn by(&mut self, level: Level, dt: f64) {
        fearless_simd::dispatch!(level, simd => self.all(simd, dt));
    }

    #[inline(always)]
    fn all<S: Simd>(&mut self, simd: S, dt: f64) {
        for (position, velocity) in self.position.iter_mut().zip(self.velocity) {
            let row = position.simd(simd) + velocity.simd(simd) * dt;
            *position = Vector::of_row(row.into());
        }
        if let Some(allowance) = self.allowance {
            self.moved = !allowance.hold(self.position, self.reference);
        }
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
        let mut rest = Kick {
            velocity,
            force,
            spin,
            torque,
            inverse_mass,
            inverse_inertia,
            slow: self.parts.limits.slow,
            too_fast: false,
        };
        let too_fast = match &self.division {
            None => {
                rest.by(level, dt);
                rest.too_fast
            }
            Some(division) => {
                let length = rest.velocity.len().div_ceil(division.threads());
                let mut shares: Vec<_> = (0..division.threads())
                    .map(|_| rest.split(length))
                    .collect();
                in_parallel(&mut shares, &|share| share.by(level, dt));
                shares.iter().any(|share| share.too_fast)
            }
        };
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
        let mut rest = Drift {
            position,
            velocity,
            reference: if is_listed {
                self.near.anchor().position()
            } else {
                &[]
            },
            allowance: is_listed.then(|| self.near.allowance(self.near_age.time)),
            moved: false,
        };
        let moved = match &self.division {
            None => {
                rest.by(level, dt);
                rest.moved
            }
            Some(division) => {
                let length = rest.position.len().div_ceil(division.threads());
                let mut shares: Vec<_> = (0..division.threads())
                    .map(|_| rest.split(length))
                    .collect();
                in_parallel(&mut shares, &|share| share.by(level, dt));
                shares.iter().any(|share| share.moved)
            }
        };
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
