//! How long spheres stay, by where they start.

use super::overlay::{self, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::measure::Residence;

/// How long spheres stay.
pub(super) static RESIDENCE: Overlay = Overlay {
    name: "residence",
    description: "median time until spheres leave, over the height at which they start",
    labels: [
        "height at the start over diameter",
        "time until half have left (s)",
    ],
    panels: &[
        OverlayPanel {
            head: "above the opening",
            x: None,
            y: PanelScale::FromZero,
        },
        OverlayPanel {
            head: "halfway to the side walls",
            x: None,
            y: PanelScale::FromZero,
        },
        OverlayPanel {
            head: "at the side walls",
            x: None,
            y: PanelScale::FromZero,
        },
    ],
    note: "Of the inner, the third and the outer of five parts of the half width. A line ends \
           where less than half have left; a panel without lines is where they have left nowhere.",
    lines,
    guides: overlay::none,
};

/// Parts of the half width, and those that are shown.
const PARTS: usize = 5;
const SHOWN: [usize; 3] = [0, 2, 4];
/// Height of a bin, in diameters.
const HEIGHT: f64 = 4.0;

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let (floor, diameter) = (drainage.filled_box.floor, drainage.filled_box.diameter);
    let mut residence = Residence::new(drainage.start());
    for state in &drainage.states()[1..] {
        residence.add(state);
    }
    let heights = (drainage.filled_box.filled / (HEIGHT * diameter))
        .round()
        .max(1.0) as usize;
    let range = [floor, floor + drainage.filled_box.filled];
    let times = residence.by_start(drainage.filled_box.half_width, range, [PARTS, heights]);
    let part = |distance: f64| (distance / drainage.filled_box.half_width * PARTS as f64) as usize;
    let curve = |shown: usize| {
        let points = times.iter().filter(|it| part(it.distance) == shown);
        let points =
            points.filter_map(|it| Some(((it.height - floor) / diameter, it.quartiles[1]?)));
        RunCurve::through(points.collect())
    };
    RunLines {
        curves: SHOWN.map(curve).to_vec(),
        word: None,
    }
}
