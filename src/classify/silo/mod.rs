//! Silos: grains that leave (Remmers, 2009). Their sieves look at what leaves once the door is
//! open.

mod arching;
mod emptied;
mod flowing;
mod order;
mod outflow;
#[cfg(test)]
mod synthetic;

pub use arching::ArchingSieve;
pub use emptied::EmptiedSieve;
pub use flowing::FlowingSieve;

use super::lengths::check_lengths;
use super::{ClassifyError, Family, Label, Sieves};
use crate::record::RunRecord;
use crate::scene::{Scene, Tank};
use arching::ArchingEvidence;
use emptied::EmptiedEvidence;
use flowing::FlowingEvidence;
use order::SiloOrder;
use outflow::Outflow;

/// Scenes with a door or an outlet, but no opening in the floor of a tank.
pub static SILO: Family = Family {
    name: "silo",
    labels: &[
        Label::UNSTABLE,
        Label::UNSETTLED,
        Label::ARCHING,
        Label::FLOWING,
        Label::EMPTIED,
    ],
    sieves: &["emptied", "arching", "flowing"],
    measures: &[
        EmptiedEvidence::MEASURES,
        ArchingEvidence::MEASURES,
        FlowingEvidence::MEASURES,
        SiloOrder::MEASURES,
    ],
    default_figures: &["phase", "discharge-rate"],
    takes: |scene| {
        let is_drainage = scene.tank.as_ref().is_some_and(Tank::has_opening);
        !is_drainage && (scene.dem.door.is_some() || scene.dem.outlet.is_some())
    },
    check,
    // These sieves take what there is of a window.
    windows: |_| Vec::new(),
    judge,
};

fn check(sieves: &Sieves, scene: &Scene) -> Result<(), ClassifyError> {
    let interval = scene.time.frame_interval;
    sieves.emptied.check()?;
    sieves.arching.check(interval)?;
    sieves.flowing.check(interval)?;
    let outlet = scene.dem.outlet.as_ref();
    outlet.map(|_| ()).ok_or(ClassifyError::NoOutlet)
}

/// The first of emptied, arching, flowing, unsettled that applies is the label.
fn judge(record: &RunRecord, sieves: &Sieves) -> Result<(Label, Vec<Option<f64>>), ClassifyError> {
    check_lengths(record)?;
    let run = Outflow::new(record)?;
    let emptied = sieves.emptied.sift(&run);
    let arching = sieves.arching.sift(&run);
    let flowing = sieves.flowing.sift(&run);
    let yes = |margin: Option<f64>| margin.is_some_and(|margin| margin >= 0.0);
    let has_stopped = yes(arching.arching_margin);
    // What could leave has left.
    let is_drained = has_stopped && arching.over_opening == Some(0.0);
    let label = if yes(emptied.emptied_margin) || is_drained {
        Label::EMPTIED
    } else if has_stopped {
        Label::ARCHING
    } else if yes(flowing.flowing_margin) {
        Label::FLOWING
    } else {
        Label::UNSETTLED
    };
    let order = SiloOrder::measure(&run, &sieves.emptied);
    let values = [
        emptied.values(),
        arching.values(),
        flowing.values(),
        order.values(),
    ];
    Ok((label, values.concat()))
}
