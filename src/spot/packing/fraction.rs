//! The packing fraction in the middle of a box.

use crate::particles::vector::Vector;
use crate::spot::cells::SphereCells;
use crate::spot::parameters::Parameters;

/// Distance of the middle from floor and top, in diameters.
const MARGIN: f64 = 3.0;

/// Scan points per diameter along y; there are fewer along the other axes.
const RESOLUTION: f64 = 8.0;

/// Least distance of opposite walls, in diameters: between nearer ones all spheres are in layers.
const NARROWEST: f64 = 4.0;

/// Fraction of a lattice of points in the middle of the box that lie in spheres. Walls order the
/// spheres in layers; to average over the layers, the weight of the points rises smoothly from 0 at
/// one diameter from a wall to 1 in the middle. Accurate to about .002. Zero if the packing is
/// lower than eight diameters or opposite walls are less than four apart: there is then no such
/// middle.
pub fn packing_fraction(parameters: &Parameters, centres: &[Vector]) -> f64 {
    let d = parameters.diameter;
    let top = centres.iter().fold(0.0, |most: f64, it| most.max(it.z));
    let halves = [parameters.half_width, parameters.half_depth];
    let is_narrow = halves.iter().any(|half| 2.0 * half < NARROWEST * d);
    if top < 8.0 * d || is_narrow {
        return 0.0;
    }
    let mut cells = SphereCells::new(d, halves, top);
    let order = cells.sort(centres);
    let sorted: Vec<Vector> = order.iter().map(|&it| centres[it as usize]).collect();
    let step = d / RESOLUTION;
    let [x, y] = halves.map(|half| half - d);
    let heights = points(MARGIN * d, top - MARGIN * d, 3.0 * step);
    let mut ranges = Vec::new();
    let (mut covered, mut all) = (0.0, 0.0);
    for at_x in points(-x, x, 4.0 * step) {
        for at_y in points(-y, y, step) {
            let weight = window(at_x / x) * window(at_y / y);
            for &z in &heights {
                let point = Vector::new(at_x, at_y, z);
                cells.cover(point, 0.5 * d, &mut ranges);
                let slots = ranges.iter().flat_map(|range| range.clone());
                let mut near = slots.map(|slot| sorted[slot as usize] - point);
                let inside = near.any(|it| it.norm_squared() < 0.25 * d * d);
                covered += if inside { weight } else { 0.0 };
                all += weight;
            }
        }
    }
    covered / all
}

fn points(from: f64, to: f64, step: f64) -> Vec<f64> {
    let count = ((to - from) / step) as usize;
    (0..count).map(|k| from + (k as f64 + 0.5) * step).collect()
}

/// Hann window: 1 in the middle, 0 at -1 and 1.
fn window(place: f64) -> f64 {
    0.5 + 0.5 * libm::cos(std::f64::consts::PI * place)
}
