//! An elastic gas in the tank.

use super::bench::{Bench, downward, unguarded};
use super::material::Material;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::scene::{DemScene, Effects, Scene, Spheres, Start, Tank};
use serde::Deserialize;

/// Elastic spheres that bounce on one another and on the tank's walls, under gravity.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gas {
    /// Number of spheres.
    count: usize,
    /// Radius (m).
    radius: f64,
    material: Material,
    /// Radius of the tank (m).
    tank_radius: f64,
    /// The floor is at zero; centres start between these heights (m).
    heights: [f64; 2],
    /// Velocity components at the start are uniform in plus or minus this (m/s).
    speed: f64,
    /// Gravity (m/s2).
    gravity: f64,
    /// Time step (s); the order is measured against a run at an eighth of it.
    dt: f64,
    /// Duration (s).
    duration: f64,
}

/// Number of energy checks in a run.
const LOOKS: u32 = 1000;

impl CaseFamily for Gas {
    fn name(&self) -> &'static str {
        "gas"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let [energy, momentum] = self.drifts(self.dt, bench)?;
        let mut measured = named([
            ("energy_drift", energy),
            ("angular_momentum_drift", momentum),
        ]);
        if bench.expects("order") {
            // Collisions are many and their errors random: halving the step would reveal little.
            let [finer, _] = self.drifts(self.dt / 8.0, bench)?;
            measured.insert("order".to_owned(), libm::log2(energy / finer) / 3.0);
        }
        Ok(measured)
    }
}

impl Gas {
    /// Root mean square deviations from the first values: of the energy, relative to its first
    /// value, and of the angular momentum about the axis, which a round wall without friction
    /// conserves, relative to the sum of the spheres' absolute angular momenta.
    fn drifts(&self, dt: f64, bench: &mut Bench<'_>) -> Result<[f64; 2], VerifyError> {
        let scene = Scene {
            tank: Some(Tank {
                radius: Some(self.tank_radius),
                floor: Some(0.0),
                ..Tank::default()
            }),
            dem: DemScene {
                contact: Some(self.material.contact()),
                effects: Effects {
                    gravity: Some(downward(self.gravity)),
                    ..Effects::default()
                },
                ..unguarded()
            },
            ..bench.scene(self.material.density, self.radius, Vec::new(), dt)
        };
        let scene = Scene {
            spheres: Spheres {
                count: self.count,
                ..scene.spheres
            },
            start: Start::Random {
                z_min: self.heights[0],
                z_max: self.heights[1],
                x: None,
                y: None,
                speed: self.speed,
                spin: 0.0,
            },
            ..scene
        };
        let mut simulation = DemSimulation::new(&scene)?;
        let momenta = angular_momenta(&simulation);
        let first = [self.energy(&mut simulation), momenta.iter().sum()];
        let scale = [first[0], momenta.iter().map(|it| it.abs()).sum()];
        let mut sums = [0.0; 2];
        for _ in 0..LOOKS {
            bench.advance_for(&mut simulation, self.duration / f64::from(LOOKS), dt)?;
            let momentum = angular_momenta(&simulation).iter().sum();
            for (place, value) in [self.energy(&mut simulation), momentum]
                .into_iter()
                .enumerate()
            {
                let deviation = (value - first[place]) / scale[place];
                sums[place] += deviation * deviation;
            }
        }
        Ok(sums.map(|sum| (sum / f64::from(LOOKS)).sqrt()))
    }

    fn energy(&self, simulation: &mut DemSimulation) -> f64 {
        let elastic = simulation.elastic_energy();
        let particles = simulation.particles();
        (0..particles.len())
            .map(|i| {
                let kinetic = 0.5 * particles.velocity[i].norm_squared();
                particles.mass[i] * (kinetic + self.gravity * particles.position[i].z)
            })
            .sum::<f64>()
            + elastic
    }
}

/// Angular momentum of each sphere about the axis of the tank (kg m2/s).
fn angular_momenta(simulation: &DemSimulation) -> Vec<f64> {
    let particles = simulation.particles();
    let momentum = |i: usize| {
        let (place, velocity) = (particles.position[i], particles.velocity[i]);
        particles.mass[i] * (place.x * velocity.y - place.y * velocity.x)
    };
    (0..particles.len()).map(momentum).collect()
}
