//! The distribution of angles between bonds.

use super::overlay::{self, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::measure::{BondAngles, Centres};
use std::f64::consts::PI;

/// The distribution of angles between bonds.
pub(super) static BOND_ANGLES: Overlay = Overlay {
    name: "bond-angles",
    description: "distribution of the angles between neighbours in the middle",
    labels: ["angle $θ$ (°)", "$g_3$($θ$) (1/rad)"],
    panels: &[OverlayPanel {
        head: "",
        x: Some((0.0, 180.0)),
        y: PanelScale::FromZero,
    }],
    note: "Angles at a sphere between two neighbours nearer than 1.3 diameters. Region as of the \
           radial distribution.",
    lines,
    guides: overlay::none,
};

/// Largest distance of a neighbour, in diameters.
const CUTOFF: f64 = 1.3;
/// Bins of two degrees.
const BINS: usize = 90;

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let region = drainage.filled_box.middle();
    let mut angles = BondAngles::new(CUTOFF * drainage.filled_box.diameter, BINS);
    for state in drainage.flow() {
        angles.add(&Centres::of(state), &region);
    }
    let values = angles.values().into_iter();
    let points = values.map(|[angle, density]| (angle * 180.0 / PI, density));
    RunLines {
        curves: vec![RunCurve::through(points.collect())],
        word: None,
    }
}
