//! Overlaps against processor time (Rycroft, Wong and Bazant, 2010, figures 9 and 12).

use super::overlay::{self, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::compare::badness_of;
use crate::plot::numbers;

/// Overlaps against processor time: what a coarser relaxation saves.
pub(super) static BADNESS: Overlay = Overlay {
    name: "badness",
    description: "overlaps of the spheres against processor time, one point per run",
    labels: ["processor time of the run (s)", "packing badness $B$"],
    panels: &[OverlayPanel {
        head: "",
        x: None,
        y: PanelScale::Decades,
    }],
    note: "Sum of overlaps over diameters, of pairs, per sphere in the middle of the lower half. \
           Bars: 95 % over ten states.",
    lines,
    guides: overlay::none,
};

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let seconds = drainage.record.cpu_seconds;
    // Files of other programs do not say what their runs took.
    let badness = badness_of(drainage).filter(|_| seconds.is_finite());
    let curve = badness.map(|badness| RunCurve {
        points: vec![(seconds, badness.value)],
        half_widths: vec![badness.half_width],
    });
    let word = curve.as_ref().map(|it| {
        let [seconds, badness] = [it.points[0].0, it.points[0].1].map(|it| numbers::rounded(it, 3));
        format!("{seconds} s, $B$ = {badness}")
    });
    RunLines {
        curves: vec![curve.unwrap_or_default()],
        word,
    }
}
