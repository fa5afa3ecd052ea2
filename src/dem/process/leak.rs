//! Whether a disc passed between two fixed ones where there is no way through.
//!
//! A wall of fixed discs is soft: a grain that is fast or heavy enough squeezes through. Neighbours
//! whose gap is too narrow even for the smallest grain are taken to form a wall, and no grain's
//! centre may cross the line between their centres.

use super::Free;
use crate::particles::Particles;
use crate::scene::{FixedSphere, FixedSpheres, Scene, Shape};
use crate::simulation::{Guard, Instability};

/// A point of the plane, x and z (m).
pub(super) type PlanePoint = [f64; 2];

/// Checks the ways of the centres of the discs.
pub(super) struct LeakWatch {
    walls: Barrier,
    /// Walls and door, while the door is closed.
    closed: Option<Barrier>,
    /// Number and centre of each disc at the latest check, in the order of their numbers.
    pub(super) before: Vec<(u32, PlanePoint)>,
}

impl LeakWatch {
    /// A watch over a scene of discs. `None` for spheres, whose walls have holes.
    pub(super) fn of_scene(scene: &Scene, fixed: &FixedSpheres) -> Option<Self> {
        let narrow = 2.0 * scene.smallest_radius();
        let with_door = [&fixed.walls[..], &fixed.door[..]].concat();
        (scene.spheres.shape == Shape::Disc && !with_door.is_empty()).then(|| Self {
            walls: Barrier::new(&fixed.walls, narrow),
            closed: Some(Barrier::new(&with_door, narrow)),
            before: Vec::new(),
        })
    }

    /// Takes the door away.
    pub(super) fn open_door(&mut self) {
        self.closed = None;
    }

    /// Reports the first disc that passed a wall since the latest check.
    pub(super) fn check(
        &mut self,
        particles: &Particles,
        free: &Free,
        step: u64,
        dt: f64,
    ) -> Result<(), Instability> {
        let barrier = self.closed.as_ref().unwrap_or(&self.walls);
        let mut discs: Vec<(u32, usize)> = free
            .indices(particles)
            .map(|i| (particles.number[i], i))
            .collect();
        discs.sort_unstable();
        let mut before = self.before.iter().peekable();
        for &(number, i) in &discs {
            let now = place(particles, i);
            while before.next_if(|(other, _)| *other < number).is_some() {}
            let Some(&(_, from)) = before.next_if(|(other, _)| *other == number) else {
                continue;
            };
            if let Some([[x1, z1, ..], [x2, z2, ..]]) = barrier.crossed(from, now) {
                return Err(Instability {
                    guard: Guard::WallPassed,
                    step,
                    time: step as f64 * dt,
                    sphere: i,
                    detail: format!(
                        "from ({:.4}, {:.4}) m to ({:.4}, {:.4}) m, between the fixed ones at \
                         ({:.4}, {:.4}) m and ({:.4}, {:.4}) m; stiffen the contact, or make it \
                         lighter or slower",
                        from[0], from[1], now[0], now[1], x1, z1, x2, z2
                    ),
                });
            }
        }
        self.before.clear();
        let discs = discs.into_iter();
        self.before
            .extend(discs.map(|(number, i)| (number, place(particles, i))));
        Ok(())
    }
}

fn place(particles: &Particles, i: usize) -> PlanePoint {
    [particles.position[i].x, particles.position[i].z]
}

/// Lines between neighbouring fixed discs, sorted into cells.
struct Barrier {
    lines: Vec<[PlanePoint; 2]>,
    low: PlanePoint,
    width: f64,
    shape: [usize; 2],
    /// Lines that reach into each cell or one next to it.
    cells: Vec<Vec<u32>>,
}

