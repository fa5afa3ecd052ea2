//! Viscous damping of spins: torque = -c w.

use super::{Effect, EffectKeys, Effects, OneBody, SceneFacts, Targets};
use crate::document::{Problem, quantity};
use crate::forces::limit::{Limit, Regime};
use crate::particles::block::BLOCK;
use crate::particles::bodies::{Asked, Bodies};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Viscous damping of spins.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpinDamping {
    /// Torque per spin, c (kg m2/s).
    #[schemars(transform = quantity("c_ω", "kg m²/s", "coefficient of spin damping").at_least(0.0))]
    pub coefficient: f64,
}

impl EffectKeys for SpinDamping {
    fn effect(&self, _: &Effects, _: &Targets<'_>) -> Option<Box<dyn Effect>> {
        Some(Box::new(DampingTorque {
            coefficient: self.coefficient,
        }))
    }

    fn limit(&self, _: &Effects, regime: &Regime<'_>) -> Option<Limit> {
        let rate = self.coefficient / regime.smallest_inertia();
        Some(Limit {
            name: "spin damping",
            seconds: regime.scheme.oscillator(0.0, rate),
            decisive: true,
            explanation: "2 I / (q c) of the smallest sphere; q = 2 for synchronised-verlet, else \
                          1",
            consequence: Limit::PASSES_ITS_END,
        })
    }

    fn problems(&self, _: &Effects, scene: &SceneFacts) -> Vec<Problem> {
        if scene.rotates {
            return Vec::new();
        }
        let message = "[spin_damping] acts on spins, but without [friction] there are none";
        let help = "add [friction], or remove [spin_damping]";
        vec![Problem::new("spin_damping", message).help(help)]
    }
}

struct DampingTorque {
    coefficient: f64,
}

impl OneBody for DampingTorque {
    const ASKS: Asked = Asked {
        motion: false,
        turn: true,
    };

    #[inline(always)]
    fn add(&self, bodies: &mut Bodies) {
        for (torque, spin) in bodies.torque.0.iter_mut().zip(&bodies.spin.0) {
            for k in 0..BLOCK {
                torque[k] -= spin[k] * self.coefficient;
            }
        }
    }
}
