//! Packing fractions of boxes whose spheres fill a known share of them.
//!
//! Symptom: `compare` never gave less than .065. Cause: Voronoi cells ended a diameter from their
//! centres, whether a free surface was there or not.

use crate::support::{Workplace, drainage_file};
use ndarray::Array2;
use phase::measure::{CellBounds, Centres, FilledBox, voronoi_cells};
use phase::simulation::Snapshot;
use phase::store::read_record;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use std::f64::consts::PI;

const SIDES: [f64; 3] = [20.0, 12.0, 40.0];

/// The fraction that `compare` gives spheres of diameter 1 at these places over a floor at 0.
fn fraction(places: &[[f64; 3]], [width, depth, _]: [f64; 3]) -> Option<f64> {
    let state = Snapshot {
        position: Array2::from_shape_fn((places.len(), 3), |(sphere, axis)| places[sphere][axis]),
        ..Snapshot::default()
    };
    FilledBox::new([0.5 * width, 0.5 * depth], 0.0, 1.0, &state).packing_fraction(&state)
}

/// A lattice of cells of this side, with the places `basis` in each, which fills a box.
fn lattice(basis: &[[f64; 3]], side: f64, cells: [usize; 3]) -> ([f64; 3], Vec<[f64; 3]>) {
    let sides = cells.map(|count| count as f64 * side);
    let mut places = Vec::new();
    for index in 0..cells.iter().product() {
        let [x, y, z] = [
            index % cells[0],
            index / cells[0] % cells[1],
            index / (cells[0] * cells[1]),
        ];
        for it in basis {
            places.push([
                (x as f64 + it[0]) * side - 0.5 * sides[0],
                (y as f64 + it[1]) * side - 0.5 * sides[1],
                (z as f64 + it[2]) * side,
            ]);
        }
    }
    (sides, places)
}

#[test]
fn lattices_fill_what_they_fill() {
    let cubic = [[0.5; 3]];
    let face_centred = [
        [0.25, 0.25, 0.25],
        [0.25, 0.75, 0.75],
        [0.75, 0.25, 0.75],
        [0.75, 0.75, 0.25],
    ];
    let expect = |basis: &[[f64; 3]], side: f64, expected: f64| {
        let (sides, places) = lattice(basis, side, [12, 6, 30]);
        let found = fraction(&places, sides).unwrap();
        assert!(
            (found / expected - 1.0).abs() < 1e-9,
            "{side}: {found}, not {expected}"
        );
    };
    for spacing in [1.0, 1.1, 1.3, 1.7, 2.0, 3.0, 9.0] {
        expect(&cubic, spacing, PI / 6.0 / (spacing * spacing * spacing));
        let share = PI / (3.0 * 2.0_f64.sqrt()) / (spacing * spacing * spacing);
        expect(&face_centred, 2.0_f64.sqrt() * spacing, share);
    }
    let (sides, places) = lattice(&cubic, 3.0, [12, 6, 30]);
    let found = fraction(&places, sides).unwrap();
    assert!((found - 0.01939).abs() < 5e-6, "{found}");
}

/// Spheres at random without overlap, of diameter 1, which fill a share of the box.
fn at_random(share: f64, seed: u64) -> Vec<[f64; 3]> {
    let mut random = Pcg64::seed_from_u64(seed);
    let count = (share * SIDES.iter().product::<f64>() / (PI / 6.0)).round() as usize;
    let mut cells = std::collections::HashMap::<[i64; 3], Vec<[f64; 3]>>::new();
    let mut places = Vec::new();
    while places.len() < count {
        let unit: [f64; 3] = [random.random(), random.random(), random.random()];
        let place: [f64; 3] = std::array::from_fn(|axis| {
            let corner = if axis == 2 { 0.0 } else { -0.5 * SIDES[axis] };
            corner + 0.5 + unit[axis] * (SIDES[axis] - 1.0)
        });
        let cell = place.map(|it| it.floor() as i64);
        let near = (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]);
        let near = near.filter_map(|away: [i64; 3]| {
            cells.get(&std::array::from_fn(|axis| cell[axis] + away[axis]))
        });
        let apart = |other: &[f64; 3]| -> f64 {
            (0..3)
                .map(|axis| (place[axis] - other[axis]) * (place[axis] - other[axis]))
                .sum()
        };
        if near.flatten().all(|other| apart(other) >= 1.0) {
            cells.entry(cell).or_default().push(place);
            places.push(place);
        }
    }
    places
}

