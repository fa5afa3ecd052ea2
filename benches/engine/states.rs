//! The moments in which is measured.

use phase::dem::Simulation;
use phase::scene::{Friction, Scene, Start};
use std::path::Path;

/// A scene of this repository.
pub(crate) fn scene(path: &str) -> Scene {
    phase::scene::load(Path::new(path)).unwrap()
}

/// A simulation of a scene at a time (s).
pub(crate) fn at(scene: &Scene, time: f64) -> Simulation {
    let mut simulation = Simulation::new(scene).unwrap();
    let steps = (time / scene.time.dt).round() as u64;
    simulation.advance(steps).unwrap();
    simulation
}

/// The theoretical tank with air that rotates so fast (rad/s).
pub(crate) fn theoretical(omega: f64) -> Scene {
    let mut scene = scene("sweeps/scenes/theoretical.toml");
    scene.swirl.as_mut().unwrap().omega = omega;
    scene
}

/// A bed of so many spheres, without friction, with Coulomb's or Mindlin's.
pub(crate) fn bed(count: usize, friction: &str) -> Scene {
    let mut scene = scene("benches/bed.toml");
    let scale = libm::cbrt(count as f64 / scene.spheres.count as f64);
    scene.spheres.count = count;
    *scene.tank.as_mut().unwrap().radius.as_mut().unwrap() *= scale;
    if let Start::Random { z_max, .. } = &mut scene.start {
        *z_max *= scale;
    }
    scene.friction = match friction {
        "none" => None,
        "coulomb" => Some(Friction::Coulomb {
            coefficient: 0.3,
            regularisation: 1e-3,
        }),
        _ => scene.friction,
    };
    scene
}
