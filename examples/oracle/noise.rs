//! Seeds for maps that have one.

use super::maps::PublishedMap;
use super::replay::Oracle;
use phase::refine::{Code, Lattice, Trial};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// A map in which every seed shows the label of another place nearby: the place is moved by
/// normal numbers of equal spread, in steps of the lattice, on every axis. The labels of one place
/// and seed are always the same.
#[derive(Clone, Debug)]
pub(crate) struct NoisyMap {
    map: PublishedMap,
    spread: f64,
}

impl NoisyMap {
    /// Moves places by this many steps of the lattice.
    pub(crate) fn new(map: PublishedMap, spread: f64) -> Self {
        Self { map, spread }
    }

    /// Moves places so far that two seeds agree as often as those of `sample` do, a map with
    /// several seeds at some of the places of `map`. The spread is found by bisection.
    pub(crate) fn calibrated(map: PublishedMap, sample: &PublishedMap) -> Self {
        let wanted = agreement(sample);
        let places: Vec<usize> = (0..sample.lattice().places())
            .map(|place| map.place(&sample.lattice().values(place)))
            .collect();
        let (mut low, mut high) = (0.0, 4.0);
        let mut noisy = Self::new(map, 0.0);
        for _ in 0..12 {
            noisy.spread = 0.5 * (low + high);
            let shares = places.iter().map(|place| {
                let labels: Vec<Code> = (1..=30).map(|seed| noisy.draw(*place, seed)).collect();
                pairwise(&labels)
            });
            if shares.sum::<f64>() / places.len() as f64 > wanted {
                low = noisy.spread;
            } else {
                high = noisy.spread;
            }
        }
        noisy
    }

    /// How far places are moved, in steps of the lattice.
    pub(crate) fn spread(&self) -> f64 {
        self.spread
    }

    /// The map with this many seeds at all places.
    pub(crate) fn with_seeds(&self, seeds: u64) -> PublishedMap {
        let lattice = self.map.lattice().clone();
        PublishedMap::from_formula(lattice, 1..=seeds, |values, seed| {
            self.draw(self.map.place(values), seed)
        })
    }

    fn draw(&self, place: usize, seed: u64) -> Code {
        let lattice = self.map.lattice();
        let mut random = Pcg64::seed_from_u64(seed.wrapping_mul(1 << 32) + place as u64);
        let mut indices = lattice.indices(place);
        for (index, axis) in indices.iter_mut().zip(lattice.axes()) {
            let moved = *index as f64 + self.spread * normal(&mut random);
            let last = (axis.values().len() - 1) as f64;
            *index = libm::round(moved.clamp(0.0, last)) as usize;
        }
        self.map.label(lattice.place(&indices))
    }
}

impl Oracle for NoisyMap {
    fn lattice(&self) -> &Lattice {
        self.map.lattice()
    }

    fn label(&self, run: &Trial) -> Code {
        self.draw(self.map.place(&run.values), run.seed)
    }
}

/// How often two seeds of one place agree, the mean over places.
pub(crate) fn agreement(map: &PublishedMap) -> f64 {
    let places = map.lattice().places();
    let shares = (0..places).map(|place| {
        let labels: Vec<Code> = map.at(place).iter().map(|(_, code)| *code).collect();
        pairwise(&labels)
    });
    shares.sum::<f64>() / places as f64
}

/// Share of the pairs that are equal; 1 without pairs.
fn pairwise(labels: &[Code]) -> f64 {
    let pairs = labels.len() * labels.len().saturating_sub(1) / 2;
    let equal = (0..labels.len()).flat_map(|one| (0..one).map(move |other| (one, other)));
    let equal = equal
        .filter(|(one, other)| labels[*one] == labels[*other])
        .count();
    if pairs == 0 {
        1.0
    } else {
        equal as f64 / pairs as f64
    }
}

/// A number of the standard normal distribution: Box and Muller, Ann. Math. Stat. 29, 610 (1958).
fn normal(random: &mut Pcg64) -> f64 {
    let radius = (-2.0 * libm::log(1.0 - random.random::<f64>())).sqrt();
    radius * libm::cos(2.0 * std::f64::consts::PI * random.random::<f64>())
}
