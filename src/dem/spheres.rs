//! Spheres in rows: kicks and drifts of some of them.

use super::neighbours::Allowance;
use super::particles::Particles;
use super::threads::{split, split_shared};
use super::vector::Vector;
use fearless_simd::{Level, Simd, SimdBase, SimdCombine, SimdMask, SimdSplit, f64x4, f64x8, mask64x8};
use std::ops::Range;

/// All spheres, or a thread's share of them, in rows.
pub(super) struct Spheres<'a> {
    /// The index of the first one.
    pub(super) first: usize,
    pub(super) position: &'a mut [Vector],
    pub(super) velocity: &'a mut [Vector],
    pub(super) force: &'a mut [Vector],
    pub(super) spin: &'a mut [Vector],
    pub(super) torque: &'a mut [Vector],
    pub(super) mass: &'a [f64],
    inverse_mass: &'a [f64],
    inverse_inertia: &'a [f64],
    /// Coordinates of where they were when near pairs were looked for (m), where these are looked for.
    reference: [&'a [f32]; 3],
}

impl<'a> Spheres<'a> {
    pub(super) fn all(particles: &'a mut Particles, reference: [&'a [f32]; 3]) -> Self {
        Self {
            first: 0,
            position: &mut particles.position,
            velocity: &mut particles.velocity,
            force: &mut particles.force,
            spin: &mut particles.spin,
            torque: &mut particles.torque,
            mass: &particles.mass,
            inverse_mass: &particles.inverse_mass,
            inverse_inertia: &particles.inverse_inertia,
            reference,
        }
    }

    /// How many they are.
    pub(super) fn len(&self) -> usize {
        self.position.len()
    }

    /// Takes so many from the front, or all that there are.
    pub(super) fn split(&mut self, count: usize) -> Self {
        let first = self.first;
        self.first += count.min(self.len());
        Self {
            first,
            position: split(&mut self.position, count),
            velocity: split(&mut self.velocity, count),
            force: split(&mut self.force, count),
            spin: split(&mut self.spin, count),
            torque: split(&mut self.torque, count),
            mass: split_shared(&mut self.mass, count),
            inverse_mass: split_shared(&mut self.inverse_mass, count),
            inverse_inertia: split_shared(&mut self.inverse_inertia, count),
            reference: self.reference.each_mut().map(|column| split_shared(column, count)),
        }
    }

    /// Changes velocities and spins of some by what acts on them for a time (s). Whether no component of a velocity
    /// is beyond `slow` (m/s), or not a number.
    pub(super) fn kick(&mut self, level: Level, which: Range<usize>, time: f64, slow: f64) -> bool {
        let velocity = (&mut self.velocity[which.clone()], &self.force[which.clone()]);
        let inverse_mass = &self.inverse_mass[which.clone()];
        let turn = (!self.spin.is_empty()).then(|| {
            let spin = (&mut self.spin[which.clone()], &self.torque[which.clone()]);
            (spin, &self.inverse_inertia[which])
        });
        fearless_simd::dispatch!(level, simd => {
            if let Some((spin, inverse_inertia)) = turn {
                accelerate(simd, spin, inverse_inertia, time, f64::MAX);
            }
            accelerate(simd, velocity, inverse_mass, time, slow)
        })
    }

    /// Moves the centres of some by their velocities for a time (s). Whether they are all within an allowance, if
    /// there is one.
    pub(super) fn drift(
        &mut self,
        level: Level,
        which: Range<usize>,
        time: f64,
        allowance: Option<Allowance>,
    ) -> bool {
        // There are none before near pairs are looked for.
        let before = self.reference.map(|column| column.get(which.clone()).unwrap_or_default());
        let (position, velocity) = (&mut self.position[which.clone()], &self.velocity[which]);
        fearless_simd::dispatch!(level, simd => {
            move_on(simd, position, velocity, time);
            match allowance {
                Some(allowance) => allowance.hold(simd, position, before),
                None => true,
            }
        })
    }
}

/// Adds to rates what acts for a time (s) on inverse masses or moments. Whether none of their components is beyond
/// `most`, or not a number.
#[inline(always)]
fn accelerate<S: Simd>(
    simd: S,
    (rates, by): (&mut [Vector], &[Vector]),
    inverse: &[f64],
    time: f64,
    most: f64,
) -> bool {
    let most_of = f64x8::splat(simd, most);
    let mut all = mask64x8::splat(simd, true);
    let (twos, rest) = rates.as_chunks_mut::<2>();
    let ((by, last_by), (inverse, last_inverse)) = (by.as_chunks::<2>(), inverse.as_chunks::<2>());
    for ((rates, by), inverse) in twos.iter_mut().zip(by).zip(inverse) {
        let factor = |k: usize| f64x4::splat(simd, inverse[k] * time);
        let rate = two(simd, rates) + two(simd, by) * factor(0).combine(factor(1));
        store(rate, rates);
        // What is not a number is not slow.
        all &= rate.abs().simd_le(most_of);
    }
    let mut slow = all.all_true();
    if let ([rate], [by], [inverse]) = (rest, last_by, last_inverse) {
        *rate += *by * (inverse * time);
        slow &= rate.row().iter().all(|component| component.abs() <= most);
    }
    slow
}

/// Moves places by velocities for a time (s).
#[inline(always)]
fn move_on<S: Simd>(simd: S, places: &mut [Vector], velocities: &[Vector], time: f64) {
    let (twos, rest) = places.as_chunks_mut::<2>();
    let (velocities, last) = velocities.as_chunks::<2>();
    for (places, velocities) in twos.iter_mut().zip(velocities) {
        store(two(simd, places) + two(simd, velocities) * time, places);
    }
    if let ([place], [velocity]) = (rest, last) {
        *place += *velocity * time;
    }
}

/// Two rows in a register.
#[inline(always)]
fn two<S: Simd>(simd: S, vectors: &[Vector; 2]) -> f64x8<S> {
    vectors[0].simd(simd).combine(vectors[1].simd(simd))
}

#[inline(always)]
fn store<S: Simd>(rows: f64x8<S>, vectors: &mut [Vector; 2]) {
    let (one, other) = rows.split();
    vectors[0] = Vector::of_row(one.into());
    vectors[1] = Vector::of_row(other.into());
}
