//! Which spheres are near each sphere, so that the removal of overlaps tests only these.

use super::cells::SphereCells;
use super::guard::{Fault, SpotGuard};
use super::threads::in_parallel;
use crate::particles::block::ROWS;
use crate::particles::vector::Vector;
use fearless_simd::{Level, Simd, SimdBase, SimdMask, f64x8, mask32x8, u32x8};
use std::ops::Range;

/// Largest number of neighbours of one sphere. Twelve spheres touch one, and about 50 fit into
/// twice its radius if they overlap as much as in the paper's worst packing.
const MOST: usize = 64;

/// Least length of the lists, enough for a dense packing.
const LEAST: usize = 16;

/// Spheres whose lists one task makes.
const TASK: usize = 1024;

/// Number of a task, and the numbers of neighbours and the lists that it fills.
type ListTask<'a> = (usize, (&'a mut [u32], &'a mut [u32]));

/// Lists of neighbours, all of the same length, padded with the slot of a dummy sphere far away.
#[derive(Clone, Debug)]
pub(crate) struct NeighbourLists {
    /// Length of each list.
    pub(crate) width: usize,
    /// Number of neighbours of each sphere, and of the dummy.
    pub(crate) count: Vec<u32>,
    /// The lists, one after the other.
    pub(crate) slot: Vec<u32>,
}

impl NeighbourLists {
    pub(crate) fn new() -> Self {
        Self {
            width: LEAST,
            count: Vec::new(),
            slot: Vec::new(),
        }
    }

    /// Lists the spheres nearer to each sphere than its reach (m). The positions are sorted by cell
    /// and padded for vector instructions.
    pub(crate) fn find(
        &mut self,
        level: Level,
        cells: &SphereCells,
        position: &[Vector],
        reach: &[f64],
    ) -> Result<(), Fault> {
        let spheres = reach.len();
        let columns = Coordinates::of(position);
        loop {
            self.count.clear();
            self.count.resize(spheres + 1, 0);
            self.slot.clear();
            self.slot.resize((spheres + 1) * self.width, spheres as u32);
            let width = self.width;
            let counts = self.count[..spheres].chunks_mut(TASK);
            let lists = self.slot[..spheres * width].chunks_mut(TASK * width);
            let mut tasks: Vec<_> = counts.zip(lists).enumerate().collect();
            in_parallel(&mut tasks, &|(task, (count, slot)): &mut ListTask<'_>| {
                let first = *task * TASK;
                fearless_simd::dispatch!(level, simd => {
                    columns.list(simd, cells, (first, &reach[first..]), (&mut *count, &mut *slot));
                });
            });
            let most = self.count.iter().copied().max().unwrap_or(0) as usize;
            if most <= self.width {
                return Ok(());
            }
            if most > MOST {
                return Err(self.crowded(position, reach));
            }
            self.width = most.next_multiple_of(LEAST);
        }
    }

    fn crowded(&self, position: &[Vector], reach: &[f64]) -> Fault {
        let crowded = |count: &u32| *count as usize > MOST;
        let slot = self.count.iter().position(crowded).unwrap_or(0);
        let (count, reach) = (self.count[slot], reach[slot]);
        Fault {
            guard: SpotGuard::Crowded,
            place: position[slot],
            slot: Some(slot as u32),
            detail: format!("{count} spheres within {reach} m, more than {MOST}"),
        }
    }
}

/// Centres, one array per axis (m).
struct Coordinates([Vec<f64>; 3]);

impl Coordinates {
    fn of(position: &[Vector]) -> Self {
        Self([
            position.iter().map(|it| it.x).collect(),
            position.iter().map(|it| it.y).collect(),
            position.iter().map(|it| it.z).collect(),
        ])
    }

    /// Fills the lists of some spheres, the first of which is `first`.
    #[inline(always)]
    fn list<S: Simd>(
        &self,
        simd: S,
        cells: &SphereCells,
        (first, reach): (usize, &[f64]),
        (count, slot): (&mut [u32], &mut [u32]),
    ) {
        let width = slot.len() / count.len();
        let mut ranges = Vec::new();
        let mut found = [0; MOST + ROWS];
        for (k, (count, list)) in count
            .iter_mut()
            .zip(slot.chunks_exact_mut(width))
            .enumerate()
        {
            let sphere = first + k;
            let [x, y, z] = self.0.each_ref().map(|axis| axis[sphere]);
            let reach = reach[k];
            cells.cover(Vector::new(x, y, z), reach, &mut ranges);
            let number = self.near(simd, sphere, &ranges, reach, &mut found);
            *count = number as u32;
            let kept = number.min(width);
            list[..kept].copy_from_slice(&found[..kept]);
        }
    }

    /// The neighbours of a sphere in some ranges. Returns their number; if there are too many, only
    /// the first are kept.
    #[inline(always)]
    fn near<S: Simd>(
        &self,
        simd: S,
        sphere: usize,
        ranges: &[Range<u32>],
        reach: f64,
        found: &mut [u32; MOST + ROWS],
    ) -> usize {
        let [x, y, z] = &self.0;
        let (own_x, own_y, own_z) = (x[sphere], y[sphere], z[sphere]);
        let lanes = u32x8::from_slice(simd, &[0, 1, 2, 3, 4, 5, 6, 7]);
        let mut count = 0;
        for range in ranges {
            for at in range.clone().step_by(ROWS) {
                let eight = at as usize..at as usize + ROWS;
                let dx = f64x8::from_slice(simd, &x[eight.clone()]) - own_x;
                let dy = f64x8::from_slice(simd, &y[eight.clone()]) - own_y;
                let dz = f64x8::from_slice(simd, &z[eight]) - own_z;
                let near = (dx * dx + dy * dy + dz * dz).simd_lt(reach * reach);
                let rest = (range.end - at).min(ROWS as u32);
                let mut bits = near.to_bitmask() & ((1 << rest) - 1);
                if let Some(own) = (sphere as u32).checked_sub(at).filter(|&it| it < rest) {
                    bits &= !(1 << own);
                }
                let place = count.min(MOST);
                (lanes + at)
                    .compress(mask32x8::from_bitmask(simd, bits))
                    .store_slice(&mut found[place..place + ROWS]);
                count += bits.count_ones() as usize;
            }
        }
        count
    }
}
