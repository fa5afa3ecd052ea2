//! Continuous measures of a drainage.

use super::run::DrainageRun;
use crate::classify::measure::{measured, measures};
use crate::compare::{MeasuredDrainage, badness_of, mixing, packing_fraction};
use crate::measure::{Centres, surface_angle};
use crate::record::RunRecord;

/// Shares of the spheres that left until the end between which the rate is measured: not while the
/// flow begins.
const RATE_SHARES: [f64; 2] = [0.2, 1.0];

measures! {
    /// Continuous measures of a drainage.
    struct DrainageOrder {
        /// Packing fraction in the middle when the opening opened.
        start_packing_fraction: measured("packing fraction at the opening", "").part(),
        /// Spheres that left per second, from the frame by which a fifth had left of those that
        /// did. One that is blocked has none.
        outflow_rate: measured("outflow", "spheres/s"),
        /// Share of all spheres that left.
        left_share: measured("share of the spheres that left", "").share(),
        /// Height of the stagnant zone at the side walls (m).
        stagnant_height: measured("height of the stagnant zone", "m"),
        /// Slope of the free surface at the end, positive if it rises to the walls (rad).
        surface_slope: measured("angle of the free surface", "rad"),
        /// Lacey's index of mixing of layers of ten diameters at the end.
        mixing_index: measured("index of mixing of layers", "").share(),
        /// Overlaps over diameters of the pairs in the middle, per sphere.
        packing_badness: measured("packing badness", ""),
    }
}

impl DrainageOrder {
    pub(super) fn measure(record: &RunRecord, run: &DrainageRun<'_>, is_blocked: bool) -> Self {
        let drainage = MeasuredDrainage::new(record, None).ok();
        let end = run.snapshots.last().map(Centres::of);
        Self {
            start_packing_fraction: drainage
                .as_ref()
                .and_then(|it| packing_fraction(it, it.start())),
            outflow_rate: outflow_rate(run).filter(|_| !is_blocked),
            left_share: Some(run.left() / run.spheres),
            stagnant_height: run.stagnant_height(),
            surface_slope: end.and_then(|it| surface_angle(&it, run.diameter, run.half_width)),
            mixing_index: drainage
                .as_ref()
                .and_then(|it| mixing(it, it.states().last()?)),
            packing_badness: drainage.as_ref().and_then(badness_of).map(|it| it.value),
        }
    }
}

fn outflow_rate(run: &DrainageRun<'_>) -> Option<f64> {
    let (time, left) = (&run.observations.time, &run.observations.discharged);
    let [first, last] = RATE_SHARES.map(|share| {
        let wanted = share * run.left();
        left.partition_point(|it| f64::from(*it) < wanted)
    });
    let at = |frame: usize| Some((time.get(frame)?, f64::from(*left.get(frame)?)));
    let ((from, before), (to, after)) = (at(first)?, at(last)?);
    (to > from && after > before).then(|| (after - before) / (to - from))
}
