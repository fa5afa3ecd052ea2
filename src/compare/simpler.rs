//! The same drainage by simpler models: voids on a lattice, and the kinematic flow.
//!
//! Both are plane. Their grains start on one triangular lattice that fills the width and height of
//! the box. At any time equal shares of grains and of the record's spheres have left.

use super::quantities::{layers, mixing_of};
use super::{MeasuredDrainage, flow_spread_of};
use crate::measure::{Centres, count_left};
use crate::particles::vector::Vector;
use crate::spot::kinematic::KinematicFlow;
use crate::spot::voids::{ROW_HEIGHT, VoidSilo};

/// Longest way of a grain in a step of the kinematic flow, in diameters.
const LONGEST_WAY: f64 = 0.25;

/// A grain on the lattice, and where a model has it; none once it has left.
type Places = Vec<Option<[f64; 2]>>;

/// Indices of mixing of a model: time (s) and index.
pub type MixingOverTime = Vec<(f64, f64)>;

/// The index of mixing over time of voids: of their model, a grain strays by half a diameter with
/// each row that it drops. None if the box has no opening.
pub fn mixing_of_voids(drainage: &MeasuredDrainage<'_>) -> Option<MixingOverTime> {
    let lattice = VoidLattice::of(drainage)?;
    let mut silo = lattice.full.clone();
    let grains = silo.grains();
    let mut left = 0;
    let places = lattice.shares.iter().map(|share| {
        let wanted = (share * grains as f64).round() as usize;
        while left < wanted {
            match silo.drain(wanted - left) {
                // The slopes beside the opening are stable.
                0 => break,
                gone => left += gone,
            }
        }
        lattice.places(&silo)
    });
    Some(lattice.mixing(drainage, places))
}

/// The index of mixing over time of the kinematic flow, with the diffusion length b that the record
/// has: grains do not stray at all. What it has of mixing is layers that bend through cells. None
/// if the box has no opening, or the record no b.
pub fn mixing_of_kinematic_flow(drainage: &MeasuredDrainage<'_>) -> Option<MixingOverTime> {
    let lattice = VoidLattice::of(drainage)?;
    let diffusion = flow_spread_of(drainage)?.diffusion_length.value;
    let tank = drainage.record.scene.tank.as_ref()?;
    let mut flow = KinematicFlow {
        flux: 0.0,
        diffusion,
        half_opening: tank.opening()?.1,
        half_width: Some(drainage.filled_box.half_width),
    };
    let mut places = lattice.places(&lattice.full);
    let area = 4.0 * drainage.filled_box.half_width * 0.5 * drainage.filled_box.filled;
    let mut earlier = None;
    let times = drainage
        .states()
        .iter()
        .map(|it| drainage.since_opening(it.time));
    let moments = times.zip(&lattice.shares).map(|(time, share)| {
        if let Some((before, left)) = earlier.replace((time, *share)) {
            flow.flux = area * (share - left) / (time - before);
            lattice.drift(&flow, time - before, &mut places);
        }
        places.clone()
    });
    Some(lattice.mixing(drainage, moments))
}

/// The lattice on which grains start.
struct VoidLattice {
    /// All grains at their start.
    full: VoidSilo,
    diameter: f64,
    floor: f64,
    /// Share of the spheres that have left, at each state.
    shares: Vec<f64>,
}

impl VoidLattice {
    fn of(drainage: &MeasuredDrainage<'_>) -> Option<Self> {
        let it = &drainage.filled_box;
        let half_opening = drainage.record.scene.tank.as_ref()?.opening()?.1;
        let sites = |length: f64| (length / it.diameter).round().max(1.0) as usize;
        let left = count_left(drainage.states());
        let spheres = Centres::of(drainage.start()).number.len() as f64;
        Some(Self {
            full: VoidSilo::new(
                sites(2.0 * it.half_width),
                sites(it.filled / ROW_HEIGHT),
                sites(2.0 * half_opening),
                drainage.record.scene.seed,
            )?,
            diameter: it.diameter,
            floor: it.floor,
            shares: left.iter().map(|left| left / spheres).collect(),
        })
    }

    /// Where the grains of a silo are in the box (m); the lowest row lies on the floor.
    fn places(&self, silo: &VoidSilo) -> Places {
        let place = |[x, z]: [f64; 2]| [x * self.diameter, self.floor + (z + 0.5) * self.diameter];
        (0..silo.grains())
            .map(|grain| silo.place(grain).map(place))
            .collect()
    }

    /// Moves grains with a flow for a time, by the midpoint rule; those that pass the floor leave.
    fn drift(&self, flow: &KinematicFlow, time: f64, places: &mut Places) {
        let fastest = flow.flux / (2.0 * flow.half_opening);
        let way = LONGEST_WAY * self.diameter;
        let steps = (fastest * time / way).ceil().max(1.0);
        let step = time / steps;
        let velocity = |[x, z]: [f64; 2]| {
            let height = z - self.floor;
            (height > 0.0).then(|| flow.velocity(x, height))
        };
        let moved = |[x, z]: [f64; 2], [u, w]: [f64; 2], time: f64| [x + u * time, z + w * time];
        for _ in 0..steps as usize {
            for place in places.iter_mut() {
                *place = place.and_then(|at| {
                    let middle = moved(at, velocity(at)?, 0.5 * step);
                    Some(moved(at, velocity(middle)?, step))
                });
            }
        }
    }

    /// The index of mixing of the places at each state; states without an index are left out.
    fn mixing(
        &self,
        drainage: &MeasuredDrainage<'_>,
        places: impl Iterator<Item = Places>,
    ) -> MixingOverTime {
        let of = layers(drainage);
        let layer = |place: &Option<[f64; 2]>| place.map(|[_, z]| of.layer(z));
        let layers: Vec<Option<usize>> = self.places(&self.full).iter().map(layer).collect();
        let times = drainage
            .states()
            .iter()
            .map(|it| drainage.since_opening(it.time));
        let index = |(time, places): (f64, Places)| {
            let inside = places.iter().enumerate();
            let inside = inside.filter_map(|(grain, place)| Some((grain, (*place)?)));
            let (number, place) = inside
                .map(|(grain, [x, z])| (grain, Vector::new(x, 0.0, z)))
                .unzip();
            let centres = Centres { place, number };
            Some((time, mixing_of(drainage, &centres, &layers)?))
        };
        times.zip(places).filter_map(index).collect()
    }
}
