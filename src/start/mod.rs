//! Where and how the spheres start.

mod scatter;

use self::scatter::{ATTEMPTS, StartRoom, scatter};
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
         use fewer or smaller spheres, or a larger range of `start.z_min` to `start.z_max`"
    )]
    NoRoom {
        /// Spheres placed before.
        placed: usize,
        /// Spheres of the scene.
        count: usize,
        /// Radius of the sphere that found no room (m).
        radius: f64,
    },
    /// Random positions need a tank.
    #[error(
        "start.kind = \"random\" needs walls all around; give the tank a radius, or width and \
         depth, or list the spheres"
    )]
    NoTank,
    /// A file of radii or positions has not been read yet.
    #[error("{0} is still the name of a file; load the scene with Scene::load")]
    NotLoaded(&'static str),
    /// A packing has not been made yet.
    #[error("the packing is still to be made; build the scene with `run::model_of`")]
    NotMade,
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

/// The spheres of a scene at time zero, without fixed ones. All spheres of a feed are at the
/// position where they come in.
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
            ..
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
        Start::Packing {} => return Err(StartError::NotMade),
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
    let room = StartRoom::of_scene(scene, heights).ok_or(StartError::NoTank)?;
    let mut random = scene.random_stream("positions");
    particles.position = scatter(&particles.radius, &room, &fixed(scene), &mut random)?;
    Ok(())
}

/// Places the spheres as listed. A sphere without a listed radius keeps its own.
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
