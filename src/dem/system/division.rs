//! One simulation on several threads.
//!
//! Each thread answers for the forces on a range of indices, which in a sorted scene is a region of space.
//! A pair whose spheres are those of two threads is computed by both, and each adds to its own sphere, before
//! its other pairs: so every sum is in the order of the list, as with one thread, and there is nothing to wait
//! for. What such a pair remembers, both have.

use super::share::{AtWall, Buffers, Known, Scenery, Share, TooDeep};
use super::sums::Sums;
use super::wall_contacts::WallContacts;
use crate::dem::contact::NormalLaw;
use crate::dem::friction::{History, TangentialLaw};
use crate::dem::neighbours::NearPair;
use crate::dem::threads::{in_parallel, split};
use crate::dem::vector::Vector;
use crate::dem::walls::TankWall;
use fearless_simd::Level;
use std::ops::Range;

/// Who answers for what.
pub(super) struct Division<H> {
    parts: Vec<Region<H>>,
}

/// What one thread answers for.
struct Region<H> {
    spheres: Range<usize>,
    /// Near pairs whose first sphere is one of these.
    pairs: Range<usize>,
    /// Spheres near each wall.
    walls: [Range<usize>; TankWall::MOST],
    crossing: Vec<NearPair>,
    crossing_history: Vec<H>,
    buffers: Box<Buffers<H>>,
}

impl<H: History> Division<H> {
    /// Among so many threads.
    pub(super) fn new(threads: usize) -> Self {
        let region = || Region {
            spheres: 0..0,
            pairs: 0..0,
            walls: [const { 0..0 }; TankWall::MOST],
            crossing: Vec::new(),
            crossing_history: Vec::new(),
            buffers: Buffers::new(),
        };
        Self {
            parts: (0..threads).map(|_| region()).collect(),
        }
    }

    /// Divides so many spheres such that all have as many of these pairs.
    pub(super) fn divide(
        &mut self,
        spheres: usize,
        pairs: &[NearPair],
        histories: &[H],
        walls: &[WallContacts<H>],
    ) {
        let threads = self.parts.len();
        let bound = |k: usize| match k {
            0 => 0,
            _ if k == threads => spheres,
            _ => {
                let pair = pairs.get(pairs.len() * k / threads);
                pair.map_or(spheres * k / threads, |pair| pair.i() as usize)
            }
        };
        let bounds: Vec<usize> = (0..=threads).map(bound).collect();
        let mut regions: Vec<_> = self.parts.iter_mut().zip(bounds.windows(2)).collect();
        in_parallel(&mut regions, &|(region, bounds)| {
            let range = bounds[0]..bounds[1];
            let from = |bound: usize| pairs.partition_point(|it| (it.i() as usize) < bound);
            region.pairs = from(range.start)..from(range.end);
            for (place, wall) in region.walls.iter_mut().zip(walls) {
                let from = |bound: usize| wall.near.partition_point(|it| (it.i as usize) < bound);
                *place = from(range.start)..from(range.end);
            }
            let before = pairs[..region.pairs.start].iter().zip(histories);
            let crossing = before.filter(|(it, _)| range.contains(&(it.j() as usize)));
            region.crossing.clear();
            region.crossing_history.clear();
            for (pair, history) in crossing {
                region.crossing.push(*pair);
                region.crossing_history.push(*history);
            }
            region.spheres = range;
        });
    }

    /// Evaluates the forces of all contacts; `clear` says whether others are to be forgotten first. Says of the
    /// first contact that is too deep.
    pub(super) fn evaluate<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        level: Level,
        scenery: &Scenery<'_, N, T>,
        [force, torque]: [&mut [Vector]; 2],
        clear: bool,
        pairs: Known<'_, NearPair, H>,
        walls: &mut [AtWall<'_, H>],
    ) -> TooDeep {
        let (mut forces, mut torques) = (force, torque);
        let mut histories = pairs.histories;
        let mut at_walls: Vec<_> = walls
            .iter_mut()
            .map(|(wall, known)| (*wall, known.contacts, &mut *known.histories))
            .collect();
        let mut shares: Vec<Share<'_, H>> = Vec::with_capacity(self.parts.len());
        for region in &mut self.parts {
            let count = region.spheres.len();
            let mut walls = [const { None }; TankWall::MOST];
            for ((place, range), (wall, contacts, histories)) in
                walls.iter_mut().zip(&region.walls).zip(&mut at_walls)
            {
                let known = Known {
                    contacts: &contacts[range.clone()],
                    histories: split(histories, range.len()),
                };
                *place = Some((*wall, known));
            }
            shares.push(Share {
                sums: Sums {
                    first: region.spheres.start,
                    force: split(&mut forces, count),
                    torque: split(&mut torques, count),
                },
                clear,
                buffers: &mut region.buffers,
                crossing: Known {
                    contacts: &region.crossing,
                    histories: &mut region.crossing_history,
                },
                pairs: Known {
                    contacts: &pairs.contacts[region.pairs.clone()],
                    histories: split(&mut histories, region.pairs.len()),
                },
                walls,
                too_deep: [None; 1 + TankWall::MOST],
            });
        }
        in_parallel(&mut shares, &|share| {
            share.add_contacts(level, scenery, &mut None);
        });
        // As one thread would find it: pairs before walls.
        let kinds = 0..=TankWall::MOST;
        let all = kinds.flat_map(|kind| shares.iter().map(move |share| share.too_deep[kind]));
        all.flatten().next()
    }
}

/// Threads that there are, one where the work is not divided.
pub(super) fn threads<H>(division: &Option<Division<H>>) -> usize {
    division.as_ref().map_or(1, |it| it.parts.len())
}
