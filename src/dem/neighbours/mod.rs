//! Lists of neighbours, on two levels.
//!
//! The Verlet list holds the pairs that may interact before a sphere has moved by half the skin. A
//! common rotation of all spheres about the axis does not count. One list serves the contacts and
//! the updraught's counting shield. The shield reaches over columns of any height, so that this
//! list has ten times as many pairs as touch. A second list, [`Near`], selects from it the pairs
//! that matter for a few steps: those that may touch, and those whose part in the shield may
//! change.
//!
//! Both lists hold pairs in the order of their indices: i < j, sorted by i and then by j. So the
//! order in which forces are summed follows from the indices alone. Skins, margins, the moments of
//! rebuilds and the cells of the search change no bit of the motion.

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
use self::cells::Storage;
use self::few::{FEW, FewSpheres};
use self::search::Search;
use super::threads::in_parallel;
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::Neighbours;
use fearless_simd::Level;
use std::f64::consts::SQRT_2;

pub use self::anchor::{Allowance, Reference};

/// The pairs that a list must hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Pairs that may touch.
    Contact,
    /// Pairs in one another's vertical column, |dx| and |dy| within the larger diameter, at any
    /// height; they include all that may touch.
    Column,
}

/// Bits of a word, one for each of as many spheres or pairs.
const WORD: usize = u64::BITS as usize;

/// Steps from one build to the next that the skin adapts to.
const LIFE: std::ops::Range<u64> = 30..80;

/// The largest part of the skin that is used by turning all spheres. Near pairs use up to seven
/// tenths.
const TURN: f64 = 0.2;

/// The Verlet list.
#[derive(Clone, Debug)]
pub struct VerletList {
    reach: Reach,
    skin: f64,
    narrowest: f64,
    widest: f64,
    /// The least skin that is requested (m).
    least: f64,
    /// Entries of sphere i are `start[i]..start[i + 1]`.
    start: Vec<u32>,
    neighbour: Vec<u32>,
    /// The sphere to which each entry belongs. Empty in a list of many spheres, to save memory.
    owner: Vec<u32>,
    anchor: Anchor,
    /// Half the diagonal of the largest sphere's shielding box, plus the skin (m); zero if the
    /// list holds contacts alone.
    half_diagonal: f64,
    /// How long the previous list held (s).
    life: f64,
    search: Search,
    few: FewSpheres,
    level: Level,
    /// Whether spheres are sorted in memory, by cells of about the width of the search's cells.
    sorted: bool,
    builds: u64,
    /// Whether the list must be built again: spheres were replaced or sorted since the build, or a
    /// wider skin is requested.
    outdated: bool,
}

impl VerletList {
    /// A list that is not built yet. Its skin (m) starts from a guess and adapts. With a skin of
    /// zero the list is built in every step, and holds the pairs that touch.
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

    /// A list of many spheres, which are sorted in memory. The search then needs no copies of them
    /// in the order of the cells.
    pub fn of_sorted(self) -> Self {
        Self {
            sorted: true,
            ..self
        }
    }

    /// Notes that spheres were replaced or sorted, so that the list must be built again.
    pub fn outdate(&mut self) {
        self.outdated = true;
    }

    /// Whether the list still holds `time` (s) after its build, and will hold until the offset of a
    /// pair has changed by another `margin` (m). False if a coordinate is not a number.
    pub fn holds(&self, particles: &Particles, time: f64, margin: f64) -> bool {
        let allowance = self.allowance(time, margin);
        self.builds > 0
            && !self.outdated
            && allowance.hold(&particles.position, self.anchor.position())
    }

    /// How far spheres may have moved `time` (s) after the build, if the offset of a pair may
    /// change by another `margin` (m).
    fn allowance(&self, time: f64, margin: f64) -> Allowance {
        let margin = self.skin - margin;
        self.anchor.allowance(time, margin, self.half_diagonal)
    }

    /// How far the offset of a pair may change from the build to the end of the list (m).
    pub fn skin(&self) -> f64 {
        self.skin
    }

    /// Asks for a skin of at least this (m) from now on.
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

    /// The sphere to which an entry belongs.
    pub(super) fn owner_of(&self, entry: usize) -> usize {
        let before = self.start.partition_point(|&start| start as usize <= entry);
        before.saturating_sub(1)
    }

    /// Writes the spheres to which the entries from `first` on belong. They have lower indices than
    /// the partners. `owner` must not be behind the first of them, and becomes the last.
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
        // More entries of the last sphere may follow.
        *owner = i - 1;
    }

    /// Widens or narrows the skin, after the list has held for this many steps and this time (s).
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

    /// Builds the list for the present positions, which must be finite, on this number of threads
    /// of the present pool.
    pub fn build(&mut self, particles: &Particles, threads: usize) {
        let count = particles.len();
        let largest = particles.largest_radius();
        let few = count <= FEW && !self.sorted && self.search.may_be_replaced();
        self.anchor.renew(particles);
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

    /// Finds the partners of all spheres, divided among threads.
    fn find_on_threads(&mut self, particles: &Particles, threads: usize) {
        let count = particles.len();
        // Each part has its spheres, all their partners, and the end of the partners of each.
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

/// Calls `visit` with both spheres of every pair that may touch, and of other pairs. It stores no
/// list of pairs. In a scene that is not checked yet, all spheres may lie in one place, and the
/// list would be too long.
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
            let offset = particles.domain.offset(position, centre);
            if j >= first && offset.norm_squared() < distance * distance {
                found.push(j);
            }
        }),
        Reach::Column => search.near(i, particles, |j, position: Vector, other| {
            let distance = 2.0 * radius.max(other) + skin;
            let offset = particles.domain.offset(position, centre);
            if j >= first && offset.x.abs() < distance && offset.y.abs() < distance {
                found.push(j);
            }
        }),
    }
}