impl Barrier {
    /// Lines between all discs whose surfaces are less than `narrow` (m) apart.
    fn new(fixed: &[FixedSphere], narrow: f64) -> Self {
        let pairs = wall_pairs(fixed, narrow).into_iter();
        let lines: Vec<[PlanePoint; 2]> = pairs.map(|pair| pair.each_ref().map(centre)).collect();
        let ends = || lines.iter().flatten();
        let longest = lines
            .iter()
            .map(|[a, b]| length(*a, *b))
            .fold(0.0, f64::max);
        let bound = |axis: usize, pick: fn(f64, f64) -> f64, none: f64| {
            ends().map(|point| point[axis]).fold(none, pick)
        };
        let low = [0, 1].map(|axis| bound(axis, f64::min, f64::INFINITY));
        let high = [0, 1].map(|axis| bound(axis, f64::max, f64::NEG_INFINITY));
        let extent = (high[0] - low[0]).max(high[1] - low[1]).max(0.0);
        // A thousand cells along each side at most.
        let width = longest.max(1e-3 * extent).max(f64::MIN_POSITIVE);
        let shape = [0, 1].map(|axis| ((high[axis] - low[axis]).max(0.0) / width) as usize + 1);
        let mut barrier = Self {
            cells: vec![Vec::new(); shape[0] * shape[1]],
            lines,
            low,
            width,
            shape,
        };
        for index in 0..barrier.lines.len() {
            let [a, b] = barrier.lines[index];
            let reach = |axis: usize| {
                let cell = |value: f64| ((value - barrier.low[axis]) / barrier.width) as usize;
                let (first, last) = (cell(a[axis].min(b[axis])), cell(a[axis].max(b[axis])));
                first.saturating_sub(1)..=(last + 1).min(barrier.shape[axis] - 1)
            };
            for row in reach(1) {
                for column in reach(0) {
                    barrier.cells[row * barrier.shape[0] + column].push(index as u32);
                }
            }
        }
        barrier
    }

    /// The ends of the first line that the way from one point to another crosses.
    fn crossed(&self, from: PlanePoint, to: PlanePoint) -> Option<[PlanePoint; 2]> {
        let crosses = |line: &[PlanePoint; 2]| crosses([from, to], *line);
        if length(from, to) > self.width {
            // The way is longer than a cell, so all lines are tested.
            return self.lines.iter().find(|line| crosses(line)).copied();
        }
        let column = (to[0] - self.low[0]) / self.width;
        let row = (to[1] - self.low[1]) / self.width;
        let inside = column >= -1.0
            && row >= -1.0
            && column < self.shape[0] as f64 + 1.0
            && row < self.shape[1] as f64 + 1.0;
        if !inside {
            return None;
        }
        let clamp = |value: f64, cells: usize| (value.max(0.0) as usize).min(cells - 1);
        let cell = clamp(row, self.shape[1]) * self.shape[0] + clamp(column, self.shape[0]);
        let lines = self.cells[cell].iter();
        lines
            .map(|&line| self.lines[line as usize])
            .find(|line| crosses(line))
    }
}

