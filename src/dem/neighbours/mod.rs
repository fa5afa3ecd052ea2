//! Lists of neighbours, on two levels.
//!
//! The Verlet list holds the pairs that may interact before anything has moved by half the skin, a
//! rotation of all spheres about the axis not counted. One list serves the contacts and the
//! updraught's counting shield. At the shield's reach, a column of any height, it has ten times
//! as many pairs as touch; so a second list, [`Near`], holds for a few steps what of it matters:
//! the pairs that may touch, and those whose part in the shield may change.
//!
//! Pairs stand in order of their indices (i < j, then by j) in both. The order in which forces are
//! summed is therefore that of the indices alone, so that neither skin nor margin, nor the
//! moment of a rebuild, nor the cells behind it can change a bit of the motion.

mod anchor;
mod cells;
mod few;
mod follow;
mod glance;
mod hash;
mod near;
mod pair;
mod search;
mod shield;

pub use near::{Near, Purpose};
pub use pair::NearPair;
pub(in crate::dem) use pair::keep_pairs;

use self::anchor::Anchor;
use self::few::{FEW, FewSpheres};
use self::search::{Search, Storage};
use super::threads::in_parallel;
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::Neighbours;
use fearless_simd::Level;
use std::f64::consts::SQRT_2;

pub use self::anchor::{Allowance, Reference};

/// Which pairs a list must hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Pairs that may touch.
    Contact,
    /// Pairs in one another's vertical column, |dx| and |dy| within the larger diameter, at any
    /// height; they include all that may touch.
    Column,
}

/// Bits of a number, of as many spheres or pairs.
const WORD: usize = u64::BITS as usize;

/// Steps from one build to the next that the skin adapts to.
const LIFE: std::ops::Range<u64> = 30..80;

/// The part of the skin that a turn of all spheres may take: near pairs have up to seven tenths.
const TURN: f64 = 0.2;

/// The Verlet list.
#[derive(Clone, Debug)]
pub struct VerletList {
    reach: Reach,
    skin: f64,
    narrowest: f64,
    widest: f64,
    /// The least skin that is asked for (m).
    least: f64,
    /// Entries of sphere i are `start[i]..start[i + 1]`.
    start: Vec<u32>,
    neighbour: Vec<u32>,
    /// The sphere whose entry it is, of every entry; none in a list of many spheres, where memory
    /// counts.
    owner: Vec<u32>,
    anchor: Anchor,
    /// Half the diagonal of the largest sphere's shielding box, plus the skin (m); zero if the
    /// list holds contacts alone.
    half_diagonal: f64,
    /// How long the list before held (s).
    life: f64,
    search: Search,
    few: FewSpheres,
    level: Level,
    /// Whether spheres are sorted in memory by cells of about the search's.
    sorted: bool,
    builds: u64,
    /// Whether spheres are others or in another order since the build, or a wider skin is asked
    /// for.
    outdated: bool,
}

impl VerletList {
    /// A list that is not built yet. Its skin (m) starts from a guess and adapts; with a skin of 0
    /// the list is built in every step, and holds the pairs that touch.
    pub fn new(reach: Reach, skin: f64, neighbours: Neighbours) -> Self {
        Self {
            reach,
            skin,
            narrowest: 0.5 * skin,
            widest: 4.0 * skin,
            least: 0.0,
            start: vec![0],
            neighbour: Vec::new(),
            owner: Vec::new(),
            anchor: Anchor::default(),
            half_diagonal: 0.0,
            life: 0.0,
            search: Search::new(neighbours),
            few: FewSpheres::default(),
            level: Level::new(),
            sorted: false,
            builds: 0,
            outdated: false,
        }
    }

    /// A list of many spheres, which are sorted in memory: those of a cell are then at hand without
    /// copies, which would take memory.
    pub fn of_sorted(self) -> Self {
        Self {
            sorted: true,
            ..self
        }
    }

    /// Notes that spheres are others, or in another order: the list must be built anew.
    pub fn outdate(&mut self) {
        self.outdated = true;
    }

