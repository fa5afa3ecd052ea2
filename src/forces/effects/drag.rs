//! The drag law that swirl and updraught share: force from the difference of two velocities.

use super::schiller_naumann::{FAST, SchillerNaumann};
use super::{Effect, EffectKeys, Effects, SceneFacts, Targets};
use crate::document::quantities::fluid_density;
use crate::document::{Problem, quantity};
use crate::forces::limit::{Limit, Regime};
use crate::forces::simplification::{MeanSphere, Simplification};
use crate::particles::block::BLOCK;
use crate::particles::bodies::Bodies;
use crate::particles::reorder::reorder;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;
use std::f64::consts::PI;

/// Drag law and the form of its quadratic part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// Linear coefficient; `law` determines its unit.
    #[serde(default)]
    #[schemars(
        transform = quantity("M_1", "kg/(m² s)", "linear drag coefficient")
            .at_least(0.0)
            .unit_where("law", "diameter", "kg/(m s)")
            .unit_where("law", "constant", "kg/s")
    )]
    pub linear: f64,
    /// Quadratic coefficient; `law` determines its unit.
    #[serde(default)]
    #[schemars(
        transform = quantity("M_2", "kg/m³", "quadratic drag coefficient")
            .at_least(0.0)
            .unit_where("law", "constant", "kg/m")
    )]
    pub quadratic: f64,
    /// Viscosity mu of the fluid (Pa s), which the law `schiller-naumann` needs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(
        transform = quantity("μ_{fluid}", "Pa s", "viscosity of the fluid")
            .at_least(1e-12)
            .at_most(1e12)
    )]
    pub viscosity: Option<f64>,
    /// Density rho of the fluid (kg/m3), which the law `schiller-naumann` needs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(transform = fluid_density())]
    pub density: Option<f64>,
    /// How the coefficients scale with the sphere.
    pub law: DragLaw,
    /// Whether the quadratic part is a vector law or acts component by component.
    #[serde(default)]
    pub form: DragForm,
}

/// How drag scales with the sphere of radius r: F = c1 dv + c2 |dv| dv.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DragLaw {
    /// By cross-section (Rice, 2012, eqs. 22 and 23): c1 = linear pi r^2 with `linear` in
    /// kg/(m2 s), c2 = quadratic pi r^2 with `quadratic` in kg/m3.
    CrossSection,
    /// By diameter D = 2r (Rice, 2012, eqs. 26 and 27): c1 = linear D with `linear` in kg/(m s),
    /// c2 = quadratic D^2 with `quadratic` in kg/m3.
    Diameter,
    /// The same force on every sphere: c1 = linear in kg/s, c2 = quadratic in kg/m.
    Constant,
    /// From creeping to fast flow, by `viscosity` mu and `density` rho of the fluid (Schiller and
    /// Naumann, 1933): F = pi/8 C_d rho D^2 |dv| dv with C_d = max(24/Re (1 + 0.15 Re^0.687), 0.44)
    /// and Re = rho D |dv| / mu.
    SchillerNaumann,
}

/// Form of the quadratic drag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DragForm {
    /// |dv| dv: isotropic (physically correct).
    #[default]
    Vector,
    /// dv_x |dv_x| and so on: each component separately, as in the thesis.
    Component,
}

impl Drag {
    /// Coefficients of a sphere of this radius (m) for the kernel: c1 (kg/s) and c2 (kg/m), or the
    /// coefficients of [`SchillerNaumann`].
    fn coefficients(&self, radius: f64) -> (f64, f64) {
        let diameter = 2.0 * radius;
        match self.law {
            DragLaw::CrossSection => {
                let area = std::f64::consts::PI * radius * radius;
                (self.linear * area, self.quadratic * area)
            }
            DragLaw::Diameter => (self.linear * diameter, self.quadratic * diameter * diameter),
            DragLaw::Constant => (self.linear, self.quadratic),
            DragLaw::SchillerNaumann => {
                // Scenes without them are refused.
                let (viscosity, density) = self.viscosity.zip(self.density).unwrap_or((1.0, 0.0));
                SchillerNaumann::coefficients(viscosity, density, radius)
            }
        }
    }

