//! Magnus lift turns velocities and makes no energy.

use crate::ledger::{last, with_ledger};
use phase::dem::DemSimulation;
use phase::dem::timestep::StepMargin;
use phase::scene::{Integrator, Scene};
use std::path::Path;

/// A sphere that spins at 10^4 rad/s in a dense fluid without drag: W = 3000 / s.
fn spinning(integrator: Integrator, tables: &str, dt: &str) -> Scene {
    let text = format!(
        "spheres = {{ count = 1, radius = 0.01, density = 2500.0 }}
        contact = {{ law = 'linear', stiffness = 1e3, damping = 0.0 }}
        friction = {{ law = 'coulomb', coefficient = 0.3, regularisation = 0.1 }}
        magnus = {{ density = 1000.0 }}
        {tables}
        [start]
        kind = 'list'
        spheres = [{{ position = [0.0, 0.0, 0.0], velocity = [0.8, 0.0, 0.6], \
         spin = [0.0, 0.0, 1e4] }}]
        [time]
        dt = {dt}
        duration = 1.0
        frame_interval = 0.01
        integrator = '{}'",
        integrator.name()
    );
    Scene::from_toml(&text, Path::new("spinning.toml")).unwrap_or_else(|error| panic!("{error}"))
}

fn speed(simulation: &DemSimulation) -> f64 {
    simulation.particles().velocity[0].norm()
}

fn standing(scene: &Scene) -> StepMargin {
    let mut all = StepMargin::all(scene).into_iter();
    all.find(|it| it.limit.name == "Magnus lift").unwrap()
}

/// Symptom: with symplectic Euler and velocity Verlet a sphere went from 1 to 403 m/s in a second.
/// Cause: the lift was that of the velocity half a step before, which has a part along the path.
#[test]
fn lift_keeps_the_speed() {
    for integrator in Integrator::ALL {
        let scene = spinning(integrator, "", "'auto'");
        let mut simulation = DemSimulation::new(&scene).unwrap();
        let steps = scene.time.frames() * scene.time.steps_per_frame();
        for _ in 0..100 {
            simulation.advance(steps / 100).unwrap();
            let speed = speed(&simulation);
            assert!((speed - 1.0).abs() < 1e-4, "{integrator:?}: {speed}");
        }
        let ratio = standing(&scene).ratio;
        assert!((0.19..=0.2).contains(&ratio), "{integrator:?}: {ratio}");
        // Along the spin nothing acts.
        let along = simulation.particles().velocity[0].z;
        assert!((along - 0.6).abs() < 1e-9, "{integrator:?}: {along}");
    }
}

/// It does no work beside other forces either. Schemes that predict velocities turn them by t in a
/// step, and give work in t^4; velocity Verlet shows the speed between two kicks, which is less.
#[test]
fn lift_does_no_work_beside_gravity() {
    let gravity = "gravity = { acceleration = 9.81, tilt = 0.5 }\noutput.ledger = true\n";
    for integrator in Integrator::ALL {
        for added in ["", "added_mass = { density = 1000.0 }\n"] {
            let scene = spinning(integrator, &format!("{gravity}{added}"), "5e-6");
            let observed = with_ledger(&scene);
            let [work, residual] = [&observed.work_of_air, &observed.residual].map(|it| last(it));
            let kinetic = 0.5 * 2500.0 * 4.2e-6;
            let most = match integrator {
                Integrator::SymplecticEuler => 1e-9,
                Integrator::VelocityVerlet => 1e-4,
                Integrator::SynchronisedVerlet | Integrator::AdaptiveVerlet => 4e-3,
            };
            assert!(work.abs() < most * kinetic, "{integrator:?}: {work:e}");
            assert!(
                residual.abs() < 1e-3 * kinetic,
                "{integrator:?}: {residual:e}"
            );
        }
    }
}

/// A number for the step above the limit is warned of.
#[test]
fn a_coarse_turn_is_warned_of() {
    for integrator in Integrator::ALL {
        for (dt, expected) in [("5e-6", false), ("1e-5", true)] {
            let scene = spinning(integrator, "", dt);
            let warns = standing(&scene).consequence().is_some();
            assert_eq!(warns, expected, "{integrator:?}");
        }
    }
}
