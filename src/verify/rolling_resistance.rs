//! A sphere rolls against rolling resistance, on the level or on an incline.

use super::bench::{Bench, floor, moving, unguarded};
use super::material::AnyMaterial;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::scene::{DemScene, Effects, Friction, Gravity, Rolling, Scene, StartSphere};
use serde::Deserialize;
use std::f64::consts::PI;

/// A sphere rolls without sliding, or is released, on the floor with tilted gravity.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RollingResistance {
    /// Angle of the incline (degrees).
    #[serde(default)]
    angle: f64,
    /// Radius (m).
    radius: f64,
    material: AnyMaterial,
    friction: Friction,
    rolling: Rolling,
    /// Gravity (m/s2).
    gravity: f64,
    /// Speed down the incline at the start (m/s), at which it rolls.
    #[serde(default)]
    speed: f64,
    /// Time step (s).
    dt: f64,
    /// Duration (s); the acceleration is the mean over its second half.
    duration: f64,
}

impl CaseFamily for RollingResistance {
    fn name(&self) -> &'static str {
        "rolling-resistance"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let mut simulation = DemSimulation::new(&self.scene(bench))?;
        let place = |simulation: &DemSimulation| simulation.particles().position[0].x;
        let speed = |simulation: &DemSimulation| simulation.particles().velocity[0].x;
        let mut farthest = 0.0_f64;
        let mut middle = None;
        while simulation.time() < self.duration {
            bench.advance(&mut simulation, 1)?;
            farthest = farthest.max(place(&simulation));
            if middle.is_none() && simulation.time() >= 0.5 * self.duration {
                middle = Some((simulation.time(), place(&simulation), speed(&simulation)));
            }
        }
        let Some((time, there, then)) = middle else {
            return Err(VerifyError::Unfinished {
                awaited: "the middle of the duration",
                steps: simulation.step(),
            });
        };
        let left = simulation.time() - time;
        Ok(named([
            ("farthest", farthest),
            ("distance", place(&simulation)),
            ("creep", place(&simulation) - there),
            ("acceleration", (speed(&simulation) - then) / left),
        ]))
    }
}

impl RollingResistance {
    fn scene(&self, bench: &Bench<'_>) -> Scene {
        let tilt = self.angle * PI / 180.0;
        let weight = self.material.mass(self.radius) * self.gravity * libm::cos(tilt);
        let height = self.radius - self.material.overlap(self.radius, weight);
        let sphere = StartSphere {
            spin: [0.0, self.speed / self.radius, 0.0],
            ..moving([0.0, 0.0, height], [self.speed, 0.0, 0.0])
        };
        Scene {
            tank: Some(floor()),
            dem: DemScene {
                contact: Some(self.material.contact()),
                friction: Some(self.friction.clone()),
                rolling: Some(self.rolling.clone()),
                effects: Effects {
                    gravity: Some(Gravity {
                        acceleration: self.gravity,
                        tilt,
                    }),
                    ..Effects::default()
                },
                ..unguarded()
            },
            ..bench.scene(self.material.density(), self.radius, vec![sphere], self.dt)
        }
    }
}
