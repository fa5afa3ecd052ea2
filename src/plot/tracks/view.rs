//! Where the spheres of a run are seen from, and what of the tank is in sight.

use crate::plot::chart::ends;
use crate::record::RunRecord;

/// Names of the coordinates.
const NAMES: [char; 3] = ['x', 'y', 'z'];

/// Spheres move along a line if they move less than this across it, in lengths of their way.
const STRAIGHT: f64 = 0.02;

/// A plane is at least this long in each direction, in lengths of the other.
const LEAST_ASPECT: f64 = 0.3;

/// White around the spheres, in lengths of the picture.
const PADDING: f64 = 0.05;

/// Points on a circle.
const CIRCLE: usize = 720;

/// Millimetres per metre, and milliseconds per second.
const MILLI: f64 = 1e3;

/// What a picture shows along its two directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum View {
    /// Two coordinates, to scale.
    Plane { across: usize, up: usize },
    /// One coordinate over time, where all motion is along one line.
    Time { up: usize },
}

impl View {
    /// The view in which the spheres of a record move most.
    pub(super) fn new(record: &RunRecord) -> Self {
        let extent = [0, 1, 2].map(|axis| {
            let values = record
                .trajectory
                .iter()
                .flat_map(|frame| frame.position.column(axis).to_vec());
            let (low, high) = ends(values);
            high - low
        });
        let mut order = [0, 1, 2];
        // Stable: of equal extents the first ones count.
        order.sort_by(|&a, &b| extent[b].total_cmp(&extent[a]));
        if extent[order[1]] <= STRAIGHT * extent[order[0]] {
            return Self::Time { up: order[0] };
        }
        Self::Plane {
            across: order[0].min(order[1]),
            up: order[0].max(order[1]),
        }
    }

    /// Where a place at a time is seen: in millimetres and milliseconds.
    pub(super) fn place(self, time: f64, position: [f64; 3]) -> (f64, f64) {
        match self {
            Self::Plane { across, up } => (MILLI * position[across], MILLI * position[up]),
            Self::Time { up } => (MILLI * time, MILLI * position[up]),
        }
    }

    /// The spin about the line of sight, counter-clockwise as it is seen.
    pub(super) fn turning(self, spin: [f64; 3]) -> f64 {
        match self {
            Self::Plane { across: 0, up: 1 } => spin[2],
            // With x to the right and z upward, y points away.
            Self::Plane { across: 0, .. } => -spin[1],
            Self::Plane { .. } => spin[0],
            Self::Time { .. } => 0.0,
        }
    }

    /// Labels of the two directions.
    pub(super) fn labels(self) -> [String; 2] {
        let length = |axis: usize| format!("${}$ (mm)", NAMES[axis]);
        match self {
            Self::Plane { across, up } => [length(across), length(up)],
            Self::Time { up } => ["$t$ (ms)".to_owned(), length(up)],
        }
    }
}

/// What is in sight: the ranges of both directions and the outline of the tank therein.
pub(super) struct Sight {
    /// Lowest and highest value, to the right and upward.
    pub(super) ranges: [(f64, f64); 2],
    /// Lines of the tank.
    pub(super) outline: Vec<Vec<(f64, f64)>>,
}

impl Sight {
    /// All spheres at all times, and the walls that they come near.
    pub(super) fn new(record: &RunRecord, view: View) -> Self {
        let mut ranges = [0, 1].map(|direction| {
            let edges = places(record, view).flat_map(|(place, radius)| {
                let (at, radius) = match (view, direction) {
                    (View::Time { .. }, 0) => (place.0, 0.0),
                    (_, 0) => (place.0, radius),
                    _ => (place.1, radius),
                };
                [at - radius, at + radius]
            });
            ends(edges)
        });
        let walls = walls(record, view);
        let largest = MILLI * record.radius.iter().fold(0.0, |a: f64, &b| a.max(b));
        for wall in &walls {
            if wall.is_near(&ranges, largest) {
                wall.include_in(&mut ranges);
            }
        }
        let to_scale = matches!(view, View::Plane { .. });
        let span = ranges.map(|(low, high)| high - low);
        let longest = span[0].max(span[1]);
        for (direction, range) in ranges.iter_mut().enumerate() {
            let more = match (to_scale, direction) {
                (true, _) => {
                    let lacking = LEAST_ASPECT * longest - span[direction];
                    PADDING * longest + 0.5 * lacking.max(0.0)
                }
                (false, 0) => 0.0,
                (false, _) => PADDING * span[direction],
            };
            *range = (range.0 - more, range.1 + more);
        }
        let outline = walls
            .iter()
            .flat_map(|wall| inside(&wall.points(&ranges), &ranges))
            .collect();
        Self { ranges, outline }
    }
}

