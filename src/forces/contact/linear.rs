//! Linear spring and dashpot.

use super::keys::elastic;
use super::{Collision, ContactKeys, LinearImpact, NormalLaw};
use crate::document::quantity;
use crate::forces::limit::Regime;
use crate::forces::simplification::Simplification;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::json;

/// Spring and dashpot, both linear (Cundall and Strack, 1979; Remmers, 2009): F = k delta + b
/// times the rate of the overlap. Attractive at the end of a contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Linear {
    /// Spring constant k (N/m).
    #[schemars(transform = quantity("k", "N/m", "spring constant of a contact").above(0.0))]
    pub stiffness: f64,
    /// Drag constant b (N s/m).
    #[schemars(transform = quantity("b", "N s/m", "drag constant of a contact").at_least(0.0))]
    pub damping: f64,
    /// Which part of the relative velocity the drag acts on.
    #[serde(default)]
    pub drag: ContactDrag,
}

/// Which part of the relative velocity of two partners a contact's drag acts on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum ContactDrag {
    /// The part along the line of centres.
    #[default]
    Normal,
    /// All of it (Remmers, 2009), which also slows spheres that slide along each other. Spins do
    /// not count.
    Whole,
}

impl ContactKeys for Linear {
    type Law = LinearLaw;
    const NAME: &'static str = "linear";
    const CONTACT_LIMIT: &'static str = "2/w of the two smallest spheres, w^2 = k / m_eff";
    const DAMPED_LIMIT: &'static str = "(w dt)^2 + 2 q g dt < 4 with the w of the contact limit \
                                        and the damping rate g = b / m_eff; q = 2 for \
                                        synchronised-verlet, else 1";

    fn law(&self, _: f64, _: f64) -> LinearLaw {
        LinearLaw::new(self.stiffness, self.damping, self.drag)
    }

    /// The impact of the two smallest spheres; all others have larger effective masses, and are
    /// softer.
    fn collisions(&self, regime: &Regime<'_>) -> Vec<Collision> {
        let impact = LinearImpact {
            effective_mass: 0.5 * regime.smallest_mass,
            stiffness: self.stiffness,
            damping: self.damping,
        };
        vec![Collision::of_linear_impact(&impact, regime.fastest_impact)]
    }

    fn simplifications(&self) -> Vec<Simplification> {
        let along = [("contact.drag", json!(ContactDrag::Normal))];
        let along = Simplification::setting("contact drag sideways off", along);
        let sideways = self.drag == ContactDrag::Whole && self.damping > 0.0;
        let elastic = elastic(self.damping > 0.0, "contact.damping", 0.0);
        elastic.chain(sideways.then_some(along)).collect()
    }
}

/// F = k delta + b d(delta)/dt along the line of centres, with overlap delta, spring constant k and
/// drag constant b (Cundall and Strack, 1979). With the drag on the whole relative velocity
/// (Remmers, 2009) also -b times its tangential part.
#[derive(Clone, Copy, Debug)]
pub struct LinearLaw {
    /// k (N/m).
    stiffness: f64,
    /// b (N s/m).
    damping: f64,
    /// b of the tangential part (N s/m), which may be zero.
    sideways_drag: f64,
}

impl LinearLaw {
    /// The law with a spring constant (N/m) and a drag constant (N s/m).
    pub fn new(stiffness: f64, damping: f64, drag: ContactDrag) -> Self {
        Self {
            stiffness,
            damping,
            sideways_drag: match drag {
                ContactDrag::Normal => 0.0,
                ContactDrag::Whole => damping,
            },
        }
    }
}

impl NormalLaw for LinearLaw {
    const DRAGS_SIDEWAYS: bool = true;
    const ATTRACTS: bool = true;

    #[inline(always)]
    fn force(&self, overlap: f64, overlap_rate: f64, _: f64, _: f64) -> f64 {
        self.stiffness * overlap + self.damping * overlap_rate
    }

    #[inline(always)]
    fn sideways_drag(&self) -> f64 {
        self.sideways_drag
    }

    #[inline(always)]
    fn elastic_energy(&self, overlap: f64, _: f64) -> f64 {
        0.5 * self.stiffness * overlap * overlap
    }

    fn stiffness(&self, _: f64, _: f64) -> f64 {
        self.stiffness
    }

    fn damping(&self, _: f64, _: f64, _: f64) -> f64 {
        self.damping
    }

    fn deepest_overlap(&self, overlap: f64, speed: f64, _: f64, effective_mass: f64) -> f64 {
        (overlap * overlap + effective_mass * speed * speed / self.stiffness).sqrt()
    }
}
