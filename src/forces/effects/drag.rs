//! The drag law that swirl and updraught share: force from the difference of two velocities.

use super::{Effect, EffectKeys, Effects};
use crate::document::{Problem, quantity};
use crate::forces::limit::{Limit, Regime};
use crate::particles::block::BLOCK;
use crate::particles::bodies::Bodies;
use crate::particles::reorder::reorder;
use crate::particles::vector::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Drag law and the form of its quadratic part.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// Linear coefficient, with the unit that `law` says.
    #[serde(default)]
    #[schemars(
        transform = quantity("M_1", "kg/(m² s)", "linear drag coefficient")
            .at_least(0.0)
            .unit_where("law", "diameter", "kg/(m s)")
            .unit_where("law", "constant", "kg/s")
    )]
    pub linear: f64,
    /// Quadratic coefficient, with the unit that `law` says.
    #[serde(default)]
    #[schemars(
        transform = quantity("M_2", "kg/m³", "quadratic drag coefficient")
            .at_least(0.0)
            .unit_where("law", "constant", "kg/m")
    )]
    pub quadratic: f64,
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
}

/// Form of the quadratic drag.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DragForm {
    /// |dv| dv: isotropic, as physics has it.
    #[default]
    Vector,
    /// dv_x |dv_x| and so on: each component by itself, as the thesis ran it.
    Component,
}

impl Drag {
    /// Coefficients (c1 in kg/s, c2 in kg/m) for a sphere of radius `radius` (m).
    pub fn coefficients(&self, radius: f64) -> (f64, f64) {
        let diameter = 2.0 * radius;
        match self.law {
            DragLaw::CrossSection => {
                let area = std::f64::consts::PI * radius * radius;
                (self.linear * area, self.quadratic * area)
            }
            DragLaw::Diameter => (self.linear * diameter, self.quadratic * diameter * diameter),
            DragLaw::Constant => (self.linear, self.quadratic),
        }
    }

    /// Which kernel the law needs.
    pub(super) fn kernel(&self) -> Form {
        match self.form {
            _ if self.quadratic == 0.0 => Form::Linear,
            DragForm::Vector => Form::Vector,
            DragForm::Component => Form::Components,
        }
    }
}

impl EffectKeys for Drag {
    fn effect(&self, _: &Effects, _: &[f64]) -> Option<Box<dyn Effect>> {
        None
    }

    /// A sphere that slips through the air at speed u returns to its terminal speed at the rate
    /// (c1 + 2 c2 u) / m. Swirl and updraught both act on the vertical velocity.
    fn limit(&self, all: &Effects, regime: &Regime<'_>) -> Option<Limit> {
        let updraught = all.updraught.as_ref().map_or(0.0, |air| {
            let height = regime.lowest_height - air.origin;
            air.strength_in(all.swirl.as_ref()) * libm::exp(-air.decay * height)
        });
        let swirl = if all.swirl.is_some() { 1.0 } else { 0.0 };
        let (linear, quadratic) = self.coefficients(regime.smallest_radius);
        let coefficient = (linear + 2.0 * quadratic * regime.fastest_impact) * (swirl + updraught);
        Some(Limit {
            name: "drag",
            seconds: (regime.scheme).oscillator(0.0, coefficient / regime.smallest_mass),
            decisive: true,
            explanation: "2 m / (q (c1 + 2 c2 u)) of the smallest sphere, times the factors of \
                          swirl and updraught at the lowest height; q = 2 for \
                          synchronised-verlet, else 1",
            consequence: Limit::PASSES_ITS_END,
        })
    }

    fn problems(&self, all: &Effects, _: bool) -> Vec<Problem> {
        if all.swirl.is_some() || all.updraught.is_some() {
            return Vec::new();
        }
        let message = "[drag] acts through [swirl] or [updraught], but there is neither";
        let help = "add [swirl], with `omega = 0.0` for still air, or remove [drag]";
        vec![Problem::new("drag", message).help(help)]
    }
}

/// What is wrong with a table that needs the drag law where there is none.
pub(super) fn missing_drag(all: &Effects, name: &str) -> Vec<Problem> {
    if all.drag.is_some() {
        return Vec::new();
    }
    let message = format!("[{name}] needs a drag law, but there is no [drag]");
    let help = "add [drag] with `law` and `linear` or `quadratic`";
    vec![Problem::new(name, message).help(help)]
}

/// Force of the air on a sphere from the velocity of the air relative to it, for the
/// coefficients c1 (kg/s) and c2 (kg/m) of the sphere.
pub(super) trait DragKernel: Copy + Send + Sync + 'static {
    /// Force (N) for the relative velocity of the air (m/s).
    fn vector(c1: f64, c2: f64, air: Vector) -> Vector;

    /// The same along one axis alone.
    fn along(c1: f64, c2: f64, air: f64) -> f64;
}

/// c1 u.
#[derive(Clone, Copy)]
pub(super) struct Linear;

impl DragKernel for Linear {
    #[inline(always)]
    fn vector(c1: f64, _: f64, air: Vector) -> Vector {
        air * c1
    }

    #[inline(always)]
    fn along(c1: f64, _: f64, air: f64) -> f64 {
        c1 * air
    }
}

/// (c1 + c2 |u|) u, isotropic.
#[derive(Clone, Copy)]
pub(super) struct QuadraticVector;

impl DragKernel for QuadraticVector {
    #[inline(always)]
    fn vector(c1: f64, c2: f64, air: Vector) -> Vector {
        air * (c1 + c2 * air.norm())
    }

    #[inline(always)]
    fn along(c1: f64, c2: f64, air: f64) -> f64 {
        (c1 + c2 * air.abs()) * air
    }
}

/// (c1 + c2 |u_x|) u_x and so on: each component by itself, as the thesis ran it.
#[derive(Clone, Copy)]
pub(super) struct QuadraticComponents;

impl DragKernel for QuadraticComponents {
    #[inline(always)]
    fn vector(c1: f64, c2: f64, air: Vector) -> Vector {
        Vector::new(
            Self::along(c1, c2, air.x),
            Self::along(c1, c2, air.y),
            Self::along(c1, c2, air.z),
        )
    }

    #[inline(always)]
    fn along(c1: f64, c2: f64, air: f64) -> f64 {
        (c1 + c2 * air.abs()) * air
    }
}

/// Which kernel a drag law needs.
pub(super) enum Form {
    Linear,
    Vector,
    Components,
}

/// Coefficients c1 and c2 of every sphere, in whole blocks.
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

    /// Those of a block.
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
