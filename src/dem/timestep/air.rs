//! Limits of what the air does to spheres and of damped spins.

use super::{Limit, Scheme, fastest_impact};
use crate::scene::{Scene, Start};

/// A sphere that slips through the air at speed u returns to its terminal speed at the rate
/// (c1 + 2 c2 u) / m. Swirl and updraught both act on the vertical velocity.
pub(super) fn drag_limit(scene: &Scene) -> Option<Limit> {
    let drag = scene.dem.effects.drag.as_ref()?;
    let lowest = match (&scene.start, scene.lowest_support()) {
        (_, Some(floor)) => floor,
        (Start::Random { z_min, .. }, None) => *z_min,
        (Start::List { spheres }, None) => spheres
            .iter()
            .fold(f64::MAX, |low, sphere| low.min(sphere.position[2])),
        (Start::Feed { position, .. }, None) => position[2],
        (Start::File { .. }, None) => 0.0,
    };
    let updraught = scene.dem.effects.updraught.as_ref().map_or(0.0, |air| {
        air.strength_in(scene.dem.effects.swirl.as_ref())
            * libm::exp(-air.decay * (lowest - air.origin))
    });
    let swirl = if scene.dem.effects.swirl.is_some() {
        1.0
    } else {
        0.0
    };
    let (linear, quadratic) = drag.coefficients(scene.smallest_radius());
    let coefficient = (linear + 2.0 * quadratic * fastest_impact(scene)) * (swirl + updraught);
    let mass = scene.smallest_mass();
    Some(Limit {
        name: "drag",
        seconds: Scheme::of(scene).oscillator(0.0, coefficient / mass),
        decisive: true,
        explanation: "2 m / (q (c1 + 2 c2 u)) of the smallest sphere, times the factors of swirl and \
                      updraught at the lowest height; q = 2 for synchronised-verlet, else 1",
    })
}

pub(super) fn spin_damping_limit(scene: &Scene) -> Option<Limit> {
    let damping = scene.dem.effects.spin_damping.as_ref()?;
    let radius = scene.smallest_radius();
    let inertia = scene.spheres.shape.inertia_factor() * scene.smallest_mass() * radius * radius;
    Some(Limit {
        name: "spin damping",
        seconds: Scheme::of(scene).oscillator(0.0, damping.coefficient / inertia),
        decisive: true,
        explanation: "2 I / (q c) of the smallest sphere; q = 2 for synchronised-verlet, else 1",
    })
}
