//! The walls around the spheres, and the visible part of the scene.

use crate::observe::Snapshot;
use crate::particles::Domain;
use crate::particles::vector::Vector;
use crate::scene::Scene;
use crate::walls::Wall;

/// The walls, and the visible box.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Radius of the cylinder about the z axis (m), if there is one.
    pub radius: Option<f64>,
    /// Distance of plane sides from the axis along x and along y (m), if there are any.
    pub sides: [Option<f64>; 2],
    /// Height of the floor (m), if there is one.
    pub floor: Option<f64>,
    /// Edges and rims of listed walls as lines from point to point (m).
    pub lines: Vec<Vec<Vector>>,
    /// Corners of the visible box (m): least x, y and z, then the largest.
    pub seen: [[f64; 3]; 2],
}

impl Stage {
    /// A stage with these walls and nothing on it yet.
    pub fn new(radius: Option<f64>, floor: Option<f64>) -> Self {
        let reach = radius.unwrap_or(0.0);
        let floor_or_zero = floor.unwrap_or(0.0);
        Self {
            radius,
            sides: [None; 2],
            floor,
            lines: Vec::new(),
            seen: [
                [-reach, -reach, floor_or_zero],
                [reach, reach, floor_or_zero],
            ],
        }
    }

    /// The stage of a scene, with nothing on it yet.
    pub fn of_scene(scene: &Scene) -> Self {
        let walls = Wall::of_scene(scene).into_iter();
        let lines = walls.flat_map(|wall| wall.outline()).collect();
        let Some(tank) = &scene.tank else {
            return Self::new(None, None)
                .with_lines(lines)
                .with_periods(scene.domain());
        };
        let stage = Self::new(tank.radius, tank.floor);
        let stage = match tank.radius {
            Some(_) => stage,
            None => stage.with_sides(tank.reach()),
        };
        stage.with_lines(lines).with_periods(scene.domain())
    }

    /// The stage, extended to the periodic box along the axes that have a period. An empty stage
    /// takes its extent from the spheres.
    fn with_periods(mut self, domain: Domain) -> Self {
        if self.is_empty() {
            return self;
        }
        for (axis, period) in domain.periods().into_iter().enumerate() {
            if let Some(half) = period.map(|period| 0.5 * period) {
                self.seen[0][axis] = self.seen[0][axis].min(-half);
                self.seen[1][axis] = self.seen[1][axis].max(half);
            }
        }
        self
    }

    /// The stage with lines (m), extended to include them.
    fn with_lines(mut self, lines: Vec<Vec<Vector>>) -> Self {
        for point in lines.iter().flatten() {
            let point = [point.x, point.y, point.z];
            if self.is_empty() {
                self.seen = [point; 2];
                // From now on it is not empty, however small.
                self.lines.clone_from(&lines);
            }
            for (axis, value) in point.into_iter().enumerate() {
                self.seen[0][axis] = self.seen[0][axis].min(value);
                self.seen[1][axis] = self.seen[1][axis].max(value);
            }
        }
        self.lines = lines;
        self
    }

    /// The stage with plane sides at these distances from the axis along x and along y (m), if
    /// there are any.
    #[must_use]
    pub fn with_sides(mut self, sides: [Option<f64>; 2]) -> Self {
        self.sides = sides;
        for (axis, reach) in sides.into_iter().enumerate() {
            let reach = reach.unwrap_or(0.0);
            self.seen[0][axis] = self.seen[0][axis].min(-reach);
            self.seen[1][axis] = self.seen[1][axis].max(reach);
        }
        self
    }

    /// Whether there are plane sides.
    pub(super) fn has_sides(&self) -> bool {
        self.sides.iter().any(Option::is_some)
    }

    /// Least and largest x and y between plane sides (m); without sides, of the visible box.
    pub(super) fn between_sides(&self) -> [[f64; 2]; 2] {
        [0, 1].map(|axis| {
            let seen = [self.seen[0][axis], self.seen[1][axis]];
            self.sides[axis].map_or(seen, |reach| [-reach, reach])
        })
    }

