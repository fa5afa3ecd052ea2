//! Drag toward air in rigid rotation about the axis.

use super::drag::{
    Coefficients, DragKernel, Form, Linear, QuadraticComponents, QuadraticVector, missing_drag,
};
use super::schiller_naumann::SchillerNaumann;
use super::{Effect, EffectKeys, Effects, OneBody, SceneFacts, Targets};
use crate::document::{Problem, quantity};
use crate::forces::simplification::{MeanSphere, Simplification};
use crate::particles::block::BLOCK;
use crate::particles::bodies::{Asked, Bodies};
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::marker::PhantomData;

/// Air in rigid rotation about the axis (Rice, 2012, eqs. 21 to 27).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Swirl {
    /// Angular velocity Omega of the air (rad/s), counter-clockwise seen from above.
    #[schemars(transform = quantity("Ω", "rad/s", "angular velocity of the air"))]
    pub omega: f64,
}

impl EffectKeys for Swirl {
    fn effect(&self, all: &Effects, targets: &Targets<'_>) -> Option<Box<dyn Effect>> {
        fn boxed<K: DragKernel>(omega: f64, coefficients: Coefficients) -> Box<dyn Effect> {
            Box::new(SwirlForce::<K> {
                omega,
                coefficients,
                kernel: PhantomData,
            })
        }
        let drag = all.drag.as_ref()?;
        let coefficients = Coefficients::new(drag, targets.radii);
        Some(match drag.kernel() {
            Form::Linear => boxed::<Linear>(self.omega, coefficients),
            Form::Vector => boxed::<QuadraticVector>(self.omega, coefficients),
            Form::Components => boxed::<QuadraticComponents>(self.omega, coefficients),
            Form::SchillerNaumann => boxed::<SchillerNaumann>(self.omega, coefficients),
        })
    }

    /// Without the swirl, an updraught with a `reference_omega` keeps its strength.
    fn simplifications(
        &self,
        off: Simplification,
        all: &Effects,
        _: &MeanSphere,
    ) -> Vec<Simplification> {
        let updraught = all.updraught.as_ref();
        let Some(updraught) = updraught.filter(|it| it.reference_omega.is_some()) else {
            return vec![off];
        };
        let strength = json!(updraught.strength_in(Some(self)));
        let still = Simplification::setting(off.name, [("updraught.strength", strength)]);
        vec![still.removing(["swirl", "updraught.reference_omega"])]
    }

    fn problems(&self, all: &Effects, _: &SceneFacts) -> Vec<Problem> {
        missing_drag(all, "swirl")
    }

    fn keeps_numbers_per_sphere(&self) -> bool {
        true
    }

    fn fastest(&self, reach: f64) -> f64 {
        self.omega.abs() * reach
    }
}

/// Rice (2012), eqs. 21 to 27: drag toward the air's velocity Omega x r, on all three
/// components, the air's own vertical speed being zero in this term.
struct SwirlForce<K> {
    omega: f64,
    coefficients: Coefficients,
    kernel: PhantomData<K>,
}

impl<K: DragKernel> OneBody for SwirlForce<K> {
    const ASKS: Asked = Asked {
        motion: true,
        turn: false,
    };

    fn reorder(&mut self, order: &[u32]) {
        self.coefficients.reorder(order);
    }

    #[inline(always)]
    fn add(&self, bodies: &mut Bodies) {
        let [c1, c2] = self.coefficients.of_block(bodies);
        let [x, y, _] = &bodies.position.0;
        let [fx, fy, fz] = &mut bodies.force.0;
        for k in 0..BLOCK {
            let air = Vector::new(-self.omega * y[k], self.omega * x[k], 0.0);
            let force = K::vector(c1[k], c2[k], air - bodies.velocity.vector(k));
            fx[k] += force.x;
            fy[k] += force.y;
            fz[k] += force.z;
        }
    }
}
