//! A shaken box: all walls move together, and spheres feel the acceleration of its frame.

use super::{Effect, EffectKeys, Effects, Gravity, OneBody, SceneFacts, Targets};
use crate::document::quantities::length;
use crate::document::{Problem, quantity, unit};
use crate::forces::limit::{LARGEST_SWING, Limit, Regime};
use crate::forces::simplification::{MeanSphere, Simplification};
use crate::particles::block::BLOCK;
use crate::particles::bodies::{Asked, Bodies};
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::f64::consts::TAU;

/// A box that is shaken as a whole: its position is A sin(w t + p) along a direction. Positions and
/// velocities are those in the frame of the box, in which its walls are at rest and each sphere has
/// the additional acceleration A w^2 sin(w t + p). Fluid and air are shaken with the box. Give
/// either `frequency` or `gamma`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shaking {
    /// Amplitude A (m).
    #[schemars(transform = length("A_s", "amplitude of the shaking"))]
    pub amplitude: f64,
    /// Frequency w / (2 pi) (Hz).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("f_s", "Hz", "frequency of the shaking").at_least(1e-9).at_most(1e9)
    )]
    pub frequency: Option<f64>,
    /// Largest acceleration A w^2 of the box over gravity, in place of `frequency`; needs
    /// `gravity`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("Γ", "", "acceleration of the shaking over gravity")
            .at_least(1e-9)
            .at_most(1e9)
    )]
    pub gamma: Option<f64>,
    /// Direction (default upward); its length does not matter.
    #[serde(default = "upward")]
    #[schemars(transform = unit("").at_least(-1e9).at_most(1e9))]
    pub direction: [f64; 3],
    /// Phase p at the start (rad, default 0).
    #[serde(default)]
    #[schemars(transform = quantity("p_s", "rad", "phase of the shaking at the start"))]
    pub phase: f64,
    /// Frames in a period, from the phase of the start on, in place of `time.frame_interval`. With
    /// 1, all frames have this phase. Absent in the scene of a run, which has the interval.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("").at_least(1))]
    pub frames_per_period: Option<u64>,
    /// Duration in periods, in place of `time.duration`; needs `frames_per_period`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = unit("").at_least(1))]
    pub periods: Option<u64>,
}

fn upward() -> [f64; 3] {
    [0.0, 0.0, 1.0]
}

impl Shaking {
    /// Angular frequency w (rad/s) beside this gravity; 0 if no key gives it.
    pub fn angular_frequency(&self, gravity: Option<&Gravity>) -> f64 {
        match (self.frequency, self.gamma, gravity) {
            (Some(frequency), _, _) => TAU * frequency,
            (None, Some(gamma), Some(gravity)) => {
                (gamma * gravity.acceleration / self.amplitude).sqrt()
            }
            _ => 0.0,
        }
    }

    /// Period (s) beside this gravity.
    pub fn period(&self, gravity: Option<&Gravity>) -> f64 {
        match self.frequency {
            Some(frequency) => 1.0 / frequency,
            None => TAU / self.angular_frequency(gravity),
        }
    }

    /// The interval of frames and the duration (s), each if it is given in periods.
    pub(crate) fn times(&self, gravity: Option<&Gravity>) -> Option<(f64, Option<f64>)> {
        let frames = self.frames_per_period? as f64;
        let interval = self.period(gravity) / frames;
        let duration = self.periods.map(|it| interval * (it as f64 * frames));
        Some((interval, duration))
    }

    /// The most that the shaking changes the velocity of a free sphere in the frame of the box:
    /// 2 A w (m/s), from one end of the swing of the box's velocity to the other.
    pub(super) fn fastest_change(&self, gravity: Option<&Gravity>) -> f64 {
        2.0 * self.amplitude * self.angular_frequency(gravity)
    }
}

