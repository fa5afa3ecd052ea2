//! A sphere is pressed on the floor and moved to and fro along it.

use super::bench::{Bench, Material, at, floor, unguarded};
use super::{Family, Measured, VerifyError, named};
use crate::dem::Simulation;
use crate::scene::{DemScene, Driven, Friction, Scene};
use serde::Deserialize;
use std::f64::consts::TAU;

/// A sphere that a path presses on the floor and swings along it, without rolling.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TangentialLoop {
    /// Radius of the sphere (m).
    radius: f64,
    material: Material,
    friction: Friction,
    /// Force on the floor (N).
    normal_force: f64,
    /// Amplitude of the swing (m).
    amplitude: f64,
    /// Duration of a cycle (s).
    period: f64,
    /// Time steps of a cycle.
    #[serde(default = "thousands")]
    steps: u32,
}

fn thousands() -> u32 {
    20_000
}

impl Family for TangentialLoop {
    fn name(&self) -> &'static str {
        "tangential-loop"
    }

    /// Measures the second cycle: in the first one the contact leaves the curve of first loading.
    fn measure(&self, bench: &mut Bench<'_>) -> Result<Measured, VerifyError> {
        let dt = self.period / f64::from(self.steps);
        let depth = self.material.overlap(self.radius, self.normal_force);
        let path = Driven {
            sphere: 0,
            velocity: [0.0; 3],
            amplitude: [self.amplitude, 0.0, 0.0],
            angular_frequency: TAU / self.period,
            phase: 0.0,
        };
        let place = at([0.0, 0.0, self.radius - depth]);
        let scene = Scene {
            tank: Some(floor()),
            dem: DemScene {
                contact: Some(self.material.contact()),
                friction: Some(self.friction.clone()),
                driven: vec![path],
                ..unguarded()
            },
            ..bench.scene(self.material.density, self.radius, vec![place], dt)
        };
        let mut simulation = Simulation::new(&scene)?;
        bench.advance(&mut simulation, u64::from(self.steps))?;
        let age = bench.age_of_forces() * dt;
        let moment = |simulation: &Simulation| {
            let particles = simulation.particles();
            let place = particles.position[0] - particles.velocity[0] * age;
            (place.x, particles.force[0].x)
        };
        let mut before = moment(&simulation);
        let (mut lost, mut largest) = (0.0, 0.0_f64);
        for _ in 0..self.steps {
            bench.advance(&mut simulation, 1)?;
            let now = moment(&simulation);
            lost -= 0.5 * (now.1 + before.1) * (now.0 - before.0);
            largest = largest.max(now.1.abs());
            before = now;
        }
        Ok(named([("lost_energy", lost), ("largest_force", largest)]))
    }
}
