//! One simulation on several threads.
//!
//! Each thread computes the forces on a range of indices, which in a sorted scene is a region of
//! space. If the spheres of a pair belong to two threads, both compute the pair, and each adds the
//! force to its own sphere. Such pairs come before the other pairs of the thread. So every sum
//! keeps the order of the list, and no thread waits for another. Each of the two threads keeps a
//! copy of the pair's history. If threads move their spheres in the same pass, these pairs read
//! copies of the spheres around the boundary.

use super::candidates::{AtWall, AtWalls, Candidates};
use super::contact_task::{
    Buffers, ContactSettings, ContactSlice, ContactTask, FirstTooDeep, TooDeep,
};
use super::partners::{Copies, Partners};
use super::sums::Sums;
use super::wall_contacts::WallContacts;
use crate::dem::bodies::SphereRows;
use crate::dem::neighbours::NearPair;
use crate::dem::threads::in_parallel;
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{History, TangentialLaw};
use crate::particles::block::BLOCK;
use fearless_simd::Level;
use std::ops::Range;

/// Boundaries are narrow if at most one in this number of spheres is copied.
const NARROW: usize = 8;

/// The division of spheres and contacts among threads.
pub(super) struct Division<H> {
    regions: Vec<ThreadRegion<H>>,
    /// For each region but the first, the range of spheres that holds all pairs across the boundary
    /// before it.
    boundaries: Vec<Copies>,
}

/// The part of one thread.
struct ThreadRegion<H> {
    spheres: Range<usize>,
    /// Near pairs whose first sphere is one of these.
    pairs: Range<usize>,
    /// Spheres near each wall.
    walls: Vec<Range<usize>>,
    crossing: Vec<NearPair>,
    crossing_history: Vec<H>,
    buffers: Box<Buffers<H>>,
}

/// The contacts that one thread computes.
pub(super) struct ThreadContacts<'a, H> {
    pub(super) crossing: ContactSlice<'a, NearPair, H>,
    pub(super) pairs: ContactSlice<'a, NearPair, H>,
    pub(super) walls: AtWalls<'a, H>,
    pub(super) buffers: &'a mut Buffers<H>,
}

impl<'a, H> ThreadContacts<'a, H> {
    /// The contacts of a thread that computes all.
    pub(super) fn all(candidates: Candidates<'a, H>, buffers: &'a mut Buffers<H>) -> Self {
        Self {
            crossing: ContactSlice::none(),
            pairs: candidates.pairs,
            walls: candidates.walls,
            buffers,
        }
    }
}

impl<H: History> Division<H> {
    /// An empty division among this number of threads.
    pub(super) fn new(threads: usize) -> Self {
        let region = || ThreadRegion {
            spheres: 0..0,
            pairs: 0..0,
            walls: Vec::new(),
            crossing: Vec::new(),
            crossing_history: Vec::new(),
            buffers: Buffers::new(),
        };
        Self {
            regions: (0..threads).map(|_| region()).collect(),
            boundaries: (1..threads).map(|_| Copies::default()).collect(),
        }
    }

    /// Divides the spheres so that each thread has about as many of these pairs.
    pub(super) fn divide(
        &mut self,
        spheres: usize,
        pairs: &[NearPair],
        histories: &[H],
        walls: &[WallContacts<H>],
    ) {
        let threads = self.regions.len();
        let bound = |k: usize| match k {
            0 => 0,
            _ if k == threads => spheres,
            _ => {
                let pair = pairs.get(pairs.len() * k / threads);
                let sphere = pair.map_or(spheres * k / threads, |pair| pair.i() as usize);
                whole_blocks(sphere)
            }
        };
        let bounds: Vec<usize> = (0..=threads).map(bound).collect();
        // There is no boundary before the first region.
        let mut none = Copies::default();
        let boundaries = std::iter::once(&mut none).chain(&mut self.boundaries);
        let mut regions: Vec<_> = (self.regions.iter_mut().zip(boundaries))
            .zip(bounds.windows(2))
            .collect();
        in_parallel(&mut regions, &|((region, boundary), bounds)| {
            let range = bounds[0]..bounds[1];
            let from = |bound: usize| pairs.partition_point(|it| (it.i() as usize) < bound);
            region.pairs = from(range.start)..from(range.end);
            region.walls.clear();
            region.walls.extend(walls.iter().map(|wall| {
                let from = |bound: usize| wall.near.partition_point(|it| (it.i as usize) < bound);
                from(range.start)..from(range.end)
            }));
            region.crossing.clear();
            region.crossing_history.clear();
            let mut across = range.start..range.start;
            for (pair, history) in pairs[..region.pairs.start].iter().zip(histories) {
                let [i, j] = pair.sides().map(|it| it as usize);
                if j >= range.start {
                    across = across.start.min(whole_blocks(i))..across.end.max(j + 1);
                }
                if range.contains(&j) {
                    region.crossing.push(*pair);
                    region.crossing_history.push(*history);
                }
            }
            boundary.spheres = across;
            region.spheres = range;
        });
    }

