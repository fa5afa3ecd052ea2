//! Drainage of a box through an opening in its floor: what leaves, and what stays in the corners.

pub(super) mod blocked;
pub(super) mod drained;
mod order;
pub(super) mod run;
pub(super) mod stagnant;
#[cfg(test)]
mod tests;

pub use blocked::BlockedSieve;
pub use drained::DrainedSieve;
pub use stagnant::StagnantSieve;

pub(super) use run::DrainageRun;

use super::lengths::check_lengths;
use super::sieve::values;
use super::sieves::DRAINAGE_SIEVES;
use super::{ClassifyError, Family, Label, Sieves};
use crate::record::RunRecord;
use crate::scene::Tank;
use order::DrainageOrder;

/// Scenes of a box with an opening in its floor.
pub static DRAINAGE: Family = Family {
    name: "drainage",
    sieves: DRAINAGE_SIEVES,
    without_sieve: &[Label::UNSTABLE, Label::DRAINING],
    order: DrainageOrder::MEASURES,
    default_figures: &["phase", "outflow-rate"],
    takes: |scene| scene.tank.as_ref().and_then(Tank::opening).is_some(),
    check: |_, _| Ok(()),
    judge,
    rules: None,
};

impl Label {
    /// Spheres leave when the run ends, and no corner is stagnant.
    pub const DRAINING: Self = Self::new(10, "draining", 0x3f_92_d2);
}

/// The first sieve that says yes decides.
fn judge(record: &RunRecord, sieves: &Sieves) -> Result<(Label, Vec<Option<f64>>), ClassifyError> {
    check_lengths(record)?;
    let mut run = DrainageRun::new(record);
    let sifted = sieves.sift_drainage(&mut run);
    let label = sifted.iter().find_map(|it| it.label);
    let label = label.unwrap_or(Label::DRAINING);
    let order = DrainageOrder::measure(record, &run, label == Label::BLOCKED);
    Ok((label, values(sifted, order.values())))
}
