//! Effects, kicks and drifts: loops over all spheres, or over each thread's.

use crate::dem::block::BLOCK;
use crate::dem::bodies::{Asked, Bodies, Spheres};
use crate::dem::effects::Effect;
use crate::dem::neighbours::Allowance;
use crate::dem::profile::{self, Part, Profile};
use crate::dem::threads::in_parallel;
use crate::dem::vector::Vector;
use fearless_simd::{Level, Simd, SimdBase, SimdFrom, SimdMask, f64x4, mask64x4};

/// Spheres to which everything is done before the next ones: few enough to stay in the nearest cache.
const AT_HAND: usize = 4 * BLOCK;

/// What is done to each sphere, in this order.
pub(super) struct Moves<'a> {
    /// Add to its force and torque.
    pub(super) effects: &'a [Box<dyn Effect>],
    pub(super) kick: Option<Kick>,
    pub(super) drift: Option<Drift>,
    /// Forgets forces and torques, which are at hand: others come next.
    pub(super) clear: bool,
}

/// v += a dt, and the same for spins.
#[derive(Clone, Copy)]
pub(super) struct Kick {
    /// How long it is (s).
    pub(super) dt: f64,
    /// [`Limits::slow`](crate::dem::guard::Limits::slow).
    pub(super) slow: f64,
}

/// x += v dt.
#[derive(Clone, Copy)]
pub(super) struct Drift {
    /// How long it is (s).
    pub(super) dt: f64,
    /// How far spheres may be from their references, where these are looked at.
    pub(super) allowance: Option<Allowance>,
}

/// What moves found.
#[derive(Clone, Copy, Default)]
pub(super) struct Found {
    /// A kicked sphere may be too fast.
    pub(super) fast: bool,
    /// A sphere drifted farther than the near pairs allow.
    pub(super) far: bool,
}

impl Moves<'_> {
    /// Does all that to the spheres, with what each thread has for blocks of them. One thread for all may keep a
    /// profile.
    pub(super) fn of_all(
        &self,
        mut spheres: Spheres<'_>,
        bodies: &mut [Bodies],
        level: Level,
        profile: &mut Option<Box<Profile>>,
    ) -> Found {
        let asked = self.effects.iter().map(|effect| effect.asks());
        let asked = asked.fold(Asked::default(), Asked::or);
        // Without rotation there are neither spins nor torques.
        let asked = Asked {
            turn: asked.turn && !spheres.spin.is_empty(),
            ..asked
        };
        if let [bodies] = bodies {
            return self.of_share(&mut spheres, bodies, asked, level, profile);
        }
        let length = spheres.len().div_ceil(bodies.len());
        let length = length.next_multiple_of(BLOCK);
        let share = |bodies| (spheres.split(length), bodies, Found::default());
        let mut shares: Vec<_> = bodies.iter_mut().map(share).collect();
        in_parallel(&mut shares, &|(spheres, bodies, found)| {
            *found = self.of_share(spheres, bodies, asked, level, &mut None);
        });
        shares
            .iter()
            .fold(Found::default(), |all, (_, _, it)| Found {
                fast: all.fast || it.fast,
                far: all.far || it.far,
            })
    }

    fn of_share(
        &self,
        spheres: &mut Spheres<'_>,
        bodies: &mut Bodies,
        asked: Asked,
        level: Level,
        profile: &mut Option<Box<Profile>>,
    ) -> Found {
        let mut found = Found::default();
        while spheres.len() > 0 {
            let mut some = spheres.split(AT_HAND);
            if !self.effects.is_empty() {
                fearless_simd::dispatch!(level, simd => self.act(simd, &mut some, bodies, asked, level, profile));
            }
            if let Some(kick) = self.kick {
                found.fast |= fearless_simd::dispatch!(level, simd => kick.all(simd, &mut some));
                profile::mark(profile, Part::Kick);
            }
            if let Some(drift) = self.drift {
                found.far |= fearless_simd::dispatch!(level, simd => drift.all(simd, &mut some));
                profile::mark(profile, Part::Drift);
            }
            if self.clear {
                some.force.fill(Vector::ZERO);
                some.torque.fill(Vector::ZERO);
                profile::mark(profile, Part::Rest);
            }
        }
        found
    }

    /// Adds the forces and torques of the effects, block by block.
    #[inline(always)]
    fn act<S: Simd>(
        &self,
        simd: S,
        spheres: &mut Spheres<'_>,
        bodies: &mut Bodies,
        asked: Asked,
        level: Level,
        profile: &mut Option<Box<Profile>>,
    ) {
        for from in (0..spheres.len()).step_by(BLOCK) {
            bodies.take(simd, spheres, from, asked);
            profile::mark(profile, Part::Rest);
            for effect in self.effects {
                effect.apply(level, bodies);
                profile::mark(profile, effect.part());
            }
            bodies.give(simd, spheres, from, asked);
        }
        profile::mark(profile, Part::Rest);
    }
}

impl Kick {
    /// Whether one of them may be too fast.
    #[inline(always)]
    fn all<S: Simd>(&self, simd: S, spheres: &mut Spheres<'_>) -> bool {
        // The last number of a row means nothing.
        let most = [self.slow, self.slow, self.slow, f64::INFINITY];
        let most = f64x4::simd_from(simd, most);
        let mut slow = mask64x4::splat(simd, true);
        for ((velocity, force), inverse) in (spheres.velocity.iter_mut())
            .zip(&*spheres.force)
            .zip(spheres.inverse_mass)
        {
            let row = velocity.simd(simd) + force.simd(simd) * (inverse * self.dt);
            *velocity = Vector::of_row(row.into());
            // What is not a number is not slow.
            slow &= row.abs().simd_le(most);
        }
        for ((spin, torque), inverse) in (spheres.spin.iter_mut())
            .zip(&*spheres.torque)
            .zip(spheres.inverse_inertia)
        {
            let row = spin.simd(simd) + torque.simd(simd) * (inverse * self.dt);
            *spin = Vector::of_row(row.into());
        }
        !slow.all_true()
    }
}

impl Drift {
    /// Whether one of them went too far.
    #[inline(always)]
    fn all<S: Simd>(&self, simd: S, spheres: &mut Spheres<'_>) -> bool {
        for (position, velocity) in spheres.position.iter_mut().zip(&*spheres.velocity) {
            let row = position.simd(simd) + velocity.simd(simd) * self.dt;
            *position = Vector::of_row(row.into());
        }
        let allowance = self.allowance;
        allowance.is_some_and(|it| !it.hold(spheres.position, spheres.reference))
    }
}