    /// Whether few spheres around the boundaries are copied.
    pub(super) fn has_narrow_boundaries(&self) -> bool {
        let copies: usize = self.boundaries.iter().map(|it| it.spheres.len()).sum();
        let spheres = self.regions.last().map_or(0, |it| it.spheres.end);
        copies * NARROW <= spheres
    }

    /// The spheres and contacts of each thread, out of all contacts.
    fn thread_contacts<'a>(
        regions: &'a mut [ThreadRegion<H>],
        candidates: Candidates<'a, H>,
    ) -> impl Iterator<Item = (Range<usize>, ThreadContacts<'a, H>)> {
        let Candidates {
            mut pairs,
            mut walls,
        } = candidates;
        regions.iter_mut().map(move |region| {
            let at_walls = walls.iter_mut().zip(&region.walls);
            let at_walls = at_walls.map(|(at_wall, range)| AtWall {
                wall: at_wall.wall,
                near: at_wall.near.split(range.len()),
            });
            let contacts = ThreadContacts {
                crossing: ContactSlice {
                    contacts: &region.crossing,
                    histories: &mut region.crossing_history,
                },
                pairs: pairs.split(region.pairs.len()),
                walls: at_walls.collect(),
                buffers: &mut region.buffers,
            };
            (region.spheres.clone(), contacts)
        })
    }

    /// Adds the forces of all contacts to the sums of all spheres. Returns the first contact that
    /// is too deep.
    pub(super) fn evaluate<'a, N: NormalLaw, T: TangentialLaw<History = H>>(
        &'a mut self,
        level: Level,
        settings: &ContactSettings<N, T>,
        partners: Partners<'a>,
        mut sums: Sums<'a>,
        candidates: Candidates<'a, H>,
    ) -> TooDeep {
        let thread_contacts = Self::thread_contacts(&mut self.regions, candidates);
        let tasks = thread_contacts.map(|(spheres, of)| ContactTask {
            partners,
            sums: sums.split(spheres.len()),
            buffers: of.buffers,
            crossing: of.crossing,
            pairs: of.pairs,
            walls: of.walls,
            too_deep: None,
        });
        let mut tasks: Vec<_> = tasks.collect();
        in_parallel(&mut tasks, &|task| {
            task.add_contacts(level, settings, &mut None);
        });
        first_too_deep(tasks.iter().map(|task| task.too_deep))
    }

    /// What `work` makes for each thread, if it moves its spheres in the same pass: of its spheres,
    /// its contacts, and copies of the spheres around the boundaries before and after them.
    pub(super) fn share_out<'a, W>(
        &'a mut self,
        mut all: SphereRows<'a>,
        candidates: Candidates<'a, H>,
        mut work: impl FnMut(SphereRows<'a>, ThreadContacts<'a, H>, Around<'a>) -> W,
    ) -> Vec<W> {
        let Self {
            regions,
            boundaries,
        } = self;
        in_parallel(boundaries, &|boundary| boundary.renew(&all));
        let around = |boundary: &'a Copies| Some(boundary.partners(&all));
        let around: Vec<_> = boundaries.iter().map(around).collect();
        let before = std::iter::once(None).chain(around.iter().copied());
        let after = around.iter().copied().chain(std::iter::once(None));
        let parts = Self::thread_contacts(regions, candidates).zip(before.zip(after));
        parts
            .map(|((spheres, contacts), around)| work(all.split(spheres.len()), contacts, around))
            .collect()
    }
}

/// Copies of the spheres before and after those of a thread.
pub(super) type Around<'a> = (Option<Partners<'a>>, Option<Partners<'a>>);

