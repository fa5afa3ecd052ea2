//! Volumes of Voronoi cells, and packing fractions from them.

use super::polyhedron::Polyhedron;
use super::{CellGrid, Centres, Region};
use crate::particles::vector::Vector;
use std::f64::consts::PI;

/// Boundaries of cells besides their neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellBounds {
    /// The corner of the box with the least coordinates (m).
    pub low: [f64; 3],
    /// The corner with the largest coordinates (m).
    pub high: [f64; 3],
    /// Free surfaces: cells reach no farther than this from their centres along each axis (m).
    pub farthest: f64,
}

/// Number of faces and volume of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoronoiCell {
    /// Volume (m3).
    pub volume: f64,
    /// Number of faces, including faces at walls.
    pub faces: usize,
}

/// The Voronoi cell of every sphere: all places nearer to its centre than to others, inside the
/// walls. Planes between it and its neighbours, the nearest first, cut it out of the box until no
/// remaining one can reach its corners (Rycroft, Chaos 19, 041111 (2009)).
pub fn voronoi_cells(centres: &Centres, walls: &CellBounds) -> Vec<VoronoiCell> {
    let count = centres.place.len() as f64;
    let extent = (0..3).map(|axis| (walls.high[axis] - walls.low[axis]).min(2.0 * walls.farthest));
    // Approximate distance of neighbours.
    let spacing = libm::cbrt(extent.product::<f64>() / count.max(1.0)).min(walls.farthest);
    let mut search = VoronoiSearch {
        grid: CellGrid::new(&centres.place, spacing),
        first: 1.5 * spacing,
        near: Vec::new(),
    };
    let places = 0..centres.place.len();
    places
        .map(|own| search.cell(centres.place[own], own, walls))
        .collect()
}

/// A search for the neighbours of one sphere after the other.
struct VoronoiSearch<'a> {
    grid: CellGrid<'a>,
    /// Distance of the first search (m).
    first: f64,
    near: Vec<(f64, Vector)>,
}

impl VoronoiSearch<'_> {
    fn cell(&mut self, place: Vector, own: usize, walls: &CellBounds) -> VoronoiCell {
        let at = [place.x, place.y, place.z];
        let farthest = walls.farthest;
        let side =
            |axis: usize, wall: &[f64; 3]| (wall[axis] - at[axis]).clamp(-farthest, farthest);
        let low = std::array::from_fn(|axis| side(axis, &walls.low));
        let high = std::array::from_fn(|axis| side(axis, &walls.high));
        let mut cell = Polyhedron::of_box(low, high);
        let (mut from, mut to) = (0.0, self.first);
        loop {
            self.look(place, own, from, to);
            for (squared, away) in &self.near {
                // A plane halfway to a sphere twice as far away as all corners cuts off none of
                // them.
                if *squared >= 4.0 * cell.reach_squared() {
                    break;
                }
                let distance = squared.sqrt();
                cell.cut(*away * (1.0 / distance), 0.5 * distance);
            }
            if to * to >= 4.0 * cell.reach_squared() {
                return VoronoiCell {
                    volume: cell.volume(),
                    faces: cell.faces(),
                };
            }
            (from, to) = (to, 1.5 * to);
        }
    }

    /// The spheres between two distances (m), the nearest first.
    fn look(&mut self, place: Vector, own: usize, from: f64, to: f64) {
        self.near.clear();
        let near = &mut self.near;
        self.grid.within(place, to, |other, away| {
            let squared = away.norm_squared();
            if other != own && squared > from * from && squared > 0.0 {
                near.push((squared, away));
            }
        });
        near.sort_by(|one, other| one.0.total_cmp(&other.0));
    }
}

/// Number of neighbours from which the distance of spheres is estimated.
const NEIGHBOURS: usize = 6;
/// Distance, in diameters, within which a sphere in a dense packing has this many neighbours.
const DENSE: f64 = 1.2;
/// How far cells reach at the free surface of a loose packing, in units of the distance of the last
/// of these neighbours.
const LOOSE_REACH: f64 = 2.0;

/// How far cells may reach from their centres at a free surface (m), for the spheres of one
/// diameter (m) in a region. One diameter in a dense packing, where at least half of them have six
/// neighbours within 1.2 diameters. Twice the median distance of the sixth neighbour in a looser
/// packing, so that cells between distant spheres are not cut.
pub(super) fn reach_of_cells(centres: &Centres, region: &Region, diameter: f64) -> f64 {
    let grid = CellGrid::new(&centres.place, DENSE * diameter);
    let inside = centres.place.iter().filter(|it| region.contains(**it));
    let mut distances: Vec<f64> = inside
        .map(|it| of_last_neighbour(&grid, *it, diameter))
        .collect();
    distances.sort_by(f64::total_cmp);
    match distances.get(distances.len() / 2) {
        Some(median) if *median > DENSE * diameter => LOOSE_REACH * median,
        _ => diameter,
    }
}

