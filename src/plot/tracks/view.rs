//! Where the spheres of a run are seen from, and what of the tank is in sight.

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

/// The smallest and the largest of some values.
pub(super) fn ends(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
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
        for (direction, (low, high)) in ranges.iter_mut().enumerate() {
            let (span, least) = if to_scale {
                (span[direction], LEAST_ASPECT * longest)
            } else {
                (span[direction], 0.0)
            };
            let padding = if !to_scale && direction == 0 {
                0.0
            } else {
                PADDING * if to_scale { longest } else { span }
            };
            let more = padding + 0.5 * (least - span).max(0.0);
            (*low, *high) = (*low - more, *high + more);
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
enum Wall {
    /// The tank from above, of that radius.
    Circle(f64),
    /// A line across, at that height.
    Level(f64),
    /// A line upward, there.
    Upright(f64),
}

fn walls(record: &RunRecord, view: View) -> Vec<Wall> {
    let Some(tank) = &record.scene.tank else {
        return Vec::new();
    };
    let radius = tank.radius.map(|radius| MILLI * radius);
    let floor = tank.floor.map(|floor| Wall::Level(MILLI * floor));
    let sides = |side: fn(f64) -> Wall| radius.into_iter().flat_map(move |r| [side(-r), side(r)]);
    match view {
        View::Plane { up: 1, .. } => radius.map(Wall::Circle).into_iter().collect(),
        View::Plane { .. } => sides(Wall::Upright).chain(floor).collect(),
        View::Time { up: 2 } => floor.into_iter().collect(),
        View::Time { .. } => sides(Wall::Level).collect(),
    }
}

impl Wall {
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