impl EffectKeys for Shaking {
    /// F = m A w^2 sin(w t + p). A fluid that is shaken with the box presses on the volume that a
    /// sphere displaces as gravity does. Added mass is inertia relative to the fluid, which is at
    /// rest in this frame (Maxey and Riley, Phys. Fluids 26, 883 (1983), eq. 48).
    fn effect(&self, all: &Effects, targets: &Targets<'_>) -> Option<Box<dyn Effect>> {
        let buoyancy = all.buoyancy.as_ref();
        let displaced = buoyancy.map_or(0.0, |it| it.ratio(targets.scene.density));
        let frequency = self.angular_frequency(all.gravity.as_ref());
        let direction = Vector::from(self.direction);
        let largest = self.amplitude * frequency * frequency * (1.0 - displaced);
        Some(Box::new(ShakingForce {
            largest: direction * (largest / direction.norm()),
            frequency,
            phase: self.phase,
            present: Vector::ZERO,
        }))
    }

    fn limit(&self, all: &Effects, _: &Regime<'_>) -> Option<Limit> {
        Some(Limit {
            name: "shaking period",
            seconds: LARGEST_SWING / self.angular_frequency(all.gravity.as_ref()),
            decisive: false,
            explanation: "0.5 / w, with the angular frequency w of [shaking]: 12.6 steps in a \
                          period",
            consequence: Some(
                "the shaking has one acceleration per step, so that spheres leave the floor too \
                 early or too late; with a step of one period or half a period it does nothing",
            ),
        })
    }

    /// Without the shaking, times in its periods stay as they are.
    fn simplifications(
        &self,
        mut off: Simplification,
        all: &Effects,
        _: &MeanSphere,
    ) -> Vec<Simplification> {
        if let Some((interval, duration)) = self.times(all.gravity.as_ref()) {
            off.set.push(("time.frame_interval", json!(interval)));
            off.set
                .extend(duration.map(|it| ("time.duration", json!(it))));
        }
        vec![off]
    }

    fn problems(&self, all: &Effects, _: &SceneFacts) -> Vec<Problem> {
        let mut problems = Vec::new();
        let mut refuse = |path: &str, message: &str, help: &str| {
            problems.push(Problem::new(path, message).help(help));
        };
        let falls = (all.gravity.as_ref()).is_some_and(|it| it.acceleration > 0.0);
        match (self.frequency, self.gamma) {
            (Some(_), Some(_)) => refuse(
                "shaking.gamma",
                "`shaking.frequency` and `shaking.gamma` both say how fast the shaking is",
                "remove one of them",
            ),
            (None, None) => refuse(
                "shaking",
                "[shaking] needs `frequency` or `gamma`",
                "add `frequency`, in Hz, or `gamma`, the largest acceleration over gravity",
            ),
            (None, Some(_)) if !falls => refuse(
                "shaking.gamma",
                "`shaking.gamma` is a multiple of gravity, but there is no gravity",
                "use `frequency` instead, or add [gravity] with `acceleration`",
            ),
            _ => {}
        }
        if self.direction == [0.0; 3] {
            let message = "`shaking.direction` has no length";
            refuse(
                "shaking.direction",
                message,
                "use `direction = [0, 0, 1]`, or another",
            );
        }
        if self.periods.is_some() && self.frames_per_period.is_none() {
            let message = "`shaking.periods` needs `frames_per_period`";
            let help = "add `frames_per_period`, or use `time.duration` instead";
            refuse("shaking.periods", message, help);
        }
        problems
    }
}

/// F = m a(t), with one acceleration for all spheres.
struct ShakingForce {
    /// The largest acceleration (m/s2).
    largest: Vector,
    /// Angular frequency (rad/s).
    frequency: f64,
    /// Phase at the start (rad).
    phase: f64,
    /// The acceleration of this step (m/s2).
    present: Vector,
}

impl OneBody for ShakingForce {
    const ASKS: Asked = Asked {
        motion: false,
        turn: false,
    };

    fn prepare(&mut self, time: f64, _: &[u32]) {
        self.present = self.largest * libm::sin(self.frequency * time + self.phase);
    }

    #[inline(always)]
    fn add(&self, bodies: &mut Bodies) {
        let Vector { x, y, z, .. } = self.present;
        for (force, acceleration) in bodies.force.0.iter_mut().zip([x, y, z]) {
            for k in 0..BLOCK {
                force[k] += bodies.mass[k] * acceleration;
            }
        }
    }

    fn acceleration(&self) -> Option<Vector> {
        Some(self.present)
    }
}
