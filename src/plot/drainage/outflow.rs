//! How many spheres have left, over time.

use super::overlay::{self, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::measure::outflow_rate;
use crate::plot::numbers;

/// How many spheres have left.
pub(super) static OUTFLOW: Overlay = Overlay {
    name: "outflow",
    description: "spheres that have left over time, and their rate",
    labels: ["time (s)", "spheres that have left"],
    panels: &[OverlayPanel {
        head: "",
        x: None,
        y: PanelScale::FromZero,
    }],
    note: "Rates with 95 % intervals (jackknife over blocks of time).",
    lines,
    guides: overlay::none,
};

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let [time, left] = drainage.left();
    let rate = outflow_rate(&time, &left, drainage.times);
    let word = rate.map(|rate| {
        let [value, half] = [rate.value, rate.half_width].map(|it| numbers::rounded(it, 3));
        format!("{value} ± {half} per {}", drainage.units().of_time())
    });
    let points = time.into_iter().zip(left);
    RunLines {
        curves: vec![RunCurve::through(points.collect())],
        word,
    }
}
