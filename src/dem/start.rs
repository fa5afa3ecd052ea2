//! Where and how the spheres start.

use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::{Geometry, Radii, Scene, Start, StartSphere};
use rand::Rng;

/// Why the spheres of a scene cannot be placed.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The random placement found no room.
    #[error(
        "no room for sphere {placed} of {count} (radius {radius} m) after {ATTEMPTS} attempts; \
         use fewer or smaller spheres, or a larger range of start.z_min to start.z_max"
    )]
    NoRoom {
        /// Spheres placed before.
        placed: usize,
        /// Spheres of the scene.
        count: usize,
        /// Radius of the sphere that found no room (m).
        radius: f64,
    },
    /// Random positions need a tank to be in.
    #[error(
        "start.kind = \"random\" needs walls all around; give the tank a radius, or width and \
         depth, or list the spheres"
    )]
    NoTank,
    /// A file of radii or positions has not been read yet.
    #[error("{0} is still the name of a file; load the scene with Scene::load")]
    NotLoaded(&'static str),
    /// Numbers of spheres differ.
    #[error("{what} holds {found} spheres, spheres.count is {count}")]
    Count {
        /// The key of the list.
        what: &'static str,
        /// Its length.
        found: usize,
        /// The number in the scene.
        count: usize,
    },
}

/// Random positions tried for a sphere before the tank counts as full.
const ATTEMPTS: usize = 100_000;

/// The spheres of a scene at time zero, without fixed ones. All spheres of a feed are at the
/// position where they will come in.
///
/// # Errors
/// If they cannot be placed.
pub fn place(scene: &Scene) -> Result<Particles, StartError> {
    let count = scene.spheres.count;
    let mut particles = Particles {
        radius: radii(scene)?,
        velocity: vec![Vector::ZERO; count],
        ..Particles::default()
    };
    let mut spins = vec![Vector::ZERO; count];
    match &scene.start {
        Start::Random {
            z_min,
            z_max,
            speed,
            spin,
        } => {
            place_at_random(&mut particles, scene, [*z_min, *z_max])?;
            let mut random = scene.random_stream("velocities");
            for i in 0..count {
                particles.velocity[i] = within(*speed, &mut random);
                spins[i] = within(*spin, &mut random);
            }
        }
        Start::List { spheres } => place_listed(&mut particles, &mut spins, spheres)?,
        Start::Feed {
            position,
            velocity,
            spread,
            ..
        } => {
            let mut random = scene.random_stream("positions");
            for i in 0..count {
                let aside = spread * (2.0 * uniform(&mut random) - 1.0);
                let mut place: Vector = (*position).into();
                place.x += aside;
                particles.position.push(place);
                particles.velocity[i] = (*velocity).into();
            }
        }
        Start::File { .. } => return Err(StartError::NotLoaded("start.path")),
    }
    complete(&mut particles, scene, spins);
    Ok(particles)
}

/// Gives the spheres random positions between two heights (m).
fn place_at_random(
    particles: &mut Particles,
    scene: &Scene,
    heights: [f64; 2],
) -> Result<(), StartError> {
    let room = Room::of_scene(scene, heights).ok_or(StartError::NoTank)?;
    let mut random = scene.random_stream("positions");
    particles.position = scatter(&particles.radius, &room, &mut random)?;
    Ok(())
}

/// Places the spheres as they are listed. One that lists no radius keeps its own.
fn place_listed(
    particles: &mut Particles,
    spins: &mut [Vector],
    spheres: &[StartSphere],
) -> Result<(), StartError> {
    if spheres.len() != spins.len() {
        return Err(StartError::Count {
            what: "start.spheres",
            found: spheres.len(),
            count: spins.len(),
        });
    }
    for (i, sphere) in spheres.iter().enumerate() {
        particles.position.push(sphere.position.into());
        particles.velocity[i] = sphere.velocity.into();
        spins[i] = sphere.spin.into();
        particles.radius[i] = sphere.radius.unwrap_or(particles.radius[i]);
    }
    Ok(())
}

/// The fixed spheres of a scene: the walls, then the door.
pub fn fixed(scene: &Scene) -> Particles {
    let spheres = scene.dem.geometry.as_ref().map(Geometry::spheres);
    let spheres = spheres.map(|spheres| [spheres.walls, spheres.door].concat());
    let spheres = spheres.unwrap_or_default();
    let mut particles = Particles {
        fixed: spheres.len(),
        position: spheres.iter().map(|it| it.position.into()).collect(),
        radius: spheres.iter().map(|it| it.radius).collect(),
        velocity: vec![Vector::ZERO; spheres.len()],
        ..Particles::default()
    };
    complete(&mut particles, scene, vec![Vector::ZERO; spheres.len()]);
    particles.inverse_mass.fill(0.0);
    particles.inverse_inertia.fill(0.0);
    particles
}

