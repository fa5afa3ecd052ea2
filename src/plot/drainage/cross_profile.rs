//! The velocity through the depth of a box (Rycroft, Wong and Bazant, 2010, figure 8).

use super::overlay::{self, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::compare::cross_profile;
use crate::measure::ProfilePoint;

/// The velocity through the depth.
pub(super) static CROSS_PROFILE: Overlay = Overlay {
    name: "cross-profile",
    description: "downward velocity through the depth, from wall to wall",
    labels: [
        "place along the depth $y$ / $d$",
        "downward velocity over its mean $v_z$ / $V_z$",
    ],
    panels: &[OverlayPanel {
        head: "",
        x: None,
        y: PanelScale::FromZero,
    }],
    note: "Of the middle 40 % of the width, at 45 to 64 % of the height at the start. Bars: 95 %.",
    lines,
    guides: overlay::none,
};

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let diameter = drainage.filled_box.diameter;
    let values = cross_profile(drainage).normalized();
    let point = |it: &ProfilePoint| (it.place / diameter, it.value.value);
    RunLines {
        curves: vec![RunCurve {
            points: values.iter().map(point).collect(),
            half_widths: values.iter().map(|it| it.value.half_width).collect(),
        }],
        word: None,
    }
}
