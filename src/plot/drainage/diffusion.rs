//! How far spheres stray from the mean flow, over the distance that they drop.

use super::overlay::{Guide, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::compare::spreading;
use crate::spot::voids::ROW_HEIGHT;

/// How far spheres stray from the mean flow.
pub(super) static DIFFUSION: Overlay = Overlay {
    name: "diffusion",
    description: "mean square displacement about the mean flow, over the distance dropped",
    labels: [
        "mean distance dropped over diameter",
        "mean square displacement / $d$²",
    ],
    panels: &[
        OverlayPanel {
            head: "across the flow, along x",
            x: None,
            y: PanelScale::Decades,
        },
        OverlayPanel {
            head: "along the flow",
            x: None,
            y: PanelScale::Decades,
        },
    ],
    note: "Of the spheres that start in the middle 40 % of the width at 30 to 80 % of the height; \
           about a mean flow that is linear in cells of two diameters. Pe = $V$ $d$ / $D$ across, \
           of the longest distance that is measured eight times, with its 95 % interval. Voids on \
           a lattice (Caram and Hong, 1991) move grains by ± $d$/2 in rows of √3/2 $d$.",
    lines,
    guides,
};

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let diameter = drainage.filled_box.diameter;
    let spreading = spreading(drainage);
    let curve = |axis: usize| {
        let points = spreading.points.iter();
        let point = |it: &[f64; 3]| (it[0] / diameter, it[axis] / (diameter * diameter));
        RunCurve::through(points.map(point).collect())
    };
    let word = spreading
        .peclet
        .map(|[across, _]| format!("Pe = {:.0} ± {:.0}", across.value, across.half_width));
    RunLines {
        curves: vec![curve(1), curve(2)],
        word,
    }
}

/// What voids make: a mean square displacement of d²/4 in a row.
fn guides(drainage: &MeasuredDrainage<'_>) -> Vec<Guide> {
    let diameter = drainage.filled_box.diameter;
    let dropped = spreading(drainage).points;
    let dropped = dropped.iter().map(|it| it[0] / diameter);
    let points = dropped.map(|it| (it, 0.25 / ROW_HEIGHT * it)).collect();
    vec![Guide {
        name: "voids on a lattice, Pe = 6.9",
        points,
    }]
}
