//! Replays: refining with labels from an oracle.

use crate::refine::{
    Code, Lattice, Observations, ProbabilityMap, RefineError, Run, Settings, missing,
    probabilities, round_of,
};

/// What knows the labels of all runs.
pub trait Oracle {
    /// The axes and places.
    fn lattice(&self) -> &Lattice;

    /// The label of a run.
    fn label(&self, run: &Run) -> Code;
}

/// Makes rounds as [`next_round`](crate::refine::next_round) does, until none is left, and shows
/// the runs and their map after each.
///
/// # Errors
/// If settings are out of their ranges.
pub fn replay(
    oracle: &dyn Oracle,
    settings: &Settings,
    mut after: impl FnMut(&Observations, &ProbabilityMap),
) -> Result<Observations, RefineError> {
    let lattice = oracle.lattice();
    settings.check(lattice.axes().len())?;
    let mut runs = Observations::new();
    let mut round = missing(lattice, &runs, settings);
    while !round.is_empty() {
        for run in round {
            let label = oracle.label(&run);
            runs.add(run, label)?;
        }
        let map = probabilities(lattice, &runs, settings)?;
        after(&runs, &map);
        round = round_of(lattice, &runs, settings, &map);
    }
    Ok(runs)
}
