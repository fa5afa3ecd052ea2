//! How many spheres have left, over time.

use super::overlay::{self, Frame, Scale};
use super::{Curve, Drainage, Lines, Overlay};
use crate::measure::outflow_rate;
use crate::plot::numbers;

/// How many spheres have left.
pub(super) static OUTFLOW: Overlay = Overlay {
    name: "outflow",
    description: "spheres that have left over time, and their rate",
    labels: ["time (s)", "spheres that have left"],
    panels: &[Frame {
        head: "",
        x: None,
        y: Scale::FromZero,
    }],
    note: "Rates with 95 % intervals (jackknife over blocks of time).",
    lines,
    guides: overlay::none,
};

fn lines(drainage: &Drainage<'_>) -> Lines {
    let [time, left] = drainage.left();
    let rate = outflow_rate(&time, &left, drainage.times);
    let word = rate.map(|rate| {
        let [value, half] = [rate.value, rate.half_width].map(|it| numbers::rounded(it, 3));
        format!("{value} ± {half} per {}", drainage.units().of_time())
    });
    let points = time.into_iter().zip(left);
    Lines {
        curves: vec![Curve::through(points.collect())],
        word,
    }
}
