//! Rounds of runs.

use super::choice::{Candidates, Choice};
use super::observations::Training;
use super::{Lattice, Observations, ProbabilityMap, RefineError, Run, Settings, widths};
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
    let fitted = settings.model.model().fit(&training);
    Ok(ProbabilityMap::new(lattice, training.codes(), &*fitted))
}

/// The runs of the coarse grid, in the order of the lattice: values of each axis at equal steps of
/// its list, the first and the last among them; the middle value where one is asked for.
pub fn start(lattice: &Lattice, settings: &Settings) -> Vec<Run> {
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
    let runs = places.map(|place| Run {
        values: lattice.values(place),
        seed: settings.first_seed,
    });
    runs.collect()
}

/// The runs to make next: those of the coarse grid that are missing, or else a round. Runs beyond
/// the budget are left out. There are none when refining has [finished].
///
/// The runs depend on the axes, the settings, and the labels so far. Ask for a round when all runs
/// of the one before have labels: the rounds are then the same for any number of workers. After a
/// stop, [`resume`] tells the runs that the round before it lacks.
///
/// # Errors
/// If settings are out of their ranges, or if a run does not lie on the axes.
pub fn next_round(
    lattice: &Lattice,
    runs: &Observations,
    settings: &Settings,
) -> Result<Vec<Run>, RefineError> {
    settings.check(lattice.axes().len())?;
    let missing = missing(lattice, runs, settings);
    if !missing.is_empty() || runs.len() >= settings.budget {
        return Ok(missing);
    }
    let map = probabilities(lattice, runs, settings)?;
    Ok(round_of(lattice, runs, settings, &map))
}

/// The runs that are missing in the first round that is not complete, after a stop: all rounds are
/// chosen again from their labels among the `known` runs. There are none when refining has
/// [finished]. When they have been made, rounds go on from all runs with [`next_round`].
///
/// Runs that refining has not chosen change nothing here, but do change what [`next_round`]
/// chooses. It takes as long as all rounds before, without the runs.
///
/// # Errors
/// If settings are out of their ranges.
pub fn resume(
    lattice: &Lattice,
    known: &Observations,
    settings: &Settings,
) -> Result<Vec<Run>, RefineError> {
    let mut runs = Observations::new();
    loop {
        let mut round = next_round(lattice, &runs, settings)?;
        let is_finished = round.is_empty();
        let mut missing = Vec::new();
        for run in round.drain(..) {
            match known.label(&run) {
                Some(label) => runs.add(run, label)?,
                None => missing.push(run),
            }
        }
        if is_finished || !missing.is_empty() {
            return Ok(missing);
        }
    }
}

/// Why refining is finished, or none if it goes on.
///
/// # Errors
/// If settings are out of their ranges, or if a run does not lie on the axes.
pub fn finished(
    lattice: &Lattice,
    runs: &Observations,
    settings: &Settings,
) -> Result<Option<Finish>, RefineError> {
    settings.check(lattice.axes().len())?;
    if runs.len() >= settings.budget {
        return Ok(Some(Finish::Budget));
    }
    if !missing(lattice, runs, settings).is_empty() {
        return Ok(None);
    }
    let map = probabilities(lattice, runs, settings)?;
    if is_narrow(lattice, settings, &map) {
        return Ok(Some(Finish::Width));
    }
    let round = round_of(lattice, runs, settings, &map);
    Ok(round.is_empty().then_some(Finish::Complete))
}

/// Runs of the coarse grid that have no label, as many as the budget allows.
pub fn missing(lattice: &Lattice, runs: &Observations, settings: &Settings) -> Vec<Run> {
    let mut missing = start(lattice, settings);
    missing.retain(|run| runs.label(run).is_none());
    missing.truncate(settings.budget.saturating_sub(runs.len()));
    missing
}

/// The round after the coarse grid, with the map that has been learnt from all runs: what
/// [`next_round`] gives when no run of the coarse grid is missing.
pub fn round_of(
    lattice: &Lattice,
    runs: &Observations,
    settings: &Settings,
    map: &ProbabilityMap,
) -> Vec<Run> {
    let mut round = Vec::new();
    if is_narrow(lattice, settings, map) {
        return round;
    }
    let mut candidates = Candidates::new(lattice, runs, map, settings);
    let after_start = runs.len().saturating_sub(start(lattice, settings).len());
    let left = settings.budget.saturating_sub(runs.len());
    for number in after_start..after_start + settings.round.min(left) {
        // A share of the numbers: those at which the product passes a whole number.
        let passed = |number: usize| libm::floor(number as f64 * settings.exploring + 1e-9);
        let explores = passed(number + 1) > passed(number);
        let place = if explores || settings.choice == Choice::Spread {
            candidates.farthest().or_else(|| candidates.wanted())
        } else {
            candidates.wanted()
        };
        let Some(place) = place else { break };
        round.push(candidates.take(place));
    }
    round
}

/// Whether all borders are as narrow as wanted. Without a border the map is not known to have one
/// label only, so that runs go on.
pub fn is_narrow(lattice: &Lattice, settings: &Settings, map: &ProbabilityMap) -> bool {
    let Some(wanted) = settings.width else {
        return false;
    };
    let widths = widths(lattice, map);
    !widths.is_empty() && widths.iter().all(|width| width.mean <= wanted)
}
