//! Limits of the time step, by a scene's stiffest contact, its drag and its friction.
//!
//! Symplectic Euler and velocity Verlet evaluate forces once per step, at velocities half a step
//! behind the positions. A linear oscillator x'' = -w^2 x - g x' then stays bounded while
//! (w dt)^2 + 2 g dt < 4: below 2/w without damping and below 2/g without a spring. Synchronised
//! Verlet predicts the velocities from the latest forces; its bound is (w dt)^2 + 4 g dt < 4.
//! Adaptive Verlet cuts its steps itself where spheres touch. What is left is that no sphere moves
//! by more than the displacement guard allows, and the drag, with g dt < 2 as for the first two.
//!
//! Every limit here is that criterion for one effect, at the fastest impact that the scene lets
//! expect or at the deepest overlap at the start. The smallest spheres decide, because all of these
//! times grow with the radius.
//!
//! Bounded is not accurate. An elastic impact at the limit takes two steps and ends with 0.6 to 2.4
//! times its speed. At half the limit the error is below 4 %, at a tenth below 0.03 %. The decisive
//! limits do not consider several contacts of one sphere, for which the limit of twelve contacts is
//! advised (tests/engine/stability measures both).

mod standing;

pub use crate::forces::contact::{Impact, LinearImpact, rayleigh_time};
pub use crate::forces::limit::Limit;
pub use standing::Standing;

use super::overlap::deepest_at_start;
use crate::forces::limit::{DISPLACEMENT, Regime, Scheme};
use crate::scene::{Driven, Integrator, Scene, Spheres, Start, StartSphere, Tank};
use std::cell::LazyCell;

/// The fastest relative speed (m/s) that the scene lets expect at an impact: the largest of the
/// speeds at the start, of free fall from the highest start to the floor, of the air's updraught
/// and of the air's rotation at the wall. Zero if nothing moves.
pub fn fastest_impact(scene: &Scene) -> f64 {
    let (highest, widest, start_speed) = match &scene.start {
        // Two spheres may meet with opposite velocities.
        Start::Random { z_max, speed, .. } => (*z_max, 0.0, 2.0 * 3.0_f64.sqrt() * speed),
        Start::List { spheres } => extent(spheres),
        Start::Feed {
            position, velocity, ..
        } => extent(&[StartSphere {
            velocity: *velocity,
            ..StartSphere::at(*position)
        }]),
        Start::Packing {} => (scene.packed_height(), 0.0, 0.0),
        Start::File { .. } => (0.0, 0.0, 0.0),
    };
    let tank = scene.tank.as_ref();
    let free_fall = match (scene.gravity_in_fluid(), scene.lowest_support()) {
        (Some(gravity), Some(floor)) => {
            let height = (highest - floor).max(scene.smallest_radius());
            // What is lighter than its fluid rises as fast.
            let acceleration = gravity.acceleration.abs() / scene.inertial_factor();
            (2.0 * acceleration * height).sqrt()
        }
        _ => 0.0,
    };
    // A sphere that is fed in starts to fall with its own speed.
    let free_fall = match scene.start {
        Start::Feed { .. } => libm::hypot(free_fall, start_speed),
        _ => free_fall,
    };
    let reach = tank.and_then(farthest_wall).unwrap_or(widest);
    let of_paths = scene.dem.driven.iter().map(Driven::fastest);
    let of_effects = of_paths.fold(scene.dem.effects.fastest(reach), f64::max);
    start_speed.max(free_fall).max(of_effects)
}

/// The largest distance of a sphere from the axis (m), if there are walls all around it.
fn farthest_wall(tank: &Tank) -> Option<f64> {
    let [x, y] = tank.reach();
    tank.radius
        .or(x.zip(y).map(|(x, y)| (x * x + y * y).sqrt()))
}

/// Highest centre (m), largest distance of a centre from the axis (m), and a bound on the speeds
/// of the spheres and their differences (m/s).
fn extent(spheres: &[StartSphere]) -> (f64, f64, f64) {
    let norm = |vector: [f64; 3]| vector.iter().map(|part| part * part).sum::<f64>().sqrt();
    let (mut low, mut high) = ([f64::MAX; 3], [f64::MIN; 3]);
    let (mut highest, mut widest, mut fastest) = (f64::MIN, 0.0_f64, 0.0_f64);
    for StartSphere {
        position, velocity, ..
    } in spheres
    {
        highest = highest.max(position[2]);
        widest = widest.max(norm([position[0], position[1], 0.0]));
        fastest = fastest.max(norm(*velocity));
        for axis in 0..3 {
            low[axis] = low[axis].min(velocity[axis]);
            high[axis] = high[axis].max(velocity[axis]);
        }
    }
    if spheres.is_empty() {
        return (0.0, 0.0, 0.0);
    }
    let spread = norm([0, 1, 2].map(|axis| high[axis] - low[axis]));
    (highest, widest, fastest.max(spread))
}

