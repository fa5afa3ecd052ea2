//! Random places without overlap.

use super::{StartError, uniform};
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::Scene;
use rand::Rng;

/// Random positions tried for a sphere before the tank counts as full.
pub(super) const ATTEMPTS: usize = 100_000;

/// Where centres may be at the start.
pub(super) struct StartRoom {
    /// How far the walls are from the axis along x and y (m).
    reach: [f64; 2],
    /// Whether they are a cylinder.
    is_round: bool,
    /// Lowest and highest centre (m).
    heights: [f64; 2],
}

impl StartRoom {
    /// The room within the walls of a scene, if they enclose it.
    pub(super) fn of_scene(scene: &Scene, heights: [f64; 2]) -> Option<Self> {
        let tank = scene.tank.as_ref()?;
        let [Some(x), Some(y)] = tank.reach() else {
            return None;
        };
        Some(Self {
            reach: [x, y],
            is_round: tank.radius.is_some(),
            heights,
        })
    }

    /// A random position, uniform in the box around the room. Between plane sides it keeps a sphere
    /// of this radius (m) away from them.
    fn place(&self, radius: f64, random: &mut impl Rng) -> Vector {
        let [x, y] = match self.is_round {
            true => self.reach,
            false => self.reach.map(|reach| reach - radius),
        };
        let [low, high] = self.heights;
        let (a, b, c) = (uniform(random), uniform(random), uniform(random));
        Vector::new(
            x * (2.0 * a - 1.0),
            y * (2.0 * b - 1.0),
            low + (high - low) * c,
        )
    }

    /// Whether a sphere of this radius (m) at such a position does not touch the walls.
    fn holds(&self, centre: Vector, radius: f64) -> bool {
        let reach = self.reach[0] - radius;
        !self.is_round || centre.x * centre.x + centre.y * centre.y < reach * reach
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
                (p - placed[j]).norm_squared() > distance * distance
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
    /// The corner of the room with the least coordinates (m), and the width of a cell (m).
    corner: Vector,
    width: f64,
    /// Number of cells along x, y and z.
    sizes: [usize; 3],
    /// For each cell the sphere that was added last, and for each sphere the one added before it to
    /// its cell, or [`NONE`](Self::NONE).
    last: Vec<u32>,
    before: Vec<u32>,
}

impl ScatterGrid {
    const NONE: u32 = u32::MAX;

    fn new(radii: &[f64], room: &StartRoom) -> Self {
        let [x, y] = room.reach;
        let [low, high] = room.heights;
        let corner = Vector::new(-x, -y, low);
        let mut width = 2.0 * radii.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let cells = |side: f64, width: f64| (side / width).max(0.0) + 1.0;
        let sizes = |width: f64| [2.0 * x, 2.0 * y, high - low].map(|side| cells(side, width));
        // A nearly empty room only needs wider cells.
        while sizes(width).iter().product::<f64>() > 8.0 * (radii.len() as f64 + 512.0) {
            width *= 1.25;
        }
        let sizes = sizes(width).map(|size| size as usize);
        Self {
            corner,
            width,
            sizes,
            last: vec![Self::NONE; sizes.iter().product()],
            before: Vec::with_capacity(radii.len()),
        }
    }

    fn cell(&self, place: Vector) -> [usize; 3] {
        let from_corner = place - self.corner;
        let along = [from_corner.x, from_corner.y, from_corner.z];
        std::array::from_fn(|axis| ((along[axis] / self.width) as usize).min(self.sizes[axis] - 1))
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
        let [x, y, z] = [0, 1, 2].map(|axis| {
            let last = self.sizes[axis] - 1;
            cell[axis].saturating_sub(1)..=(cell[axis] + 1).min(last)
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
