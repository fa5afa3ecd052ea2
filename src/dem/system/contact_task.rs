//! Forces at contacts, block by block: which candidates touch, and the resulting forces. One thread
//! computes all of them, or each thread the forces on its own spheres.

use super::candidates::{AtWall, AtWalls, Candidates};
use super::contact_block::ContactBlock;
use super::contact_laws::Laws;
use super::contact_state::SphereProperties;
use super::lanes::full_block;
use super::partners::Partners;
use super::sums::Sums;
use super::touching::{CHUNK, Touching};
use super::wall_contacts::NearSphere;
use crate::dem::neighbours::NearPair;
use crate::dem::profile::{self, Profile, StepPart};
use crate::dem::threads::{split, split_shared};
use crate::forces::contact::NormalLaw;
use crate::forces::friction::{History, TangentialLaw};
use crate::particles::block::BLOCK;
use crate::particles::vector::Vector;
use crate::walls::WallSurface;
use fearless_simd::{Level, Simd};

/// Everything on which a contact force depends, besides the two spheres and their history.
#[derive(Clone, Copy)]
pub(super) struct ContactSettings<N, T> {
    pub(super) laws: Laws<N, T>,
    /// The properties of all spheres, if they are alike.
    pub(super) alike: Option<SphereProperties>,
    /// Whether nearly all near pairs touch. The others are then computed too, with a force of zero.
    pub(super) mostly_touch: bool,
    /// Whether the histories of pairs exceed the caches, and are prefetched.
    pub(super) prefetched: bool,
}

/// Candidates for contacts, each with its history.
pub(super) struct ContactSlice<'a, C, H> {
    pub(super) contacts: &'a [C],
    /// The history of each contact.
    pub(super) histories: &'a mut [H],
}

impl<C, H> ContactSlice<'_, C, H> {
    pub(super) fn none() -> Self {
        Self {
            contacts: &[],
            histories: &mut [],
        }
    }

    /// Takes this number from the front, or all if there are fewer.
    pub(super) fn split(&mut self, count: usize) -> Self {
        Self {
            contacts: split_shared(&mut self.contacts, count),
            histories: split(&mut self.histories, count),
        }
    }
}

/// A sphere whose contact is beyond the overlap limit, and the overlap (m).
pub(super) type TooDeep = Option<(usize, f64)>;

/// The first contact of a thread beyond the overlap limit: among pairs if the place is 0, else at
/// the wall before this place.
pub(super) type FirstTooDeep = Option<(usize, (usize, f64))>;

/// Which pairs of a thread.
#[derive(Clone, Copy, PartialEq, Eq)]
enum PairKind {
    /// Pairs whose first sphere belongs to another thread.
    Crossing,
    /// Pairs whose first sphere is its own.
    Own,
}

/// Buffers of a thread for its contacts.
pub(super) struct Buffers<H> {
    block: ContactBlock<H>,
    touching: Touching,
    /// Pairs with the indices of [`Partners`].
    local: [NearPair; CHUNK],
}

impl<H: History> Buffers<H> {
    pub(super) fn new() -> Box<Self> {
        Box::new(Self {
            block: ContactBlock::new(),
            touching: Touching::new(),
            local: [NearPair::default(); CHUNK],
        })
    }
}

/// The work of one thread: forces and torques of some spheres, or of all.
pub(super) struct ContactTask<'a, H> {
    pub(super) partners: Partners<'a>,
    pub(super) sums: Sums<'a>,
    pub(super) buffers: &'a mut Buffers<H>,
    /// Pairs whose first sphere belongs to another thread. That thread computes the force on it and
    /// keeps the original of this history.
    pub(super) crossing: ContactSlice<'a, NearPair, H>,
    /// Pairs whose first sphere belongs to this thread.
    pub(super) pairs: ContactSlice<'a, NearPair, H>,
    pub(super) walls: AtWalls<'a, H>,
    /// The first contact beyond the overlap limit, pairs before walls.
    pub(super) too_deep: FirstTooDeep,
}

impl<'a, H: History> ContactTask<'a, H> {
    /// The work of a thread that computes all of these contacts.
    pub(super) fn of_all(
        partners: Partners<'a>,
        sums: Sums<'a>,
        candidates: Candidates<'a, H>,
        buffers: &'a mut Buffers<H>,
    ) -> Self {
        Self {
            partners,
            sums,
            buffers,
            crossing: ContactSlice::none(),
            pairs: candidates.pairs,
            walls: candidates.walls,
            too_deep: None,
        }
    }

