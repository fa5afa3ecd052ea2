//! How steep the free surface is.

use crate::particles::Domain;
use crate::particles::vector::Vector;
use crate::simulation::Frame;
use std::collections::BTreeMap;

/// Side of a square, in diameters.
const SIDE: f64 = 2.0;

/// Spread across the squares' main direction, over the spread along it, below which the squares
/// form a line.
const LINE: f64 = 1e-9;

/// Angle (rad) between the horizontal and the plane of least squares through the highest centre
/// over each square of two diameters. If the squares form a line, the plane is level across it. In
/// a periodic space it goes through the images in the box.
pub(super) fn angle(frame: &dyn Frame, diameter: f64, domain: Domain) -> f64 {
    let side = SIDE * diameter;
    let mut highest: BTreeMap<[i64; 2], [f64; 3]> = BTreeMap::new();
    frame.show(&mut |block| {
        let [x, y, z] = block.position;
        for ((&x, &y), &z) in x.iter().zip(y).zip(z) {
            let Vector { x, y, .. } = domain.wrapped(Vector::new(x, y, z));
            let square = [x, y].map(|place| (place / side).floor() as i64);
            let top = highest.entry(square).or_insert([x, y, z]);
            if z > top[2] {
                *top = [x, y, z];
            }
        }
    });
    let tops: Vec<[f64; 3]> = highest.into_values().collect();
    slope(&tops).map_or(f64::NAN, libm::atan)
}

/// Slope of the plane of least squares through some points; `None` if they have one place.
fn slope(points: &[[f64; 3]]) -> Option<f64> {
    let count = points.len() as f64;
    let middle = [0, 1, 2].map(|axis| points.iter().map(|it| it[axis]).sum::<f64>() / count);
    let product = |one: usize, other: usize| {
        let terms = points
            .iter()
            .map(|it| (it[one] - middle[one]) * (it[other] - middle[other]));
        terms.sum::<f64>()
    };
    let [xx, xy, yy] = [product(0, 0), product(0, 1), product(1, 1)];
    let [xz, yz] = [product(0, 2), product(1, 2)];
    let (trace, determinant) = (xx + yy, xx * yy - xy * xy);
    let [along_x, along_y] = match determinant > LINE * trace * trace {
        true => [yy * xz - xy * yz, xx * yz - xy * xz].map(|it| it / determinant),
        // The inverse along the only direction that the points have.
        false => [xx * xz + xy * yz, xy * xz + yy * yz].map(|it| it / (trace * trace)),
    };
    (trace > 0.0).then(|| libm::hypot(along_x, along_y))
}
