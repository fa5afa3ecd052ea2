//! A sphere at rest on three others in a cylinder.

use super::bench::{Bench, at, downward, unguarded};
use super::material::Material;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::forces::contact::{HertzLaw, NormalLaw};
use crate::particles::vector::Vector;
use crate::scene::{DemScene, Effects, Scene, Tank};
use serde::Deserialize;
use std::f64::consts::PI;

/// Three equal spheres on the floor, held by a frictionless cylinder, and a fourth on top of them.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tripod {
    /// Radius (m).
    radius: f64,
    /// Distance of the lower centres from the axis, in radii; 2 / sqrt(3) where they touch.
    spread: f64,
    /// Its dissipation time brings the spheres to rest.
    material: Material,
    /// Gravity (m/s2).
    gravity: f64,
    /// Time step (s).
    dt: f64,
    /// Duration (s), long enough to come to rest.
    duration: f64,
}

impl CaseFamily for Tripod {
    fn name(&self) -> &'static str {
        "tripod"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let distance = self.spread * self.radius;
        let foot = |i: usize| {
            let angle = 2.0 * PI * i as f64 / 3.0;
            at([
                distance * libm::cos(angle),
                distance * libm::sin(angle),
                self.radius,
            ])
        };
        let rise = (4.0 * self.radius * self.radius - distance * distance).sqrt();
        let mut spheres: Vec<_> = (0..3).map(foot).collect();
        spheres.push(at([0.0, 0.0, self.radius + rise]));
        let scene = Scene {
            tank: Some(Tank {
                radius: Some(distance + self.radius),
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
            ..bench.scene(self.material.density, self.radius, spheres, self.dt)
        };
        let mut simulation = DemSimulation::new(&scene)?;
        bench.advance_for(&mut simulation, self.duration, self.dt)?;
        let particles = simulation.particles();
        let law = HertzLaw::new(
            self.material.young_modulus,
            self.material.poisson_ratio,
            0.0,
            1.0,
        );
        let weight = self.material.mass(self.radius) * self.gravity;
        let force = |foot: usize| {
            let offset = particles.position[3] - particles.position[foot];
            let overlap = 2.0 * self.radius - offset.norm();
            law.elastic_force(overlap, 0.5 * self.radius) / weight
        };
        let forces = [force(0), force(1), force(2)];
        let Vector { x, y, z, .. } = bench.force_of_walls(&scene, particles)?;
        Ok(named([
            (
                "contact_force_over_weight",
                forces.iter().sum::<f64>() / 3.0,
            ),
            (
                "contact_force_spread",
                forces.iter().copied().fold(f64::MIN, f64::max)
                    - forces.iter().copied().fold(f64::MAX, f64::min),
            ),
            ("floor_force_over_weight", z / (4.0 * weight)),
            ("side_force_over_weight", (x * x + y * y).sqrt() / weight),
        ]))
    }
}
