//! How far coloured layers have mixed, over time.

use super::overlay::{Guide, OverlayPanel, PanelScale};
use super::{MeasuredDrainage, Overlay, RunCurve, RunLines};
use crate::compare::{mixing, mixing_of_kinematic_flow, mixing_of_voids};

/// How far coloured layers have mixed.
pub(super) static MIXING: Overlay = Overlay {
    name: "mixing",
    description: "Lacey's index of mixing of layers of ten diameters, over time",
    labels: ["time (s)", "index of mixing $M$"],
    panels: &[OverlayPanel {
        head: "",
        x: None,
        y: PanelScale::FromZero,
    }],
    note: "Lacey (1954), in cells of about 2.5 diameters that span the depth, of the part below \
           half of the height at the start: 0 unmixed, 1 at random. Layers that bend through \
           cells count as mixed: as much as in the kinematic flow (Nedderman and Tüzün, 1979), in \
           which grains do not stray, with the first run's b. Voids on a lattice: Caram and Hong \
           (1991). In both as large a share has left as in the first run.",
    lines,
    guides,
};

fn lines(drainage: &MeasuredDrainage<'_>) -> RunLines {
    let states = drainage.states().iter();
    let points = states
        .filter_map(|state| Some((drainage.since_opening(state.time), mixing(drainage, state)?)));
    RunLines {
        curves: vec![RunCurve::through(points.collect())],
        word: None,
    }
}

fn guides(drainage: &MeasuredDrainage<'_>) -> Vec<Guide> {
    let guide = |name, points: Option<_>| points.map(|points| Guide { name, points });
    let voids = guide("voids on a lattice", mixing_of_voids(drainage));
    let flow = guide("kinematic flow", mixing_of_kinematic_flow(drainage));
    voids.into_iter().chain(flow).collect()
}
