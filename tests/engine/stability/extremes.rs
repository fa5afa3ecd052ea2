//! Spheres that are too fast, air that is too fast, and scenes with hardly anything in them.

use super::bench::{LIMIT, RADIUS, at, crowded, downward, moving, watch};
use super::crowds::dropped;
use crate::scenes::{cluster, damped, momentum, scales};
use phase::dem::DemSimulation;
use phase::record::Guard;
use phase::scene::{
    Contact, Friction, Hertz, Integrator, Mindlin, Scene, StartSphere, Swirl, Tank,
};

/// Takes the guards away.
fn unguarded(mut scene: Scene) -> Scene {
    (scene.dem.guards.overlap, scene.dem.guards.displacement) = (f64::MAX, f64::MAX);
    scene
}

/// Whether a sphere came out behind the one it was shot at; nothing where the run was reported.
fn passes(scene: &Scene, speed: f64) -> Option<bool> {
    let mut simulation = DemSimulation::new(scene).unwrap();
    let steps = (0.06 / speed / scene.time.dt).ceil() as u64;
    if let Err(broken) = simulation.advance(steps) {
        let expected = [Guard::Displacement, Guard::Overlap];
        assert!(expected.contains(&broken.guard), "{broken}");
        return None;
    }
    let position = &simulation.particles().position;
    Some(position[0].x > position[1].x)
}

/// Whatever the speed and the step: a sphere bounces back or the run ends, it never comes out
/// behind the other. Without guards it does.
#[test]
fn fast_spheres_bounce_back_or_are_reported() {
    for integrator in Integrator::ALL {
        let (mut bounced, mut reported, mut through) = (0, 0, 0);
        for speed in [3.0, 10.0, 30.0, 100.0, 300.0] {
            let flying = moving([-0.02, 0.0, 0.0], [speed, 0.0, 0.0]);
            let pair = cluster(vec![flying, StartSphere::at([0.0; 3])], None, 1e-6);
            for part in (0..50).map(|k| LIMIT * (1.0 - 0.018 * f64::from(k))) {
                let scene = at(&pair, integrator, part);
                match passes(&scene, speed) {
                    Some(passed) => {
                        assert!(!passed, "passed at {speed} m/s, {part} of the limit");
                        bounced += 1;
                    }
                    None => reported += 1,
                }
                through += usize::from(passes(&unguarded(scene), speed) == Some(true));
            }
        }
        let counts = [bounced, reported, through];
        assert!(counts.into_iter().all(|count| count > 0), "{counts:?}");
    }
}

/// How far a centre comes behind floor or wall (radii) before the run ends or 1000 steps are over.
fn farthest_behind_walls(scene: &Scene) -> f64 {
    let mut simulation = DemSimulation::new(scene).unwrap();
    let mut farthest = f64::MIN;
    for _ in 0..1000 {
        if simulation.advance(1).is_err() {
            break;
        }
        let centre = simulation.particles().position[0];
        let behind_wall = libm::hypot(centre.x, centre.y) - 0.06;
        farthest = farthest.max(behind_wall.max(-centre.z) / RADIUS);
    }
    farthest
}

/// The guard of the overlap lets a centre half a radius behind a wall, and that of the displacement
/// one radius farther, before forces are evaluated again.
#[test]
fn fast_spheres_do_not_leave_the_tank_unreported() {
    for integrator in Integrator::ALL {
        let mut unseen = f64::MIN;
        for speed in [3.0, 30.0, 300.0, 3000.0] {
            let directions = [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.6, 0.3, -0.7]];
            for direction in directions {
                let velocity = direction.map(|part| speed * part);
                let mut scene = cluster(vec![moving([0.0, 0.0, 0.02], velocity)], None, 1e-6);
                scene.tank = Some(Tank {
                    radius: Some(0.06),
                    floor: Some(0.0),
                    ..Tank::default()
                });
                let scene = at(&scene, integrator, LIMIT);
                let behind = farthest_behind_walls(&scene);
                assert!(behind < 1.5, "{behind} radii behind a wall at {speed} m/s");
                unseen = unseen.max(farthest_behind_walls(&unguarded(scene)));
            }
        }
        assert!(unseen > 1.5, "{unseen}");
    }
}

