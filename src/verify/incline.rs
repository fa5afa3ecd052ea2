//! A sphere rolls or slides down an incline.

use super::bench::{Bench, at, floor, unguarded};
use super::material::AnyMaterial;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::scene::{DemScene, Effects, Friction, Gravity, Scene};
use serde::Deserialize;
use std::f64::consts::PI;

/// A sphere released on an incline: the floor, with tilted gravity.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Incline {
    /// Angle of the incline (degrees).
    angle: f64,
    /// Radius (m).
    radius: f64,
    material: AnyMaterial,
    friction: Friction,
    /// Gravity (m/s2).
    gravity: f64,
    /// Time step (s).
    dt: f64,
    /// Duration (s); accelerations are means over its second half.
    duration: f64,
}

impl CaseFamily for Incline {
    fn name(&self) -> &'static str {
        "incline"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let tilt = self.angle * PI / 180.0;
        let weight = self.material.mass(self.radius) * self.gravity * libm::cos(tilt);
        let rest = self.material.overlap(self.radius, weight);
        let scene = Scene {
            tank: Some(floor()),
            dem: DemScene {
                contact: Some(self.material.contact()),
                friction: Some(self.friction.clone()),
                effects: Effects {
                    gravity: Some(Gravity {
                        acceleration: self.gravity,
                        tilt,
                    }),
                    ..Effects::default()
                },
                ..unguarded()
            },
            ..bench.scene(
                self.material.density(),
                self.radius,
                vec![at([0.0, 0.0, self.radius - rest])],
                self.dt,
            )
        };
        let mut simulation = DemSimulation::new(&scene)?;
        let half = 0.5 * self.duration;
        bench.advance_for(&mut simulation, half, self.dt)?;
        let middle = self.surface_speeds(&simulation);
        bench.advance_for(&mut simulation, half, self.dt)?;
        let end = self.surface_speeds(&simulation);
        Ok(named([
            ("acceleration", (end[0] - middle[0]) / half),
            // Speed of the surface about the centre: equal if it rolls without slipping.
            ("surface_acceleration", (end[1] - middle[1]) / half),
        ]))
    }
}

impl Incline {
    /// Speed of the centre down the incline, and of the surface about it.
    fn surface_speeds(&self, simulation: &DemSimulation) -> [f64; 2] {
        let particles = simulation.particles();
        [particles.velocity[0].x, particles.spin[0].y * self.radius]
    }
}
