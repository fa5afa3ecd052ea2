//! A sphere slides on the floor until it rolls.

use super::bench::{Bench, downward, floor, moving, unguarded};
use super::material::AnyMaterial;
use super::{CaseFamily, MeasuredValues, VerifyError, named};
use crate::dem::DemSimulation;
use crate::particles::Particles;
use crate::scene::{Coulomb, DemScene, Effects, Friction, Scene, StartSphere};
use serde::Deserialize;

/// A sphere slides along x on the floor, pressed by its weight, until it rolls.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RollingCase {
    /// Radius (m).
    radius: f64,
    material: AnyMaterial,
    friction: Friction,
    /// Gravity (m/s2).
    gravity: f64,
    /// Speed at the start (m/s).
    speed: f64,
    /// Spin at the start, positive if the sphere rolls forward (rad/s).
    #[serde(default)]
    spin: f64,
    /// Time step (s).
    dt: f64,
    /// Duration (s), past the beginning of rolling.
    duration: f64,
}

impl CaseFamily for RollingCase {
    fn name(&self) -> &'static str {
        "rolling"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let mut simulation = DemSimulation::new(&self.scene(bench))?;
        // Sliding ends when friction drops below its full size: below the speed of regularisation,
        // or when the sliding reverses.
        let rest = match self.friction {
            Friction::Coulomb(Coulomb { regularisation, .. }) => regularisation,
            _ => 0.0,
        };
        let sign = (self.speed - self.spin * self.radius).signum();
        let moment = |simulation: &DemSimulation| {
            let particles = simulation.particles();
            RollingMoment {
                time: simulation.time(),
                sliding: sign * self.sliding_speed(particles),
                distance: particles.position[0].x,
            }
        };
        let (mut last, mut now) = (moment(&simulation), moment(&simulation));
        let mut rolls = None;
        while simulation.time() < self.duration {
            bench.advance(&mut simulation, 1)?;
            let next = moment(&simulation);
            if rolls.is_none() && next.sliding <= rest {
                rolls = Some(last.straight_on(now));
            }
            (last, now) = (now, next);
        }
        let Some(rolls) = rolls else {
            return Err(VerifyError::Unfinished {
                awaited: "the sphere rolls",
                steps: simulation.step(),
            });
        };
        // The spring of Mindlin's law still oscillates: the mean speed from then on counts.
        let speed = (now.distance - rolls.distance) / (now.time - rolls.time);
        Ok(named([
            ("rolling_time", rolls.time),
            ("rolling_distance", rolls.distance),
            ("final_speed", speed),
        ]))
    }
}

#[derive(Clone, Copy)]
struct RollingMoment {
    time: f64,
    sliding: f64,
    distance: f64,
}

impl RollingMoment {
    /// The moment without sliding, by linear interpolation between this moment and the next.
    fn straight_on(self, next: Self) -> Self {
        let ahead = next.sliding / (self.sliding - next.sliding);
        Self {
            time: next.time + ahead * (next.time - self.time),
            sliding: 0.0,
            distance: next.distance + ahead * (next.distance - self.distance),
        }
    }
}

impl RollingCase {
    fn scene(&self, bench: &Bench<'_>) -> Scene {
        let weight = self.material.mass(self.radius) * self.gravity;
        let height = self.radius - self.material.overlap(self.radius, weight);
        let sphere = StartSphere {
            spin: [0.0, self.spin, 0.0],
            ..moving([0.0, 0.0, height], [self.speed, 0.0, 0.0])
        };
        Scene {
            tank: Some(floor()),
            dem: DemScene {
                contact: Some(self.material.contact()),
                friction: Some(self.friction.clone()),
                effects: Effects {
                    gravity: Some(downward(self.gravity)),
                    ..Effects::default()
                },
                ..unguarded()
            },
            ..bench.scene(self.material.density(), self.radius, vec![sphere], self.dt)
        }
    }

    /// Velocity of the lowest point of the sphere.
    fn sliding_speed(&self, particles: &Particles) -> f64 {
        particles.velocity[0].x - particles.spin[0].y * self.radius
    }
}