/// Distance (m) of the sixth neighbour of a sphere; infinite if there are fewer.
fn of_last_neighbour(grid: &CellGrid<'_>, place: Vector, diameter: f64) -> f64 {
    let mut farthest = DENSE * diameter;
    loop {
        let mut near = Vec::new();
        grid.within(place, farthest, |_, away| near.push(away.norm_squared()));
        near.sort_by(f64::total_cmp);
        // The first is the sphere itself.
        match near.get(NEIGHBOURS) {
            Some(squared) => return squared.sqrt(),
            None if near.len() == grid.len() => return f64::INFINITY,
            None => farthest *= 1.5,
        }
    }
}

/// Packing fraction at a place: volume of the spheres, of one diameter (m), whose centres are at
/// most `distance` (m) away, over the volume of their cells. `None` without such spheres.
pub fn local_packing_fraction(
    grid: &CellGrid<'_>,
    cells: &[VoronoiCell],
    diameter: f64,
    place: Vector,
    distance: f64,
) -> Option<f64> {
    let (mut spheres, mut volume) = (0, 0.0);
    grid.within(place, distance, |sphere, _| {
        spheres += 1;
        volume += cells[sphere].volume;
    });
    let sphere = PI / 6.0 * diameter * diameter * diameter;
    (spheres > 0).then(|| f64::from(spheres) * sphere / volume)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::synthetic::{cubic, ideal_gas, of};
    use proptest::prelude::*;

    fn walls(side: f64) -> CellBounds {
        CellBounds {
            low: [0.0; 3],
            high: [side; 3],
            farthest: 1e3,
        }
    }

    /// The cells of a lattice, `basis` in cubes of this width, that no wall touches.
    fn inner(basis: &[[f64; 3]], cubes: usize) -> Vec<VoronoiCell> {
        let corner = cubic(cubes);
        let places = corner
            .place
            .iter()
            .flat_map(|it| basis.iter().map(|b| *it + Vector::from(*b)));
        let centres = of(places.collect());
        let cells = voronoi_cells(&centres, &walls(cubes as f64));
        let middle = |it: &Vector| {
            let from = [it.x, it.y, it.z].map(|it| (it - 0.5 * cubes as f64).abs());
            from.into_iter().fold(0.0, f64::max) < 0.5 * cubes as f64 - 1.3
        };
        let pairs = centres.place.iter().zip(cells);
        pairs
            .filter(|(it, _)| middle(it))
            .map(|(_, cell)| cell)
            .collect()
    }

    /// Corners where more than three faces meet are the hard case of cutting.
    #[test]
    fn cells_of_lattices_have_closed_forms() {
        let half = 0.5;
        let fcc = [
            [0.0; 3],
            [half, half, 0.0],
            [half, 0.0, half],
            [0.0, half, half],
        ];
        let bcc = [[0.0; 3], [half; 3]];
        for (basis, volume, faces) in [
            (&[[0.0; 3]][..], 1.0, 6),
            (&fcc[..], 0.25, 12),
            (&bcc[..], 0.5, 14),
        ] {
            let cells = inner(basis, 5);
            assert!(!cells.is_empty());
            for cell in cells {
                assert!((cell.volume - volume).abs() < 1e-12, "{cell:?}");
                assert_eq!(cell.faces, faces, "{volume}");
            }
        }
    }

    #[test]
    fn at_a_free_surface_cells_end_at_the_farthest() {
        let walls = CellBounds {
            low: [-1.0; 3],
            high: [1.0, 1.0, f64::INFINITY],
            farthest: 3.0,
        };
        let cells = voronoi_cells(&of(vec![Vector::ZERO]), &walls);
        assert!((cells[0].volume - 2.0 * 2.0 * 4.0).abs() < 1e-12);
    }

    #[test]
    fn the_packing_fraction_of_a_lattice_is_found() {
        let lattice = cubic(11);
        let shifted = of(lattice
            .place
            .iter()
            .map(|it| *it + Vector::new(0.5, 0.5, 0.5))
            .collect());
        let cells = voronoi_cells(&shifted, &walls(11.0));
        let grid = CellGrid::new(&shifted.place, 1.0);
        let at = Vector::new(5.3, 5.1, 5.2);
        let fraction = local_packing_fraction(&grid, &cells, 1.0, at, 2.2).unwrap();
        assert!((fraction - PI / 6.0).abs() < 1e-12, "{fraction}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]
        #[test]
        fn cells_fill_the_box(count in 1_usize..400, stream in 0_u32..1000, flat in 0.2..1.0) {
            let mut gas = ideal_gas(count, 1.0, &stream.to_string());
            for place in &mut gas.place {
                place.z *= flat;
            }
            let walls = CellBounds { low: [0.0; 3], high: [1.0, 1.0, flat], farthest: 9.0 };
            let volume: f64 = voronoi_cells(&gas, &walls).iter().map(|cell| cell.volume).sum();
            prop_assert!((volume / flat - 1.0).abs() < 1e-9, "{volume}");
        }
    }
}