/// Rounds an index down to a multiple of [`BLOCK`]: effects work on whole blocks.
fn whole_blocks(sphere: usize) -> usize {
    sphere / BLOCK * BLOCK
}

/// The first contact of all threads that is too deep, in the order of a single thread: pairs before
/// walls.
pub(super) fn first_too_deep(of: impl Iterator<Item = FirstTooDeep>) -> TooDeep {
    // Of equal places the first counts.
    of.flatten()
        .min_by_key(|(place, _)| *place)
        .map(|(_, found)| found)
}

/// Number of threads: one if the work is not divided.
pub(super) fn threads<H>(division: Option<&Division<H>>) -> usize {
    division.map_or(1, |it| it.regions.len())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    fn divided(spheres: usize, pairs: &[NearPair], threads: usize) -> Division<()> {
        let mut division = Division::new(threads);
        division.divide(spheres, pairs, &vec![(); pairs.len()], &[]);
        division
    }

    fn inside(pair: NearPair, range: &Range<usize>) -> bool {
        pair.sides()
            .iter()
            .all(|&it| range.contains(&(it as usize)))
    }

    proptest! {
        /// Every pair is computed by each thread that has one of its spheres.
        #[test]
        fn pairs_are_inside_their_regions_or_among_the_copies(
            spheres in 2..900_usize,
            steps in prop::collection::btree_set((0..900_u32, 1..200_u32), 0..400),
            threads in 2..9_usize,
        ) {
            let pairs = steps.iter().map(|&(i, step)| NearPair::new(i, i + step));
            let pairs: Vec<_> = pairs.filter(|pair| (pair.j() as usize) < spheres).collect();
            let division = divided(spheres, &pairs, threads);
            let nobody = Copies::default();
            let mut own = 0;
            for (k, region) in division.regions.iter().enumerate() {
                let Range { start, end } = region.spheres;
                let before = k.checked_sub(1).map(|before| &division.regions[before]);
                prop_assert_eq!(start, before.map_or(0, |before| before.spheres.end));
                prop_assert!(start.is_multiple_of(BLOCK) || start == spheres);
                let before = k.checked_sub(1).map_or(&nobody, |k| &division.boundaries[k]);
                let expected = pairs.iter().filter(|it| (it.i() as usize) < start);
                let expected = expected.filter(|it| region.spheres.contains(&(it.j() as usize)));
                prop_assert!(region.crossing.iter().eq(expected));
                prop_assert!(region.crossing.iter().all(|&it| inside(it, &before.spheres)));
                let tail = division.boundaries.get(k);
                let tail = tail.map_or(spheres..spheres, |it| it.spheres.clone());
                let moved_at_once = start..tail.start.clamp(start, end);
                for &pair in &pairs[region.pairs.clone()] {
                    prop_assert!(region.spheres.contains(&(pair.i() as usize)));
                    match moved_at_once.contains(&(pair.i() as usize)) {
                        true => prop_assert!(inside(pair, &region.spheres)),
                        false => prop_assert!(inside(pair, &tail)),
                    }
                }
                own += region.pairs.len();
            }
            prop_assert_eq!(division.regions[threads - 1].spheres.end, spheres);
            prop_assert_eq!(own, pairs.len());
        }
    }

    /// Pairs of a lattice with `layer` spheres in each layer, where a sphere touches the next one
    /// in its layer and the one above.
    fn lattice(layer: u32, layers: u32) -> Vec<NearPair> {
        let count = layer * layers;
        let pairs = (0..count).flat_map(|i| [1, layer].map(|step| (i, i + step)));
        let pairs = pairs.filter(|&(_, j)| j < count);
        let sorted: BTreeSet<_> = pairs.collect();
        sorted
            .into_iter()
            .map(|(i, j)| NearPair::new(i, j))
            .collect()
    }

    #[test]
    fn boundaries_of_a_column_are_narrow_and_those_of_a_slab_are_not() {
        for (layer, layers, threads, narrow) in [
            (40, 200, 2, true),
            (40, 200, 4, true),
            (2000, 4, 2, false),
            (40, 200, 60, false),
        ] {
            let division = divided((layer * layers) as usize, &lattice(layer, layers), threads);
            assert_eq!(
                division.has_narrow_boundaries(),
                narrow,
                "{layer} a layer, {threads} threads"
            );
        }
    }
}
