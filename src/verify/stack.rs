//! A column of spheres at rest.

use super::bench::{Bench, at, downward, floor, unguarded};
use super::material::Material;
use super::{CaseFamily, MeasuredValues, VerifyError, named, numbered};
use crate::dem::DemSimulation;
use crate::scene::{DemScene, Effects, Scene};
use serde::Deserialize;

/// A column of equal spheres on the floor, released where they just touch.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stack {
    /// Number of spheres.
    count: usize,
    /// Radius (m).
    radius: f64,
    /// Its dissipation time brings the spheres to rest.
    material: Material,
    /// Gravity (m/s2).
    gravity: f64,
    /// Time step (s).
    dt: f64,
    /// Duration (s), long enough to come to rest.
    duration: f64,
}

impl CaseFamily for Stack {
    fn name(&self) -> &'static str {
        "stack"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let height = |i: usize| (2 * i + 1) as f64 * self.radius;
        let spheres = (0..self.count).map(|i| at([0.0, 0.0, height(i)])).collect();
        let scene = Scene {
            tank: Some(floor()),
            dem: DemScene {
                contact: Some(self.material.contact()),
                effects: Effects {
                    gravity: Some(downward(self.gravity)),
                    ..Effects::default()
                },
                ..unguarded()
            },
            ..bench.scene(self.material.density, self.radius, spheres, self.dt)
        };
        let mut simulation = DemSimulation::new(&scene)?;
        bench.advance_for(&mut simulation, self.duration, self.dt)?;
        let particles = simulation.particles();
        let z = |i: usize| particles.position[i].z;
        // From the top contact down.
        let mut overlaps: Vec<f64> = (1..self.count)
            .rev()
            .map(|i| 2.0 * self.radius - (z(i) - z(i - 1)))
            .collect();
        overlaps.push(self.radius - z(0));
        let weight = self.count as f64 * self.material.mass(self.radius) * self.gravity;
        let floor = bench.force_of_walls(&scene, particles)?.z;
        let mut measured = numbered("overlap", overlaps);
        measured.append(&mut named([("floor_force_over_weight", floor / weight)]));
        Ok(measured)
    }
}