/// Pairs of neighbouring fixed discs whose surfaces are less than `narrow` (m) apart: each is a
/// segment of a wall. Two discs are neighbours if the circle whose diameter joins their centres
/// holds no other centre (Gabriel and Sokal, 1969). So segments cut no corners and do not cross.
pub(in crate::dem) fn wall_pairs(fixed: &[FixedSphere], narrow: f64) -> Vec<[FixedSphere; 2]> {
    let mut sorted = fixed.to_vec();
    sorted.sort_by(|a, b| a.position[0].total_cmp(&b.position[0]));
    let largest = fixed.iter().map(|sphere| sphere.radius).fold(0.0, f64::max);
    let are_neighbours = |one: &FixedSphere, other: &FixedSphere| {
        let (a, b) = (centre(one), centre(other));
        let middle = [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
        // Slightly less, so that the two themselves do not count.
        let reach = 0.5 * length(a, b) * (1.0 - 1e-9);
        let from = sorted.partition_point(|disc| disc.position[0] < middle[0] - reach);
        let near = sorted[from..].iter();
        near.take_while(|disc| disc.position[0] <= middle[0] + reach)
            .all(|disc| length(centre(disc), middle) >= reach)
    };
    let mut pairs = Vec::new();
    for (index, one) in sorted.iter().enumerate() {
        for other in &sorted[index + 1..] {
            if other.position[0] - one.position[0] > one.radius + largest + narrow {
                break;
            }
            let apart = length(centre(one), centre(other));
            let is_narrow = apart > 0.0 && apart - one.radius - other.radius < narrow;
            if is_narrow && are_neighbours(one, other) {
                pairs.push([*one, *other]);
            }
        }
    }
    pairs
}

fn centre(sphere: &FixedSphere) -> PlanePoint {
    [sphere.position[0], sphere.position[2]]
}

fn length(a: PlanePoint, b: PlanePoint) -> f64 {
    libm::hypot(b[0] - a[0], b[1] - a[1])
}

/// Whether two lines between points cross each other.
fn crosses([a, b]: [PlanePoint; 2], [c, d]: [PlanePoint; 2]) -> bool {
    let side = |p: PlanePoint, q: PlanePoint, r: PlanePoint| {
        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
    };
    let apart = |one: f64, other: f64| (one > 0.0) != (other > 0.0);
    apart(side(a, b, c), side(a, b, d)) && apart(side(c, d, a), side(c, d, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wall() -> Vec<FixedSphere> {
        (0..5)
            .map(|k| FixedSphere {
                position: [0.0, 0.0, 0.05 * f64::from(k)],
                radius: 0.03,
            })
            .collect()
    }

    #[test]
    fn only_what_crosses_the_wall_is_named() {
        let barrier = Barrier::new(&wall(), 0.06);
        assert!(barrier.crossed([-0.02, 0.12], [0.03, 0.13]).is_some());
        assert!(barrier.crossed([0.02, 0.12], [-0.03, 0.13]).is_some());
        assert!(barrier.crossed([0.02, 0.02], [0.03, 0.18]).is_none());
        // Over its top.
        assert!(barrier.crossed([-0.02, 0.21], [0.03, 0.21]).is_none());
        // Far and fast.
        assert!(barrier.crossed([-5.0, 0.12], [5.0, 0.12]).is_some());
        assert!(barrier.crossed([-5.0, 0.32], [5.0, 0.32]).is_none());
    }

    #[test]
    fn a_gap_that_a_disc_fits_through_is_no_wall() {
        let mut fixed = wall();
        fixed.remove(2);
        // 0.1 - 0.06 = 0.04 m are left.
        let way = ([-0.02, 0.1], [0.03, 0.1]);
        assert!(Barrier::new(&fixed, 0.05).crossed(way.0, way.1).is_some());
        assert!(Barrier::new(&fixed, 0.03).crossed(way.0, way.1).is_none());
        assert!(Barrier::new(&[], 0.03).crossed(way.0, way.1).is_none());
    }

    /// Symptom: a grain that bounced off the foot of a wall was reported to have passed it, and the
    /// report on the published silo named two discs with a third between them. Cause: second
    /// neighbours made walls too.
    #[test]
    fn walls_do_not_cut_corners() {
        let disc = |x: f64, z: f64| FixedSphere {
            position: [x, 0.0, z],
            radius: 0.03,
        };
        // A wall that turns into a slope.
        let corner = [
            disc(-1.3, 1.05),
            disc(-1.3, 1.0),
            disc(-1.26, 0.97),
            disc(-1.22, 0.94),
        ];
        let pairs = wall_pairs(&corner, 0.08);
        assert_eq!(pairs.len(), 3);
        for [one, other] in &pairs {
            assert!(length(centre(one), centre(other)) < 0.06);
        }
        // Inside, near the corner.
        let barrier = Barrier::new(&corner, 0.08);
        assert!(barrier.crossed([-1.24, 1.03], [-1.27, 1.0]).is_none());
        assert!(barrier.crossed([-1.24, 1.03], [-1.3, 0.97]).is_some());
    }
}
