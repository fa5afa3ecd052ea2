//! Random places without overlap.

use super::{StartError, uniform};
use crate::particles::domain::cells_around;
use crate::particles::vector::Vector;
use crate::particles::{Domain, Particles};
use crate::scene::{Scene, Tank};
use crate::walls::Wall;
use rand::Rng;

/// Random positions tried for a sphere before the tank counts as full.
pub(super) const ATTEMPTS: usize = 100_000;

/// Where centres may be at the start.
pub(super) struct StartRoom {
    /// Least and largest x and y (m): of the tank, or of centres if the start gives them.
    sides: [[f64; 2]; 2],
    /// Whether spheres keep away from these sides by their radii.
    are_walls: [bool; 2],
    /// Radius of the tank (m), if it is round.
    radius: Option<f64>,
    /// Lowest and highest centre (m).
    heights: [f64; 2],
    /// Walls that the scene lists.
    walls: Vec<Wall>,
    domain: Domain,
}

impl StartRoom {
    /// The room within the walls of a scene, if they enclose it.
    pub(super) fn of_scene(scene: &Scene, heights: [f64; 2]) -> Option<Self> {
        let tank = scene.tank.as_ref();
        let reach = tank.map(Tank::reach).unwrap_or_default();
        let given = scene.start_box();
        let domain = scene.domain();
        let periods = domain.periods();
        let half = |axis: usize| periods[axis].map(|period| 0.5 * period).or(reach[axis]);
        let side = |axis: usize| given[axis].or(half(axis).map(|half| [-half, half]));
        let radius = tank.and_then(|tank| tank.radius);
        let listed = Wall::of_scene(scene).into_iter();
        Some(Self {
            sides: [side(0)?, side(1)?],
            are_walls: [0, 1]
                .map(|axis| given[axis].is_none() && radius.is_none() && periods[axis].is_none()),
            radius,
            heights,
            walls: listed.filter(|wall| !wall.name.is_of_tank()).collect(),
            domain,
        })
    }

    /// A random position, uniform in the box around the room. Between plane sides it keeps a sphere
    /// of this radius (m) away from them.
    fn place(&self, radius: f64, random: &mut impl Rng) -> Vector {
        let along = |axis: usize, share: f64| {
            let [low, high] = self.sides[axis];
            let margin = if self.are_walls[axis] { radius } else { 0.0 };
            0.5 * (low + high) + (0.5 * (high - low) - margin) * (2.0 * share - 1.0)
        };
        let [low, high] = self.heights;
        let (a, b, c) = (uniform(random), uniform(random), uniform(random));
        Vector::new(along(0, a), along(1, b), low + (high - low) * c)
    }

    /// Whether a sphere of this radius (m) at such a position does not touch the walls.
    fn holds(&self, centre: Vector, radius: f64) -> bool {
        let is_inside = |tank: f64| {
            let reach = tank - radius;
            centre.x * centre.x + centre.y * centre.y < reach * reach
        };
        let touches = |wall: &Wall| wall.is_near(centre, radius, 0.0);
        self.radius.is_none_or(is_inside) && !self.walls.iter().any(touches)
    }
}

/// Random centres without overlap, uniform in the part of the room where a sphere touches neither
/// the walls nor the spheres that are fixed.
pub(super) fn scatter(
    radii: &[f64],
    room: &StartRoom,
    fixed: &Particles,
    random: &mut impl Rng,
) -> Result<Vec<Vector>, StartError> {
    let all = [&fixed.radius, radii].concat();
    let mut grid = ScatterGrid::new(&all, room);
    let mut placed = fixed.position.clone();
    placed.reserve(radii.len());
    for &centre in &placed {
        grid.add(centre);
    }
    for (i, &radius) in radii.iter().enumerate() {
        let free = |p: Vector| {
            grid.near(p).all(|j| {
                let distance = radius + all[j];
                room.domain.offset(p, placed[j]).norm_squared() > distance * distance
            })
        };
        let candidate = (0..ATTEMPTS)
            .map(|_| room.place(radius, random))
            .find(|&place| room.holds(place, radius) && free(place))
            .ok_or(StartError::NoRoom {
                placed: i,
                count: radii.len(),
                radius,
            })?;
        placed.push(candidate);
        grid.add(candidate);
    }
    Ok(placed.split_off(fixed.len()))
}

