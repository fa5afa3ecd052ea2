//! The keys of friction laws, and the contact laws that they go with.

use crate::document::quantities::fraction;
use crate::document::quantity;
use crate::forces::contact::Contact;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
