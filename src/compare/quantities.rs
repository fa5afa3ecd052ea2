//! The numbers of a drainage, each with its interval.

use super::spreading::correlation_radius;
use super::{MeasuredDrainage, flow_spread_of, spreading};
use crate::measure::{
    Badness, Centres, Layers, RadialDistribution, lacey_index, outflow_rate, solid_like,
    stagnant_height, surface_angle,
};
use crate::observe::Snapshot;
use crate::statistics::Estimate;

/// A number that is measured of a drainage.
pub struct DrainageQuantity {
    /// Name.
    pub name: &'static str,
    /// Unit; lengths are over the diameter of the spheres, and have none.
    pub unit: &'static str,
    /// Whether it describes the flow, so that its error counts where drainages are compared.
    pub is_of_flow: bool,
    /// Measures it, with its interval of 95 % over states or blocks of time, infinite where nothing
    /// tells its scatter. `None` if it is undefined.
    pub measure: fn(&MeasuredDrainage<'_>) -> Option<Estimate>,
}

/// Name of the time that a run took: seconds of a processor, not of its scene.
pub(super) const PROCESSOR_TIME: &str = "processor time";

/// All of them.
pub static QUANTITIES: [DrainageQuantity; 16] = [
    DrainageQuantity {
        name: "outflow",
        unit: "1/s",
        is_of_flow: true,
        measure: outflow,
    },
    DrainageQuantity {
        name: "diffusion length of the flow b / d",
        unit: "",
        is_of_flow: true,
        measure: diffusion_length,
    },
    DrainageQuantity {
        name: "height z0 / d from which the flow widens",
        unit: "",
        is_of_flow: false,
        measure: origin,
    },
    DrainageQuantity {
        name: "packing fraction at the start",
        unit: "",
        is_of_flow: false,
        measure: |drainage| exact(packing_fraction(drainage, drainage.start())),
    },
    DrainageQuantity {
        name: "packing fraction in the flow",
        unit: "",
        is_of_flow: true,
        measure: |drainage| over_states(drainage, |state| packing_fraction(drainage, state)),
    },
    DrainageQuantity {
        name: "share of spheres in crystals, in the flow",
        unit: "",
        is_of_flow: true,
        measure: |drainage| over_states(drainage, |state| solid_share(drainage, state)),
    },
    DrainageQuantity {
        name: "packing badness, of pairs",
        unit: "",
        is_of_flow: true,
        measure: badness_of,
    },
    DrainageQuantity {
        name: "packing badness, as printed",
        unit: "",
        is_of_flow: false,
        measure: |drainage| over_states(drainage, |state| badness(drainage, state).as_printed()),
    },
    DrainageQuantity {
        name: "least distance / d",
        unit: "",
        is_of_flow: false,
        measure: least_distance,
    },
    DrainageQuantity {
        name: "Peclet number across the flow",
        unit: "",
        is_of_flow: true,
        measure: |drainage| spreading(drainage).peclet.map(|it| it[0]),
    },
    DrainageQuantity {
        name: "Peclet number along the flow",
        unit: "",
        is_of_flow: false,
        measure: |drainage| spreading(drainage).peclet.map(|it| it[1]),
    },
    DrainageQuantity {
        name: "length of velocity correlation R / d",
        unit: "",
        is_of_flow: true,
        measure: |drainage| {
            let radius = correlation_radius(drainage)?;
            Some(over_diameter(drainage, radius))
        },
    },
    DrainageQuantity {
        name: "index of mixing at the end",
        unit: "",
        is_of_flow: true,
        measure: |drainage| exact(mixing(drainage, last(drainage))),
    },
    DrainageQuantity {
        name: "angle of the surface at the end",
        unit: "°",
        is_of_flow: true,
        measure: angle,
    },
    DrainageQuantity {
        name: "height of the stagnant zone / d",
        unit: "",
        is_of_flow: false,
        measure: stagnant,
    },
    DrainageQuantity {
        name: PROCESSOR_TIME,
        unit: "s",
        is_of_flow: false,
        measure: |drainage| {
            let seconds = Some(drainage.record.cpu_seconds);
            exact(seconds.filter(|it| it.is_finite()))
        },
    },
];

/// Largest number of states on which the packing is measured: more add little, as states close in
/// time are alike.
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
    drainage: &MeasuredDrainage<'_>,
    value: impl Fn(&Snapshot) -> Option<f64>,
) -> Option<Estimate> {
    let states = drainage.flow();
    let count = states.len().min(STATES);
    let chosen = (0..count).map(|index| &states[(2 * index + 1) * states.len() / (2 * count)]);
    let values: Option<Vec<f64>> = chosen.map(value).collect();
    Estimate::of_mean(&values?)
}

