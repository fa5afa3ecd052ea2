//! Drainage of a box through an opening in its floor: what leaves, and what stays in the corners.

mod blocked;
mod drained;
mod order;
mod run;
mod stagnant;
#[cfg(test)]
mod tests;

pub use blocked::BlockedSieve;
pub use drained::DrainedSieve;
pub use stagnant::StagnantSieve;

use super::lengths::check_lengths;
use super::{ClassifyError, Family, Label, Sieves};
use crate::record::RunRecord;
use crate::scene::{Scene, Tank};
use blocked::BlockedEvidence;
use drained::DrainedEvidence;
use order::DrainageOrder;
use run::Run;
use stagnant::StagnantEvidence;

/// Scenes of a box with an opening in its floor.
pub static DRAINAGE: Family = Family {
    name: "drainage",
    labels: &[
        Label::UNSTABLE,
        Label::EMPTIED,
        Label::DRAINING,
        Label::STAGNANT_CORNERS,
        Label::BLOCKED,
    ],
    sieves: &["drained", "blocked", "stagnant"],
    measures: &[
        DrainedEvidence::MEASURES,
        BlockedEvidence::MEASURES,
        StagnantEvidence::MEASURES,
        DrainageOrder::MEASURES,
    ],
    default_figures: &["phase", "outflow-rate"],
    takes: |scene| scene.tank.as_ref().and_then(Tank::opening).is_some(),
    check,
    windows: |sieves| vec![("blocked", sieves.blocked.window)],
    judge,
};

impl Label {
    /// Spheres leave when the run ends, and no corner is stagnant.
    pub const DRAINING: Self = Self::new(10, "draining", 0x3f_92_d2);
}

fn check(sieves: &Sieves, scene: &Scene) -> Result<(), ClassifyError> {
    sieves.drained.check()?;
    sieves.blocked.check(scene.time.frame_interval)?;
    sieves.stagnant.check()
}

/// The first of emptied, blocked, stagnant corners, draining that applies is the label.
fn judge(record: &RunRecord, sieves: &Sieves) -> Result<(Label, Vec<Option<f64>>), ClassifyError> {
    check_lengths(record)?;
    let run = Run::new(record);
    let drained = sieves.drained.sift(&run);
    let blocked = sieves.blocked.sift(&run);
    let stagnant = sieves.stagnant.sift(&run);
    let yes = |margin: Option<f64>| margin.is_some_and(|margin| margin >= 0.0);
    let label = if yes(drained.drained_margin) || run.nothing_can_leave() {
        Label::EMPTIED
    } else if yes(blocked.blocked_margin) {
        Label::BLOCKED
    } else if yes(stagnant.stagnant_margin) {
        Label::STAGNANT_CORNERS
    } else {
        Label::DRAINING
    };
    let order = DrainageOrder::measure(record, &run, label == Label::BLOCKED);
    let values = [
        drained.values(),
        blocked.values(),
        stagnant.values(),
        order.values(),
    ];
    Ok((label, values.concat()))
}
