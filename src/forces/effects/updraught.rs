//! Rising air with the rectangular counting shield.

use super::drag::{Coefficients, Form, missing_drag};
use super::drag_kernel::{DragKernel, LinearDrag, QuadraticComponents};
use super::schiller_naumann::SchillerNaumann;
use super::{Effect, EffectKeys, Effects, OneBody, SceneFacts, Swirl, Targets};
use crate::document::quantities::{fraction, place};
use crate::document::{Problem, quantity};
use crate::forces::one;
use crate::forces::simplification::{MeanSphere, Simplification};
use crate::particles::block::BLOCK;
use crate::particles::bodies::{Asked, Bodies};
use crate::particles::math::exp;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::marker::PhantomData;

/// Rising air with the rectangular counting shield (Rice, 2012, eq. 24).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Updraught {
    /// Speed v_z of the rising air (m/s).
    #[schemars(transform = quantity("v_z", "m/s", "speed of the rising air"))]
    pub speed: f64,
    /// Factor s on the force.
    #[serde(default = "one")]
    #[schemars(transform = quantity("s", "", "strength of the updraught").at_least(0.0))]
    pub strength: f64,
    /// Decay beta of the force with height (1/m).
    #[schemars(
        transform = quantity("β", "1/m", "decay of the updraught with height").at_least(0.0)
    )]
    pub decay: f64,
    /// Height z0 at which the decay is 1 (m).
    #[schemars(transform = place("z_0", "height where the decay begins"))]
    pub origin: f64,
    /// Factor alpha per shielding sphere below, 0 to 1.
    #[schemars(transform = fraction("α", "factor per shielding sphere"))]
    pub alpha: f64,
    /// Rotation Omega_0 (rad/s) of the swirl for which the force is given; at another Omega it is
    /// multiplied by (Omega / Omega_0)^2 (Rice, 2012, eq. 44). Absent: independent of the swirl.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("Ω_0", "rad/s", "rotation at which the updraught is as given")
            .above(0.0)
    )]
    pub reference_omega: Option<f64>,
}

impl Updraught {
    /// The factor on the force at the height z0, without shield: s, or s (Omega / Omega_0)^2.
    pub fn strength_in(&self, swirl: Option<&Swirl>) -> f64 {
        let rotation = match (self.reference_omega, swirl) {
            (Some(reference), Some(swirl)) => swirl.omega / reference,
            _ => 1.0,
        };
        self.strength * rotation * rotation
    }
}

impl EffectKeys for Updraught {
    fn effect(&self, all: &Effects, targets: &Targets<'_>) -> Option<Box<dyn Effect>> {
        fn boxed<K: DragKernel>(
            parameters: Updraught,
            coefficients: Coefficients,
        ) -> Box<dyn Effect> {
            Box::new(UpdraughtForce::<K> {
                parameters,
                coefficients,
                powers: vec![1.0],
                shield: Vec::new(),
                kernel: PhantomData,
            })
        }
        let drag = all.drag.as_ref()?;
        let coefficients = Coefficients::new(drag, targets.radii);
        let parameters = Self {
            strength: self.strength_in(all.swirl.as_ref()),
            ..self.clone()
        };
        Some(match drag.kernel() {
            Form::Linear => boxed::<LinearDrag>(parameters, coefficients),
            // Along one axis the two quadratic forms are the same.
            Form::Vector | Form::Components => {
                boxed::<QuadraticComponents>(parameters, coefficients)
            }
            Form::SchillerNaumann => boxed::<SchillerNaumann>(parameters, coefficients),
        })
    }

    fn simplifications(
        &self,
        off: Simplification,
        _: &Effects,
        _: &MeanSphere,
    ) -> Vec<Simplification> {
        let all_alike = [("updraught.alpha", json!(1.0))];
        let shield = Simplification::setting("counting shield to none", all_alike);
        let shield = (self.alpha != 1.0).then_some(shield);
        shield.into_iter().chain([off]).collect()
    }

    fn problems(&self, all: &Effects, _: &SceneFacts) -> Vec<Problem> {
        let mut problems = missing_drag(all, "updraught");
        if self.reference_omega.is_some() && all.swirl.is_none() {
            let message = "`updraught.reference_omega` refers to [swirl], but there is none";
            let help = "add [swirl], or remove `reference_omega`";
            problems.push(Problem::new("updraught.reference_omega", message).help(help));
        }
        problems
    }

    fn keeps_numbers_per_sphere(&self) -> bool {
        true
    }

    fn fastest(&self, _: f64) -> f64 {
        self.speed.abs()
    }
}

/// Rice (2012), eq. 24: F_z = s exp(-beta (z - z0)) alpha^n drag(v_air - v_z), with n the number
/// of lower spheres whose centre lies within 2r in |dx| and in |dy|. With a reference rotation
/// Omega_0, s (Omega / Omega_0)^2 replaces s (eq. 44).
struct UpdraughtForce<K> {
    parameters: Updraught,
    coefficients: Coefficients,
    /// alpha^n for n = 0, 1, 2, ... up to the largest n so far.
    powers: Vec<f64>,
    /// alpha^n of every sphere, padded to whole blocks.
    shield: Vec<f64>,
    kernel: PhantomData<K>,
}

impl<K: DragKernel> OneBody for UpdraughtForce<K> {
    const ASKS: Asked = Asked {
        motion: true,
        turn: false,
    };

    fn reorder(&mut self, order: &[u32]) {
        self.coefficients.reorder(order);
    }

    fn prepare(&mut self, _: f64, shielding: &[u32]) {
        let most = shielding.iter().copied().max().unwrap_or(0) as usize;
        while self.powers.len() <= most {
            self.powers
                .push(self.powers[self.powers.len() - 1] * self.parameters.alpha);
        }
        self.shield.clear();
        let powers = shielding
            .iter()
            .map(|&spheres| self.powers[spheres as usize]);
        self.shield.extend(powers);
        let blocks = shielding.len().div_ceil(BLOCK);
        self.shield.resize(blocks * BLOCK, 1.0);
    }

    #[inline(always)]
    fn add(&self, bodies: &mut Bodies) {
        let Updraught {
            speed,
            strength,
            decay,
            origin,
            ..
        } = self.parameters;
        let shield = &self.shield[bodies.first..bodies.first + BLOCK];
        let [c1, c2] = self.coefficients.of_block(bodies);
        let (height, velocity) = (&bodies.position.0[2], &bodies.velocity.0[2]);
        let force = &mut bodies.force.0[2];
        for k in 0..BLOCK {
            let factor = strength * exp(-decay * (height[k] - origin));
            force[k] += factor * shield[k] * K::along(c1[k], c2[k], speed - velocity[k]);
        }
    }
}
