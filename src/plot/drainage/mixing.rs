//! How far coloured layers have mixed, over time.

use super::overlay::{Frame, Scale};
use super::{Curve, Drainage, Lines, Overlay};
use crate::compare::mixing;

/// How far coloured layers have mixed.
pub(super) static MIXING: Overlay = Overlay {
    name: "mixing",
    description: "Lacey's index of mixing of layers of ten diameters, over time",
    labels: ["time (s)", "index of mixing $M$"],
    panels: &[Frame {
        head: "",
        x: None,
        y: Scale::FromZero,
    }],
    note: "Lacey (1954), in cells of about 2.5 diameters that span the depth, of the part below \
           half of the height at the start: 0 unmixed, 1 at random. Layers that bend through \
           cells count as mixed a little.",
    lines,
};

fn lines(drainage: &Drainage<'_>) -> Lines {
    let states = drainage.states().iter();
    let points = states.filter_map(|state| Some((state.time, mixing(drainage, state)?)));
    Lines {
        curves: vec![Curve::through(points.collect())],
        word: None,
    }
}
