//! The radial distribution function (Rycroft, Wong and Bazant, 2010, figure 11).

use super::overlay::{self, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::measure::{Centres, RadialDistribution};

/// The radial distribution function while spheres leave, and its tail of overlaps.
pub(super) static RADIAL_DISTRIBUTION: Overlay = Overlay {
    name: "radial-distribution",
    description: "radial distribution function in the middle, while spheres leave",
    labels: ["distance over diameter $r$ / $d$", "$g$($r$)"],
    panels: &[
        OverlayPanel {
            head: "",
            x: Some((0.0, FARTHEST)),
            y: PanelScale::FromZero,
        },
        OverlayPanel {
            head: "small distances",
            x: Some((0.0, 1.5)),
            y: PanelScale::Logarithmic,
        },
    ],
    note: "Of the spheres in the middle of the lower half: 60 % of the width, 14 to 41 % of the \
           height at the start.",
    lines,
    guides: overlay::none,
};

/// Farthest distance, in diameters, and bins up to it.
const FARTHEST: f64 = 4.0;
const BINS: usize = 160;

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let (diameter, region) = (drainage.filled_box.diameter, drainage.filled_box.middle());
    let mut distribution = RadialDistribution::new(FARTHEST * diameter, BINS);
    for state in drainage.flow() {
        distribution.add(&Centres::of(state), &region);
    }
    let values = distribution.values().into_iter();
    let curve = RunCurve::through(values.map(|[r, g]| (r / diameter, g)).collect());
    RunLines {
        curves: vec![curve.clone(), curve],
        word: None,
    }
}
