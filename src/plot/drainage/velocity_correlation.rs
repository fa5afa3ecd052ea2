//! How velocities across the flow are correlated, over the distance of two spheres.

use super::overlay::{self, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::compare::{correlation_radius, velocity_correlation};
use crate::measure::ProfilePoint;

/// How velocities across the flow are correlated.
pub(super) static VELOCITY_CORRELATION: Overlay = Overlay {
    name: "velocity-correlation",
    description: "correlation of two spheres' velocities across the flow, over their distance",
    labels: [
        "distance over diameter $r$ / $d$",
        "correlation of velocities $<u_i u_j>$ / $<u²>$",
    ],
    panels: &[OverlayPanel {
        head: "",
        x: None,
        y: PanelScale::Free,
    }],
    note: "Of displacements along x between snapshots, about the mean flow, in the middle 40 % of \
           the width at 30 to 80 % of the height. R: of two spots whose common volume falls as the \
           correlation does above what all spheres share. Bars: 95 %.",
    lines,
    guides: overlay::none,
};

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let diameter = drainage.filled_box.diameter;
    let values = velocity_correlation(drainage).points();
    let point = |it: &ProfilePoint| (it.place / diameter, it.value.value);
    let radius = correlation_radius(drainage);
    let word = radius.map(|radius| {
        let [value, half] = [radius.value, radius.half_width].map(|it| it / diameter);
        match half.is_finite() {
            true => format!("$R$ = {value:.2} ± {half:.2} $d$"),
            false => format!("$R$ = {value:.2} $d$"),
        }
    });
    RunLines {
        curves: vec![RunCurve {
            points: values.iter().map(point).collect(),
            half_widths: values.iter().map(|it| it.value.half_width).collect(),
        }],
        word,
    }
}
