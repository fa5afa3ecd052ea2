//! What the spheres move in, and how much of it is seen.

use crate::dem::vector::Vector;
use crate::observe::Snapshot;
use crate::scene::Scene;

/// The walls, and the box that is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// Radius of the cylinder about the z axis (m), if there is one.
    pub radius: Option<f64>,
    /// Height of the floor (m), if there is one.
    pub floor: Option<f64>,
    /// Corners of the box that is seen (m): least x, y and z, then the largest.
    pub seen: [[f64; 3]; 2],
}

impl Stage {
    /// A stage with these walls and nothing on it yet.
    pub fn new(radius: Option<f64>, floor: Option<f64>) -> Self {
        let reach = radius.unwrap_or(0.0);
        let floor_or_zero = floor.unwrap_or(0.0);
        Self {
            radius,
            floor,
            seen: [
                [-reach, -reach, floor_or_zero],
                [reach, reach, floor_or_zero],
            ],
        }
    }

    /// The stage of a scene, with nothing on it yet.
    pub fn of_scene(scene: &Scene) -> Self {
        let tank = scene.tank.as_ref();
        Self::new(
            tank.and_then(|tank| tank.radius),
            tank.and_then(|tank| tank.floor),
        )
    }

    /// The stage seen so far up and wide that it holds all spheres of these snapshots.
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

    /// The stage seen so far up and wide that it holds spheres with these centres and radii (m).
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
        self.radius.is_none() && self.floor.is_none() && self.seen[0] == self.seen[1]
    }

    /// The stage seen up to the height `top` (m), whatever flies above.
    #[must_use]
    pub fn up_to(mut self, top: f64) -> Self {
        self.seen[1][2] = top.max(self.seen[0][2]);
        self
    }

    /// The stage no taller than `ratio` times its width: within a tank its upper part is not seen,
    /// without one more is seen beside the spheres.
    #[must_use]
    pub fn no_taller(mut self, ratio: f64) -> Self {
        let [low, high] = self.seen;
        let width = high[0] - low[0];
        let height = (high[2] - low[2]).min(f64::MAX);
        if height <= ratio * width {
            return self;
        }
        if self.radius.is_some() {
            return self.up_to(low[2] + ratio * width);
        }
        let middle = low[0] + 0.5 * width;
        let half = 0.5 * height / ratio;
        (self.seen[0][0], self.seen[1][0]) = (middle - half, middle + half);
        self
    }

    /// Points that enclose all that is seen, in coordinates along x and along `up`, where `up` has
    /// no component along x.
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

    /// Point by point around the rim of the cylinder at height `z`; none without a cylinder.
    pub(super) fn rim(&self, z: f64) -> Vec<Vector> {
        const CORNERS: usize = 180;
        let Some(radius) = self.radius else {
            return Vec::new();
        };
        (0..=CORNERS)
            .map(|corner| {
                let angle = std::f64::consts::TAU * corner as f64 / CORNERS as f64;
                let (sine, cosine) = libm::sincos(angle);
                Vector::new(radius * cosine, radius * sine, z)
            })
            .collect()
    }
}
