//! The packing fraction of a heap in a plane.

use crate::scene::FixedSpheres;
use ndarray::ArrayView2;

/// Distance of the scan lines, in mean diameters of the grains.
const SPACING: f64 = 0.02;

/// Depth below the surface from which the heap counts, in mean diameters.
const DEPTH: f64 = 2.0;

/// Distance from all fixed spheres from which the heap counts, in mean diameters.
const MARGIN: f64 = 1.0;

/// Least meaningful area, in squares of the mean diameter.
const LEAST_AREA: f64 = 10.0;

/// Packing fraction of grains in the plane y = 0: the area of the discs inside the heap over the
/// area of this inside. Overlaps of two discs count for both.
///
/// The inside excludes the regions that walls and free surface order or cut. Along every vertical
/// line it reaches from the lowest centre within half a diameter of the line to two diameters below
/// the highest such centre, and it keeps one diameter from the surface of every fixed sphere
/// (diameter: the mean of the grains). Lines are a fiftieth of a diameter apart; along a line
/// everything is exact.
///
/// * `position`: centres (m), n x 3
/// * `radius`: radii (m), n
/// * `fixed`: walls, and the door if it is closed
///
/// `None` if a grain is off the plane or the inside is smaller than ten squares of the diameter.
pub fn packing_fraction(
    position: ArrayView2<'_, f64>,
    radius: &[f64],
    fixed: &FixedSpheres,
) -> Option<f64> {
    if position.rows().into_iter().any(|row| row[1] != 0.0) {
        return None;
    }
    let diameter = 2.0 * radius.iter().sum::<f64>() / radius.len() as f64;
    let grains = Discs::new(
        (position.rows().into_iter().zip(radius)).map(|(row, &radius)| [row[0], row[2], radius]),
    );
    let kept_off = Discs::new(fixed.walls.iter().chain(&fixed.door).map(|sphere| {
        let [x, _, z] = sphere.position;
        [x, z, sphere.radius + MARGIN * diameter]
    }));
    let (left, right) = grains.extent()?;
    let spacing = SPACING * diameter;
    let lines = ((right - left) / spacing) as usize;
    let (mut covered, mut area) = (0.0, 0.0);
    for line in 0..lines {
        let x = left + (line as f64 + 0.5) * spacing;
        let inside = inside(x, diameter, &grains, &kept_off);
        area += inside.iter().map(|[low, high]| high - low).sum::<f64>();
        for [low, high] in grains.chords(x) {
            let within = inside
                .iter()
                .map(|[from, to]| high.min(*to) - low.max(*from));
            covered += within.filter(|length| *length > 0.0).sum::<f64>();
        }
    }
    let squares = area * spacing / (diameter * diameter);
    (squares >= LEAST_AREA).then_some(covered / area)
}

/// The pieces of the vertical line at x that lie inside the heap, from below.
fn inside(x: f64, diameter: f64, grains: &Discs, kept_off: &Discs) -> Vec<[f64; 2]> {
    let beside = grains.within(x, 0.5 * diameter).map(|[_, z, _]| *z);
    let (low, high) = beside.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| {
        (low.min(z), high.max(z))
    });
    let high = high - DEPTH * diameter;
    let mut walls: Vec<[f64; 2]> = kept_off.chords(x).collect();
    walls.sort_by(|one, other| one[0].total_cmp(&other[0]));
    let mut pieces = Vec::new();
    let mut from = low;
    for [bottom, top] in walls {
        if bottom.min(high) > from {
            pieces.push([from, bottom.min(high)]);
        }
        from = from.max(top);
    }
    if high > from {
        pieces.push([from, high]);
    }
    pieces
}

/// Discs, as x, z and radius, in the order of x.
struct Discs {
    discs: Vec<[f64; 3]>,
    largest: f64,
}

impl Discs {
    fn new(discs: impl Iterator<Item = [f64; 3]>) -> Self {
        let mut discs: Vec<[f64; 3]> = discs.collect();
        discs.sort_by(|one, other| one[0].total_cmp(&other[0]));
        let largest = discs.iter().map(|disc| disc[2]).fold(0.0, f64::max);
        Self { discs, largest }
    }