    /// Whether a point is within the walls around the stage.
    pub(super) fn is_within(&self, point: Vector) -> bool {
        let round = |radius: f64| point.x * point.x + point.y * point.y <= radius * radius;
        let along = |(reach, place): (Option<f64>, f64)| reach.is_none_or(|it| place.abs() <= it);
        let sides = self.sides.into_iter().zip([point.x, point.y]);
        self.radius.is_none_or(round) && sides.into_iter().all(along)
    }

    /// The stage, extended to include all spheres of these snapshots.
    #[must_use]
    pub fn around<'a>(
        mut self,
        snapshots: impl IntoIterator<Item = &'a Snapshot>,
        radius: &[f64],
    ) -> Self {
        for snapshot in snapshots {
            let centres = snapshot.position.rows().into_iter();
            let spheres = centres.zip(radius);
            self = self.around_spheres(
                spheres.map(|(centre, &radius)| ([centre[0], centre[1], centre[2]], radius)),
            );
        }
        self
    }

    /// The stage, extended to include spheres with these centres and radii (m).
    #[must_use]
    pub(super) fn around_spheres(
        mut self,
        spheres: impl IntoIterator<Item = ([f64; 3], f64)>,
    ) -> Self {
        for (centre, radius) in spheres {
            if !(centre.iter().all(|value| value.is_finite()) && radius.is_finite()) {
                continue;
            }
            if self.is_empty() {
                self.seen = [centre; 2];
            }
            for (axis, value) in centre.into_iter().enumerate() {
                self.seen[0][axis] = self.seen[0][axis].min(value - radius);
                self.seen[1][axis] = self.seen[1][axis].max(value + radius);
            }
        }
        self
    }

    /// Whether there is nothing to see yet, neither walls nor spheres.
    fn is_empty(&self) -> bool {
        self.radius.is_none()
            && !self.has_sides()
            && self.floor.is_none()
            && self.lines.is_empty()
            && self.seen[0] == self.seen[1]
    }

    /// The stage up to the height `top` (m), even if spheres are above it.
    #[must_use]
    pub fn up_to(mut self, top: f64) -> Self {
        self.seen[1][2] = top.max(self.seen[0][2]);
        self
    }

    /// The stage no taller than `ratio` times its width: in a tank its upper part is cut off;
    /// without a tank the view is widened.
    #[must_use]
    pub fn no_taller(mut self, ratio: f64) -> Self {
        let [low, high] = self.seen;
        let width = high[0] - low[0];
        let height = (high[2] - low[2]).min(f64::MAX);
        if height <= ratio * width {
            return self;
        }
        if self.radius.is_some() || self.has_sides() {
            return self.up_to(low[2] + ratio * width);
        }
        let middle = low[0] + 0.5 * width;
        let half = 0.5 * height / ratio;
        (self.seen[0][0], self.seen[1][0]) = (middle - half, middle + half);
        self
    }

    /// Points that enclose everything visible, in coordinates along x and along `up`, which has no
    /// component along x.
    pub(super) fn outline(&self, up: Vector) -> Vec<[f64; 2]> {
        let [low, high] = self.seen;
        let mut points = Vec::new();
        for x in [low[0], high[0]] {
            for y in [low[1], high[1]] {
                for z in [low[2], high[2]] {
                    points.push([x, up.y * y + up.z * z]);
                }
            }
        }
        points
    }

    /// Points around the rim of the walls at height `z`; empty without walls.
    pub(super) fn rim(&self, z: f64) -> Vec<Vector> {
        const CORNERS: usize = 180;
        let Some(radius) = self.radius else {
            let corners = self.has_sides().then(|| self.corners());
            let corners = corners.into_iter().flatten();
            return corners.map(|[x, y]| Vector::new(x, y, z)).collect();
        };
        (0..=CORNERS)
            .map(|corner| {
                let angle = std::f64::consts::TAU * corner as f64 / CORNERS as f64;
                let (sine, cosine) = libm::sincos(angle);
                Vector::new(radius * cosine, radius * sine, z)
            })
            .collect()
    }

    /// The corners of the box between plane sides, seen from above, in order, back to the first.
    pub(super) fn corners(&self) -> [[f64; 2]; 5] {
        let [[left, right], [front, back]] = self.between_sides();
        [
            [left, front],
            [right, front],
            [right, back],
            [left, back],
            [left, front],
        ]
    }
}
