//! The laws of contacts: along the line of centres, and across it.

use crate::document::quantity;
use crate::scene::one;
use crate::scene::quantities::fraction;
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

/// Tangential contact law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Friction {
    /// The thesis's rule (Rice, 2012, eqs. 10 to 14): from spins alone, an impulse per step.
    /// Depends on the time step, knows no sliding, does not conserve angular momentum.
    Spin {
        /// Coefficient mu.
        #[schemars(transform = fraction("μ", "coefficient of friction"))]
        coefficient: f64,
    },
    /// Sliding friction capped at mu F_n, from the velocity of the contact point.
    Coulomb {
        /// Coefficient mu.
        #[schemars(transform = quantity("μ", "", "coefficient of friction").at_least(0.0))]
        coefficient: f64,
        /// Sliding speed below which the force falls linearly to zero (m/s).
        #[schemars(transform = quantity("v_μ", "m/s", "sliding speed of full friction").above(0.0))]
        regularisation: f64,
    },
    /// A tangential spring and dashpot, together capped at mu F_n (Cundall and Strack, 1979); needs
    /// the linear contact. A pile holds still, and grains can arch.
    CundallStrack {
        /// Coefficient mu.
        #[schemars(transform = quantity("μ", "", "coefficient of friction").at_least(0.0))]
        coefficient: f64,
        /// Tangential spring constant k_t (N/m).
        #[schemars(transform = quantity("k_t", "N/m", "tangential spring constant").above(0.0))]
        stiffness: f64,
        /// Tangential drag constant b_t (N s/m).
        #[serde(default)]
        #[schemars(transform = quantity("b_t", "N s/m", "tangential drag constant").at_least(0.0))]
        damping: f64,
    },
    /// Mindlin's history spring by increments, capped at mu F_n; needs the Hertz contact.
    Mindlin {
        /// Coefficient mu.
        #[schemars(transform = quantity("μ", "", "coefficient of friction").at_least(0.0))]
        coefficient: f64,
    },
    /// A history spring sqrt(R_eff xi) k_t by increments and a dashpot sqrt(R_eff xi) gamma_t
    /// m_eff, together capped at mu F_n (Silbert et al., 2001); needs the silbert contact. The
    /// spring keeps its force, where LAMMPS keeps the displacement.
    Silbert {
        /// Coefficient mu.
        #[schemars(transform = quantity("μ", "", "coefficient of friction").at_least(0.0))]
        coefficient: f64,
        /// Tangential stiffness k_t (Pa).
        #[schemars(transform = quantity("k_t", "Pa", "tangential spring constant").above(0.0))]
        stiffness: f64,
        /// Tangential damping gamma_t (1/(m s)).
        #[serde(default)]
        #[schemars(
            transform = quantity("b_t", "1/(m s)", "tangential drag constant").at_least(0.0)
        )]
        damping: f64,
    },
}

/// Friction laws, each with the contact laws that it goes with. The engine is compiled for these
/// pairs alone.
const PAIRS: [(&str, &[&str]); 5] = [
    ("spin", &["hertz"]),
    ("coulomb", &["hertz", "linear"]),
    ("cundall-strack", &["linear"]),
    ("mindlin", &["hertz"]),
    ("silbert", &["silbert"]),
];

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

impl Friction {
    /// Name of the law, as in a scene file.
    pub fn law(&self) -> &'static str {
        match self {
            Self::Spin { .. } => "spin",
            Self::Coulomb { .. } => "coulomb",
            Self::CundallStrack { .. } => "cundall-strack",
            Self::Mindlin { .. } => "mindlin",
            Self::Silbert { .. } => "silbert",
        }
    }

    /// The contact laws that it goes with, by name.
    pub fn contacts(&self) -> &'static [&'static str] {
        let own = PAIRS.iter().find(|(law, _)| *law == self.law());
        own.map_or(&[], |(_, contacts)| contacts)
    }

    /// Whether it goes with a contact law.
    pub fn goes_with(&self, contact: &Contact) -> bool {
        self.contacts().contains(&contact.law())
    }

    /// The friction laws that go with a contact law, by name.
    pub fn laws_with(contact: &Contact) -> impl Iterator<Item = &'static str> + Clone {
        let law = contact.law();
        let pairs = PAIRS.iter();
        pairs.filter_map(move |(friction, contacts)| contacts.contains(&law).then_some(*friction))
    }
}