    /// Adds the forces and torques of all its contacts, in the order of the list.
    ///
    /// The hot loops are compiled once per instruction set, which takes most of the time of a
    /// build. Wider vectors change no bit: every lane computes what the scalar code would.
    pub(super) fn add_contacts<N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        level: Level,
        settings: &ContactSettings<N, T>,
        profile: &mut Option<Box<Profile>>,
    ) {
        fearless_simd::dispatch!(level, simd => self.add_all(simd, settings, profile));
    }

    #[inline(always)]
    fn add_all<S: Simd, N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        settings: &ContactSettings<N, T>,
        profile: &mut Option<Box<Profile>>,
    ) {
        if self.sums.clear {
            self.sums.force.fill(Vector::ZERO);
            self.sums.torque.fill(Vector::ZERO);
            profile::mark(profile, StepPart::Rest);
        }
        self.buffers.block.set_alike::<N, T>(settings.alike);
        // In one loop, so that the code in it is compiled once for each instruction set.
        for kind in [PairKind::Crossing, PairKind::Own] {
            self.pair_forces::<S, N, T>(simd, settings, kind);
        }
        if !N::ACTS {
            return;
        }
        profile::mark(profile, StepPart::Pairs);
        for place in 0..self.walls.len() {
            self.wall_forces::<S, N, T>(simd, place, settings);
            profile::mark(profile, StepPart::of_wall(self.walls[place].wall.name));
        }
    }

    /// Forces of pairs of this kind.
    #[inline(always)]
    fn pair_forces<S: Simd, N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        settings: &ContactSettings<N, T>,
        kind: PairKind,
    ) {
        let ContactSettings {
            laws,
            alike,
            mostly_touch,
            prefetched,
            ..
        } = settings;
        let partners = &self.partners;
        let slice = match kind {
            PairKind::Crossing => &mut self.crossing,
            PairKind::Own => &mut self.pairs,
        };
        debug_assert!(slice.contacts.len() <= slice.histories.len());
        let Buffers {
            block,
            touching,
            local,
        } = &mut *self.buffers;
        touching.prefetched = *prefetched;
        let histories = &mut *slice.histories;
        for (first, near) in (0..).step_by(CHUNK).zip(slice.contacts.chunks(CHUNK)) {
            let near = partners.local_pairs(near, local);
            let found = match *mostly_touch {
                true => near.len(),
                false => touching.find(simd, near, first, histories, partners, *alike),
            };
            for at in (0..found).step_by(BLOCK) {
                let lanes = &match *mostly_touch {
                    true => touching.first_of(&near[at..], first + at),
                    false => touching.block(at, found),
                };
                block.gather_pairs::<S, N, T>(simd, lanes, histories, partners);
                block.apply_laws(laws);
                block.store_pair_histories(simd, histories, lanes.entries);
                block.scatter_to_pairs::<S, T>(simd, lanes, &mut self.sums);
                // The thread of the first sphere reports a pair that crosses.
                if kind == PairKind::Own {
                    let sphere_of = |k: usize| partners.first_to_yield(&lanes.pairs[k].sides());
                    let found = block.first_too_deep(lanes.count, sphere_of);
                    note_too_deep(&mut self.too_deep, 0, found);
                }
            }
        }
    }

    /// Forces of a wall on the spheres near it.
    #[inline(always)]
    fn wall_forces<S: Simd, N: NormalLaw, T: TangentialLaw<History = H>>(
        &mut self,
        simd: S,
        place: usize,
        settings: &ContactSettings<N, T>,
    ) {
        let AtWall { wall, near } = &mut self.walls[place];
        debug_assert!(near.contacts.len() <= near.histories.len());
        let laws = settings.laws.at_wall(wall);
        let block = &mut self.buffers.block;
        let blocks = (near.contacts.chunks(BLOCK)).zip(near.histories.chunks_mut(BLOCK));
        let partners = &self.partners;
        let (mut rest, mut local) = (
            [NearSphere::default(); BLOCK],
            [NearSphere::default(); BLOCK],
        );
        let mut too_deep = None;
        for (spheres, histories) in blocks {
            let lanes = full_block(spheres, &mut rest);
            let lanes = partners.local_spheres(lanes, &mut local);
            block.gather_spheres::<S, N, T>(simd, lanes, histories, partners);
            block.level(wall);
            match wall.surface {
                WallSurface::Plane(surface) => block.find_wall_contacts(surface, &laws),
                WallSurface::Cylinder(surface) => block.find_wall_contacts(surface, &laws),
                WallSurface::Orifice(surface) => block.find_wall_contacts(surface, &laws),
                WallSurface::Slit(surface) => block.find_wall_contacts(surface, &laws),
                WallSurface::Parallelogram(surface) => block.find_wall_contacts(surface, &laws),
                WallSurface::Revolved(surface) => block.find_wall_contacts(surface, &laws),
                WallSurface::Segment(surface) => block.find_wall_contacts(surface, &laws),
            }
            if let Some(motion) = &wall.motion {
                block.see_wall_move(motion, &laws);
            }
            block.apply_laws_at_wall(&laws);
            block.store_histories(simd, histories, |k| k);
            block.weigh(wall.weight);
            block.scatter_to_spheres::<S, T>(simd, lanes, spheres.len(), &mut self.sums);
            if wall.weight > 0.0 {
                let sphere_of = |k: usize| partners.first_to_yield(&[lanes[k].i]);
                too_deep = too_deep.or(block.first_too_deep(spheres.len(), sphere_of));
            }
        }
        note_too_deep(&mut self.too_deep, 1 + place, too_deep);
    }
}

/// Notes a contact beyond the overlap limit, if it comes before the one that is known.
#[inline(always)]
fn note_too_deep(known: &mut FirstTooDeep, place: usize, found: TooDeep) {
    if let Some(found) = found
        && known.is_none_or(|(known, _)| place < known)
    {
        *known = Some((place, found));
    }
}
