//! Effects, kicks and drifts: loops over all spheres, or over each thread's.

use crate::dem::bodies::SphereRows;
use crate::dem::guard::{Limits, TooFast};
use crate::dem::neighbours::Allowance;
use crate::dem::profile::{self, Profile, StepPart};
use crate::dem::threads::in_parallel;
use crate::forces::effects::PlacedEffect;
use crate::particles::block::BLOCK;
use crate::particles::bodies::{Asked, Bodies};
use crate::particles::vector::Vector;
use fearless_simd::{Level, Select, Simd, SimdBase, SimdFrom, SimdMask, f64x4, mask64x4};

/// Spheres that are moved before the next ones: few enough to stay in the nearest cache.
const SPHERES_AT_ONCE: usize = 4 * BLOCK;

/// The first sphere that was too fast after each of at most two kicks.
pub(super) type FirstTooFast = [Option<TooFast>; 2];

/// A motion of all spheres.
#[derive(Clone, Copy)]
pub(super) struct Motion<'a> {
    /// How long each kick is (s).
    pub(super) kicks: &'a [f64],
    /// How long the drift after the kicks is (s), if there is one.
    pub(super) drift: Option<f64>,
    /// Whether forces and torques are set to zero afterwards.
    pub(super) clear: bool,
}

impl Motion<'_> {
    /// Spheres stay where they are, with their velocities and forces.
    pub(super) const NONE: Self = Self {
        kicks: &[],
        drift: None,
        clear: false,
    };
}

/// The operations on each sphere, in this order.
pub(super) struct Moves<'a> {
    /// Effects, which add to its force and torque.
    pub(super) effects: &'a [PlacedEffect],
    /// How long each kick is (s). The last kick of a step and the first of the next are not joined,
    /// because numbers are rounded after each.
    pub(super) kicks: &'a [f64],
    pub(super) drift: Option<Drift>,
    /// Whether forces and torques are set to zero while they are in a near cache.
    pub(super) clear: bool,
    pub(super) limits: &'a Limits,
    /// The time step (s).
    pub(super) dt: f64,
}

/// x += v dt.
#[derive(Clone, Copy)]
pub(super) struct Drift {
    /// How long it is (s).
    pub(super) dt: f64,
    /// How far spheres may be from their references, if that is checked.
    pub(super) allowance: Option<Allowance>,
}

/// Results of the checks during the moves.
#[derive(Clone, Copy, Default)]
pub(super) struct Found {
    pub(super) too_fast: FirstTooFast,
    /// Whether a sphere drifted farther than the near pairs allow.
    pub(super) far: bool,
}

impl Moves<'_> {
    /// Moves the spheres, divided among as many threads as there are `bodies`. A profile is kept
    /// only without other threads.
    pub(super) fn apply(
        &self,
        mut spheres: SphereRows<'_>,
        bodies: &mut [Bodies],
        level: Level,
        profile: &mut Option<Box<Profile>>,
    ) -> Found {
        let asked = self.effects.iter().map(|(_, effect)| effect.asks());
        let asked = asked.fold(Asked::default(), Asked::or);
        // Without rotation there are neither spins nor torques.
        let asked = Asked {
            turn: asked.turn && !spheres.spin.is_empty(),
            ..asked
        };
        if let [bodies] = bodies {
            return self.move_share(&mut spheres, bodies, asked, level, profile);
        }
        let length = spheres.len().div_ceil(bodies.len());
        let length = length.next_multiple_of(BLOCK);
        let share = |bodies| (spheres.split(length), bodies, Found::default());
        let mut shares: Vec<_> = bodies.iter_mut().map(share).collect();
        in_parallel(&mut shares, &|(spheres, bodies, found)| {
            *found = self.move_share(spheres, bodies, asked, level, &mut None);
        });
        shares
            .iter()
            .fold(Found::default(), |all, (_, _, it)| all.and(*it))
    }

    fn move_share(
        &self,
        spheres: &mut SphereRows<'_>,
        bodies: &mut Bodies,
        asked: Asked,
        level: Level,
        profile: &mut Option<Box<Profile>>,
    ) -> Found {
        let mut found = Found::default();
        debug_assert!(self.kicks.len() <= found.too_fast.len());
        // Gravity and shaking alone need no blocks of columns.
        let mut effects = self.effects.iter();
        let is_uniform = effects.all(|(_, effect)| effect.acceleration().is_some());
        while spheres.len() > 0 {
            let mut some = spheres.split(SPHERES_AT_ONCE);
            if is_uniform {
                for (place, effect) in self.effects {
                    let Some(uniform) = effect.acceleration() else {
                        continue;
                    };
                    fearless_simd::dispatch!(level, simd => accelerate(simd, &mut some, uniform));
                    profile::mark(profile, StepPart::Effect(*place));
                }
            } else {
                fearless_simd::dispatch!(level, simd => {
                    self.act(simd, &mut some, bodies, asked, level, profile);
                });
            }
            for (&kick, too_fast) in self.kicks.iter().zip(&mut found.too_fast) {
                let slow = self.limits.slow;
                if !fearless_simd::dispatch!(level, simd => kick_all(simd, &mut some, kick, slow)) {
                    let (velocity, radius) = (&*some.velocity, some.radius);
                    let limits = self.limits;
                    let first = || limits.first_too_fast(some.first, velocity, radius, self.dt);
                    *too_fast = too_fast.or_else(first);
                }
                profile::mark(profile, StepPart::Kick);
            }
            if let Some(drift) = self.drift {
                found.far |= fearless_simd::dispatch!(level, simd => drift.apply(simd, &mut some));
                profile::mark(profile, StepPart::Drift);
            }
            if self.clear {
                some.force.fill(Vector::ZERO);
                some.torque.fill(Vector::ZERO);
                profile::mark(profile, StepPart::Rest);
            }
        }
        found
    }

    /// Adds the forces and torques of the effects, block by block.
    #[inline(always)]
    fn act<S: Simd>(
        &self,
        simd: S,
        spheres: &mut SphereRows<'_>,
        bodies: &mut Bodies,
        asked: Asked,
        level: Level,
        profile: &mut Option<Box<Profile>>,
    ) {
        for from in (0..spheres.len()).step_by(BLOCK) {
            bodies.take(simd, spheres, from, asked);
            profile::mark(profile, StepPart::Rest);
            for (place, effect) in self.effects {
                effect.apply(level, bodies);
                profile::mark(profile, StepPart::Effect(*place));
            }
            bodies.give(simd, spheres, from, asked);
        }
        profile::mark(profile, StepPart::Rest);
    }
}