/// Volume of the spheres in the middle by their centres, over the volume of the middle.
fn by_counting(places: &[[f64; 3]]) -> f64 {
    let top = places.iter().map(|it| it[2]).fold(0.0, f64::max);
    let [x, low, high] = [0.3 * SIDES[0], 0.14 * top, 0.41 * top];
    let inside = |it: &&[f64; 3]| it[0].abs() < x && (low..high).contains(&it[2]);
    let count = places.iter().filter(inside).count();
    count as f64 * PI / 6.0 / (2.0 * x * SIDES[1] * (high - low))
}

/// Within the scatter of so many spheres.
#[test]
fn random_places_fill_their_share() {
    for share in [0.03, 0.1, 0.2, 0.28] {
        let (mut found, mut counted) = (0.0, 0.0);
        for seed in 0..6 {
            let places = at_random(share, seed);
            found += fraction(&places, SIDES).unwrap() / 6.0;
            counted += by_counting(&places) / 6.0;
        }
        assert!(
            (found / counted - 1.0).abs() < 0.03,
            "{share}: {found}, counted {counted}"
        );
        // Centres keep half a diameter from the walls, which leaves more spheres to the middle.
        let [width, _, height] = SIDES.map(|side| (side - 1.0) / side);
        let expected = share / (width * height);
        assert!(
            (found / expected - 1.0).abs() < 0.05,
            "{share}: {found}, not {expected}"
        );
    }
}

#[test]
fn a_few_spheres_fill_little_and_none_nothing() {
    assert_eq!(fraction(&[], SIDES), None);
    let one = fraction(&[[0.0, 0.0, 8.0], [1.0, 0.0, 30.0]], SIDES).unwrap();
    // The lower half of the box, up to the middle between the two.
    let expected = PI / 6.0 / (19.0 * SIDES[0] * SIDES[1]);
    assert!((one / expected - 1.0).abs() < 0.01, "{one} {expected}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]
    #[test]
    fn spheres_farther_apart_fill_less(seed in 0_u64..1000, factor in 1.05..4.0_f64) {
        let places = at_random(0.2, seed);
        let apart: Vec<_> = places.iter().map(|it| it.map(|part| factor * part)).collect();
        let before = fraction(&places, SIDES).unwrap();
        let after = fraction(&apart, SIDES.map(|side| factor * side)).unwrap();
        let expected = before / (factor * factor * factor);
        prop_assert!((after / expected - 1.0).abs() < 1e-6, "{after}, not {expected}");
    }
}

/// Dense packings are measured as before, to the bit: at their free surface cells end a diameter
/// from the centres.
#[test]
fn dense_packings_keep_their_fractions() {
    let place = Workplace::new();
    place.write("spots.toml", &drainage_file());
    place
        .phase(&["run", "spots.toml", "--out", "run.h5"])
        .code(0);
    let record = read_record(&place.path("run.h5")).unwrap();
    let start = &record.snapshots[0];
    let filled_box = FilledBox::new([4.5, 3.0], 0.0, 1.0, start);
    for state in &record.snapshots {
        let walls = CellBounds {
            low: [-4.5, -3.0, 0.0],
            high: [4.5, 3.0, f64::MAX],
            farthest: 1.0,
        };
        let centres = Centres::of(state);
        let region = filled_box.middle();
        let cells = voronoi_cells(&centres, &walls)
            .into_iter()
            .zip(&centres.place);
        let inside = cells.filter(|(_, place)| region.contains(**place));
        let volumes: Vec<f64> = inside.map(|(cell, _)| cell.volume).collect();
        let expected = volumes.len() as f64 * PI / 6.0 / volumes.iter().sum::<f64>();
        assert_eq!(filled_box.packing_fraction(state), Some(expected));
    }
}
