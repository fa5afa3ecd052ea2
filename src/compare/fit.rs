//! The parameters of the spot model that a drainage follows.

use super::quantities::{outflow, over_states, packing_fraction};
use super::spreading::correlation_radius;
use super::{MeasuredDrainage, flow_spread_of, spreading};
use crate::measure::{Centres, Region};
use crate::statistics::Estimate;
use std::f64::consts::PI;

/// Upward step of a spot, in diameters (Rycroft, Wong and Bazant, 2010).
const STEP: f64 = 0.1;
/// Heights between which the drop of the density is measured, as shares of that to which the box
/// is filled.
const HEIGHTS: [f64; 2] = [0.14, 0.54];
/// The layer above them by which it is seen that the surface is higher, and the share of its
/// spheres that have to be there.
const ABOVE: ([f64; 2], f64) = ([HEIGHTS[1], 0.58], 0.5);
/// Parts of the depth over which the volume of spots within the walls is summed.
const PARTS: u32 = 200;

/// The five parameters of the spot model, fitted to a drainage by the procedure of Rycroft, Bazant,
/// Grest and Landry, Physical Review E 73, 051306 (2006), each with its interval:
///
/// * b: how fast the flow widens upwards, sigma^2 = 2 b z
/// * w = b Pe / d: a spot that steps sqrt(2 b dz) aside moves spheres by a w-th of it, so that they
///   diffuse with the length b / w while they drop
/// * r_s: velocities are correlated over the distance at which two spots still overlap
/// * lambda = Q w V_p / (phi V_s): Q spheres leave per time, and a spot carries a w-th of the
///   volume of the spheres in it, with the volume V_s of a spot within the walls, V_p of a sphere,
///   and the packing fraction phi of the flow
/// * mu = Q V_p / (dz S): the density of a layer drops by the volume that the spots in it carry;
///   S (m2) is the integral of the drop of the packing fraction over the area of the box
///
/// The upward step dz is a tenth of a diameter, as there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpotFit {
    /// Diffusion length b (m).
    pub diffusion_length: Estimate,
    /// Displacement of a spot over the displacement of the spheres that it moves, w.
    pub displacement_ratio: Estimate,
    /// Radius r_s (m).
    pub radius: Estimate,
    /// Spots that enter per time, lambda (1/s).
    pub insertion_rate: Estimate,
    /// Steps of a spot per time, mu (1/s).
    pub move_rate: Estimate,
    /// Upward step dz (m).
    pub vertical_step: f64,
}