    /// Least and largest x of a centre.
    fn extent(&self) -> Option<(f64, f64)> {
        Some((self.discs.first()?[0], self.discs.last()?[0]))
    }

    /// Discs whose centres are at most this far from the vertical line at x.
    fn within(&self, x: f64, distance: f64) -> impl Iterator<Item = &[f64; 3]> {
        let first = self.discs.partition_point(|disc| disc[0] < x - distance);
        let near = self.discs[first..].iter();
        near.take_while(move |disc| disc[0] <= x + distance)
    }

    /// Chords of the discs on the vertical line at x, the lower end first.
    fn chords(&self, x: f64) -> impl Iterator<Item = [f64; 2]> {
        self.within(x, self.largest)
            .filter_map(move |[at, z, radius]| {
                let half = (radius * radius - (at - x) * (at - x)).max(0.0).sqrt();
                (half > 0.0).then_some([z - half, z + half])
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::FixedSphere;
    use ndarray::Array2;
    use std::f64::consts::PI;

    /// Discs of radius 1 in columns and rows at distances of `rise`, every second row shifted.
    fn lattice(columns: usize, rows: usize, pitch: f64, rise: f64, shift: f64) -> Array2<f64> {
        Array2::from_shape_fn((columns * rows, 3), |(index, axis)| {
            let (column, row) = (index % columns, index / columns);
            match axis {
                0 => column as f64 * pitch + if row % 2 == 0 { 0.0 } else { shift },
                1 => 0.0,
                _ => row as f64 * rise,
            }
        })
    }

    fn fraction(position: &Array2<f64>, fixed: &FixedSpheres) -> Option<f64> {
        packing_fraction(position.view(), &vec![1.0; position.nrows()], fixed)
    }

    #[test]
    fn lattices_have_their_packing_fractions() {
        let nothing = FixedSpheres::default();
        let square = fraction(&lattice(40, 40, 2.0, 2.0, 0.0), &nothing).unwrap();
        assert!((square - PI / 4.0).abs() < 2e-3, "{square}");
        let triangular = lattice(40, 40, 2.0, 3.0_f64.sqrt(), 1.0);
        let dense = fraction(&triangular, &nothing).unwrap();
        assert!((dense - PI / 12.0_f64.sqrt()).abs() < 0.01, "{dense}");
        let loose = fraction(&lattice(40, 40, 3.0, 2.0, 1.5), &nothing).unwrap();
        assert!((loose - PI / 6.0).abs() < 0.01, "{loose}");
    }

    #[test]
    fn overlaps_count_twice() {
        let close = fraction(&lattice(60, 60, 1.6, 1.6, 0.0), &FixedSpheres::default()).unwrap();
        assert!((close / (PI / 2.56) - 1.0).abs() < 5e-3, "{close}");
    }

    #[test]
    fn what_is_near_walls_does_not_count() {
        // In every second row the first disc is missing.
        let whole = lattice(40, 40, 2.0, 2.0, 1.0);
        let rows: Vec<usize> = (0..1600).filter(|index| index % 80 != 40).collect();
        let position = whole.select(ndarray::Axis(0), &rows);
        let open = fraction(&position, &FixedSpheres::default()).unwrap();
        assert!(open < PI / 4.0 - 5e-3, "{open}");
        let wall = (0..160).map(|step| FixedSphere {
            position: [-1.0, 0.0, 0.5 * f64::from(step)],
            radius: 1.0,
        });
        let wall = FixedSpheres {
            walls: wall.collect(),
            door: Vec::new(),
        };
        let beside = fraction(&position, &wall).unwrap();
        assert!((beside - PI / 4.0).abs() < 2e-3, "{beside}");
    }

    #[test]
    fn too_little_and_what_is_no_plane_have_none() {
        let nothing = FixedSpheres::default();
        assert_eq!(fraction(&lattice(4, 4, 2.0, 2.0, 0.0), &nothing), None);
        let mut off = lattice(40, 40, 2.0, 2.0, 0.0);
        off[[3, 1]] = 0.1;
        assert_eq!(fraction(&off, &nothing), None);
    }
}
