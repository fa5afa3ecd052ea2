//! Replays: refining with labels from an oracle.

use phase::refine::{Code, Lattice, RefineError, Round, Rounds, Settings, Trial};

/// What knows the labels of all runs.
pub(crate) trait Oracle {
    /// The axes and places.
    fn lattice(&self) -> &Lattice;

    /// The label of a run.
    fn label(&self, run: &Trial) -> Code;
}

/// Makes rounds until none is left, and shows what is known after each.
///
/// # Errors
/// If settings are out of their ranges.
pub(crate) fn replay(
    oracle: &dyn Oracle,
    settings: &Settings,
    mut after: impl FnMut(&mut Rounds) -> Result<(), RefineError>,
) -> Result<Rounds, RefineError> {
    let mut rounds = Rounds::new(oracle.lattice().clone(), settings.clone())?;
    while let Round::Runs(runs) = rounds.next_round()? {
        for run in runs {
            let label = oracle.label(&run);
            rounds.learn(run, label)?;
        }
        after(&mut rounds)?;
    }
    Ok(rounds)
}
