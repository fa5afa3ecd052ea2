//! The choice of the places to run next.

use super::lattice::square_distance;
use super::{Lattice, Observations, ProbabilityMap, Settings, Trial};

/// How much a run at a place is wanted, from 0 to 1: more if the probabilities of the two most
/// probable labels differ less.
fn score(map: &ProbabilityMap, place: usize) -> f64 {
    let at = map.at(place);
    let best = map.best(place);
    let others = (0..at.len()).filter(|label| *label != best);
    let second = others.map(|label| at[label]).fold(0.0, f64::max);
    1.0 - (at[best] - second)
}

/// The state of each place while a round is chosen.
pub(super) struct CandidatePlaces<'a> {
    lattice: &'a Lattice,
    settings: &'a Settings,
    /// How much a run is wanted, reduced by nearby runs of the round.
    scores: Vec<f64>,
    /// Squared distance from the nearest run.
    gaps: Vec<f64>,
    /// Number of seeds with which each place has been run.
    seeds: Vec<Vec<u64>>,
    /// Squared distance that runs of one round keep from each other.
    separation: f64,
}

impl<'a> CandidatePlaces<'a> {
    pub(super) fn new(
        lattice: &'a Lattice,
        runs: &Observations,
        map: &ProbabilityMap,
        settings: &'a Settings,
    ) -> Self {
        let count = lattice.places();
        // Half the mean spacing of the runs, as if they filled the lattice evenly.
        let spacing = libm::pow(runs.len() as f64, -1.0 / lattice.axes().len() as f64);
        let mut candidates = Self {
            lattice,
            settings,
            scores: (0..count).map(|place| score(map, place)).collect(),
            gaps: vec![f64::INFINITY; count],
            seeds: vec![Vec::new(); count],
            separation: 0.25 * spacing * spacing,
        };
        for (run, _) in runs.iter() {
            if let Ok(unit) = lattice.unit_of(&run.values) {
                candidates.note(&unit, run.seed);
            }
        }
        // A nearby place that is equally informative is better than one more seed.
        for (score, seeds) in candidates.scores.iter_mut().zip(&candidates.seeds) {
            *score /= (1 + seeds.len()) as f64;
        }
        candidates
    }

    /// Takes a run at a place of the unit cube into account.
    fn note(&mut self, unit: &[f64], seed: u64) {
        for place in 0..self.gaps.len() {
            let square = square_distance(self.lattice.unit(place), unit);
            self.gaps[place] = self.gaps[place].min(square);
            if square == 0.0 {
                self.seeds[place].push(seed);
            }
        }
    }

    /// Whether a place may be run once more.
    fn is_open(&self, place: usize) -> bool {
        (self.seeds[place].len() as u64) < self.settings.replicates
    }

    /// The place to explore: the farthest from all runs; among equals the most wanted.
    pub(super) fn farthest(&self) -> Option<usize> {
        let new = (0..self.gaps.len()).filter(|place| self.seeds[*place].is_empty());
        first_largest(new, |place| (self.gaps[place], self.scores[place]))
    }

    /// The most wanted place; among equals the farthest from all runs.
    pub(super) fn wanted(&self) -> Option<usize> {
        let open = (0..self.gaps.len()).filter(|place| self.is_open(*place));
        first_largest(open, |place| (self.scores[place], self.gaps[place]))
    }

    /// Adds a run at a place, with its first unused seed.
    pub(super) fn take(&mut self, place: usize) -> Trial {
        let first = self.settings.first_seed;
        let seeds = &self.seeds[place];
        let mut tried = first..=first.saturating_add(seeds.len() as u64);
        let seed = tried.find(|seed| !seeds.contains(seed)).unwrap_or(first);
        let unit = self.lattice.unit(place).to_vec();
        self.note(&unit, seed);
        for other in 0..self.scores.len() {
            let square = square_distance(self.lattice.unit(other), &unit);
            self.scores[other] *= -libm::expm1(-0.5 * square / self.separation);
        }
        Trial {
            values: self.lattice.values(place),
            seed,
        }
    }
}

/// The place with the largest pair of numbers; among equals the first.
fn first_largest(
    places: impl Iterator<Item = usize>,
    numbers: impl Fn(usize) -> (f64, f64),
) -> Option<usize> {
    let mut best: Option<(usize, (f64, f64))> = None;
    for place in places {
        let own = numbers(place);
        if best.is_none_or(|(_, other)| own > other) {
            best = Some((place, own));
        }
    }
    best.map(|(place, _)| place)
}
