//! Drainage of a box through an opening in its floor: what leaves, and what stays in the corners.

pub(super) mod blocked;
mod order;
pub(super) mod run;
#[cfg(test)]
mod tests;

pub use blocked::BlockedSieve;

pub(super) use run::DrainageRun;

use super::lengths::check_lengths;
use super::rules::rule;
use super::sieve::values;
use super::sieves::DRAINAGE_SIEVES;
use super::{ClassifyError, Family, Label, Sieves};
use crate::record::RunRecord;
use crate::scene::Tank;
use order::DrainageOrder;

/// Scenes of a box with an opening in its floor.
pub static DRAINAGE: Family = Family {
    name: "drainage",
    rules: &[
        rule!(
            Label::EMPTIED,
            "drained",
            "left_share >= 0.95 or spheres_over_opening == 0"
        ),
        rule!(
            Label::STAGNANT_CORNERS,
            "stagnant",
            "blocked_count > 0 and stagnant_height >= 6 * spheres.radius"
        ),
    ],
    sieves: DRAINAGE_SIEVES,
    without_sieve: &[Label::UNSTABLE, Label::DRAINING],
    order: DrainageOrder::MEASURES,
    default_figures: &["phase", "outflow-rate"],
    takes: |scene| scene.tank.as_ref().and_then(Tank::opening).is_some(),
    check: |_, _| Ok(()),
    judge,
    measured: &[],
    base: None,
};

impl Label {
    /// Spheres leave, and others at the side walls, up to three diameters above the floor, have not
    /// sunk.
    pub const STAGNANT_CORNERS: Self = Self::new(11, "stagnant-corners", 0x98_2c_74);

    /// Spheres leave when the run ends, and no corner is stagnant.
    pub const DRAINING: Self = Self::new(10, "draining", 0x3f_92_d2);
}

/// Blocked or draining: rules decide before.
fn judge(record: &RunRecord, sieves: &Sieves) -> Result<(Label, Vec<Option<f64>>), ClassifyError> {
    check_lengths(record)?;
    let mut run = DrainageRun::new(record);
    let sifted = sieves.sift_drainage(&mut run);
    let label = sifted.iter().find_map(|it| it.label);
    let label = label.unwrap_or(Label::DRAINING);
    let order = DrainageOrder::measure(record, &run, label == Label::BLOCKED);
    Ok((label, values(sifted, order.values())))
}
