//! The order of synchronised Verlet in a motion in which contacts come and go: prints the first
//! table of "Second order with friction" in docs/integrators.md.
//!
//!     cargo run --release --example collapse_orders

#![allow(clippy::print_stdout, reason = "an example speaks for itself")]

use phase::dem::DemSimulation;
use phase::particles::vector::Vector;
use phase::scene::{DemScene, Integrator, Scene, Start, StartSphere};
use std::error::Error;

/// Ends of the motion (s).
const ENDS: [f64; 2] = [0.05, 0.06];

/// Steps of the motion; each number is twice the one before.
const STEPS: [u64; 6] = [200, 400, 800, 1600, 3200, 6400];

/// Steps of what these are compared with.
const REFERENCE: u64 = 51_200;

/// The scene with its random spheres as a list: the same for every step.
fn from_list(scene: &Scene) -> Result<Scene, Box<dyn Error>> {
    let simulation = DemSimulation::new(scene)?;
    let particles = simulation.particles();
    let triple = |it: Vector| [it.x, it.y, it.z];
    let spheres = particles.position.iter().zip(&particles.velocity);
    let spheres = spheres.zip(&particles.spin);
    let spheres = spheres.map(|((position, velocity), spin)| StartSphere {
        position: triple(*position),
        velocity: triple(*velocity),
        spin: triple(*spin),
        radius: None,
    });
    Ok(Scene {
        start: Start::list(spheres.collect()),
        ..scene.clone()
    })
}

/// Velocities (m/s) at a time (s) that is reached in so many steps.
fn velocities(scene: &Scene, end: f64, steps: u64) -> Result<Vec<Vector>, Box<dyn Error>> {
    let mut scene = scene.clone();
    scene.time.dt = end / steps as f64;
    let mut simulation = DemSimulation::new(&scene)?;
    simulation.advance(steps)?;
    Ok(simulation.particles().velocity.clone())
}

/// Root mean square of the differences between two sets of velocities (m/s).
fn difference(velocities: &[Vector], reference: &[Vector]) -> f64 {
    let pairs = velocities.iter().zip(reference);
    let squares: f64 = pairs
        .map(|(one, other)| (*one - *other).norm_squared())
        .sum();
    (squares / velocities.len() as f64).sqrt()
}

fn main() -> Result<(), Box<dyn Error>> {
    println!(
        "| friction | T | {} | exponent |",
        STEPS.map(|it| format!("T/{it}")).join(" | ")
    );
    let mut scene = from_list(&Scene::load("sweeps/scenes/collapse.toml".as_ref())?)?;
    scene.time.integrator = Integrator::SynchronisedVerlet;
    let frictionless = Scene {
        dem: DemScene {
            friction: None,
            ..scene.dem.clone()
        },
        ..scene.clone()
    };
    for end in ENDS {
        for (name, scene) in [("none", &frictionless), ("Mindlin", &scene)] {
            let reference = velocities(scene, end, REFERENCE)?;
            let mut errors = Vec::new();
            for steps in STEPS {
                errors.push(difference(&velocities(scene, end, steps)?, &reference));
            }
            let halvings = (STEPS.len() - 1) as f64;
            let exponent = libm::log2(errors[0] / errors[STEPS.len() - 1]) / halvings;
            let cells: Vec<String> = errors.iter().map(|it| format!("{it:.1e}")).collect();
            let milliseconds = 1e3 * end;
            println!(
                "| {name} | {milliseconds} ms | {} | {exponent:.1} |",
                cells.join(" | ")
            );
        }
    }
    Ok(())
}