    /// Whether the list still holds `time` (s) after its build, and will until the offset of
    /// a pair has changed by another `margin` (m). Not so if a coordinate is not a number.
    pub fn holds(&self, particles: &Particles, time: f64, margin: f64) -> bool {
        let allowance = self.allowance(time, margin);
        self.builds > 0
            && !self.outdated
            && allowance.hold(&particles.position, self.anchor.position())
    }

    /// How far spheres may have come `time` (s) after the build, if the offset of a pair may change
    /// by another `margin` (m).
    fn allowance(&self, time: f64, margin: f64) -> Allowance {
        let margin = self.skin - margin;
        self.anchor.allowance(time, margin, self.half_diagonal)
    }

    /// How far the offset of a pair may change from the build to the end of the list (m).
    pub fn skin(&self) -> f64 {
        self.skin
    }

    /// Asks for a skin (m) of at least that from now on.
    pub fn require(&mut self, skin: f64) {
        self.least = skin;
        if self.skin < skin {
            self.skin = skin;
            self.outdated = true;
        }
    }

    /// How often the list was built.
    pub fn builds(&self) -> u64 {
        self.builds
    }

    /// Number of listed pairs.
    pub fn pairs(&self) -> usize {
        self.neighbour.len()
    }

    /// Bounds of the entries of each sphere: `start[i]..start[i + 1]`.
    #[inline]
    pub fn start(&self) -> &[u32] {
        &self.start
    }

    /// The partner of each entry.
    #[inline]
    pub fn neighbour(&self) -> &[u32] {
        &self.neighbour
    }

    /// The sphere of an entry.
    pub(super) fn owner_of(&self, entry: usize) -> usize {
        let before = self.start.partition_point(|&start| start as usize <= entry);
        before.saturating_sub(1)
    }

    /// The spheres of the entries from `first` on, all of lower index than the partners. `owner` is
    /// the first of them, or an earlier one, and then the last.
    #[inline(always)]
    pub(super) fn fill_owners(&self, first: usize, owner: &mut usize, owners: &mut [u32]) {
        if !self.sorted {
            owners.copy_from_slice(&self.owner[first..first + owners.len()]);
            return;
        }
        let (mut i, mut at) = (*owner, 0);
        while at < owners.len() {
            let end = (self.start[i + 1] as usize).saturating_sub(first);
            let until = end.clamp(at, owners.len());
            for slot in &mut owners[at..until] {
                *slot = i as u32;
            }
            at = until;
            i += 1;
        }
        // More of the last one's may follow.
        *owner = i - 1;
    }

    /// Widens or narrows the skin after a list that held for this many steps and this time (s).
    pub fn adapt(&mut self, steps: u64, time: f64) {
        self.life = time;
        if self.builds == 0 {
            return;
        }
        if steps < LIFE.start {
            self.skin = (1.25 * self.skin).min(self.widest.max(self.least));
        } else if steps >= LIFE.end {
            self.skin = (0.8 * self.skin).max(self.narrowest.max(self.least));
        }
    }

    /// Builds the list anew for the present positions, which must be finite, on so many threads of
    /// the pool that runs this.
    pub fn build(&mut self, particles: &Particles, threads: usize) {
        let count = particles.len();
        let largest = particles.largest_radius();
        let few = count <= FEW && !self.sorted && self.search.may_be_replaced();
        self.anchor.drop(particles);
        self.half_diagonal = match self.reach {
            Reach::Contact => 0.0,
            Reach::Column => SQRT_2 * (2.0 * largest + self.skin),
        };
        self.start.clear();
        self.neighbour.clear();
        self.owner.clear();
        self.start.push(0);
        if few {
            self.find_few(particles);
        } else {
            let storage = match self.sorted {
                true => Storage::InPlace,
                false => Storage::Copied,
            };
            let distance = 2.0 * largest + self.skin;
            self.search.fill(particles, distance, self.reach, storage);
            match self.sorted && threads > 1 {
                true => self.find_on_threads(particles, threads),
                false => self.find_all(particles),
            }
        }
        if self.sorted {
            self.search.forget();
        }
        self.builds += 1;
        self.outdated = false;
    }

