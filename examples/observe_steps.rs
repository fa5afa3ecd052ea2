//! Advances a simulation of a scene file step by step and looks at it on the way.
//!
//!     cargo run --release --example observe_steps -- sweeps/scenes/theoretical.toml

#![allow(clippy::print_stdout, reason = "an example speaks for itself")]

use phase::dem::DemSimulation;
use phase::observe::Observer;
use phase::scene;
use std::error::Error;
use std::path::PathBuf;

/// Height of the highest centre (m).
fn top(z: &[f64]) -> f64 {
    z.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

fn main() -> Result<(), Box<dyn Error>> {
    let file = std::env::args_os().nth(1).map(PathBuf::from);
    let scene = scene::Scene::load(&file.unwrap_or("sweeps/scenes/theoretical.toml".into()))?;

    let mut simulation = DemSimulation::new(&scene)?;
    let mut observer = Observer::new(&scene, &simulation.particles().radius);

    // A second of time, looked at ten times. A broken guard ends it with an error that says which
    // sphere broke it, and when.
    let steps = (0.1 / scene.time.dt).round() as u64;
    println!("  time (s)   highest centre (m)   elastic energy (J)");
    for _ in 0..10 {
        simulation.advance(steps)?;
        let time = simulation.time();
        // The state itself: positions, velocities, spins, radii, masses of all spheres.
        let frame = simulation.frame();
        let (top, elastic) = (top(frame.position[2]), frame.elastic_energy);
        println!("{time:10.3} {top:20.4} {elastic:20.3e}");
        // And the observables that a record would hold.
        observer.observe(time, &frame);
    }

    println!("at the end:");
    for series in observer.finish().scalars() {
        if let Some(value) = series.values.last() {
            println!(
                "  {:<15} {value:>11.3e} {:<6} {}",
                series.name, series.unit, series.description
            );
        }
    }
    Ok(())
}