/// Spheres in air that turns at 2000 rad/s.
fn whirled(young_modulus: f64) -> Scene {
    let mut scene = dropped(
        20,
        Some(Friction::Mindlin(Mindlin {
            coefficient: 0.5,
            rescale: false,
        })),
    );
    scene.dem.effects.swirl = Some(Swirl { omega: 2000.0 });
    scene.dem.effects.drag = Some(toml::from_str("law = 'constant'\nlinear = 0.5").unwrap());
    scene.tank = Some(Tank {
        radius: Some(0.06),
        floor: Some(0.0),
        ..Tank::default()
    });
    if let Some(Contact::Hertz(Hertz {
        young_modulus: modulus,
        ..
    })) = &mut scene.dem.contact
    {
        *modulus = young_modulus;
    }
    damped(scene, 1e-6)
}

/// Hard spheres are pressed to the wall by 240,000 m/s2 and turn with the air; soft ones cannot
/// bear it.
#[test]
#[ignore = "takes twenty seconds"]
fn air_at_two_thousand_radians_per_second() {
    for integrator in Integrator::ALL {
        let scene = crowded(&whirled(2e10), integrator, LIMIT);
        let mut simulation = DemSimulation::new(&scene).unwrap();
        // After these the energy changes by 1e-8 of itself in ten thousand steps.
        let seen = watch(&mut simulation, &scene, 40_000, 200).unwrap();
        assert!(seen.overlap < 0.5, "{seen:?}");
        let particles = simulation.particles();
        for (centre, velocity) in particles.position.iter().zip(&particles.velocity) {
            let distance = libm::hypot(centre.x, centre.y);
            let speed = velocity.norm();
            assert!(speed < 2000.0 * 0.06, "{speed} m/s");
            assert!(
                distance > 0.05 && speed > 10.0,
                "{speed} m/s at {distance} m"
            );
        }
        let soft = crowded(&whirled(1e6), integrator, LIMIT);
        let broken = DemSimulation::new(&soft)
            .unwrap()
            .advance(200_000)
            .unwrap_err();
        assert!(
            matches!(broken.guard, Guard::Overlap | Guard::Displacement),
            "{broken}"
        );
    }
}

#[test]
fn without_gravity_and_friction_nothing_but_impacts_changes_a_motion() {
    for integrator in Integrator::ALL {
        let spheres = vec![
            moving([-0.01, 0.001, 0.0], [1.0, 0.0, 0.0]),
            StartSphere::at([0.0; 3]),
            moving([0.0, 0.05, 0.0], [0.0, 2.0, 1.0]),
        ];
        let scene = at(&cluster(spheres, None, 1e-6), integrator, LIMIT);
        let mut simulation = DemSimulation::new(&scene).unwrap();
        let before = simulation.particles().clone();
        let steps = 1000;
        simulation.advance(steps).unwrap();
        let after = simulation.particles();
        // The third meets no one.
        let way = before.velocity[2] * (steps as f64 * scene.time.dt);
        assert_eq!(after.velocity[2], before.velocity[2]);
        assert!((after.position[2] - before.position[2] - way).norm() < 1e-12 * way.norm());
        assert!(after.velocity[0] != before.velocity[0]);
        let (linear, _) = scales(&before);
        assert!((momentum(after) - momentum(&before)).norm() < 1e-14 * linear);
    }
}

/// A single sphere on the way of a parabola: exact for what is second order, half a step's fall
/// beside it for symplectic Euler.
#[test]
fn one_sphere_falls_as_it_must() {
    for integrator in Integrator::ALL {
        let mut scene = cluster(vec![moving([0.0; 3], [1.0, 0.0, 2.0])], None, 1e-6);
        scene.dem.effects.gravity = downward();
        let scene = at(&scene, integrator, 0.1);
        let mut simulation = DemSimulation::new(&scene).unwrap();
        simulation.advance(1000).unwrap();
        let (time, centre) = (1000.0 * scene.time.dt, simulation.particles().position[0]);
        let error = centre.z - (2.0 - 4.9 * time) * time;
        assert!(
            error.abs() < 4.9 * time * scene.time.dt * (1.0 + 1e-9),
            "{error}"
        );
        assert!((centre.x - time).abs() < 1e-12);
    }
}
