//! Removal of overlaps: the elastic relaxation of Rycroft, Wong and Bazant (2010), section 2.

use super::arrangement::Arrangement;
use super::guard::{Fault, SpotGuard};
use super::model::SpotRules;
use super::region::NOWHERE;
use crate::particles::block::{ROWS, turned};
use crate::particles::vector::Vector;
use fearless_simd::{Select, Simd, SimdBase, SimdFloat, SimdMask, f64x8, mask64x8};

/// Displacements of eight spheres, one array per axis (m).
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(crate) struct EightDisplacements([[f64; ROWS]; 3]);

impl EightDisplacements {
    #[inline(always)]
    pub(crate) fn vector(&self, lane: usize) -> Vector {
        let [x, y, z] = &self.0;
        Vector::new(x[lane], y[lane], z[lane])
    }
}

/// Spheres that are relaxed together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RelaxedRegion {
    pub(crate) centre: Vector,
    /// Spheres farther from the centre than this are held (m).
    pub(crate) radius: f64,
    /// Longest displacement that is not an error (m).
    pub(crate) longest: f64,
}

/// Computes the displacements that remove overlaps of the spheres in `inside`. Slots are padded to
/// whole groups of eight with the slot of the dummy sphere.
///
/// Every pair nearer than the diameter d overlaps by delta = d - r. Either sphere is displaced by
/// alpha delta/2 away from the other, or by alpha delta if the other one is held.
///
/// An error if a displacement is too long or not a number.
#[inline(always)]
pub(crate) fn displacements<S: Simd>(
    simd: S,
    (model, arrangement): (&SpotRules, &Arrangement),
    position: &[Vector],
    region: RelaxedRegion,
    (inside, displacement): (&[u32], &mut [EightDisplacements]),
) -> Result<(), Fault> {
    let limit = region.longest * region.longest;
    let groups = inside.chunks_exact(ROWS).zip(displacement.iter_mut());
    let mut sound = mask64x8::splat(simd, true);
    for (slots, displacement) in groups {
        let [x, y, z] = displaced(simd, model, arrangement, position, region, slots);
        sound &= (x * x + y * y + z * z).simd_le(limit);
        let [to_x, to_y, to_z] = &mut displacement.0;
        x.store_slice(to_x);
        y.store_slice(to_y);
        z.store_slice(to_z);
    }
    if sound.all_true() {
        return Ok(());
    }
    Err(fault(position, inside, displacement, limit))
}

/// Displacements of eight spheres.
#[inline(always)]
fn displaced<S: Simd>(
    simd: S,
    model: &SpotRules,
    arrangement: &Arrangement,
    position: &[Vector],
    region: RelaxedRegion,
    slots: &[u32],
) -> [f64x8<S>; 3] {
    let neighbours = &arrangement.neighbours;
    let mut starts = [0; ROWS];
    let mut longest = 0;
    for lane in 0..ROWS {
        starts[lane] = slots[lane] as usize * neighbours.width;
        longest = longest.max(neighbours.count[slots[lane] as usize]);
    }
    let own = turned(
        #[inline(always)]
        |lane| position[slots[lane] as usize].simd(simd),
    );
    let (squared_radius, centre) = (region.radius * region.radius, region.centre);
    let (diameter, alpha) = (model.diameter, model.relaxation_strength);
    let zero = f64x8::splat(simd, 0.0);
    let (one_side, both_sides) = (f64x8::splat(simd, alpha), f64x8::splat(simd, 0.5 * alpha));
    let present = own[2].simd_gt(NOWHERE.z);
    let mut sum = [zero; 3];
    for k in 0..longest as usize {
        let other = turned(
            #[inline(always)]
            |lane| position[neighbours.slot[starts[lane] + k] as usize].simd(simd),
        );
        let (dx, dy, dz) = (own[0] - other[0], own[1] - other[1], own[2] - other[2]);
        let squared = dx * dx + dy * dy + dz * dz;
        let overlapping = squared.simd_lt(diameter * diameter) & present;
        if !overlapping.any_true() {
            continue;
        }
        let [x, y, z] = [
            other[0] - centre.x,
            other[1] - centre.y,
            other[2] - centre.z,
        ];
        let free = (x * x + y * y + z * z).simd_lt(squared_radius);
        let strength = free.select(both_sides, one_side);
        let factor = (diameter / squared.sqrt() - 1.0) * strength;
        let factor = overlapping.select(factor, zero);
        sum = [
            sum[0] + dx * factor,
            sum[1] + dy * factor,
            sum[2] + dz * factor,
        ];
    }
    sum
}

#[cold]
fn fault(
    position: &[Vector],
    inside: &[u32],
    displacement: &[EightDisplacements],
    limit: f64,
) -> Fault {
    let vectors = displacement.iter();
    let vectors = vectors.flat_map(|eight| (0..ROWS).map(|lane| eight.vector(lane)));
    let broken = inside.iter().zip(vectors);
    let mut broken = broken.filter(|(_, it)| !(it.norm_squared() <= limit));
    let (slot, length) = broken
        .next()
        .map_or((0, f64::NAN), |(slot, it)| (*slot, it.norm()));
    let guard = if length.is_nan() {
        SpotGuard::NotANumber
    } else {
        SpotGuard::Displacement
    };
    let most = limit.sqrt();
    Fault {
        guard,
        place: position[slot as usize],
        slot: Some(slot),
        detail: format!("relaxation displaces it by {length} m, more than {most} m"),
    }
}
