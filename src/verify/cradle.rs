//! Newton's cradle: spheres in a row, hit by the first of them.

use super::bench::{Bench, moving, unguarded};
use super::material::Material;
use super::{CaseFamily, MeasuredValues, VerifyError, numbered};
use crate::dem::DemSimulation;
use crate::particles::Particles;
use crate::scene::{DemScene, Scene};
use serde::Deserialize;

/// Spheres in a row; the first ones arrive with a common speed, the others are at rest.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cradle {
    /// Number of spheres.
    count: usize,
    /// Number of incident spheres.
    #[serde(default = "one_sphere")]
    incident: usize,
    /// Gap between all neighbours, in units of T v of the first impact.
    #[serde(default)]
    gap: f64,
    /// Radius (m).
    radius: f64,
    material: Material,
    /// Speed of the incident spheres (m/s); velocities are measured in units of it.
    speed: f64,
    /// Time steps in the duration of an elastic impact of two spheres.
    steps_per_contact: f64,
}

fn one_sphere() -> usize {
    1
}

/// The motion ends within this many times the duration of an impact plus the time to cross the
/// gaps.
const PATIENCE: f64 = 1000.0;

impl CaseFamily for Cradle {
    fn name(&self) -> &'static str {
        "cradle"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let mass = self.material.mass(self.radius);
        let impact = self
            .material
            .impact(0.5 * self.radius, 0.5 * mass, self.speed);
        let dt = impact.contact_time() / self.steps_per_contact;
        let gap = self.gap * impact.time_scale() * self.speed;
        let row = |i: usize| {
            let speed = if i < self.incident { self.speed } else { 0.0 };
            let place = i as f64 * (2.0 * self.radius + gap);
            moving([place, 0.0, 0.0], [speed, 0.0, 0.0])
        };
        let spheres = (0..self.count).map(row).collect();
        let scene = Scene {
            dem: DemScene {
                contact: Some(self.material.contact()),
                ..unguarded()
            },
            ..bench.scene(self.material.density, self.radius, spheres, dt)
        };
        let mut simulation = DemSimulation::new(&scene)?;
        let patience = (PATIENCE + self.gap * self.count as f64) * self.steps_per_contact;
        while !parted(simulation.particles()) {
            if simulation.step() as f64 > patience {
                return Err(VerifyError::Unfinished {
                    awaited: "no sphere catches up with another",
                    steps: simulation.step(),
                });
            }
            bench.advance(&mut simulation, 1)?;
        }
        let velocities = &simulation.particles().velocity;
        Ok(numbered(
            "velocity",
            velocities.iter().map(|velocity| velocity.x / self.speed),
        ))
    }
}

/// Whether no two spheres touch or will touch.
fn parted(particles: &Particles) -> bool {
    (1..particles.len()).all(|i| {
        let distance = particles.position[i].x - particles.position[i - 1].x;
        let recession = particles.velocity[i].x - particles.velocity[i - 1].x;
        distance >= particles.radius[i] + particles.radius[i - 1] && recession >= 0.0
    })
}
