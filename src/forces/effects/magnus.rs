//! Lift of spinning spheres.

use super::{Effect, EffectKeys, Effects, OneBody, SceneFacts, Targets};
use crate::document::quantities::fluid_density;
use crate::document::{Problem, quantity};
use crate::forces::limit::{Limit, Regime};
use crate::forces::one;
use crate::particles::block::BLOCK;
use crate::particles::bodies::{Asked, Bodies};
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Lift of a spinning sphere that moves through a fluid (Rubinow and Keller, 1961): F = C pi r^3
/// rho (w x u), with spin w and velocity u relative to the air, which is at rest except in `swirl`.
///
/// C is 1 at small Reynolds numbers. At larger ones the same form is used with a smaller C:
/// according to the measurements of Oesterlé and Bui Dinh (1998) about 1/3 at Re = 100 for r |w| =
/// |u|.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Magnus {
    /// Coefficient C (default 1, for small Reynolds numbers; smaller at larger ones).
    #[serde(default = "one")]
    #[schemars(
        transform = quantity("C_w", "", "coefficient of the Magnus lift").at_least(0.0).at_most(1e3)
    )]
    pub coefficient: f64,
    /// Density rho of the fluid (kg/m3).
    #[schemars(transform = fluid_density())]
    pub density: f64,
}

impl Magnus {
    /// C pi r^3 rho over the mass of spheres of a density (kg/m3): 3/4 C rho / rho_sphere.
    fn ratio(&self, density: f64) -> f64 {
        0.75 * self.coefficient * self.density / density
    }
}

/// Largest angle t (rad) by which the lift should turn a velocity in a step. Symplectic Euler and
/// velocity Verlet then keep the speed, and turn by t^2 / 12 of the angle too little. In the other
/// schemes the speed grows by t^3 / 4 per radian, 2e-6 at this angle.
const LARGEST_TURN: f64 = 0.02;

impl EffectKeys for Magnus {
    fn effect(&self, all: &Effects, targets: &Targets<'_>) -> Option<Box<dyn Effect>> {
        let density = targets.scene.density;
        Some(Box::new(Lift {
            ratio: self.ratio(density),
            inertial_factor: 1.0 + all.added_mass_ratio(density),
            lag: targets.lag,
            rotation: all.swirl.as_ref().map_or(0.0, |swirl| swirl.omega),
        }))
    }

    fn limit(&self, all: &Effects, regime: &Regime<'_>) -> Option<Limit> {
        let rotation = all.swirl.as_ref().map_or(0.0, |swirl| swirl.omega.abs());
        let spin = regime.fastest_spin + rotation;
        let rate = self.ratio(regime.density) * spin / regime.inertial_factor;
        Some(Limit {
            name: "Magnus lift",
            seconds: LARGEST_TURN / rate,
            decisive: false,
            explanation: "0.02 / W, W = C pi r^3 rho w / m at the fastest spin w: at the start, or \
                          of the smallest sphere that rolls at the speed of the fastest impact; \
                          and of the air",
            consequence: Some(
                "the lift turns velocities by wrong angles, and in schemes that predict velocities \
                    it accelerates spinning spheres",
            ),
        })
    }

    fn problems(&self, _: &Effects, scene: &SceneFacts) -> Vec<Problem> {
        if scene.rotates {
            return Vec::new();
        }
        let message = "[magnus] acts on spinning spheres, but without [friction] there are no \
            spins";
        let help = "add [friction], or remove [magnus]";
        vec![Problem::new("magnus", message).help(help)]
    }
}

/// Rubinow and Keller, J. Fluid Mech. 11, 447 (1961): F = pi r^3 rho w x u (1 + O(Re)), without the
/// viscous torque, which is [`SpinDamping`](super::SpinDamping)'s. Lift at larger Re: Oesterlé and
/// Bui Dinh, Exp. Fluids 25, 16 (1998), C = C_L / 2 where r |w| = |u|. Air in rigid rotation has at
/// each place the velocity Omega x r and the spin Omega.
///
/// The lift does no work. If velocities lag behind the forces, it uses the mean velocity of before
/// and after the kick, so that it still does no work (Boris, Proc. 4th Conf. Num. Sim. Plasmas, 3
/// (1970)). It comes after all other forces on centres, which it needs for this mean.
struct Lift {
    /// C pi r^3 rho / m.
    ratio: f64,
    /// Inertial mass over mass.
    inertial_factor: f64,
    /// How far velocities lag behind the forces (s): half a kick, or zero.
    lag: f64,
    /// Omega (rad/s).
    rotation: f64,
}

impl Lift {
    /// The velocity u (m/s) after the time h of the lag: u = `velocity` + h (`force` / m + W x u),
    /// with W for a spin of `spin` (rad/s), the forces so far (N) and the inertial mass m (kg).
    #[inline(always)]
    fn mean_velocity(&self, velocity: Vector, spin: Vector, force: Vector, mass: f64) -> Vector {
        let pushed = velocity + force * (self.lag / mass);
        let turn = spin * (self.lag * self.ratio / self.inertial_factor);
        let turned = pushed + turn.cross(pushed) + turn * turn.dot(pushed);
        turned * (1.0 / (1.0 + turn.norm_squared()))
    }
}

impl OneBody for Lift {
    const ASKS: Asked = Asked {
        motion: true,
        turn: true,
    };

    #[inline(always)]
    fn add(&self, bodies: &mut Bodies) {
        let [x, y, _] = &bodies.position.0;
        let [fx, fy, fz] = &mut bodies.force.0;
        for k in 0..BLOCK {
            let air = Vector::new(-self.rotation * y[k], self.rotation * x[k], 0.0);
            let air_spin = Vector::new(0.0, 0.0, self.rotation);
            let (velocity, spin) = (bodies.velocity.vector(k), bodies.spin.vector(k));
            let (spin, mut velocity) = (spin - air_spin, velocity - air);
            if self.lag > 0.0 {
                let (force, mass) = (Vector::new(fx[k], fy[k], fz[k]), bodies.mass[k]);
                let mass = mass * self.inertial_factor;
                velocity = self.mean_velocity(velocity, spin, force, mass);
            }
            let force = spin.cross(velocity) * (self.ratio * bodies.mass[k]);
            fx[k] += force.x;
            fy[k] += force.y;
            fz[k] += force.z;
        }
    }
}
