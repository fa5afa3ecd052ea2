//! Continuous measures of a drainage.

use super::run::Run;
use crate::classify::measure::{measured, measures};
use crate::measure::{Centres, surface_angle};

/// Shares of the spheres that left until the end between which the rate is measured: not while the
/// flow begins.
const RATE_SHARES: [f64; 2] = [0.2, 1.0];

measures! {
    /// Continuous measures of a drainage.
    struct DrainageOrder {
        /// Spheres that left per second, from the frame by which a fifth had left of those that
        /// did.
        outflow_rate: measured("outflow", "spheres/s"),
        /// Share of all spheres that left.
        left_share: measured("share of the spheres that left", "").share(),
        /// Height of the stagnant zone at the side walls (m).
        stagnant_height: measured("height of the stagnant zone", "m"),
        /// Slope of the free surface at the end, positive if it rises to the walls (rad).
        surface_angle: measured("angle of the free surface", "rad"),
    }
}

impl DrainageOrder {
    pub(super) fn measure(run: &Run<'_>) -> Self {
        let end = run.snapshots.last().map(Centres::of);
        Self {
            outflow_rate: outflow_rate(run),
            left_share: Some(run.left() / run.spheres),
            stagnant_height: run.stagnant_height(),
            surface_angle: end.and_then(|it| surface_angle(&it, run.diameter, run.half_width)),
        }
    }
}

fn outflow_rate(run: &Run<'_>) -> Option<f64> {
    let (time, left) = (&run.observations.time, &run.observations.discharged);
    let [first, last] = RATE_SHARES.map(|share| {
        let wanted = share * run.left();
        left.partition_point(|it| f64::from(*it) < wanted)
    });
    let at = |frame: usize| Some((time.get(frame)?, f64::from(*left.get(frame)?)));
    let ((from, before), (to, after)) = (at(first)?, at(last)?);
    (to > from && after > before).then(|| (after - before) / (to - from))
}
