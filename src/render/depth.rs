//! The nearest objects along parallel rays from the viewer and from the light.

use super::Stage;
use super::shade::ShadedSphere;
use crate::particles::vector::Vector;

/// Something a ray can hit first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Hit {
    /// Nothing.
    Nothing,
    /// The floor.
    Floor,
    /// The sphere with this index.
    Sphere(u32),
}

/// A grid of parallel rays.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rays {
    /// Unit vectors along rows, against columns, and against the rays.
    pub(super) axes: [Vector; 3],
    /// The point in the middle of the grid (m).
    pub(super) centre: Vector,
    /// Rays per metre.
    pub(super) scale: f64,
    pub(super) width: usize,
    pub(super) height: usize,
}

impl Rays {
    /// Column, row (the centre of the first ray is at .5) and depth (m) of a point.
    pub(super) fn project(&self, point: Vector) -> [f64; 3] {
        let [right, up, near] = self.axes;
        let offset = point - self.centre;
        [
            0.5 * self.width as f64 + offset.dot(right) * self.scale,
            0.5 * self.height as f64 - offset.dot(up) * self.scale,
            offset.dot(near),
        ]
    }

    /// The point at depth 0 of the ray in this column and row.
    pub(super) fn origin(&self, column: usize, row: usize) -> Vector {
        let [right, up, _] = self.axes;
        let across = (column as f64 + 0.5 - 0.5 * self.width as f64) / self.scale;
        let along = (0.5 * self.height as f64 - row as f64 - 0.5) / self.scale;
        self.centre + right * across + up * along
    }
}

/// The first hit of every ray.
pub(super) struct DepthMap {
    pub(super) rays: Rays,
    /// Depth of the hit (m), larger is nearer; minus infinity for none.
    depth: Vec<f32>,
    hit: Vec<Hit>,
}

impl DepthMap {
    pub(super) fn new(rays: Rays, spheres: &[ShadedSphere]) -> Self {
        let count = rays.width * rays.height;
        let mut map = Self {
            rays,
            depth: vec![f32::NEG_INFINITY; count],
            hit: vec![Hit::Nothing; count],
        };
        for (index, sphere) in (0..).zip(spheres) {
            map.add(index, sphere);
        }
        map
    }

    /// Adds the floor of a stage, seen from above.
    pub(super) fn add_floor(&mut self, stage: &Stage) {
        let near = self.rays.axes[2];
        let Some(floor) = stage.floor.filter(|_| near.z > 1e-6) else {
            return;
        };
        for row in 0..self.rays.height {
            for column in 0..self.rays.width {
                let origin = self.rays.origin(column, row);
                let depth = (floor - origin.z) / near.z;
                let point = origin + near * depth;
                if stage.is_within(point) {
                    self.put(column + row * self.rays.width, depth, Hit::Floor);
                }
            }
        }
    }

    fn add(&mut self, index: u32, sphere: &ShadedSphere) {
        let Rays { scale, .. } = self.rays;
        let [x, y, depth] = self.rays.project(sphere.centre);
        let reach = sphere.radius * scale;
        for row in covered(y, reach, self.rays.height) {
            let down = row as f64 + 0.5 - y;
            let half = (reach * reach - down * down).max(0.0).sqrt();
            for column in covered(x, half, self.rays.width) {
                let across = column as f64 + 0.5 - x;
                let rise = (half * half - across * across).max(0.0).sqrt() / scale;
                let at = column + row * self.rays.width;
                self.put(at, depth + rise, Hit::Sphere(index));
            }
        }
    }

    fn put(&mut self, at: usize, depth: f64, hit: Hit) {
        let depth = depth as f32;
        if depth > self.depth[at] {
            self.depth[at] = depth;
            self.hit[at] = hit;
        }
    }

    /// Depth (m) and hit of a ray.
    pub(super) fn at(&self, column: usize, row: usize) -> (f64, Hit) {
        let at = column + row * self.rays.width;
        (f64::from(self.depth[at]), self.hit[at])
    }

    /// Depth and hit of the ray that is `across` columns and `down` rows off, if there is one.
    pub(super) fn near(&self, column: f64, row: f64) -> Option<(f64, Hit)> {
        let inside = |place: f64, count: usize| (0.0..count as f64).contains(&place);
        (inside(column, self.rays.width) && inside(row, self.rays.height))
            .then(|| self.at(column as usize, row as usize))
    }
}

/// Indices of the cells, of `count`, whose centres are within `reach` of `middle`.
fn covered(middle: f64, reach: f64, count: usize) -> std::ops::Range<usize> {
    // Casts from floating point saturate: values below the first become the first, beyond the last
    // the last.
    let first = (middle - reach - 0.5).ceil() as usize;
    let end = (middle + reach - 0.5).floor() + 1.0;
    first.min(count)..(end as usize).min(count)
}
