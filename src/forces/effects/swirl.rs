//! Drag toward air in rigid rotation about the axis, and the pressure of a rotating fluid.

use super::drag::{Coefficients, Form, missing_drag};
use super::drag_kernel::{DragKernel, LinearDrag, QuadraticComponents, QuadraticVector};
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

/// Air in rigid rotation about the axis (Rice, 2012, eqs. 21 to 27); with `buoyancy` or
/// `added_mass` a fluid, whose pressure rises outward.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Swirl {
    /// Angular velocity Omega of the air (rad/s), counter-clockwise seen from above.
    #[schemars(transform = quantity("Ω", "rad/s", "angular velocity of the air"))]
    pub omega: f64,
}

impl EffectKeys for Swirl {
    fn effect(&self, all: &Effects, targets: &Targets<'_>) -> Option<Box<dyn Effect>> {
        fn boxed<K: DragKernel>(
            [omega, pressure]: [f64; 2],
            coefficients: Coefficients,
        ) -> Box<dyn Effect> {
            Box::new(SwirlForce::<K> {
                omega,
                pressure,
                coefficients,
                kernel: PhantomData,
            })
        }
        let drag = all.drag.as_ref()?;
        let coefficients = Coefficients::new(drag, targets.radii);
        let pressure = all.pressed_mass_ratio(targets.scene.density) * self.omega * self.omega;
        let rates = [self.omega, pressure];
        Some(match drag.kernel() {
            Form::Linear => boxed::<LinearDrag>(rates, coefficients),
            Form::Vector => boxed::<QuadraticVector>(rates, coefficients),
            Form::Components => boxed::<QuadraticComponents>(rates, coefficients),
            Form::SchillerNaumann => boxed::<SchillerNaumann>(rates, coefficients),
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
///
/// The pressure of a rotating fluid accelerates the fluid toward the axis, and with it the
/// displaced volume and the added mass: -(rho_b + C rho_a) V Omega^2 (x, y) (Maxey and Riley, Phys.
/// Fluids 26, 883 (1983), eq. 48: the fluid's acceleration in buoyancy and added mass).
struct SwirlForce<K> {
    omega: f64,
    /// (rho_b + C rho_a) / rho Omega^2 (1/s2), 0 in air.
    pressure: f64,
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
        if self.pressure != 0.0 {
            for k in 0..BLOCK {
                let inward = self.pressure * bodies.mass[k];
                fx[k] -= inward * x[k];
                fy[k] -= inward * y[k];
            }
        }
    }
}
