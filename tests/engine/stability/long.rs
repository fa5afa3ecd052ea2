//! Many steps: what takes minutes, and a short form of it.

use super::bench::{LIMIT, RADIUS, at, crowded, downward, moving, watch};
use super::crowds::{
    MINDLIN, column, column_frictions, creep, drift, dropped, falls_soundly, leaning,
};
use crate::scenes::{cluster, momentum, scales};
use phase::dem::DemSimulation;
use phase::scene::{Integrator, Scene, StartSphere, Tank};

/// Tries all integrators at the same time.
fn each_integrator(trial: impl Fn(Integrator) + Sync) {
    std::thread::scope(|scope| {
        for integrator in Integrator::ALL {
            let trial = &trial;
            scope.spawn(move || trial(integrator));
        }
    });
}

#[test]
#[ignore = "takes three minutes"]
fn a_column_of_a_hundred_stays_at_rest_for_a_million_steps() {
    each_integrator(|integrator| {
        for friction in column_frictions() {
            let scene = crowded(&column(&[RADIUS; 100], friction), integrator, LIMIT);
            let [way, speed] = drift(&scene, 1_000_000);
            assert!(way < 1e-10 && speed < 1e-10, "{way} radii, {speed} m/s");
        }
    });
}

/// Measured: 1e-11 radii.
#[test]
#[ignore = "takes half a minute"]
fn a_leaning_column_of_twenty_with_static_friction_does_not_creep() {
    each_integrator(|integrator| {
        let way = creep(
            &crowded(&leaning(20, MINDLIN), integrator, LIMIT),
            9,
            50_000,
        );
        assert!(way < 1e-8, "{way} radii, {integrator:?}");
    });
}

/// Four thousand by adaptive Verlet: each of them costs it many times as much as the others.
#[test]
#[ignore = "takes two minutes"]
fn twenty_thousand_spheres_dropped_at_once_come_to_rest() {
    each_integrator(|integrator| {
        let count = match integrator {
            Integrator::AdaptiveVerlet => 4_000,
            _ => 20_000,
        };
        let scene = crowded(&dropped(count, Some(MINDLIN)), integrator, LIMIT);
        falls_soundly(&scene, 3000, 3);
    });
}

/// A sphere that bounces on an undamped floor.
fn bouncing() -> Scene {
    let mut scene = cluster(vec![StartSphere::at([0.0, 0.0, 0.05])], None, 1e-6);
    scene.tank = Some(Tank {
        floor: Some(0.0),
        ..Tank::default()
    });
    scene.dem.effects.gravity = downward();
    scene
}

/// Three spheres in empty space, which meet and part.
fn isolated() -> Scene {
    let sphere = |x: f64, velocity: [f64; 3]| moving([x, 0.0, 0.0], velocity);
    let spheres = vec![
        sphere(-0.01, [0.5, 0.1, 0.0]),
        sphere(0.0, [0.0; 3]),
        sphere(0.01, [-0.7, 0.0, 0.2]),
    ];
    cluster(spheres, None, 1e-6)
}

fn keeps_its_energy(integrator: Integrator, steps: u64) {
    let scene = at(&bouncing(), integrator, 0.1);
    let mut simulation = DemSimulation::new(&scene).unwrap();
    let seen = watch(&mut simulation, &scene, steps, 1000).unwrap();
    assert!(
        seen.most < 1.1 && seen.end > 0.9,
        "{integrator:?}: {seen:?}"
    );
}

fn keeps_its_momentum(integrator: Integrator, steps: u64) {
    let scene = at(&isolated(), integrator, LIMIT);
    let mut simulation = DemSimulation::new(&scene).unwrap();
    let before = momentum(simulation.particles());
    let (linear, _) = scales(simulation.particles());
    simulation.advance(steps).unwrap();
    let change = (momentum(simulation.particles()) - before).norm();
    assert!(change < 1e-13 * linear, "{integrator:?}: {change}");
}

#[test]
fn two_hundred_thousand_steps_keep_energy_and_momentum() {
    for integrator in Integrator::ALL {
        keeps_its_energy(integrator, 200_000);
        keeps_its_momentum(integrator, 200_000);
    }
}

#[test]
#[ignore = "takes half a minute"]
fn ten_million_steps_keep_energy_and_momentum() {
    each_integrator(|integrator| {
        keeps_its_energy(integrator, 10_000_000);
        keeps_its_momentum(integrator, 10_000_000);
    });
}