impl SpotFit {
    /// The parameters of a drainage.
    ///
    /// # Errors
    /// What the record does not show.
    pub fn of(drainage: &MeasuredDrainage<'_>) -> Result<Self, &'static str> {
        let diameter = drainage.filled_box.diameter;
        let spread = flow_spread_of(drainage)
            .ok_or("a flow that widens upwards, at six heights below its surface")?;
        let peclet = spreading(drainage).peclet;
        let [across, _] =
            peclet.ok_or("spheres that stray, in eight pairs of snapshots or more")?;
        let radius =
            correlation_radius(drainage).ok_or("velocities that are correlated over a distance")?;
        let rate = outflow(drainage).ok_or("spheres that leave")?;
        let fraction = over_states(drainage, |state| packing_fraction(drainage, state))
            .ok_or("spheres in the middle of the flow")?;
        if has_sunk(drainage) {
            return Err("a surface above half of its first height; give earlier `--times`");
        }
        let deficit = density_deficit(drainage).ok_or("a flow that is less dense")?;
        let vertical_step = STEP * diameter;
        let sphere = PI / 6.0 * diameter * diameter * diameter;
        let diffusion_length = spread.diffusion_length;
        let displacement_ratio = scaled(product(diffusion_length, across), 1.0 / diameter);
        let inside = volume_within_walls(radius.value, drainage.filled_box.half_depth, diameter);
        // The volume grows with the cube of the radius.
        let volume = Estimate {
            value: inside,
            half_width: 3.0 * inside * radius.half_width / radius.value,
        };
        let in_spots = product(fraction, volume);
        let moved = product(rate, displacement_ratio);
        Ok(Self {
            diffusion_length,
            displacement_ratio,
            radius,
            insertion_rate: scaled(quotient(moved, in_spots), sphere),
            move_rate: scaled(quotient(rate, deficit), sphere / vertical_step),
            vertical_step,
        })
    }
}

/// Whether the surface has come down to the heights at which the drop of the density is measured:
/// the room that is left above it would count as one.
fn has_sunk(drainage: &MeasuredDrainage<'_>) -> bool {
    let (heights, share) = ABOVE;
    let region = drainage.filled_box.part(1.0, heights);
    let start = count_within(&Centres::of(drainage.start()), &region);
    let last = drainage.flow().last().unwrap_or(drainage.start());
    count_within(&Centres::of(last), &region) < share * start
}

/// How much less packing fraction there is in the flow than at the start, integrated over the area
/// of the box (m2).
fn density_deficit(drainage: &MeasuredDrainage<'_>) -> Option<Estimate> {
    let region = drainage.filled_box.part(1.0, HEIGHTS);
    let height = region.high[2] - region.low[2];
    let diameter = drainage.filled_box.diameter;
    let sphere = PI / 6.0 * diameter * diameter * diameter;
    let start = count_within(&Centres::of(drainage.start()), &region);
    let deficit = over_states(drainage, |state| {
        let now = count_within(&Centres::of(state), &region);
        Some((start - now) * sphere / height)
    })?;
    (deficit.value > 0.0).then_some(deficit)
}

fn count_within(centres: &Centres, region: &Region) -> f64 {
    let inside = centres.place.iter().filter(|it| region.contains(**it));
    inside.count() as f64
}

/// The volume (m3) of a spot of a radius (m) within walls at y = -half_depth and half_depth (m), in
/// the mean over the places that keep a diameter from them.
fn volume_within_walls(radius: f64, half_depth: f64, diameter: f64) -> f64 {
    let room = (half_depth - diameter).max(0.0);
    let cap = |height: f64| match height > 0.0 {
        true => PI * height * height * (3.0 * radius - height) / 3.0,
        false => 0.0,
    };
    let at = |place: f64| {
        let [near, far] = [half_depth - place, half_depth + place].map(|it| radius - it);
        let whole = 4.0 / 3.0 * PI * radius * radius * radius;
        whole - cap(near.min(2.0 * radius)) - cap(far.min(2.0 * radius))
    };
    let places = (0..PARTS).map(|k| room * (f64::from(k) + 0.5) / f64::from(PARTS));
    places.map(at).sum::<f64>() / f64::from(PARTS)
}

fn product(one: Estimate, other: Estimate) -> Estimate {
    let value = one.value * other.value;
    Estimate {
        value,
        half_width: value.abs() * relative(one, other),
    }
}

fn quotient(one: Estimate, other: Estimate) -> Estimate {
    let value = one.value / other.value;
    Estimate {
        value,
        half_width: value.abs() * relative(one, other),
    }
}

/// Relative half width of the interval of a product or quotient of two independent values.
fn relative(one: Estimate, other: Estimate) -> f64 {
    let [one, other] = [one, other].map(|it| it.half_width / it.value.abs());
    libm::hypot(one, other)
}

fn scaled(estimate: Estimate, factor: f64) -> Estimate {
    Estimate {
        value: estimate.value * factor,
        half_width: estimate.half_width * factor,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The volume of spots of radius 2.6 between walls 8 apart: by the integral in closed form,
    /// 73.622 less 3.146.
    #[test]
    fn spots_reach_through_the_walls() {
        let volume = volume_within_walls(2.6, 4.0, 1.0);
        assert!((volume - 70.477).abs() < 2e-3, "{volume}");
        let whole = volume_within_walls(2.6, 40.0, 5.0);
        assert!((whole - 73.622).abs() < 1e-3, "{whole}");
    }
}
