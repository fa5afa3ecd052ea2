//! How many neighbours spheres keep on their way down.

use super::overlay::{self, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::measure::NeighbourRetention;

/// How many neighbours spheres keep.
pub(super) static RETENTION: Overlay = Overlay {
    name: "retention",
    description: "share of the neighbours that spheres keep, over the distance dropped",
    labels: ["distance dropped over diameter", "share of neighbours kept"],
    panels: &[OverlayPanel {
        head: "",
        x: None,
        y: PanelScale::FromZero,
    }],
    note: "Neighbours are nearer than 1.3 diameters. Of the spheres that start in the middle 60 % \
           of the width above 14 % of the height, at all later times.",
    lines,
    guides: overlay::none,
};

/// Largest distance of a neighbour, in diameters.
const CUTOFF: f64 = 1.3;
/// Width of the bins of the distance dropped, in diameters.
const WIDTH: f64 = 2.0;
/// Fewest neighbours at the start of a bin that counts.
const FEWEST: f64 = 200.0;

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let diameter = drainage.filled_box.diameter;
    let region = drainage.filled_box.part(0.6, [0.14, 1.0]);
    let retention = NeighbourRetention::new(drainage.start(), &region, CUTOFF * diameter);
    // By bins of the distance dropped: neighbours at the start, and those that are kept.
    let mut bins: Vec<[f64; 2]> = Vec::new();
    for state in &drainage.states()[1..] {
        for kept in retention.by_drop(state, WIDTH * diameter) {
            let bin = (kept.drop / (WIDTH * diameter)).max(0.0) as usize;
            if bins.len() <= bin {
                bins.resize(bin + 1, [0.0; 2]);
            }
            let neighbours = kept.neighbours as f64;
            bins[bin][0] += neighbours;
            bins[bin][1] += kept.share * neighbours;
        }
    }
    let counted = bins.into_iter().enumerate();
    let counted = counted.filter(|(_, [neighbours, _])| *neighbours >= FEWEST);
    let points = counted.map(|(bin, [all, kept])| ((bin as f64 + 0.5) * WIDTH, kept / all));
    RunLines {
        curves: vec![RunCurve::through(points.collect())],
        word: None,
    }
}