/// Cells over a room, at least as wide as the largest sphere, with the spheres placed so far.
struct ScatterGrid {
    /// The corner of the room with the least coordinates (m), and the widths of a
    /// cell along x, y and z (m).
    corner: Vector,
    widths: [f64; 3],
    /// Number of cells along x, y and z.
    sizes: [usize; 3],
    domain: Domain,
    /// For each cell the sphere that was added last, and for each sphere the one added before it to
    /// its cell, or [`NONE`](Self::NONE).
    last: Vec<u32>,
    before: Vec<u32>,
}

impl ScatterGrid {
    const NONE: u32 = u32::MAX;

    fn new(radii: &[f64], room: &StartRoom) -> Self {
        let [x, y] = room.sides;
        // Along a period the grid covers all of it, as spheres meet across its sides.
        let mut sides = [x, y, room.heights];
        for (side, period) in sides.iter_mut().zip(room.domain.periods()) {
            if let Some(period) = period {
                *side = [-0.5 * period, 0.5 * period];
            }
        }
        let corner = Vector::from(sides.map(|[low, _]| low));
        let mut width = 2.0 * radii.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let periods = room.domain.periods();
        let sizes = |width: f64| {
            let cells = |axis: usize| {
                let [low, high] = sides[axis];
                let whole = ((high - low) / width).max(0.0);
                // The last cell along a period ends where the first begins.
                periods[axis].map_or(whole + 1.0, |_| whole.floor().max(1.0))
            };
            [cells(0), cells(1), cells(2)]
        };
        // A nearly empty room only needs wider cells.
        while sizes(width).iter().product::<f64>() > 8.0 * (radii.len() as f64 + 512.0) {
            width *= 1.25;
        }
        let sizes = sizes(width).map(|size| size as usize);
        let along = |axis: usize| periods[axis].map(|period| period / sizes[axis] as f64);
        Self {
            corner,
            widths: [0, 1, 2].map(|axis| along(axis).unwrap_or(width)),
            sizes,
            domain: room.domain,
            last: vec![Self::NONE; sizes.iter().product()],
            before: Vec::with_capacity(radii.len()),
        }
    }

    fn cell(&self, place: Vector) -> [usize; 3] {
        let from_corner = self.domain.wrapped(place) - self.corner;
        let along = [from_corner.x, from_corner.y, from_corner.z];
        std::array::from_fn(|axis| {
            let cell = (along[axis] / self.widths[axis]) as usize;
            cell.min(self.sizes[axis] - 1)
        })
    }

    fn index(&self, [a, b, c]: [usize; 3]) -> usize {
        (a * self.sizes[1] + b) * self.sizes[2] + c
    }

    /// A sphere outside the room is in the nearest cell: two spheres close to each other are still
    /// in neighbouring cells.
    fn add(&mut self, place: Vector) {
        let cell = self.index(self.cell(place));
        let number = self.before.len() as u32;
        self.before
            .push(std::mem::replace(&mut self.last[cell], number));
    }

    /// The spheres in the cell of `place` and in the cells around it.
    fn near(&self, place: Vector) -> impl Iterator<Item = usize> {
        let cell = self.cell(place);
        let wraps = self.domain.periods().map(|period| period.is_some());
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let ranges = cells_around(cell[axis], self.sizes[axis], wraps[axis]);
            ranges.into_iter().flatten()
        });
        let cells = x.flat_map(move |a| {
            let z = z.clone();
            y.clone()
                .flat_map(move |b| z.clone().map(move |c| [a, b, c]))
        });
        let listed = |sphere: u32| (sphere != Self::NONE).then_some(sphere as usize);
        cells.flat_map(move |cell| {
            let first = listed(self.last[self.index(cell)]);
            std::iter::successors(first, move |&sphere| listed(self.before[sphere]))
        })
    }
}
