//! Random walls beside the nearest of many of their points, and joints by how often each point of
//! several walls counts.

use super::*;
use crate::particles::vector::Vector;
use proptest::prelude::*;

/// How many parts a wall is cut into, along each of its two directions.
const PARTS: usize = 160;

fn shares() -> impl Iterator<Item = f64> + Clone {
    (0..=PARTS).map(|k| k as f64 / PARTS as f64)
}

/// The least distance from a place to points of a wall, which `point` gives for two numbers from 0
/// to 1; and the largest gap between neighbours of these points.
fn least_distance(place: Vector, gap: f64, point: impl Fn(f64, f64) -> Vector) -> [f64; 2] {
    let all = shares().flat_map(|a| shares().map(move |b| (a, b)));
    let distances = all.map(|(a, b)| (point(a, b) - place).norm());
    [distances.fold(f64::INFINITY, f64::min), gap / PARTS as f64]
}

fn vector(size: f64) -> impl Strategy<Value = Vector> {
    let part = move || -size..size;
    (part(), part(), part()).prop_map(|(x, y, z)| Vector::new(x, y, z))
}

fn check(surface: WallSurface, place: Vector, [least, gap]: [f64; 2]) -> Result<(), TestCaseError> {
    for radius in [0.1, 0.5, 2.0] {
        let contact = surface.contact(place, radius);
        let distance = radius - contact.overlap;
        prop_assert!(distance <= least + 1e-9, "{distance} {least}");
        prop_assert!(distance >= least - gap, "{distance} {least} {gap}");
        prop_assert_eq!(contact.touches, contact.overlap > 0.0);
        prop_assert!((contact.normal.norm() - 1.0).abs() < 1e-9);
        let foot = place - contact.normal * distance;
        prop_assert!((surface.foot(foot) - foot).norm() < 1e-7 * (1.0 + place.norm()));
        prop_assert_eq!(surface.is_near(place, radius, 0.3), distance < radius + 0.3);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn a_plate_is_touched_at_its_nearest_point(
        corner in vector(1.0), a in vector(1.0), b in vector(1.0), place in vector(2.0),
    ) {
        prop_assume!(a.cross(b).norm() > 0.05);
        let plate = Parallelogram::new(corner, [a, b]);
        let least = least_distance(place, a.norm() + b.norm(), |s, t| corner + a * s + b * t);
        check(WallSurface::Parallelogram(plate), place, least)?;
    }

    #[test]
    fn what_turned_about_an_axis_is_touched_at_its_nearest_point(
        base in vector(1.0), axis in vector(1.0), place in vector(2.0),
        from in 0.0..1.0_f64, to in 0.0..1.0_f64, length in 0.0..2.0_f64,
    ) {
        prop_assume!(axis.norm() > 0.1);
        let axis = axis.unit();
        let surface = Revolved::between(base, axis, [from, 0.0], [to, length]);
        let across = Vector::new(axis.y, axis.z, -axis.x).perpendicular_to(axis);
        prop_assume!(across.norm() > 0.1 && (place - base).perpendicular_to(axis).norm() > 1e-3);
        let (one, other) = (across.unit(), axis.cross(across.unit()));
        let least = least_distance(place, length + 1.0 + 7.0, |s, t| {
            let (sine, cosine) = libm::sincos(t * std::f64::consts::TAU);
            let radius = from + (to - from) * s;
            base + axis * (length * s) + (one * cosine + other * sine) * radius
        });
        check(WallSurface::Revolved(surface), place, least)?;
    }

    #[test]
    fn a_line_is_touched_at_its_nearest_point(
        from in vector(1.0), along in vector(1.0), place in vector(2.0),
    ) {
        let segment = Segment::new(from, along);
        let least = least_distance(place, along.norm(), |s, _| from + along * s);
        check(WallSurface::Segment(segment), place, least)?;
    }

    /// The sum over walls and joints is one wherever a wall is, for plates that share edges.
    #[test]
    fn every_point_of_joined_walls_counts_once(
        angles in prop::collection::vec(-1.5..1.5_f64, 1..4), share in 0.0..1.0_f64,
    ) {
        // A strip that is folded along parallel lines.
        let depth = Vector::new(0.0, 1.0, 0.0);
        let (mut corner, mut walls, mut places) = (Vector::ZERO, Vec::new(), Vec::new());
        for angle in &angles {
            let (sine, cosine) = libm::sincos(*angle);
            let along = Vector::new(cosine, 0.0, sine);
            walls.push(plate(walls.len(), corner, [along, depth]));
            places.push(corner + along * share + depth * 0.3);
            corner += along;
            places.push(corner + depth * share);
        }
        prop_assume!(angles.windows(2).all(|two| (two[0] - two[1]).abs() > 1e-3));
        let joined = with_joints(walls, 1e-6);
        for place in places {
            prop_assert!((count_at(&joined, place) - 1.0).abs() < 1e-12, "{place:?}");
        }
    }
}

fn plate(place: usize, corner: Vector, edges: [Vector; 2]) -> Wall {
    let surface = WallSurface::Parallelogram(Parallelogram::new(corner, edges));
    Wall::new(surface, WallName::Listed(place))
}

fn revolved(place: usize, base: Vector, from: [f64; 2], to: [f64; 2]) -> Wall {
    let axis = Vector::new(0.0, 0.0, 1.0);
    let surface = WallSurface::Revolved(Revolved::between(base, axis, from, to));
    Wall::new(surface, WallName::Listed(place))
}

/// How often a place counts.
fn count_at(walls: &[Wall], place: Vector) -> f64 {
    let here = |wall: &&Wall| (wall.surface.foot(place) - place).norm() < 1e-6;
    walls.iter().filter(here).map(|wall| wall.weight).sum()
}

#[test]
fn four_plates_around_a_corner_count_once_there() {
    let (x, y) = (Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0));
    let corners = [Vector::ZERO, -x, -y, -x - y];
    let walls = corners.into_iter().enumerate();
    let walls = walls
        .map(|(place, corner)| plate(place, corner, [x, y]))
        .collect();
    let joined = with_joints(walls, 1e-6);
    // Four lines, and the corner.
    assert_eq!(joined.len(), 9);
    for place in [Vector::ZERO, x * 0.3, y * 0.2, -x * 0.9, (x + y) * 0.5] {
        assert_eq!(count_at(&joined, place), 1.0, "{place:?}");
    }
}