    /// Finds the partners of a few spheres.
    fn find_few(&mut self, particles: &Particles) {
        let turned = match self.reach {
            Reach::Column if self.least == 0.0 => {
                let most = TURN * self.skin / self.half_diagonal;
                self.anchor.turn(self.life, most)
            }
            _ => (0.0, 1.0),
        };
        self.few.fill(particles, turned);
        for i in 0..particles.len() {
            let of = (i, particles.first_partner(i));
            let reach = (self.reach, self.skin);
            self.few.find(self.level, of, reach, &mut self.neighbour);
            self.end_entries();
        }
    }

    /// Finds the partners of all spheres among those that the search suggests.
    fn find_all(&mut self, particles: &Particles) {
        for i in 0..particles.len() {
            let (first, found) = (self.neighbour.len(), &mut self.neighbour);
            find_partners(self.reach, self.skin, &self.search, i, particles, found);
            found[first..].sort_unstable();
            self.end_entries();
        }
    }

    /// Ends the entries of the next sphere.
    fn end_entries(&mut self) {
        let sphere = self.start.len() as u32 - 1;
        self.start.push(self.neighbour.len() as u32);
        if !self.sorted {
            self.owner.resize(self.neighbour.len(), sphere);
        }
    }

    /// Finds the partners of all spheres, those of as many by each thread.
    fn find_on_threads(&mut self, particles: &Particles, threads: usize) {
        let count = particles.len();
        // In each part the spheres, all their partners, and where those of each end.
        let part = |k: usize| {
            let spheres = count * k / threads..count * (k + 1) / threads;
            (spheres, Vec::new(), Vec::new())
        };
        let mut parts: Vec<_> = (0..threads).map(part).collect();
        in_parallel(&mut parts, &|(spheres, partners, ends)| {
            for i in spheres.clone() {
                let first = partners.len();
                find_partners(self.reach, self.skin, &self.search, i, particles, partners);
                partners[first..].sort_unstable();
                ends.push(partners.len() as u32);
            }
        });
        for (_, partners, ends) in parts {
            let first = self.neighbour.len();
            self.neighbour.extend(partners);
            let ends = ends.iter().map(|end| first as u32 + end);
            self.start.extend(ends);
        }
    }
}

/// Calls `visit` with both spheres of every pair that may touch, and of others. Stores no list of
/// pairs: in a scene that is not checked yet all spheres may lie in one place, and the list would
/// be too long.
pub fn visit_pairs(particles: &Particles, mut visit: impl FnMut(usize, usize)) {
    let length = 2.0 * particles.largest_radius();
    let mut search = Search::new(Neighbours::HashedCells { length });
    search.fill(particles, length, Reach::Contact, Storage::Copied);
    for i in 0..particles.len() {
        let first = particles.first_partner(i) as u32;
        search.near(i, particles, |j, _, _| {
            if j >= first {
                visit(i, j as usize);
            }
        });
    }
}

/// Lists the partners of sphere `i` that come after it, in no order.
fn find_partners(
    reach: Reach,
    skin: f64,
    search: &Search,
    i: usize,
    particles: &Particles,
    found: &mut Vec<u32>,
) {
    let (centre, radius) = (particles.position[i], particles.radius[i]);
    let first = particles.first_partner(i) as u32;
    match reach {
        Reach::Contact => search.near(i, particles, |j, position: Vector, other| {
            let distance = radius + skin + other;
            let offset = position - centre;
            if j >= first && offset.norm_squared() < distance * distance {
                found.push(j);
            }
        }),
        Reach::Column => search.near(i, particles, |j, position: Vector, other| {
            let distance = 2.0 * radius.max(other) + skin;
            let offset = position - centre;
            if j >= first && offset.x.abs() < distance && offset.y.abs() < distance {
                found.push(j);
            }
        }),
    }
}
