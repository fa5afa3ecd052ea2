//! The keys of contact laws.

use crate::document::quantity;
use crate::forces::one;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Normal contact law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Contact {
    /// Viscoelastic Hertz contact (Brilliantov et al., 1996), never attractive.
    Hertz {
        /// Young's modulus Y (Pa).
        #[schemars(transform = quantity("Y", "Pa", "Young's modulus").above(0.0))]
        young_modulus: f64,
        /// Poisson's ratio nu.
        #[schemars(transform = quantity("ν", "", "Poisson's ratio").above(-1.0).at_most(0.5))]
        poisson_ratio: f64,
        /// Dissipation time A (s). Give this or `restitution`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(transform = quantity("A", "s", "dissipation time").at_least(0.0))]
        dissipation_time: Option<f64>,
        /// Restitution of a head-on pair at `restitution_speed`, from which A follows for
        /// the scene's (mean) radius. Give this or `dissipation_time`.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        #[schemars(
            transform = quantity("e", "", "coefficient of restitution").at_least(0.01).at_most(1.0)
        )]
        restitution: Option<f64>,
        /// Relative speed at which `restitution` holds (m/s, default 1).
        #[serde(default = "one")]
        #[schemars(
            transform = quantity("v_e", "m/s", "speed at which the restitution holds").above(0.0)
        )]
        restitution_speed: f64,
        /// Factor c of the dissipative term: 1 as the thesis prints it (default), 3/2 as
        /// Brilliantov et al. derive it.
        #[serde(default = "one")]
        #[schemars(transform = quantity("c", "", "factor of the dissipative term").above(0.0))]
        dissipation_factor: f64,
    },
    /// Spring and dashpot, both linear (Cundall and Strack, 1979; Remmers, 2009): F = k delta + b
    /// times the rate of the overlap. Attractive at the end of a contact.
    Linear {
        /// Spring constant k (N/m).
        #[schemars(transform = quantity("k", "N/m", "spring constant of a contact").above(0.0))]
        stiffness: f64,
        /// Drag constant b (N s/m).
        #[schemars(transform = quantity("b", "N s/m", "drag constant of a contact").at_least(0.0))]
        damping: f64,
        /// Which part of the relative velocity the drag acts on.
        #[serde(default)]
        drag: ContactDrag,
    },
    /// Hertzian spring and a dashpot that grows with the masses (Silbert et al., 2001;
    /// `gran/hertz/history` of LAMMPS): F = sqrt(R_eff xi) (k_n xi + gamma_n m_eff dxi/dt).
    /// Attractive at the end of a contact.
    Silbert {
        /// Stiffness k_n (Pa).
        #[schemars(transform = quantity("k", "Pa", "spring constant of a contact").above(0.0))]
        stiffness: f64,
        /// Damping gamma_n (1/(m s)).
        #[schemars(
            transform = quantity("b", "1/(m s)", "drag constant of a contact").at_least(0.0)
        )]
        damping: f64,
    },
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

impl Contact {
    /// Name of the law, as in a scene file.
    pub fn law(&self) -> &'static str {
        match self {
            Self::Hertz { .. } => "hertz",
            Self::Linear { .. } => "linear",
            Self::Silbert { .. } => "silbert",
        }
    }
}
