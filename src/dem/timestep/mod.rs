//! Limits of the time step, by a scene's stiffest contact, its drag and its friction.
//!
//! Symplectic Euler and velocity Verlet evaluate forces once per step, at velocities half a step
//! behind the positions. A linear oscillator x'' = -w^2 x - g x' then stays bounded while (w
//! dt)^2 + 2 g dt < 4: below 2/w without damping and below 2/g without a spring. Synchronised
//! Verlet predicts the velocities from the latest forces; its bound is (w dt)^2 + 4 g dt < 4.
//! Adaptive Verlet chooses sub-steps itself where spheres touch. Only two limits remain: no sphere
//! may move by more than the displacement guard allows, and drag needs g dt < 2, as for the first
//! two.
//!
//! Every limit here is this criterion for one effect, at the fastest impact expected in the scene
//! or at the deepest overlap at the start. The smallest spheres decide, because all of these times
//! grow with the radius.
//!
//! Bounded is not accurate. An elastic impact at the limit takes two steps and ends with 0.6 to 2.4
//! times its speed. At half the limit the error is below 4 %, at a tenth below 0.03 %. The decisive
//! limits ignore that one sphere may have several contacts; the limit of twelve contacts, which is
//! advised, includes this (tests/engine/stability measures both).

mod fall;
pub(super) mod fastest;
mod standing;

pub use crate::forces::contact::{Impact, LinearImpact, rayleigh_time};
pub use crate::forces::limit::Limit;
pub use standing::StepMargin;

use super::overlap::deepest_at_start;
use crate::forces::limit::{DISPLACEMENT, LARGEST_SWING, Regime, Scheme};
use crate::scene::{Driven, Integrator, Scene, Spheres, Start};
use fall::Open;
use fastest::Fastest;
use std::cell::LazyCell;

/// The fastest relative speed (m/s) expected at an impact: the largest of the speeds at the start,
/// of the fall, of driven spheres, of walls that slide in themselves, of the air's updraught and of
/// the air's rotation at the wall. Zero if nothing moves.
///
/// The fall is free, along gravity, from the highest start to the farthest wall or to the lowest
/// listed wall, fixed or driven sphere. If nothing stands there, it is the terminal speed under
/// drag plus the speed of the air. If nothing bounds it, it includes only the known speeds, and
/// [`unbounded_speed`] gives the reason. Shaking adds the most that it changes velocities up to the
/// first impact; later impacts may be faster.
pub fn fastest_impact(scene: &Scene) -> f64 {
    Fastest::of(scene).impact
}

/// Why the speeds of a scene are unbounded, if they are. Its limits then do not hold for long.
pub fn unbounded_speed(scene: &Scene) -> Option<&'static str> {
    Fastest::of(scene).open.map(Open::describe)
}

/// Duration (s) of the shortest contact expected in the scene, if there is any.
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
    let Fastest { impact, motion, .. } = Fastest::of(scene);
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
        has_walls: scene.tank.is_some()
            || scene.dem.geometry.is_some()
            || !scene.dem.walls.is_empty(),
        drives: !scene.dem.driven.is_empty(),
        fastest_impact: impact,
        fastest_motion: motion,
        fastest_spin: start_spin(scene).max(impact / smallest_radius),
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

/// The lowest height (m) of a centre: at the floor or fixed spheres, or at the start.
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
        let of_walls = scene.dem.walls.iter().filter_map(|wall| {
            let friction = scene.dem.friction.as_ref();
            Some(friction?.with_coefficient(wall.friction_coefficient?))
        });
        let frictions = [scene.dem.friction.clone(), scene.friction_at_walls()]
            .into_iter()
            .chain(of_walls.map(Some));
        let of_frictions = frictions
            .flatten()
            .filter_map(|it| it.limit(contact, &collisions, &regime));
        limits.extend(of_frictions.min_by(|a, b| a.seconds.total_cmp(&b.seconds)));
        let rolling = scene.dem.rolling.as_ref();
        limits.extend(rolling.map(|it| it.limit(contact, &regime)));
    }
    // Spheres without forces fly straight, with any step.
    if scene.dem.contact.is_none() && scene.dem.effects.tables().next().is_some() {
        limits.push(regime.displacement(0.0));
    } else if scene.time.integrator == Integrator::AdaptiveVerlet {
        limits.retain(|limit| limit.name == DISPLACEMENT);
        for limit in &mut limits {
            limit.decisive = true;
        }
    }
    limits.extend(scene.dem.effects.limits(&regime));
    limits.push(period_of_driven(&scene.dem.driven));
    let finite = |limit: &Limit| limit.seconds.is_finite();
    limits.retain(finite);
    limits.sort_by(|a, b| {
        let order = b.decisive.cmp(&a.decisive);
        order.then(a.seconds.total_cmp(&b.seconds))
    });
    limits
}

/// The limit from the fastest oscillation of a driven sphere; infinite if there is none.
fn period_of_driven(driven: &[Driven]) -> Limit {
    let swinging = driven.iter().filter(|path| path.amplitude != [0.0; 3]);
    let frequencies = swinging.map(|path| path.angular_frequency.abs());
    Limit {
        name: "driven period",
        seconds: LARGEST_SWING / frequencies.fold(0.0, f64::max),
        decisive: false,
        explanation: "0.5 / w, with the largest angular frequency w in [[driven]]: 12.6 steps in a \
                      period",
        consequence: Some(
            "driven spheres move in straight lines between steps, so that spheres bounce lower on \
                them; with a step of one period or half a period they stand still",
        ),
    }
}

/// The limit above which a scene is refused; `None` if nothing in it can become unstable.
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
