//! The numbers of a drainage, each with its interval.

use super::spreading::correlation_radius;
use super::{Drainage, flow_spread_of, spreading};
use crate::measure::{
    Badness, Centres, Layers, RadialDistribution, lacey_index, outflow_rate, solid_like,
    stagnant_height, surface_angle,
};
use crate::observe::Snapshot;
use crate::statistics::Estimate;

/// A number that is measured of a drainage.
pub struct Quantity {
    /// Name.
    pub name: &'static str,
    /// Unit; lengths are over the diameter of the spheres, and have none.
    pub unit: &'static str,
    /// Whether it describes the flow, so that its error counts where drainages are compared.
    pub is_of_flow: bool,
    /// Measures it, with its interval of 95 % over states or blocks of time, infinite where nothing
    /// tells its scatter. None where it is undefined.
    pub measure: fn(&Drainage<'_>) -> Option<Estimate>,
}

/// Name of the time that a run took, whose seconds are not those of its scene.
pub(super) const PROCESSOR_TIME: &str = "processor time";

/// All of them.
pub static QUANTITIES: [Quantity; 16] = [
    Quantity {
        name: "outflow",
        unit: "1/s",
        is_of_flow: true,
        measure: outflow,
    },
    Quantity {
        name: "diffusion length of the flow b / d",
        unit: "",
        is_of_flow: true,
        measure: diffusion_length,
    },
    Quantity {
        name: "height z0 / d from which the flow widens",
        unit: "",
        is_of_flow: false,
        measure: origin,
    },
    Quantity {
        name: "packing fraction at the start",
        unit: "",
        is_of_flow: false,
        measure: |drainage| exact(packing_fraction(drainage, drainage.start())),
    },
    Quantity {
        name: "packing fraction in the flow",
        unit: "",
        is_of_flow: true,
        measure: |drainage| over_states(drainage, |state| packing_fraction(drainage, state)),
    },
    Quantity {
        name: "share of spheres in crystals, in the flow",
        unit: "",
        is_of_flow: true,
        measure: |drainage| over_states(drainage, |state| solid_share(drainage, state)),
    },
    Quantity {
        name: "packing badness, of pairs",
        unit: "",
        is_of_flow: true,
        measure: badness_of,
    },
    Quantity {
        name: "packing badness, as printed",
        unit: "",
        is_of_flow: false,
        measure: |drainage| over_states(drainage, |state| badness(drainage, state).as_printed()),
    },
    Quantity {
        name: "least distance / d",
        unit: "",
        is_of_flow: false,
        measure: least_distance,
    },
    Quantity {
        name: "Peclet number across the flow",
        unit: "",
        is_of_flow: true,
        measure: |drainage| spreading(drainage).peclet.map(|it| it[0]),
    },
    Quantity {
        name: "Peclet number along the flow",
        unit: "",
        is_of_flow: false,
        measure: |drainage| spreading(drainage).peclet.map(|it| it[1]),
    },
    Quantity {
        name: "length of velocity correlation R / d",
        unit: "",
        is_of_flow: true,
        measure: |drainage| {
            let radius = correlation_radius(drainage)?;
            Some(over_diameter(drainage, radius))
        },
    },
    Quantity {
        name: "index of mixing at the end",
        unit: "",
        is_of_flow: true,
        measure: |drainage| exact(mixing(drainage, last(drainage))),
    },
    Quantity {
        name: "angle of the surface at the end",
        unit: "°",
        is_of_flow: true,
        measure: angle,
    },
    Quantity {
        name: "height of the stagnant zone / d",
        unit: "",
        is_of_flow: false,
        measure: stagnant,
    },
    Quantity {
        name: PROCESSOR_TIME,
        unit: "s",
        is_of_flow: false,
        measure: |drainage| {
            let seconds = Some(drainage.record.cpu_seconds);
            exact(seconds.filter(|it| it.is_finite()))
        },
    },
];

/// Most states of which the packing is measured: more tell little more, as neighbours in time are
/// alike.
const STATES: usize = 10;
/// Largest distance of a neighbour, in diameters.
const BOND: f64 = 1.3;
/// Distances of the radial distribution function: farthest, in diameters, and bins.
const DISTANCES: (f64, usize) = (1.2, 480);
/// Width of the cells of mixing, in diameters.
const CELL: f64 = 2.5;

/// A number without an interval: another seed would tell its scatter.
fn exact(value: Option<f64>) -> Option<Estimate> {
    let half_width = f64::INFINITY;
    value.map(|value| Estimate { value, half_width })
}

/// Mean over at most ten states, evenly over the times that count.
pub(super) fn over_states(
    drainage: &Drainage<'_>,
    value: impl Fn(&Snapshot) -> Option<f64>,
) -> Option<Estimate> {
    let states = drainage.flow();
    let count = states.len().min(STATES);
    let chosen = (0..count).map(|index| &states[(2 * index + 1) * states.len() / (2 * count)]);
    let values: Option<Vec<f64>> = chosen.map(value).collect();
    Estimate::of_mean(&values?)
}

fn last<'a>(drainage: &Drainage<'a>) -> &'a Snapshot {
    drainage.flow().last().unwrap_or(drainage.start())
}