impl Found {
    /// The results for these and later spheres together.
    pub(super) fn and(self, later: Self) -> Self {
        let mut too_fast = self.too_fast;
        for (first, second) in too_fast.iter_mut().zip(later.too_fast) {
            *first = first.or(second);
        }
        Self {
            too_fast,
            far: self.far || later.far,
        }
    }
}

/// F += m a.
#[inline(always)]
fn accelerate<S: Simd>(simd: S, spheres: &mut SphereRows<'_>, acceleration: Vector) {
    let acceleration = acceleration.simd(simd);
    for (force, &mass) in spheres.force.iter_mut().zip(spheres.mass) {
        let row = force.simd(simd) + acceleration * mass;
        *force = Vector::of_row(row.into());
    }
}

/// Smaller spins (rad/s) are zero. Friction and damping that act on spins alone let them decay to
/// denormal numbers, which processors multiply many times slower. Their effect on a velocity is far
/// below its last digit.
const LEAST_SPIN: f64 = 1e-280;

/// A spin (rad/s) with components below [`LEAST_SPIN`] as zero.
pub(super) fn without_least(spin: Vector) -> Vector {
    let component = |it: f64| if it.abs() < LEAST_SPIN { 0.0 } else { it };
    Vector::new(component(spin.x), component(spin.y), component(spin.z))
}

/// v += a dt, and the same for spins. Returns whether no component of a velocity is beyond `slow`.
#[inline(always)]
fn kick_all<S: Simd>(simd: S, spheres: &mut SphereRows<'_>, dt: f64, slow: f64) -> bool {
    // The fourth number of a row is padding.
    let most = f64x4::simd_from(simd, [slow, slow, slow, f64::INFINITY]);
    let mut all_slow = mask64x4::splat(simd, true);
    let (least_spin, zero) = (f64x4::splat(simd, LEAST_SPIN), f64x4::splat(simd, 0.0));
    for ((velocity, force), inverse) in (spheres.velocity.iter_mut())
        .zip(&*spheres.force)
        .zip(spheres.inverse_mass)
    {
        let row = velocity.simd(simd) + force.simd(simd) * (inverse * dt);
        *velocity = Vector::of_row(row.into());
        // NaN does not count as slow.
        all_slow &= row.abs().simd_le(most);
    }
    for ((spin, torque), inverse) in (spheres.spin.iter_mut())
        .zip(&*spheres.torque)
        .zip(spheres.inverse_inertia)
    {
        let row = spin.simd(simd) + torque.simd(simd) * (inverse * dt);
        let vanishes = row.abs().simd_lt(least_spin);
        *spin = Vector::of_row(vanishes.select(zero, row).into());
    }
    all_slow.all_true()
}

impl Drift {
    /// Moves the spheres. Returns whether one of them went too far.
    #[inline(always)]
    fn apply<S: Simd>(&self, simd: S, spheres: &mut SphereRows<'_>) -> bool {
        for (position, velocity) in spheres.position.iter_mut().zip(&*spheres.velocity) {
            let row = position.simd(simd) + velocity.simd(simd) * self.dt;
            *position = Vector::of_row(row.into());
        }
        let allowance = self.allowance;
        allowance.is_some_and(|it| !it.hold(spheres.position, spheres.reference))
    }
}
