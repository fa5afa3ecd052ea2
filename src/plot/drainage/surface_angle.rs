//! The angle of the free surface over time (Rycroft, Wong and Bazant, 2010, figure 7).

use super::overlay::{self, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::measure::{Centres, surface_angle};

/// The angle of the free surface over time.
pub(super) static SURFACE_ANGLE: Overlay = Overlay {
    name: "surface-angle",
    description: "angle of the free surface over time, of snapshots",
    labels: ["time (s)", "angle of the free surface (°)"],
    panels: &[OverlayPanel {
        head: "",
        x: None,
        y: PanelScale::Free,
    }],
    note: "Regression of the highest centres in columns of 2.5 diameters (Rycroft, Wong and \
           Bazant, 2010); positive if the surface rises to the walls.",
    lines,
    guides: overlay::none,
};

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let (diameter, half_width) = (drainage.filled_box.diameter, drainage.filled_box.half_width);
    let points = drainage.states().iter().filter_map(|state| {
        let angle = surface_angle(&Centres::of(state), diameter, half_width)?;
        Some((drainage.since_opening(state.time), angle.to_degrees()))
    });
    RunLines {
        curves: vec![RunCurve::through(points.collect())],
        word: None,
    }
}
