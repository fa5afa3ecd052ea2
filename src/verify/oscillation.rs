//! A sphere on the floor oscillates about its rest position.

use super::bench::{Bench, downward, floor, moving, unguarded};
use super::material::AnyMaterial;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::scene::{DemScene, Effects, Friction, Scene};
use serde::Deserialize;
use std::f64::consts::PI;

/// A sphere on the floor, pressed by its weight, set in motion at its rest position.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Oscillation {
    mode: Mode,
    /// Radius (m).
    radius: f64,
    material: AnyMaterial,
    #[serde(default)]
    friction: Option<Friction>,
    /// Gravity (m/s2).
    gravity: f64,
    /// Speed at the start (m/s), so small that forces are linear.
    speed: f64,
    /// Time step (s).
    dt: f64,
    /// Number of periods to average over.
    periods: u32,
}

/// The direction of the oscillation.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Mode {
    /// Vertical, against the normal stiffness.
    Normal,
    /// Horizontal, against the tangential stiffness, with rotation: the surface moves 7/2 times as
    /// far as the force would move the mass alone.
    Tangential,
}

/// Number of steps after which a set-up that does not oscillate is given up.
const PATIENCE: u64 = 10_000_000;

impl CaseFamily for Oscillation {
    fn name(&self) -> &'static str {
        "oscillation"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let mass = self.material.mass(self.radius);
        let rest = self.material.overlap(self.radius, mass * self.gravity);
        let velocity = match self.mode {
            Mode::Normal => [0.0, 0.0, self.speed],
            Mode::Tangential => [self.speed, 0.0, 0.0],
        };
        let sphere = moving([0.0, 0.0, self.radius - rest], velocity);
        let scene = Scene {
            tank: Some(floor()),
            dem: DemScene {
                contact: Some(self.material.contact()),
                friction: self.friction.clone(),
                effects: Effects {
                    gravity: Some(downward(self.gravity)),
                    ..Effects::default()
                },
                ..unguarded()
            },
            ..bench.scene(self.material.density(), self.radius, vec![sphere], self.dt)
        };
        let mut simulation = DemSimulation::new(&scene)?;
        let mut crossings = Vec::new();
        let mut last = self.surface_velocity(&simulation);
        while crossings.len() <= self.periods as usize {
            bench.advance(&mut simulation, 1)?;
            let now = self.surface_velocity(&simulation);
            if last < 0.0 && now >= 0.0 {
                crossings.push(simulation.time() - self.dt * now / (now - last));
            }
            last = now;
            if simulation.step() > PATIENCE {
                return Err(VerifyError::Unfinished {
                    awaited: "the sphere swings",
                    steps: simulation.step(),
                });
            }
        }
        let period = (crossings[crossings.len() - 1] - crossings[0]) / f64::from(self.periods);
        let frequency = 2.0 * PI / period;
        let effective_mass = match self.mode {
            Mode::Normal => mass,
            Mode::Tangential => mass / 3.5,
        };
        Ok(named([
            ("period", period),
            ("stiffness", effective_mass * frequency * frequency),
        ]))
    }
}

impl Oscillation {
    /// Velocity of the lowest point of the sphere, in the direction of the mode.
    fn surface_velocity(&self, simulation: &DemSimulation) -> f64 {
        let particles = simulation.particles();
        match self.mode {
            Mode::Normal => particles.velocity[0].z,
            Mode::Tangential => {
                let spin = particles.spin.first().map_or(0.0, |spin| spin.y);
                particles.velocity[0].x - spin * self.radius
            }
        }
    }
}
