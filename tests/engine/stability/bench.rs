//! What the cases share: scenes at a part of their limit, and what a run shows on its way.

use crate::scenes::energy;
use phase::dem::{DemSimulation, timestep};
use phase::particles::Particles;
use phase::record::{Guard, Instability};
use phase::scene::{Gravity, Integrator, Scene, StartSphere};

/// Radius of the spheres of `scenes::cluster` (m).
pub(crate) const RADIUS: f64 = 0.004;

/// The largest part of the limit that is stable whatever the rounding.
pub(crate) const LIMIT: f64 = 0.999;

/// The integrators that take the step of the scene as it is; one that divides it has other limits.
pub(crate) const PLAIN: [Integrator; 3] = [
    Integrator::SymplecticEuler,
    Integrator::VelocityVerlet,
    Integrator::SynchronisedVerlet,
];

/// The scene with this integrator, at this part of its limit of the time step.
pub(crate) fn at(scene: &Scene, integrator: Integrator, part: f64) -> Scene {
    let mut scene = scene.clone();
    scene.time.integrator = integrator;
    scene.time.dt = part * limit(&scene, |limit| limit.decisive);
    scene
}

/// The same for spheres with many contacts, of which the decisive limit knows nothing.
pub(crate) fn crowded(scene: &Scene, integrator: Integrator, part: f64) -> Scene {
    let mut scene = scene.clone();
    scene.time.integrator = integrator;
    scene.time.dt = part * limit(&scene, |it| it.decisive || it.name == "twelve contacts");
    scene
}

/// The smallest of such limits (s). Those of adaptive Verlet are so wide that impacts are over
/// within a step: it is tried at ten times that of the others, or at half its own if that is less.
fn limit(scene: &Scene, counts: fn(&timestep::Limit) -> bool) -> f64 {
    if scene.time.integrator != Integrator::AdaptiveVerlet {
        return smallest(scene, counts);
    }
    let mut plain = scene.clone();
    plain.time.integrator = Integrator::VelocityVerlet;
    // A sphere may become somewhat faster than what the scene lets expect.
    (0.5 * smallest(scene, counts)).min(10.0 * smallest(&plain, counts))
}

fn smallest(scene: &Scene, counts: fn(&timestep::Limit) -> bool) -> f64 {
    let limits = timestep::limits(scene).into_iter().filter(counts);
    limits.map(|it| it.seconds).fold(f64::INFINITY, f64::min)
}

/// A sphere that flies.
pub(crate) fn moving(position: [f64; 3], velocity: [f64; 3]) -> StartSphere {
    StartSphere {
        velocity,
        ..StartSphere::at(position)
    }
}

/// Gravity straight down.
pub(crate) fn downward() -> Option<Gravity> {
    Some(Gravity {
        acceleration: 9.8,
        tilt: 0.0,
    })
}

/// Steps after which an impact that never shows is over: it began and ended within one.
const PATIENCE: u64 = 1000;

/// Advances until the first contact is over, and the step after, which has the last kick.
pub(crate) fn collide(simulation: &mut DemSimulation) -> Result<(), Instability> {
    while simulation.elastic_energy() == 0.0 && simulation.step() < PATIENCE {
        simulation.advance(1)?;
    }
    while simulation.elastic_energy() > 0.0 {
        simulation.advance(1)?;
    }
    simulation.advance(1)
}

/// What a run shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seen {
    /// Largest energy after the start, over that at the start.
    pub(crate) most: f64,
    /// Energy at the end, over that at the start.
    pub(crate) end: f64,
    /// Deepest overlap, in radii of the smaller partner.
    pub(crate) overlap: f64,
}

/// Advances a run and looks at it so many times.
pub(crate) fn watch(
    simulation: &mut DemSimulation,
    scene: &Scene,
    steps: u64,
    looks: u64,
) -> Result<Seen, Instability> {
    let gravity = scene
        .dem
        .effects
        .gravity
        .as_ref()
        .map_or(0.0, |it| it.acceleration);
    let start = energy(simulation, gravity);
    let mut seen = Seen {
        most: 0.0,
        end: 1.0,
        overlap: 0.0,
    };
    for _ in 0..looks {
        simulation.advance((fair(scene, steps) / looks).max(1))?;
        seen.end = energy(simulation, gravity) / start;
        seen.most = seen.most.max(seen.end);
        let overlap = deepest_overlap(simulation.particles(), scene);
        seen.overlap = seen.overlap.max(overlap);
    }
    Ok(seen)
}

/// How many steps take as long as so many at the limit of the other integrators do.
pub(crate) fn fair(scene: &Scene, steps: u64) -> u64 {
    if scene.time.integrator != Integrator::AdaptiveVerlet {
        return steps;
    }
    let mut plain = scene.clone();
    plain.time.integrator = Integrator::VelocityVerlet;
    let dt = smallest(&plain, |it| it.decisive || it.name == "twelve contacts");
    (steps as f64 * (dt / scene.time.dt).min(1.0)).ceil() as u64
}

/// Runs a scene and looks at it so many times.
pub(crate) fn run(scene: &Scene, steps: u64, looks: u64) -> Result<Seen, Instability> {
    watch(&mut DemSimulation::new(scene).unwrap(), scene, steps, looks)
}

/// Asserts that a run kept its energy below so many times that of the start, or was reported as
/// too fast or too deep.
#[track_caller]
pub(crate) fn keeps_or_is_reported(outcome: Result<Seen, Instability>, gain: f64) {
    match outcome {
        Ok(seen) => assert!(seen.most <= gain, "{seen:?}"),
        Err(broken) => {
            let expected = [Guard::Displacement, Guard::Overlap];
            assert!(expected.contains(&broken.guard), "{broken}");
        }
    }
}

/// Deepest overlap of two spheres or of one with a wall, in radii of the smaller partner.
pub(crate) fn deepest_overlap(particles: &Particles, scene: &Scene) -> f64 {
    let (position, radius) = (&particles.position, &particles.radius);
    let mut deepest = 0.0_f64;
    for i in 0..particles.len() {
        for j in 0..i {
            let overlap = radius[i] + radius[j] - (position[i] - position[j]).norm();
            deepest = deepest.max(overlap / radius[i].min(radius[j]));
        }
        let tank = scene.tank.as_ref();
        if let Some(floor) = tank.and_then(|tank| tank.floor) {
            deepest = deepest.max((radius[i] - (position[i].z - floor)) / radius[i]);
        }
        if let Some(wall) = tank.and_then(|tank| tank.radius) {
            let distance = libm::hypot(position[i].x, position[i].y);
            deepest = deepest.max((distance + radius[i] - wall) / radius[i]);
        }
    }
    deepest
}
