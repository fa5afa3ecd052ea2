//! The state of a silo: what its sieves say together.

mod arching;
mod emptied;
mod flowing;
mod order;
mod outflow;
mod packing;
#[cfg(test)]
mod synthetic;

pub use arching::ArchingSieve;
pub use emptied::EmptiedSieve;
pub use flowing::FlowingSieve;
pub use order::SiloOrder;
pub use packing::packing_fraction;

use super::run::check_lengths;
use super::{ClassifyError, Label, Sieves};
use crate::record::RunRecord;
use outflow::Outflow;
use serde::{Deserialize, Serialize};

/// What is measured of a run of a silo besides its label. Nothing is measured on an unstable run,
/// whose numbers mean nothing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SiloMeasures {
    /// How clearly each sieve decided.
    pub evidence: SiloEvidence,
    /// Continuous measures besides the label.
    pub order: SiloOrder,
}

/// How clearly each sieve of a silo decided, whichever of them gave the label.
///
/// A sieve says yes exactly when its margin is zero or more. All fields are empty in a run whose
/// door did not open.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SiloEvidence {
    /// Share of the grains that left, less the threshold.
    pub emptied_margin: Option<f64>,
    /// Time without an outflow (s): from the last grain that left, or from the opening of the door if
    /// none did, to the end of the run. A run that ended because all grains were at rest would have
    /// gone on so to its duration, and has one window at least.
    pub arching_pause: Option<f64>,
    /// That time over the window, less 1.
    pub arching_margin: Option<f64>,
    /// Number of grains over the opening at the end; empty in a scene whose geometry has no door to
    /// tell where that is. Without any nothing blocks it, and what is left lies beside it.
    pub over_opening: Option<f64>,
    /// Number of grains that left in the last window.
    pub flowing_count: Option<f64>,
    /// That number over the threshold, less 1.
    pub flowing_margin: Option<f64>,
}

/// Labels a run that no guard ended: the first of emptied, arching, flowing, unsettled that applies.
pub(super) fn judge(
    record: &RunRecord,
    sieves: &Sieves,
) -> Result<(Label, SiloMeasures), ClassifyError> {
    check_lengths(record)?;
    let run = Outflow::new(record)?;
    let evidence = SiloEvidence {
        emptied_margin: sieves.emptied.margin(&run),
        arching_pause: sieves.arching.pause(&run),
        arching_margin: sieves.arching.margin(&run),
        over_opening: run.over_opening(),
        flowing_count: sieves.flowing.count(&run),
        flowing_margin: sieves.flowing.margin(&run),
    };
    let yes = |margin: Option<f64>| margin.is_some_and(|margin| margin >= 0.0);
    // What could leave has left.
    let drained = yes(evidence.arching_margin) && evidence.over_opening == Some(0.0);
    let label = if yes(evidence.emptied_margin) || drained {
        Label::Emptied
    } else if yes(evidence.arching_margin) {
        Label::Arching
    } else if yes(evidence.flowing_margin) {
        Label::Flowing
    } else {
        Label::Unsettled
    };
    let order = SiloOrder::measure(&run, &sieves.emptied);
    Ok((label, SiloMeasures { evidence, order }))
}
