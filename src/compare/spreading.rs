//! How far spheres stray from the mean flow.

use super::MeasuredDrainage;
use crate::measure::{Diffusion, SpaceAxis, VelocityCorrelation};
use crate::statistics::Estimate;

/// How far spheres stray from the mean flow while they drop.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spreading {
    /// Mean distance dropped (m), and mean square displacement (m2) along x and along z.
    pub points: Vec<[f64; 3]>,
    /// Peclet numbers V d / D along x and along z, at the longest distance with enough data.
    pub peclet: Option<[Estimate; 2]>,
}

/// Intervals between snapshots; each gives a point.
const LAGS: [usize; 8] = [1, 2, 3, 5, 8, 12, 18, 27];
/// Fewest pairs of snapshots of a point, and of a Peclet number.
const FEWEST: [usize; 2] = [3, 8];
/// Width of the cells in which the mean flow is linear, in diameters.
const CELL: f64 = 2.0;

/// From the spheres that start in the middle 40 % of the width, at 30 to 80 % of the height.
pub fn spreading(drainage: &MeasuredDrainage<'_>) -> Spreading {
    let diameter = drainage.filled_box.diameter;
    let region = drainage.filled_box.part(0.4, [0.3, 0.8]);
    let states = drainage.flow();
    let mut spreading = Spreading::default();
    for lag in LAGS {
        let pairs = states.iter().zip(states.iter().skip(lag)).step_by(lag);
        let count = pairs.len();
        if count < FEWEST[0] {
            break;
        }
        let mut diffusion = Diffusion::new(region, CELL * diameter);
        for (before, after) in pairs {
            diffusion.add(before, after);
        }
        let mean_square = |axis| diffusion.mean_square(axis).map(|it| it.value);
        let drop = diffusion.drop().map(|it| it.value);
        if let (Some(drop), Some(x), Some(z)) =
            (drop, mean_square(SpaceAxis::X), mean_square(SpaceAxis::Z))
        {
            spreading.points.push([drop, x, z]);
        }
        let peclet = |axis| diffusion.peclet(axis, diameter);
        if let (true, Some(x), Some(z)) = (
            count >= FEWEST[1],
            peclet(SpaceAxis::X),
            peclet(SpaceAxis::Z),
        ) {
            spreading.peclet = Some([x, z]);
        }
    }
    spreading
}

/// Cells of the mean flow of velocity correlations, in diameters: wider than spots, which would
/// else be taken for it.
const WIDE_CELL: f64 = 6.0;
/// Distances of velocity correlations: farthest, in diameters, and bins; and the nearest that
/// counts, beyond which no two spheres touch.
const DISTANCES: (f64, usize) = (8.0, 32);
const NEAREST: f64 = 1.25;

/// How velocities across the flow are correlated over the distance, of the spheres in the middle
/// 40 % of the width, at 30 to 80 % of the height.
pub fn velocity_correlation(drainage: &MeasuredDrainage<'_>) -> VelocityCorrelation {
    let diameter = drainage.filled_box.diameter;
    let region = drainage.filled_box.part(0.4, [0.3, 0.8]);
    let states = drainage.flow().windows(2);
    let pairs: Vec<_> = states.map(|two| (&two[0], &two[1])).collect();
    let (farthest, bins) = DISTANCES;
    let distances = (farthest * diameter, bins);
    VelocityCorrelation::of(&pairs, region, WIDE_CELL * diameter, distances)
}

/// The radius (m) of spots that correlate velocities so.
pub fn correlation_radius(drainage: &MeasuredDrainage<'_>) -> Option<Estimate> {
    let nearest = NEAREST * drainage.filled_box.diameter;
    velocity_correlation(drainage).radius(nearest)
}
