//! A sphere is pressed on the floor or on another sphere, and moved back and forth along it.

use super::bench::{Bench, at, floor, reduced, unguarded};
use super::material::AnyMaterial;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::particles::vector::Vector;
use crate::scene::{DemScene, Driven, Friction, Scene};
use serde::Deserialize;
use std::f64::consts::{FRAC_PI_2, TAU};

/// A driven sphere oscillates along its partner without rolling: along the floor at a constant
/// overlap, or along a second sphere whose path changes the overlap.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TangentialLoop {
    /// Radius of the spheres (m).
    radius: f64,
    material: AnyMaterial,
    friction: Friction,
    /// Normal force at the start (N).
    normal_force: f64,
    /// Amplitude of the oscillation (m).
    amplitude: f64,
    /// Amplitude of the overlap, a quarter of a cycle ahead of the oscillation and, in a second
    /// run, behind it (m).
    #[serde(default)]
    breathing: Option<f64>,
    /// Duration of a cycle (s).
    period: f64,
    /// Time steps of a cycle.
    #[serde(default = "thousands")]
    steps: u32,
}

fn thousands() -> u32 {
    20_000
}

/// Cycles of an oscillation with a changing overlap.
const CYCLES: u32 = 3;

impl CaseFamily for TangentialLoop {
    fn name(&self) -> &'static str {
        "tangential-loop"
    }

    /// Loss and largest force of a cycle at a constant overlap, or the energy gained by any number
    /// of cycles at a changing one.
    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        match self.breathing {
            None => self.cycle_on_the_floor(bench),
            Some(breathing) => {
                let ahead = self.gain(breathing, FRAC_PI_2, bench)?;
                let behind = self.gain(breathing, -FRAC_PI_2, bench)?;
                Ok(named([("gained_energy", ahead.max(behind))]))
            }
        }
    }
}

impl TangentialLoop {
    fn dt(&self) -> f64 {
        self.period / f64::from(self.steps)
    }

    fn path(&self, sphere: usize, amplitude: [f64; 3], phase: f64) -> Driven {
        Driven {
            sphere,
            velocity: [0.0; 3],
            amplitude,
            angular_frequency: TAU / self.period,
            phase,
        }
    }

    fn laws(&self, driven: Vec<Driven>) -> DemScene {
        DemScene {
            contact: Some(self.material.contact()),
            friction: Some(self.friction.clone()),
            driven,
            ..unguarded()
        }
    }

    /// Measures the second cycle: in the first one the contact leaves the curve of first loading.
    fn cycle_on_the_floor(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let dt = self.dt();
        let depth = self.material.overlap(self.radius, self.normal_force);
        let place = at([0.0, 0.0, self.radius - depth]);
        let scene = Scene {
            tank: Some(floor()),
            dem: self.laws(vec![self.path(0, [self.amplitude, 0.0, 0.0], 0.0)]),
            ..bench.scene(self.material.density(), self.radius, vec![place], dt)
        };
        let mut simulation = DemSimulation::new(&scene)?;
        bench.advance(&mut simulation, u64::from(self.steps))?;
        let age = bench.age_of_forces() * dt;
        let moment = |simulation: &DemSimulation| {
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

    /// The most energy (J) that the tangential force has released by any moment, if the oscillation
    /// begins with an unloaded contact. The overlap lags by this phase (rad).
    fn gain(&self, breathing: f64, lag: f64, bench: &mut Bench<'_>) -> Result<f64, VerifyError> {
        let dt = self.dt();
        let effective_radius = reduced(self.radius, self.radius);
        let depth = self.material.overlap(effective_radius, self.normal_force);
        let places = vec![at([0.0; 3]), at([0.0, 0.0, 2.0 * self.radius - depth])];
        let scene = Scene {
            dem: self.laws(vec![
                self.path(0, [self.amplitude, 0.0, 0.0], 0.0),
                self.path(1, [0.0, 0.0, breathing], lag),
            ]),
            ..bench.scene(self.material.density(), self.radius, places, dt)
        };
        let mut simulation = DemSimulation::new(&scene)?;
        let age = bench.age_of_forces() * dt;
        let moment = |simulation: &DemSimulation| {
            let particles = simulation.particles();
            let place = |i: usize| particles.position[i] - particles.velocity[i] * age;
            (place(0) - place(1), particles.force[0])
        };
        let (mut given, mut most) = (0.0, 0.0_f64);
        let mut before: (Vector, Vector) = moment(&simulation);
        for _ in 0..CYCLES * self.steps {
            bench.advance(&mut simulation, 1)?;
            let now = moment(&simulation);
            let offset = now.0 + before.0;
            let normal = offset * (1.0 / offset.norm());
            let mean = (now.1 + before.1) * 0.5;
            given += mean
                .perpendicular_to(normal)
                .dot((now.0 - before.0).perpendicular_to(normal));
            most = most.max(given);
            before = now;
        }
        Ok(most)
    }
}
