//! Spheres that are too fast, air that is too fast, and scenes with hardly anything in them.

use crate::bench::{LIMIT, RADIUS, at, crowded, downward, moving, watch};
use crate::crowds::dropped;
use crate::scenes::{cluster, damped, momentum, scales};
use phase::dem::Simulation;
use phase::record::Guard;
use phase::scene::{Contact, Friction, Integrator, Scene, StartSphere, Swirl, Tank};

/// Whatever the speed: a sphere bounces back or the run ends, it never comes out behind.
#[test]
fn fast_spheres_bounce_back_or_are_reported() {
    for integrator in Integrator::ALL {
        let (mut bounced, mut reported) = (0, 0);
        for (speed, phase) in [3.0, 10.0, 30.0, 100.0, 300.0]
            .into_iter()
            .flat_map(|v| (0..16).map(move |k| (v, k)))
        {
            for part in [0.1, 0.5, LIMIT] {
                let flying = moving([-0.02, 0.0, 0.0], [speed, 0.0, 0.0]);
                let pair = cluster(vec![flying, StartSphere::at([0.0; 3])], None, 1e-6);
                let scene = at(&pair, integrator, part * (1.0 - 0.02 * f64::from(phase)));
                let mut simulation = Simulation::new(&scene).unwrap();
                let steps = (0.06 / speed / scene.time.dt).ceil() as u64;
                match simulation.advance(steps) {
                    Ok(()) => {
                        let particles = simulation.particles();
                        let (x, v) = (&particles.position, &particles.velocity);
                        assert!(x[0].x < x[1].x && v[0].x < v[1].x, "passed at {speed} m/s");
                        bounced += 1;
                    }
                    Err(broken) => {
                        let expected = [Guard::Displacement, Guard::Overlap];
                        assert!(expected.contains(&broken.guard), "{broken}");
                        reported += 1;
                    }
                }
            }
        }
        assert!(
            bounced > 0 && reported > 0,
            "{bounced} bounced, {reported} reported"
        );
    }
}

/// The same with a floor and a wall; what is too fast for its step is reported at once.
#[test]
fn fast_spheres_do_not_leave_the_tank_unreported() {
    for integrator in Integrator::ALL {
        for speed in [3.0, 30.0, 300.0, 3000.0] {
            for velocity in [
                [0.0, 0.0, -speed],
                [speed, 0.0, 0.0],
                [0.6 * speed, 0.3 * speed, -0.7 * speed],
            ] {
                let mut scene = cluster(vec![moving([0.0, 0.0, 0.02], velocity)], None, 1e-6);
                scene.tank = Some(Tank {
                    radius: Some(0.06),
                    floor: Some(0.0),
                });
                let scene = at(&scene, integrator, LIMIT);
                let mut simulation = Simulation::new(&scene).unwrap();
                for _ in 0..1000 {
                    if simulation.advance(1).is_err() {
                        break;
                    }
                    let centre = simulation.particles().position[0];
                    let out = (0.02 - centre.z).max(libm::hypot(centre.x, centre.y) - 0.06);
                    // The guard of the overlap allows the centre half a radius behind the wall, and looks
                    // when forces are next evaluated.
                    assert!(
                        out < 0.02 + 1.5 * RADIUS,
                        "{out} m behind a wall at {speed} m/s"
                    );
                }
            }
        }
    }
}

/// Spheres in air that turns at 2000 rad/s.
fn whirled(young_modulus: f64) -> Scene {
    let mut scene = dropped(20, Some(Friction::Mindlin { coefficient: 0.5 }));
    scene.swirl = Some(Swirl { omega: 2000.0 });
    scene.drag = Some(toml::from_str("law = 'constant'\nlinear = 0.5").unwrap());
    scene.tank = Some(Tank {
        radius: Some(0.06),
        floor: Some(0.0),
    });
    if let Some(Contact::Hertz {
        young_modulus: modulus,
        ..
    }) = &mut scene.contact
    {
        *modulus = young_modulus;
    }
    damped(scene, 1e-6)
}

/// Hard spheres are pressed to the wall by 240,000 m/s2 and turn with the air; soft ones cannot bear
/// it.
#[test]
fn air_at_two_thousand_radians_per_second() {
    for integrator in Integrator::ALL {
        let scene = crowded(&whirled(2e10), integrator, LIMIT);
        let mut simulation = Simulation::new(&scene).unwrap();
        let seen = watch(&mut simulation, &scene, 200_000, 200).unwrap();
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
        let broken = Simulation::new(&soft)
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
        let mut simulation = Simulation::new(&scene).unwrap();
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

/// A single sphere on the way of a parabola: exact for what is second order, half a step's fall beside
/// it for symplectic Euler.
#[test]
fn one_sphere_falls_as_it_must() {
    for integrator in Integrator::ALL {
        let mut scene = cluster(vec![moving([0.0; 3], [1.0, 0.0, 2.0])], None, 1e-6);
        scene.gravity = downward();
        let scene = at(&scene, integrator, 0.1);
        let mut simulation = Simulation::new(&scene).unwrap();
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
