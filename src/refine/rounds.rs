//! Rounds of runs.

use super::choice::CandidatePlaces;
use super::observations::Training;
use super::{Finding, Lattice, Observations, ProbabilityMap, RefineError, Settings, Trial, widths};
use serde::{Deserialize, Serialize};

/// Why no more runs are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finish {
    /// The budget of runs is spent.
    Budget,
    /// All borders are as narrow as wanted.
    Width,
    /// Every place has been run with all its seeds.
    Complete,
}

/// The probability of each label at each place, learnt from runs by the model of the settings.
///
/// # Errors
/// If there are no runs, or if one does not lie on the axes.
pub fn probabilities(
    lattice: &Lattice,
    runs: &Observations,
    settings: &Settings,
) -> Result<ProbabilityMap, RefineError> {
    let training = Training::new(lattice, runs)?;
    let model = settings.model.model();
    let fitted = model.fit(&training);
    Ok(ProbabilityMap::new(
        lattice,
        &model.codes(&training),
        &*fitted,
    ))
}

/// The runs of the coarse grid, in the order of the lattice: values of each axis at equal steps of
/// its list, including the first and the last; the middle value if only one is requested.
pub(crate) fn start(lattice: &Lattice, settings: &Settings) -> Vec<Trial> {
    let axes = lattice.axes().iter().enumerate();
    let chosen: Vec<Vec<usize>> = axes
        .map(|(axis, it)| {
            let last = it.values().len() - 1;
            let steps = settings.start_on(axis).clamp(1, last + 1) - 1;
            match steps {
                0 => vec![last / 2],
                // Rounded to the nearest index.
                _ => (0..=steps)
                    .map(|step| (2 * step * last + steps) / (2 * steps))
                    .collect(),
            }
        })
        .collect();
    let is_chosen = |place: &usize| {
        let mut indices = lattice.indices(*place).into_iter().zip(&chosen);
        indices.all(|(index, chosen)| chosen.contains(&index))
    };
    let places = (0..lattice.places()).filter(is_chosen);
    let runs = places.map(|place| Trial {
        values: lattice.values(place),
        seed: settings.first_seed,
    });
    runs.collect()
}

/// What comes next.
#[derive(Clone, Debug, PartialEq)]
pub enum Round {
    /// All of these runs must be made and learnt before the next round is requested.
    Runs(Vec<Trial>),
    /// No more runs are made.
    Finished(Finish),
}

/// The rounds of a refined diagram: first the coarse grid, then runs where the label is least
/// certain.
///
/// The runs depend on the axes, the settings and the labels so far, but not on the order in which
/// the runs of a round are learnt. So after a stop the same rounds are chosen again: learn the
/// known labels, and make the missing runs.
#[derive(Clone, Debug)]
pub struct Rounds {
    lattice: Lattice,
    settings: Settings,
    runs: Observations,
    /// The probabilities learnt from the runs, if they have been requested.
    map: Option<ProbabilityMap>,
}

impl Rounds {
    /// Rounds of a lattice of places, before the first run.
    ///
    /// # Errors
    /// If settings are out of their ranges.
    pub fn new(lattice: Lattice, settings: Settings) -> Result<Self, RefineError> {
        settings.check(lattice.axes().len())?;
        Ok(Self {
            lattice,
            settings,
            runs: Observations::new(),
            map: None,
        })
    }

    /// Learns what was found of a run, which is its label at least: of one of a round, or of one
    /// that was made before the first round.
    ///
    /// # Errors
    /// If the run is known with another label.
    pub fn learn(&mut self, run: Trial, found: impl Into<Finding>) -> Result<(), RefineError> {
        self.map = None;
        self.runs.add(run, found)
    }

    /// The next round: the runs of the coarse grid that are missing, or else runs where the label
    /// is least certain, at most as many as the budget allows.
    ///
    /// # Errors
    /// If a run does not lie on the axes.
    pub fn next_round(&mut self) -> Result<Round, RefineError> {
        let missing = self.missing();
        if !missing.is_empty() {
            return Ok(Round::Runs(missing));
        }
        if self.runs.len() >= self.settings.budget {
            return Ok(Round::Finished(Finish::Budget));
        }
        self.map()?;
        let map = self.map.as_ref().ok_or_else(RefineError::no_runs)?;
        if is_narrow(&self.lattice, &self.settings, map) {
            return Ok(Round::Finished(Finish::Width));
        }
        let round = self.uncertain(map);
        Ok(match round.is_empty() {
            true => Round::Finished(Finish::Complete),
            false => Round::Runs(round),
        })
    }

    /// The places.
    pub fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    /// The settings.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The runs so far and their labels.
    pub fn runs(&self) -> &Observations {
        &self.runs
    }

    /// The probabilities learnt from the runs so far.
    ///
    /// # Errors
    /// If there are no runs, or if one does not lie on the axes.
    pub fn map(&mut self) -> Result<&ProbabilityMap, RefineError> {
        let map = match self.map.take() {
            Some(map) => map,
            None => probabilities(&self.lattice, &self.runs, &self.settings)?,
        };
        Ok(self.map.insert(map))
    }

    /// Runs of the coarse grid that have no label, as many as the budget allows.
    fn missing(&self) -> Vec<Trial> {
        let mut missing = start(&self.lattice, &self.settings);
        missing.retain(|run| self.runs.label(run).is_none());
        missing.truncate(self.settings.budget.saturating_sub(self.runs.len()));
        missing
    }

    /// Runs where the label is least certain, with some far from all runs among them.
    fn uncertain(&self, map: &ProbabilityMap) -> Vec<Trial> {
        let Self {
            lattice,
            settings,
            runs,
            ..
        } = self;
        let mut round = Vec::new();
        let mut candidates = CandidatePlaces::new(lattice, runs, map, settings);
        let after_start = runs.len().saturating_sub(start(lattice, settings).len());
        let left = settings.budget.saturating_sub(runs.len());
        for number in after_start..after_start + settings.round.min(left) {
            // A share of the runs: those at which the product passes a whole number.
            let passed = |number: usize| libm::floor(number as f64 * settings.exploring + 1e-9);
            let place = match passed(number + 1) > passed(number) {
                true => candidates.farthest().or_else(|| candidates.wanted()),
                false => candidates.wanted(),
            };
            let Some(place) = place else { break };
            round.push(candidates.take(place));
        }
        round
    }
}

/// Whether all borders are as narrow as wanted. Without any border, a second label may still be
/// hidden, so runs continue.
fn is_narrow(lattice: &Lattice, settings: &Settings, map: &ProbabilityMap) -> bool {
    let Some(wanted) = settings.width else {
        return false;
    };
    let widths = widths(lattice, map);
    !widths.is_empty() && widths.iter().all(|width| width.mean <= wanted)
}