/// Every place of every sphere as it is seen, and its radius there.
fn places(record: &RunRecord, view: View) -> impl Iterator<Item = ((f64, f64), f64)> {
    record.trajectory.iter().flat_map(move |frame| {
        let rows = frame.position.outer_iter().zip(&record.radius);
        rows.map(move |(centre, radius)| {
            let centre = [centre[0], centre[1], centre[2]];
            (view.place(frame.time, centre), MILLI * radius)
        })
    })
}

/// A wall as it is seen.
enum SeenWall {
    /// The tank from above, of that radius.
    Circle(f64),
    /// A line across, at that height.
    Level(f64),
    /// A line upward, there.
    Upright(f64),
}

fn walls(record: &RunRecord, view: View) -> Vec<SeenWall> {
    let Some(tank) = &record.scene.tank else {
        return Vec::new();
    };
    let reach = tank.reach().map(|reach| reach.map(|reach| MILLI * reach));
    let floor = tank.floor.map(|floor| SeenWall::Level(MILLI * floor));
    let sides = |axis: usize, side: fn(f64) -> SeenWall| {
        let reach = reach[axis].into_iter();
        reach.flat_map(move |reach| [side(-reach), side(reach)])
    };
    match view {
        View::Plane { up: 1, .. } if tank.radius.is_some() => {
            reach[0].map(SeenWall::Circle).into_iter().collect()
        }
        View::Plane { across, up: 1 } => sides(across, SeenWall::Upright)
            .chain(sides(1, SeenWall::Level))
            .collect(),
        View::Plane { across, .. } => sides(across, SeenWall::Upright).chain(floor).collect(),
        View::Time { up: 2 } => floor.into_iter().collect(),
        View::Time { up } => sides(up, SeenWall::Level).collect(),
    }
}

impl SeenWall {
    /// Whether something in these ranges is about to touch it.
    fn is_near(&self, [across, up]: &[(f64, f64); 2], largest: f64) -> bool {
        let near =
            |(low, high): (f64, f64), at: f64| (low - largest..=high + largest).contains(&at);
        match *self {
            // Only half of a radius away from it a picture gains from leaving it out.
            Self::Circle(radius) => [across.0, across.1, up.0, up.1]
                .iter()
                .any(|edge| edge.abs() >= 0.5 * radius),
            Self::Level(height) => near(*up, height),
            Self::Upright(place) => near(*across, place),
        }
    }

    fn include_in(&self, [across, up]: &mut [(f64, f64); 2]) {
        let include = |range: &mut (f64, f64), at: f64| {
            *range = (range.0.min(at), range.1.max(at));
        };
        match *self {
            Self::Circle(radius) => {
                for range in [across, up] {
                    include(range, radius);
                    include(range, -radius);
                }
            }
            Self::Level(height) => include(up, height),
            Self::Upright(place) => include(across, place),
        }
    }

    fn points(&self, [across, up]: &[(f64, f64); 2]) -> Vec<(f64, f64)> {
        match *self {
            Self::Circle(radius) => (0..=CIRCLE)
                .map(|point| {
                    let angle = std::f64::consts::TAU * point as f64 / CIRCLE as f64;
                    let (sine, cosine) = libm::sincos(angle);
                    (radius * cosine, radius * sine)
                })
                .collect(),
            Self::Level(height) => vec![(across.0, height), (across.1, height)],
            Self::Upright(place) => vec![(place, up.0), (place, up.1)],
        }
    }
}