/// Gives mass to spheres that have a radius and, in a scene with friction, rotation.
fn complete(particles: &mut Particles, scene: &Scene, spins: Vec<Vector>) {
    give_mass(particles, scene);
    if scene.dem.friction.is_some() {
        give_rotation(particles, scene.spheres.shape.inertia_factor(), spins);
    }
}

fn give_mass(particles: &mut Particles, scene: &Scene) {
    let (shape, density) = (scene.spheres.shape, scene.spheres.density);
    particles.mass = particles
        .radius
        .iter()
        .map(|radius| shape.mass(density, *radius))
        .collect();
    particles.inertial_factor = scene.inertial_factor();
    particles.inverse_mass = (0..particles.len())
        .map(|i| 1.0 / particles.inertial_mass(i))
        .collect();
    particles.force = vec![Vector::ZERO; particles.len()];
}

fn give_rotation(particles: &mut Particles, factor: f64, spins: Vec<Vector>) {
    let pairs = particles.mass.iter().zip(&particles.radius);
    particles.inertia = pairs
        .map(|(mass, radius)| factor * mass * radius * radius)
        .collect();
    particles.inverse_inertia = particles
        .inertia
        .iter()
        .map(|inertia| 1.0 / inertia)
        .collect();
    particles.spin = spins;
    particles.torque = vec![Vector::ZERO; particles.len()];
}

fn radii(scene: &Scene) -> Result<Vec<f64>, StartError> {
    let count = scene.spheres.count;
    match &scene.spheres.radius {
        Radii::One(radius) => Ok(vec![*radius; count]),
        Radii::Each(radii) if radii.len() == count => Ok(radii.clone()),
        Radii::Each(radii) => Err(StartError::Count {
            what: "spheres.radius",
            found: radii.len(),
            count,
        }),
        Radii::File { .. } => Err(StartError::NotLoaded("spheres.radius")),
        Radii::Shares(shares) => {
            let total: f64 = shares.iter().map(|share| share.share).sum();
            let mut radii = Vec::with_capacity(count);
            let mut sum = 0.0;
            for share in shares {
                sum += share.share;
                radii.resize((sum / total * count as f64).round() as usize, share.radius);
            }
            shuffle(&mut radii, &mut scene.random_stream("radii"));
            Ok(radii)
        }
    }
}

/// Where centres may be at the start.
struct Room {
    /// How far the walls are from the axis along x and y (m).
    reach: [f64; 2],
    /// Whether they are a cylinder.
    is_round: bool,
    /// Lowest and highest centre (m).
    heights: [f64; 2],
}

impl Room {
    /// The room within the walls of a scene, if they are all around.
    fn of_scene(scene: &Scene, heights: [f64; 2]) -> Option<Self> {
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

/// Random centres without overlap, uniform in the part of the room where a sphere does not touch
/// the walls.
fn scatter(radii: &[f64], room: &Room, random: &mut impl Rng) -> Result<Vec<Vector>, StartError> {
    let mut grid = Grid::new(radii, room);
    let mut placed: Vec<Vector> = Vec::with_capacity(radii.len());
    for (i, &radius) in radii.iter().enumerate() {
        let free = |p: Vector| {
            grid.near(p).all(|j| {
                let distance = radius + radii[j];
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
    Ok(placed)
}

/// Cells over a room, at least as wide as the largest sphere, with the spheres placed so far.
struct Grid {
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

impl Grid {
    const NONE: u32 = u32::MAX;

    fn new(radii: &[f64], room: &Room) -> Self {
        let [x, y] = room.reach;
        let [low, high] = room.heights;
        let corner = Vector::new(-x, -y, low);
        let mut width = 2.0 * radii.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        let cells = |side: f64, width: f64| (side / width).max(0.0) + 1.0;
        let sizes = |width: f64| [2.0 * x, 2.0 * y, high - low].map(|side| cells(side, width));
        // A room that is nearly empty needs wider cells only.
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

/// A number in [0, 1) with 53 random bits.
fn uniform(random: &mut impl Rng) -> f64 {
    (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// Components uniform between -`bound` and `bound`.
fn within(bound: f64, random: &mut impl Rng) -> Vector {
    let mut component = || bound * (2.0 * uniform(random) - 1.0);
    let [x, y, z] = [component(), component(), component()];
    Vector::new(x, y, z)
}

/// Fisher-Yates.
fn shuffle<T>(items: &mut [T], random: &mut impl Rng) {
    for last in (1..items.len()).rev() {
        let other = (uniform(random) * (last + 1) as f64) as usize;
        items.swap(last, other);
    }
}