#[test]
fn three_plates_at_one_edge_count_once_there() {
    let y = Vector::new(0.0, 1.0, 0.0);
    let edges = [0.0, 2.0, 4.0].map(|angle: f64| {
        let (sine, cosine) = libm::sincos(angle);
        Vector::new(cosine, 0.0, sine)
    });
    let walls = edges.into_iter().enumerate();
    let walls = walls
        .map(|(place, edge)| plate(place, Vector::ZERO, [edge, y]))
        .collect();
    let joined = with_joints(walls, 1e-6);
    assert_eq!(joined.len(), 4);
    assert_eq!(count_at(&joined, y * 0.4), 1.0);
}

/// A bin: tube, cone below it, outlet tube, with a lid on it and a ring around its outlet.
#[test]
fn rims_of_a_hopper_count_once() {
    let up = Vector::new(0.0, 0.0, 1.0);
    let walls = vec![
        revolved(0, up * 1.0, [0.5, 0.0], [0.5, 1.0]),
        revolved(1, Vector::ZERO, [0.1, 0.0], [0.5, 1.0]),
        revolved(2, up * -0.2, [0.1, 0.0], [0.1, 0.2]),
        revolved(3, up * 2.0, [0.0, 0.0], [0.5, 0.0]),
        revolved(4, Vector::ZERO, [0.1, 0.0], [0.3, 0.0]),
    ];
    let joined = with_joints(walls, 1e-6);
    let x = Vector::new(1.0, 0.0, 0.0);
    for (place, lines) in [(x * 0.5 + up, 1), (x * 0.1, 1), (x * 0.5 + up * 2.0, 1)] {
        let circles = joined[5..].iter();
        let here = circles.filter(|it| (it.surface.foot(place) - place).norm() < 1e-6);
        assert_eq!(here.count(), lines);
        assert_eq!(count_at(&joined, place), 1.0, "{place:?}");
    }
    assert_eq!(joined.len(), 8);
}

/// Walls of a tank meet in corners, which spheres do not reach.
#[test]
fn a_tank_alone_has_no_joints() {
    let tank = crate::scene::Tank {
        width: Some(1.0),
        depth: Some(2.0),
        floor: Some(0.0),
        ..crate::scene::Tank::default()
    };
    assert_eq!(with_joints(Wall::of_tank(&tank, false), 1e-6).len(), 5);
}

#[test]
fn a_plate_in_a_drum_joins_along_its_edge() {
    let drum = revolved(0, Vector::ZERO, [1.0, 0.0], [1.0, 2.0]);
    let (x, z) = (Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 0.0, 1.0));
    let lifter = plate(1, x * 0.8, [x * 0.2, z * 2.0]);
    let joined = with_joints(vec![drum, lifter], 1e-6);
    assert_eq!(joined.len(), 3);
    assert_eq!(count_at(&joined, x + z * 0.7), 1.0);
}

/// Where a door joins another wall, that wall is whole again without it.
#[test]
fn joints_of_a_door_go_with_it() {
    let (x, y) = (Vector::new(1.0, 0.0, 0.0), Vector::new(0.0, 1.0, 0.0));
    let door = Wall {
        weight_when_open: 0.0,
        ..plate(1, x, [x, y])
    };
    let joined = with_joints(vec![plate(0, Vector::ZERO, [x, y]), door], 1e-6);
    assert_eq!(joined.len(), 3);
    assert_eq!((joined[2].weight, joined[2].weight_when_open), (-1.0, 0.0));
}