/// The pieces of a line whose points are in sight.
fn inside(points: &[(f64, f64)], [across, up]: &[(f64, f64); 2]) -> Vec<Vec<(f64, f64)>> {
    let visible =
        |&(x, y): &(f64, f64)| (across.0..=across.1).contains(&x) && (up.0..=up.1).contains(&y);
    let pieces = points.split(|point| !visible(point));
    let pieces = pieces.filter(|piece| piece.len() > 1);
    pieces.map(<[_]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::Snapshot;
    use crate::record::{Outcome, Program};
    use crate::scene::Tank;
    use ndarray::Array2;
    use serde_json::json;

    /// One sphere of 1 mm that goes through these places (m), a millisecond each.
    fn record(places: &[[f64; 3]], tank: Option<Tank>) -> RunRecord {
        let scene = serde_json::from_value(json!({
            "spheres": { "count": 1, "radius": 0.001, "density": 1e3 },
            "start": { "kind": "list", "spheres": [{ "position": places[0] }] },
            "time": { "dt": 1e-3, "duration": 1.0, "frame_interval": 1e-3 },
        }));
        let mut scene: crate::scene::Scene = scene.unwrap();
        scene.tank = tank;
        let snapshot = |(frame, place): (usize, &[f64; 3])| Snapshot {
            time: 1e-3 * frame as f64,
            position: Array2::from_shape_fn((1, 3), |(_, axis)| place[axis]),
            velocity: Array2::zeros((1, 3)),
            spin: Array2::zeros((0, 3)),
        };
        RunRecord {
            scene,
            program: Program::current(),
            outcome: Outcome::Completed,
            radius: vec![1e-3],
            mass: vec![1.0],
            milestones: Vec::new(),
            observations: crate::observe::Observations::default(),
            snapshots: Vec::new(),
            trajectory: places.iter().enumerate().map(snapshot).collect(),
            work: 0,
            cpu_seconds: 0.0,
        }
    }

    #[test]
    fn the_plane_is_that_of_the_largest_motions() {
        let cases = [
            ([0.0, 0.1, 0.3], View::Plane { across: 1, up: 2 }),
            ([0.1, -0.3, 0.05], View::Plane { across: 0, up: 1 }),
            ([0.2, 0.0, 0.2], View::Plane { across: 0, up: 2 }),
            ([0.0, 0.001, -0.3], View::Time { up: 2 }),
            ([0.0; 3], View::Time { up: 0 }),
        ];
        for (end, expected) in cases {
            assert_eq!(View::new(&record(&[[0.0; 3], end], None)), expected);
        }
    }

    #[test]
    fn spins_turn_as_they_are_seen() {
        let spin = [1.0, 2.0, 3.0];
        assert_eq!(View::Plane { across: 0, up: 1 }.turning(spin), 3.0);
        assert_eq!(View::Plane { across: 0, up: 2 }.turning(spin), -2.0);
        assert_eq!(View::Plane { across: 1, up: 2 }.turning(spin), 1.0);
    }

    #[test]
    fn walls_are_in_sight_where_spheres_come_near() {
        let tank = |radius, floor| {
            Some(Tank {
                radius,
                floor,
                ..Tank::default()
            })
        };
        let places = [[0.0, 0.0, 0.01], [0.03, 0.0, 0.03]];
        let sight = |tank| {
            let record = record(&places, tank);
            Sight::new(&record, View::new(&record))
        };
        assert!(sight(None).outline.is_empty());
        assert!(sight(tank(Some(0.06), Some(-0.2))).outline.is_empty());
        let floor = sight(tank(None, Some(0.009)));
        assert_eq!(floor.outline.len(), 1);
        assert!(floor.outline[0].iter().all(|point| point.1 == 9.0));
        let wall = sight(tank(Some(0.032), None));
        assert!(wall.outline[0].iter().all(|point| point.0 == 32.0));
        assert!(wall.ranges[0].1 > 32.0);

        let from_above = record(&[[0.0; 3], [0.03, 0.03, 0.0]], tank(Some(0.05), Some(0.0)));
        let circle = Sight::new(&from_above, View::new(&from_above));
        assert_eq!(circle.outline.len(), 1);
        let on_circle = |&(x, y): &(f64, f64)| (libm::hypot(x, y) - 50.0).abs() < 1e-9;
        assert!(circle.outline[0].len() > 100 && circle.outline[0].iter().all(on_circle));
    }

    #[test]
    fn everything_is_in_sight() {
        let record = record(&[[0.0; 3], [0.01, 0.3, 0.0], [0.05, -0.1, 0.0]], None);
        let [(left, right), (bottom, top)] = Sight::new(&record, View::new(&record)).ranges;
        assert!(left < -1.0 && right > 51.0 && bottom < -101.0 && top > 301.0);
        // Not narrower than three tenths of its height.
        assert!((right - left) > 0.3 * (top - bottom) * 0.9);
    }
}