/// Duration (s) of the shortest contact the scene lets expect, if there is any.
pub fn shortest_contact(scene: &Scene) -> Option<f64> {
    let collisions = scene.dem.contact.as_ref()?.collisions(&regime(scene));
    collisions.first().map(|collision| collision.contact_time)
}

/// The properties of a scene on which the limits of effects and laws depend.
fn regime(scene: &Scene) -> Regime<'_> {
    let Spheres { density, shape, .. } = &scene.spheres;
    let (smallest_radius, largest_radius) = scene.radius_range();
    let mean_radius = scene.mean_radius();
    let inertial_factor = scene.inertial_factor();
    let inertial_mass = |radius: f64| shape.mass(*density, radius) * inertial_factor;
    let fastest_impact = fastest_impact(scene);
    Regime {
        scheme: scheme_of(scene),
        smallest_radius,
        largest_radius,
        mean_radius,
        smallest_mass: inertial_mass(smallest_radius),
        largest_mass: inertial_mass(largest_radius),
        mean_mass: inertial_mass(mean_radius),
        inertial_factor,
        density: *density,
        inertia_factor: shape.inertia_factor(),
        has_walls: scene.tank.is_some() || scene.dem.geometry.is_some(),
        fastest_impact,
        fastest_spin: start_spin(scene).max(fastest_impact / smallest_radius),
        lowest_height: lowest_height(scene),
        displacement_guard: scene.dem.guards.displacement,
        deepest_at_start: LazyCell::new(Box::new(|| deepest_at_start(scene))),
    }
}

/// A bound on the spins at the start (rad/s).
fn start_spin(scene: &Scene) -> f64 {
    match &scene.start {
        Start::Random { spin, .. } => 3.0_f64.sqrt() * spin,
        Start::List { spheres } => spheres.iter().fold(0.0, |most: f64, sphere| {
            let [x, y, z] = sphere.spin;
            most.max((x * x + y * y + z * z).sqrt())
        }),
        Start::Packing {} | Start::Feed { .. } | Start::File { .. } => 0.0,
    }
}

/// The lowest height (m) of a centre: of what holds spheres, or at the start.
fn lowest_height(scene: &Scene) -> f64 {
    match (&scene.start, scene.lowest_support()) {
        (_, Some(floor)) => floor,
        (Start::Random { z_min, .. }, None) => *z_min,
        (Start::List { spheres }, None) => spheres
            .iter()
            .fold(f64::MAX, |low, sphere| low.min(sphere.position[2])),
        (Start::Feed { position, .. }, None) => position[2],
        (Start::Packing {} | Start::File { .. }, None) => 0.0,
    }
}

/// How the integrator of a scene treats an oscillator.
pub(super) fn scheme_of(scene: &Scene) -> Scheme {
    let damping = match scene.time.integrator {
        // For adaptive Verlet this concerns the drag alone, as contacts have sub-steps.
        Integrator::SymplecticEuler | Integrator::VelocityVerlet | Integrator::AdaptiveVerlet => {
            1.0
        }
        Integrator::SynchronisedVerlet => 2.0,
    };
    Scheme { damping }
}

/// All limits that apply to a scene: the decisive ones first, and in each group the smallest first.
pub fn limits(scene: &Scene) -> Vec<Limit> {
    let regime = regime(scene);
    let mut limits = Vec::new();
    if let Some(contact) = &scene.dem.contact {
        let collisions = contact.collisions(&regime);
        limits.extend(contact.limits(&collisions, &regime));
        // The larger coefficient of friction, of pairs or of walls, gives the smaller limit.
        let frictions = [scene.dem.friction.clone(), scene.friction_at_walls()];
        let of_frictions = frictions
            .iter()
            .flatten()
            .filter_map(|it| it.limit(contact, &collisions, &regime));
        limits.extend(of_frictions.min_by(|a, b| a.seconds.total_cmp(&b.seconds)));
        let rolling = scene.dem.rolling.as_ref();
        limits.extend(rolling.map(|it| it.limit(contact, &regime)));
    }
    if scene.time.integrator == Integrator::AdaptiveVerlet {
        limits.retain(|limit| limit.name == DISPLACEMENT);
        for limit in &mut limits {
            limit.decisive = true;
        }
    }
    limits.extend(scene.dem.effects.limits(&regime));
    let finite = |limit: &Limit| limit.seconds.is_finite();
    limits.retain(finite);
    limits.sort_by(|a, b| {
        let order = b.decisive.cmp(&a.decisive);
        order.then(a.seconds.total_cmp(&b.seconds))
    });
    limits
}

/// The limit above which a scene is refused; absent if nothing in it can become unstable.
pub fn largest_stable(scene: &Scene) -> Option<Limit> {
    limits(scene).into_iter().find(|limit| limit.decisive)
}

/// The smallest of all limits, decisive or not.
pub fn least(scene: &Scene) -> Option<Limit> {
    let limits = limits(scene).into_iter();
    limits.min_by(|a, b| a.seconds.total_cmp(&b.seconds))
}

#[cfg(test)]
mod tests;
