//! A small sphere in the neck between two large ones, with static friction (Vyas, Ottino, Lueptow
//! and Umbanhowar, Comput. Phys. Commun. 310, 109524 (2025)).
//!
//! It rolls around the neck and should fall off below. The tangential spring is loaded by
//! velocities half a step older than the normal it is turned to; the part of them that pulls
//! inwards adds up, the sphere is wedged in, and goes on around the neck.

use super::bench::{LIMIT, at, downward, moving};
use phase::dem::DemSimulation;
use phase::scene::{
    Contact, DemScene, Effects, FixedSphere, Friction, Geometry, Hertz, Integrator, Mindlin, Radii,
    Scene, Shape, Spheres, Start, Time,
};

/// Radius of the large spheres (m).
const LARGE: f64 = 0.005;

/// The integrators that load the spring by such velocities. Any other must let the sphere fall at
/// every ratio of sizes.
const TRAPPING: [Integrator; 2] = [Integrator::SymplecticEuler, Integrator::VelocityVerlet];

/// A sphere that touches two fixed ones, these touch each other: one degree beside the top of the
/// neck. `ratio` is that of the radii.
fn neck(ratio: f64) -> Scene {
    let radius = LARGE / ratio;
    let height = ((LARGE + radius) * (LARGE + radius) - LARGE * LARGE).sqrt();
    let (sine, cosine) = libm::sincos(1.0_f64.to_radians());
    let spheres = Spheres {
        count: 1,
        radius: Radii::One(radius),
        density: 2500.0,
        shape: Shape::Sphere,
    };
    let start = Start::list(vec![moving(
        [0.0, height * sine, height * cosine],
        [0.0; 3],
    )]);
    let time = Time {
        safety_factor: None,
        resolution: None,
        dt: 1e-6,
        duration: 0.3,
        frame_interval: 1e-3,
        integrator: Integrator::VelocityVerlet,
    };
    let fixed = |x: f64| FixedSphere {
        position: [x, 0.0, 0.0],
        radius: LARGE,
    };
    Scene {
        dem: DemScene {
            geometry: Some(Geometry::List {
                walls: vec![fixed(-LARGE), fixed(LARGE)],
                door: Vec::new(),
            }),
            contact: Some(Contact::Hertz(Hertz {
                young_modulus: 5e8,
                poisson_ratio: 0.3,
                dissipation_time: None,
                restitution: Some(0.5),
                restitution_speed: 0.1,
                dissipation_factor: 1.0,
            })),
            friction: Some(Friction::Mindlin(Mindlin {
                coefficient: 0.5,
                rescale: false,
            })),
            effects: Effects {
                gravity: downward(),
                ..Effects::default()
            },
            ..DemScene::default()
        },
        ..Scene::new(spheres, start, time)
    }
}

/// Whether the sphere falls off within 0.3 s: farther down than anything can hold it.
fn falls(scene: &Scene) -> bool {
    let mut simulation = DemSimulation::new(scene).unwrap();
    (0..30).any(|_| {
        simulation.advance((0.01 / scene.time.dt) as u64).unwrap();
        simulation.particles().position[2].z < -LARGE
    })
}

#[test]
fn a_small_sphere_falls_from_the_neck_between_two_large_ones() {
    for integrator in Integrator::ALL {
        for ratio in [2.0, 3.0, 5.0, 10.0, 20.0, 30.0] {
            let trapped = ratio >= 10.0 && TRAPPING.contains(&integrator);
            let scene = at(&neck(ratio), integrator, LIMIT);
            assert_eq!(falls(&scene), !trapped, "{integrator:?} at 1:{ratio}");
        }
    }
}

#[test]
#[ignore = "takes a quarter of a minute"]
fn what_traps_a_small_sphere_is_the_time_step() {
    for integrator in TRAPPING {
        assert!(falls(&at(&neck(10.0), integrator, 0.2)));
        assert!(falls(&at(&neck(20.0), integrator, 0.02)));
    }
}
