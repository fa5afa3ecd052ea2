//! Common parts of the families: materials, bare scenes, counted steps.

use super::VerifyError;
use crate::dem::DemSimulation;
use crate::dem::timestep::Impact;
use crate::particles::Particles;
use crate::particles::vector::Vector;
use crate::scene::{
    Contact, DemScene, Effects, Gravity, Guards, Hertz, Integrator, Radii, Scene, Shape, Silbert,
    Spheres, Start, StartSphere, Tank, Time,
};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

/// The material of spheres and walls.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Young's modulus Y (Pa).
    pub young_modulus: f64,
    /// Poisson's ratio nu.
    pub poisson_ratio: f64,
    /// Density (kg/m3).
    pub density: f64,
    /// Dissipation time A (s).
    #[serde(default)]
    pub dissipation_time: f64,
    /// Factor c of the dissipative term.
    #[serde(default = "one")]
    pub dissipation_factor: f64,
}

pub(super) fn one() -> f64 {
    1.0
}

impl Material {
    /// Mass of a sphere of this radius (kg).
    pub(super) fn mass(&self, radius: f64) -> f64 {
        Shape::Sphere.mass(self.density, radius)
    }

    /// An elastic head-on impact of an effective radius (m) and mass (kg) at a relative speed
    /// (m/s).
    pub(super) fn impact(&self, radius: f64, mass: f64, speed: f64) -> Impact {
        Impact {
            effective_mass: mass,
            stiffness: self.stiffness(radius),
            speed,
        }
    }

    /// K = 2 Y sqrt(R_eff) / (3 (1 - nu^2)) (N/m^1.5) of an effective radius.
    fn stiffness(&self, effective_radius: f64) -> f64 {
        2.0 * self.young_modulus * effective_radius.sqrt()
            / (3.0 * (1.0 - self.poisson_ratio * self.poisson_ratio))
    }

    /// Overlap at which the elastic force of an effective radius is `force` (m).
    pub(super) fn overlap(&self, effective_radius: f64, force: f64) -> f64 {
        libm::pow(force / self.stiffness(effective_radius), 2.0 / 3.0)
    }

    /// The contact law.
    pub(super) fn contact(&self) -> Contact {
        Contact::Hertz(Hertz {
            young_modulus: self.young_modulus,
            poisson_ratio: self.poisson_ratio,
            dissipation_time: Some(self.dissipation_time),
            restitution: None,
            restitution_speed: 1.0,
            dissipation_factor: self.dissipation_factor,
        })
    }
}

/// A material of Silbert et al.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SilbertMaterial {
    /// Stiffness k_n (Pa).
    pub stiffness: f64,
    /// Damping gamma_n (1/(m s)).
    pub damping: f64,
    /// Density (kg/m3).
    pub density: f64,
}

impl SilbertMaterial {
    /// Mass of a sphere of this radius (kg).
    pub(super) fn mass(&self, radius: f64) -> f64 {
        Shape::Sphere.mass(self.density, radius)
    }

    /// An elastic head-on impact of an effective radius (m) and mass (kg) at a relative speed
    /// (m/s).
    pub(super) fn impact(&self, radius: f64, mass: f64, speed: f64) -> Impact {
        Impact {
            effective_mass: mass,
            stiffness: self.stiffness * radius.sqrt(),
            speed,
        }
    }

    /// The contact law.
    pub(super) fn contact(&self) -> Contact {
        Contact::Silbert(Silbert {
            stiffness: self.stiffness,
            damping: self.damping,
        })
    }
}

/// A material of either law, for set-ups that accept both.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum AnyMaterial {
    /// For the Hertz contact.
    Hertz(Material),
    /// For the contact of Silbert et al.
    Silbert(SilbertMaterial),
}

impl AnyMaterial {
    /// Density (kg/m3).
    pub(super) fn density(&self) -> f64 {
        match self {
            Self::Hertz(material) => material.density,
            Self::Silbert(material) => material.density,
        }
    }

    /// Mass of a sphere of this radius (kg).
    pub(super) fn mass(&self, radius: f64) -> f64 {
        Shape::Sphere.mass(self.density(), radius)
    }

    /// Overlap at which the elastic force of an effective radius is `force` (m).
    pub(super) fn overlap(&self, effective_radius: f64, force: f64) -> f64 {
        match self {
            Self::Hertz(material) => material.overlap(effective_radius, force),
            Self::Silbert(material) => {
                let stiffness = material.stiffness * effective_radius.sqrt();
                libm::pow(force / stiffness, 2.0 / 3.0)
            }
        }
    }

    /// The contact law.
    pub(super) fn contact(&self) -> Contact {
        match self {
            Self::Hertz(material) => material.contact(),
            Self::Silbert(material) => material.contact(),
        }
    }
}

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