    /// Force over speed (kg/s) on a sphere of this radius (m), in air that passes it at a speed
    /// (m/s) along one axis.
    pub fn coefficient(&self, radius: f64, speed: f64) -> f64 {
        let (c1, c2) = self.coefficients(radius);
        match self.law {
            DragLaw::SchillerNaumann => SchillerNaumann::coefficient(c1, c2, speed.abs()),
            _ => c1 + c2 * speed.abs(),
        }
    }

    /// dF/du (kg/s) at a speed u (m/s), where it is larger than at any lower speed.
    fn slope(&self, radius: f64, speed: f64) -> f64 {
        let (c1, c2) = self.coefficients(radius);
        match self.law {
            DragLaw::SchillerNaumann => SchillerNaumann::slope(c1, c2, speed),
            _ => c1 + 2.0 * c2 * speed,
        }
    }

    /// The speed (m/s) through the air at which the force on a sphere of this radius (m), along one
    /// axis, reaches `force` (N); infinite if it never does.
    pub(super) fn speed_at(&self, radius: f64, force: f64) -> f64 {
        let (c1, c2) = self.coefficients(radius);
        match self.law {
            _ if force == 0.0 => 0.0,
            DragLaw::SchillerNaumann => SchillerNaumann::speed_at(c1, c2, force),
            // The root of c1 u + c2 u^2 = F, in the form without cancellation.
            _ => 2.0 * force / (c1 + (c1 * c1 + 4.0 * c2 * force).sqrt()),
        }
    }

    /// Which kernel the law needs.
    pub(super) fn kernel(&self) -> Form {
        match self.form {
            _ if self.law == DragLaw::SchillerNaumann => Form::SchillerNaumann,
            _ if self.quadratic == 0.0 => Form::Linear,
            DragForm::Vector => Form::Vector,
            DragForm::Component => Form::Components,
        }
    }
}

impl EffectKeys for Drag {
    fn effect(&self, _: &Effects, _: &Targets<'_>) -> Option<Box<dyn Effect>> {
        None
    }

    /// A sphere that slips through the air at speed u returns to its terminal speed at the rate
    /// dF/du / m, which is (c1 + 2 c2 u) / m where the force is c1 u + c2 u^2. Swirl and updraught
    /// both act on the vertical velocity.
    ///
    /// Both forces change with place, and so act as springs as well: the updraught, which decays
    /// with height, with w^2 = beta F / m; the drag of the swirl, whose air is faster farther out,
    /// with w^2 = g Omega and its share g of the rate; and the pressure of a rotating fluid.
    fn limit(&self, all: &Effects, regime: &Regime<'_>) -> Option<Limit> {
        let updraught = all.updraught.as_ref().map_or(0.0, |air| {
            let height = regime.lowest_height - air.origin;
            air.strength_in(all.swirl.as_ref()) * libm::exp(-air.decay * height)
        });
        let swirl = if all.swirl.is_some() { 1.0 } else { 0.0 };
        let (radius, mass) = (regime.smallest_radius, regime.smallest_mass);
        let speed = regime.fastest_impact;
        let slope = self.slope(radius, speed);
        let coefficient = slope * (swirl + updraught);
        let rotation = all.swirl.as_ref().map_or(0.0, |it| it.omega.abs());
        let pressed = all.pressed_mass_ratio(regime.density) / regime.inertial_factor;
        let decay = all.updraught.as_ref().map_or(0.0, |it| it.decay);
        let springs = [
            slope / mass * rotation,
            swirl * pressed * rotation * rotation,
            decay * updraught * self.coefficient(radius, speed) * speed / mass,
        ];
        let spring = springs.into_iter().fold(0.0, f64::max);
        Some(Limit {
            name: "drag",
            seconds: (regime.scheme).oscillator(spring.sqrt(), coefficient / mass),
            decisive: true,
            explanation: match self.law {
                DragLaw::SchillerNaumann => {
                    "(w dt)^2 + 2 q g dt < 4 of the smallest sphere, with g = dF/du / m times the \
                     factors of swirl and updraught at the lowest height, and the largest of w^2 = \
                     g Omega, beta F / m and the pressure of a rotating fluid; q = 2 for \
                     synchronised-verlet, else 1"
                }
                _ => {
                    "(w dt)^2 + 2 q g dt < 4 of the smallest sphere, with g = (c1 + 2 c2 u) / m \
                     times the factors of swirl and updraught at the lowest height, and the \
                     largest of w^2 = g Omega, beta F / m and the pressure of a rotating fluid; \
                     q = 2 for synchronised-verlet, else 1"
                }
            },
            consequence: Limit::PASSES_ITS_END,
        })
    }

