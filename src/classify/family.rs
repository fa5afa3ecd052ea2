//! The two families of scenes, each with sieves, labels and measures of its own.

use super::Label;
use crate::scene::Scene;

/// A family of scenes, with sieves, labels and measures of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// Spheres that stay, in the vortex of a tank (Rice, 2012).
    Tank,
    /// Grains that leave a silo (Remmers, 2009).
    Silo,
}

impl Family {
    /// The family of a scene: one with a door or an outlet is a silo.
    pub fn of(scene: &Scene) -> Self {
        if scene.door.is_some() || scene.outlet.is_some() {
            Self::Silo
        } else {
            Self::Tank
        }
    }

    /// The labels that runs of the family can have, in the order of their codes.
    pub fn labels(self) -> &'static [Label] {
        match self {
            Self::Tank => &[
                Label::Unstable,
                Label::Unsettled,
                Label::Settled,
                Label::Fluid,
                Label::Pinned,
                Label::SmallSpout,
                Label::LargeSpout,
            ],
            Self::Silo => &[
                Label::Unstable,
                Label::Unsettled,
                Label::Arching,
                Label::Flowing,
                Label::Emptied,
            ],
        }
    }

    /// Name, as in messages.
    pub fn name(self) -> &'static str {
        match self {
            Self::Tank => "tank",
            Self::Silo => "silo",
        }
    }
}