fn last<'a>(drainage: &MeasuredDrainage<'a>) -> &'a Snapshot {
    drainage.flow().last().unwrap_or(drainage.start())
}

/// Spheres that leave per second.
pub fn outflow(drainage: &MeasuredDrainage<'_>) -> Option<Estimate> {
    let [time, left] = drainage.left();
    outflow_rate(&time, &left, drainage.window())
}

fn diffusion_length(drainage: &MeasuredDrainage<'_>) -> Option<Estimate> {
    let spread = flow_spread_of(drainage)?;
    Some(over_diameter(drainage, spread.diffusion_length))
}

fn origin(drainage: &MeasuredDrainage<'_>) -> Option<Estimate> {
    let spread = flow_spread_of(drainage)?;
    let floor = drainage.filled_box.floor;
    let above = Estimate {
        value: spread.origin.value - floor,
        ..spread.origin
    };
    Some(over_diameter(drainage, above))
}

fn over_diameter(drainage: &MeasuredDrainage<'_>, length: Estimate) -> Estimate {
    let diameter = drainage.filled_box.diameter;
    Estimate {
        value: length.value / diameter,
        half_width: length.half_width / diameter,
    }
}

/// Volume of the spheres in the middle over the volume of their Voronoi cells.
pub fn packing_fraction(drainage: &MeasuredDrainage<'_>, state: &Snapshot) -> Option<f64> {
    drainage.filled_box.packing_fraction(state)
}

/// Share of the spheres in the middle that are part of a crystal.
fn solid_share(drainage: &MeasuredDrainage<'_>, state: &Snapshot) -> Option<f64> {
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
pub fn badness_of(drainage: &MeasuredDrainage<'_>) -> Option<Estimate> {
    over_states(drainage, |state| badness(drainage, state).of_pairs())
}

fn badness(drainage: &MeasuredDrainage<'_>, state: &Snapshot) -> Badness {
    let filled_box = &drainage.filled_box;
    let mut badness = Badness::default();
    badness.add(
        &Centres::of(state),
        filled_box.diameter,
        &filled_box.middle(),
    );
    badness
}

fn least_distance(drainage: &MeasuredDrainage<'_>) -> Option<Estimate> {
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
pub fn mixing(drainage: &MeasuredDrainage<'_>, state: &Snapshot) -> Option<f64> {
    let start = layers(drainage).of(drainage.start());
    mixing_of(drainage, &Centres::of(state), &start)
}

/// The layers whose mixing is measured.
pub(super) fn layers(drainage: &MeasuredDrainage<'_>) -> Layers {
    let filled_box = &drainage.filled_box;
    Layers::of_ten_diameters(filled_box.floor, filled_box.diameter)
}

/// The same of any centres in the box of a drainage, whose layers at their start are given.
pub(super) fn mixing_of(
    drainage: &MeasuredDrainage<'_>,
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

fn angle(drainage: &MeasuredDrainage<'_>) -> Option<Estimate> {
    let filled_box = &drainage.filled_box;
    let centres = Centres::of(last(drainage));
    let angle = surface_angle(&centres, filled_box.diameter, filled_box.half_width);
    exact(angle.map(f64::to_degrees))
}

fn stagnant(drainage: &MeasuredDrainage<'_>) -> Option<Estimate> {
    let filled_box = &drainage.filled_box;
    let [diameter, floor] = [filled_box.diameter, filled_box.floor];
    let (start, end) = (drainage.start(), last(drainage));
    let height = stagnant_height(start, end, diameter, filled_box.half_width, floor);
    exact(Some(height / diameter))
}