    fn simplifications(
        &self,
        off: Simplification,
        all: &Effects,
        mean: &MeanSphere,
    ) -> Vec<Simplification> {
        let mut all = match self.law {
            DragLaw::SchillerNaumann => self.of_slow_and_fast_flow(),
            _ => self.linear_instead(all, mean).into_iter().collect(),
        };
        if let Form::Vector | Form::Components = self.kernel() {
            let (name, form) = match self.form {
                DragForm::Vector => ("vector drag to component", DragForm::Component),
                DragForm::Component => ("component drag to vector", DragForm::Vector),
            };
            all.push(Simplification::setting(name, [("drag.form", json!(form))]));
        }
        all.push(off);
        all
    }

    fn problems(&self, all: &Effects, _: &SceneFacts) -> Vec<Problem> {
        let mut problems = self.problems_of_law();
        if all.swirl.is_none() && all.updraught.is_none() {
            let message = "[drag] acts through [swirl] or [updraught], but there is neither";
            let help = "add [swirl], with `omega = 0.0` for still air, or remove [drag]";
            problems.push(Problem::new("drag", message).help(help));
        }
        problems
    }
}

impl Drag {
    /// A linear drag in place of a quadratic one, with the same terminal speed of the mean sphere.
    fn linear_instead(&self, all: &Effects, mean: &MeanSphere) -> Option<Simplification> {
        let gravity = all.gravity_in_fluid(mean.density)?;
        let weight = mean.mass * gravity.acceleration.abs();
        let terminal = self.speed_at(mean.radius, weight);
        let of_one = Self {
            linear: 1.0,
            ..self.clone()
        };
        let linear = weight / terminal / of_one.coefficients(mean.radius).0;
        let name = "quadratic drag to linear";
        let set = [
            ("drag.linear", json!(linear)),
            ("drag.quadratic", json!(0.0)),
        ];
        (self.quadratic != 0.0 && weight > 0.0).then(|| Simplification::setting(name, set))
    }