/// Spheres that leave per second.
pub fn outflow(drainage: &Drainage<'_>) -> Option<Estimate> {
    let [time, left] = drainage.left();
    outflow_rate(&time, &left, drainage.window())
}

fn diffusion_length(drainage: &Drainage<'_>) -> Option<Estimate> {
    let spread = flow_spread_of(drainage)?;
    Some(over_diameter(drainage, spread.diffusion_length))
}

fn origin(drainage: &Drainage<'_>) -> Option<Estimate> {
    let spread = flow_spread_of(drainage)?;
    let floor = drainage.filled_box.floor;
    let above = Estimate {
        value: spread.origin.value - floor,
        ..spread.origin
    };
    Some(over_diameter(drainage, above))
}

fn over_diameter(drainage: &Drainage<'_>, length: Estimate) -> Estimate {
    let diameter = drainage.filled_box.diameter;
    Estimate {
        value: length.value / diameter,
        half_width: length.half_width / diameter,
    }
}

/// Volume of the spheres in the middle over the volume of their Voronoi cells.
pub fn packing_fraction(drainage: &Drainage<'_>, state: &Snapshot) -> Option<f64> {
    drainage.filled_box.packing_fraction(state)
}

/// Share of the spheres in the middle that are part of a crystal.
fn solid_share(drainage: &Drainage<'_>, state: &Snapshot) -> Option<f64> {
    let filled_box = &drainage.filled_box;
    let centres = Centres::of(state);
    let region = filled_box.middle();
    let solid = solid_like(&centres, BOND * filled_box.diameter);
    let places = solid.iter().zip(&centres.place);
    let inside = places.filter(|(_, place)| region.contains(**place));
    let inside: Vec<bool> = inside.map(|(solid, _)| *solid).collect();
    let count = inside.iter().filter(|it| **it).count();
    (!inside.is_empty()).then(|| count as f64 / inside.len() as f64)
}

/// Overlaps over diameters of the pairs in the middle, per sphere.
pub fn badness_of(drainage: &Drainage<'_>) -> Option<Estimate> {
    over_states(drainage, |state| badness(drainage, state).of_pairs())
}

fn badness(drainage: &Drainage<'_>, state: &Snapshot) -> Badness {
    let filled_box = &drainage.filled_box;
    let mut badness = Badness::default();
    badness.add(
        &Centres::of(state),
        filled_box.diameter,
        &filled_box.middle(),
    );
    badness
}

fn least_distance(drainage: &Drainage<'_>) -> Option<Estimate> {
    let filled_box = &drainage.filled_box;
    let (farthest, bins) = DISTANCES;
    let mut distances = RadialDistribution::new(farthest * filled_box.diameter, bins);
    for state in drainage.flow() {
        distances.add(&Centres::of(state), &filled_box.middle());
    }
    exact(
        distances
            .least_distance()
            .map(|it| it / filled_box.diameter),
    )
}

/// Lacey's index of mixing of layers of ten diameters in the lower half, in cells that span the
/// depth.
pub fn mixing(drainage: &Drainage<'_>, state: &Snapshot) -> Option<f64> {
    let start = layers(drainage).of(drainage.start());
    mixing_of(drainage, &Centres::of(state), &start)
}

/// The layers whose mixing is measured.
pub(super) fn layers(drainage: &Drainage<'_>) -> Layers {
    let filled_box = &drainage.filled_box;
    Layers::of_ten_diameters(filled_box.floor, filled_box.diameter)
}

/// The same of any centres in the box of a drainage, whose layers at their start are given.
pub(super) fn mixing_of(
    drainage: &Drainage<'_>,
    centres: &Centres,
    layers: &[Option<usize>],
) -> Option<f64> {
    let filled_box = &drainage.filled_box;
    let region = filled_box.lower_half();
    let cells = |axis: usize| {
        let width = region.high[axis] - region.low[axis];
        (width / (CELL * filled_box.diameter)).round().max(1.0) as usize
    };
    lacey_index(centres, layers, &region, [cells(0), 1, cells(2)])
}

fn angle(drainage: &Drainage<'_>) -> Option<Estimate> {
    let filled_box = &drainage.filled_box;
    let centres = Centres::of(last(drainage));
    let angle = surface_angle(&centres, filled_box.diameter, filled_box.half_width);
    exact(angle.map(f64::to_degrees))
}

fn stagnant(drainage: &Drainage<'_>) -> Option<Estimate> {
    let filled_box = &drainage.filled_box;
    let [diameter, floor] = [filled_box.diameter, filled_box.floor];
    let (start, end) = (drainage.start(), last(drainage));
    let height = stagnant_height(start, end, diameter, filled_box.half_width, floor);
    exact(Some(height / diameter))
}
