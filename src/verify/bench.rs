//! Common parts of the families: bare scenes, counted steps.

use super::VerifyError;
use crate::dem::DemSimulation;
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::{
    DemScene, Effects, Gravity, Guards, Integrator, Radii, Scene, Shape, Spheres, Start,
    StartSphere, Tank, Time,
};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

/// a b / (a + b), for masses or radii.
pub(super) fn reduced(a: f64, b: f64) -> f64 {
    a * b / (a + b)
}

/// Gravity straight down (m/s2).
pub(super) fn downward(acceleration: f64) -> Gravity {
    Gravity {
        acceleration,
        tilt: 0.0,
    }
}

/// Only a floor at height zero.
pub(super) fn floor() -> Tank {
    Tank {
        floor: Some(0.0),
        ..Tank::default()
    }
}

/// A sphere at rest.
pub(super) fn at(position: [f64; 3]) -> StartSphere {
    moving(position, [0.0; 3])
}

/// A sphere that moves.
pub(super) fn moving(position: [f64; 3], velocity: [f64; 3]) -> StartSphere {
    StartSphere {
        position,
        velocity,
        spin: [0.0; 3],
        radius: None,
    }
}

/// Steps between two checks whether to stop.
const STEPS_AT_ONCE: u64 = 10_000;

/// Runs the simulations of one case.
pub(super) struct Bench<'a> {
    integrator: Integrator,
    /// The quantities that the case expects.
    expected: &'a BTreeMap<String, f64>,
    /// When set, the simulations stop.
    stop: &'a AtomicBool,
    steps: u64,
    moves: u64,
}

impl<'a> Bench<'a> {
    pub(super) fn new(
        integrator: Integrator,
        expected: &'a BTreeMap<String, f64>,
        stop: &'a AtomicBool,
    ) -> Self {
        Self {
            integrator,
            expected,
            stop,
            steps: 0,
            moves: 0,
        }
    }

    /// A scene with these spheres and nothing else. Its guards allow any displacement per step:
    /// some set-ups have no contacts and need no small steps.
    pub(super) fn scene(
        &self,
        density: f64,
        radius: f64,
        list: Vec<StartSphere>,
        dt: f64,
    ) -> Scene {
        let count = list.len();
        let spheres = Spheres {
            count,
            radius: Radii::One(radius),
            density,
            shape: Shape::Sphere,
        };
        let time = Time {
            dt,
            safety_factor: None,
            resolution: None,
            duration: dt,
            frame_interval: dt,
            integrator: self.integrator,
        };
        Scene {
            dem: unguarded(),
            ..Scene::new(spheres, Start::list(list), time)
        }
    }

    /// Advances and counts.
    pub(super) fn advance(
        &mut self,
        simulation: &mut DemSimulation,
        steps: u64,
    ) -> Result<(), VerifyError> {
        let before = simulation.moves();
        let mut left = steps;
        while left > 0 {
            if self.stop.load(Ordering::Relaxed) {
                return Err(VerifyError::Stopped);
            }
            let next = left.min(STEPS_AT_ONCE);
            simulation.advance(next)?;
            left -= next;
        }
        self.steps += steps;
        self.moves += simulation.moves() - before;
        Ok(())
    }

    /// Advances by a duration (s), to the nearest step.
    pub(super) fn advance_for(
        &mut self,
        simulation: &mut DemSimulation,
        duration: f64,
        dt: f64,
    ) -> Result<(), VerifyError> {
        self.advance(simulation, (duration / dt).round() as u64)
    }

    /// The scheme of all simulations.
    pub(super) fn integrator(&self) -> Integrator {
        self.integrator
    }

    /// How many steps ago spheres were at the positions of the latest forces: symplectic Euler
    /// moves them after it evaluates the forces, other schemes evaluate them in the middle of a
    /// step.
    pub(super) fn age_of_forces(&self) -> f64 {
        match self.integrator {
            Integrator::SymplecticEuler => 1.0,
            Integrator::VelocityVerlet => 0.0,
            // In an impact, the last of many sub-steps.
            Integrator::AdaptiveVerlet => 0.0,
            Integrator::SynchronisedVerlet => 0.5,
        }
    }

    /// Whether the case expects a quantity, which may need extra simulations.
    pub(super) fn expects(&self, quantity: &str) -> bool {
        self.expected.contains_key(quantity)
    }

    /// Steps of all simulations so far.
    pub(super) fn steps(&self) -> u64 {
        self.steps
    }

    /// How often spheres were moved by all simulations so far, counting sub-steps.
    pub(super) fn moves(&self) -> u64 {
        self.moves
    }

    /// Force of the walls (N) on these spheres, without motion, gravity or air: the sum of all
    /// forces, in which forces between spheres cancel.
    pub(super) fn force_of_walls(
        &mut self,
        scene: &Scene,
        particles: &Particles,
    ) -> Result<Vector, VerifyError> {
        let centre = |position: &Vector| at([position.x, position.y, position.z]);
        // The first step of symplectic Euler evaluates the forces before anything moves.
        let time = Time {
            integrator: Integrator::SymplecticEuler,
            ..scene.time.clone()
        };
        let bare = Scene {
            time,
            start: Start::list(particles.position.iter().map(centre).collect()),
            dem: DemScene {
                friction: None,
                effects: Effects::default(),
                ..scene.dem.clone()
            },
            ..scene.clone()
        };
        let mut simulation = DemSimulation::new(&bare)?;
        self.advance(&mut simulation, 1)?;
        let forces = &simulation.particles().force;
        Ok(forces.iter().fold(Vector::ZERO, |sum, &force| sum + force))
    }
}

/// No forces on spheres, and no guard on displacements per step.
pub(super) fn unguarded() -> DemScene {
    DemScene {
        guards: Guards {
            displacement: f64::MAX,
            ..Guards::default()
        },
        ..DemScene::default()
    }
}