    /// The limits of Schiller and Naumann's law for slow and fast flow as simpler laws: linear
    /// (Stokes) and quadratic (Newton).
    fn of_slow_and_fast_flow(&self) -> Vec<Simplification> {
        let Some((viscosity, density)) = self.viscosity.zip(self.density) else {
            return Vec::new();
        };
        let simpler = |name: &str, law: DragLaw, key: &'static str, coefficient: f64| {
            let set = [("drag.law", json!(law)), (key, json!(coefficient))];
            Simplification::setting(name, set).removing(["drag.viscosity", "drag.density"])
        };
        let stokes = "Schiller-Naumann drag to linear (Stokes)";
        let newton = "Schiller-Naumann drag to quadratic (C_d = 0.44)";
        vec![
            simpler(
                stokes,
                DragLaw::Diameter,
                "drag.linear",
                3.0 * PI * viscosity,
            ),
            // pi/8 D^2 is half the cross-section.
            simpler(
                newton,
                DragLaw::CrossSection,
                "drag.quadratic",
                0.5 * FAST * density,
            ),
        ]
    }

    /// Missing keys of Schiller and Naumann's law, and keys that belong to other laws.
    fn problems_of_schiller_naumann(&self) -> Vec<Problem> {
        let missing = [
            (
                "drag.viscosity",
                self.viscosity,
                "air has 1.8e-5 Pa s, water 1e-3 Pa s",
            ),
            (
                "drag.density",
                self.density,
                "air has 1.2 kg/m3, water 1000 kg/m3",
            ),
        ];
        let missing = missing.iter().filter(|(_, value, _)| value.is_none());
        let missing = missing.map(|(path, _, known)| {
            let name = path.trim_start_matches("drag.");
            let message = format!("the law `schiller-naumann` needs the fluid's `{name}`");
            Problem::new("drag", message).help(format!("add `{name}` to [drag]: {known}"))
        });
        let strange = [
            ("drag.linear", self.linear),
            ("drag.quadratic", self.quadratic),
        ];
        let strange = strange.iter().filter(|(_, value)| *value != 0.0);
        let strange = strange.map(|(path, _)| {
            let message = format!("`{path}` does not go with `law = \"schiller-naumann\"`");
            let help = "remove it: the force follows from `viscosity` and `density`";
            Problem::new(*path, message).help(help).at_key()
        });
        missing.chain(strange).collect()
    }

    /// The problems of keys that do not go with the law.
    fn problems_of_law(&self) -> Vec<Problem> {
        if self.law == DragLaw::SchillerNaumann {
            let mut problems = self.problems_of_schiller_naumann();
            if self.form == DragForm::Component {
                let message =
                    "`form = \"component\"` does not go with `law = \"schiller-naumann\"`";
                let help = "remove `form`: C_d depends on the speed, not on its components";
                problems.push(Problem::new("drag.form", message).help(help));
            }
            return problems;
        }
        let of_fluid = [
            ("drag.viscosity", self.viscosity),
            ("drag.density", self.density),
        ];
        let strange = of_fluid.iter().filter(|(_, value)| value.is_some());
        let strange = strange.map(|(path, _)| {
            let message = format!("`{path}` goes with `law = \"schiller-naumann\"` only");
            let help = "remove it, or use that law without `linear` and `quadratic`";
            Problem::new(*path, message).help(help).at_key()
        });
        strange.collect()
    }
}

/// The problem of a table that needs the drag law, in a scene without one.
pub(super) fn missing_drag(all: &Effects, name: &str) -> Vec<Problem> {
    if all.drag.is_some() {
        return Vec::new();
    }
    let message = format!("[{name}] needs a drag law, but there is no [drag]");
    let help = "add [drag] with `law` and `linear` or `quadratic`";
    vec![Problem::new(name, message).help(help)]
}

/// Which kernel a drag law needs.
pub(super) enum Form {
    Linear,
    Vector,
    Components,
    SchillerNaumann,
}

/// Coefficients c1 and c2 of every sphere, padded to whole blocks.
pub(super) struct Coefficients {
    linear: Vec<f64>,
    quadratic: Vec<f64>,
}

impl Coefficients {
    pub(super) fn new(drag: &Drag, radii: &[f64]) -> Self {
        let (mut linear, mut quadratic): (Vec<f64>, Vec<f64>) = radii
            .iter()
            .map(|&radius| drag.coefficients(radius))
            .unzip();
        let blocks = linear.len().div_ceil(BLOCK);
        linear.resize(blocks * BLOCK, 0.0);
        quadratic.resize(blocks * BLOCK, 0.0);
        Self { linear, quadratic }
    }

    /// The coefficients c1 and c2 of the spheres of a block.
    #[inline(always)]
    pub(super) fn of_block(&self, bodies: &Bodies) -> [&[f64]; 2] {
        let block = bodies.first..bodies.first + BLOCK;
        [&self.linear[block.clone()], &self.quadratic[block]]
    }

    pub(super) fn reorder(&mut self, order: &[u32]) {
        for coefficients in [&mut self.linear, &mut self.quadratic] {
            coefficients.truncate(order.len());
            reorder(coefficients, order);
            coefficients.resize(order.len().next_multiple_of(BLOCK), 0.0);
        }
    }
}
