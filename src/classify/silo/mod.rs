//! Silos: grains that leave (Remmers, 2009). Their sieves look at what leaves once the door is
//! open.

pub(super) mod arching;
pub(super) mod emptied;
pub(super) mod flowing;
mod order;
pub(super) mod outflow;
#[cfg(test)]
mod synthetic;

pub use arching::ArchingSieve;
pub use emptied::EmptiedSieve;
pub use flowing::FlowingSieve;

pub(super) use outflow::Outflow;

use super::lengths::check_lengths;
use super::sieve::values;
use super::sieves::SILO_SIEVES;
use super::{ClassifyError, Family, Label, Sieves};
use crate::record::RunRecord;
use crate::scene::Tank;
use order::SiloOrder;

/// Scenes with a door or an outlet, but no opening in the floor of a tank.
pub static SILO: Family = Family {
    name: "silo",
    sieves: SILO_SIEVES,
    without_sieve: &[Label::UNSTABLE, Label::UNSETTLED],
    order: SiloOrder::MEASURES,
    default_figures: &["phase", "discharge-rate"],
    takes: |scene| {
        let is_drainage = scene.tank.as_ref().is_some_and(Tank::has_opening);
        !is_drainage && (scene.dem.door.is_some() || scene.dem.outlet.is_some())
    },
    check: |_, scene| match scene.dem.outlet {
        Some(_) => Ok(()),
        None => Err(ClassifyError::NoOutlet),
    },
    judge,
    rules: None,
};

/// The first sieve that says yes decides.
fn judge(record: &RunRecord, sieves: &Sieves) -> Result<(Label, Vec<Option<f64>>), ClassifyError> {
    check_lengths(record)?;
    let mut run = Outflow::new(record)?;
    run.is_drained = sieves.arching.is_drained(&run);
    let sifted = sieves.sift_silo(&mut run);
    let label = sifted.iter().find_map(|it| it.label);
    let order = SiloOrder::measure(&run, &sieves.emptied);
    Ok((
        label.unwrap_or(Label::UNSETTLED),
        values(sifted, order.values()),
    ))
}
