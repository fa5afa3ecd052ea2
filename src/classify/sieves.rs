//! The list of all sieves.

use super::drainage::blocked::BlockedSieve;
use super::drainage::run::DrainageRun;
use super::rules::{self, Rules};
use super::sieve::{Sieve, SieveOfFamily, Sifted};
use super::silo::arching::ArchingSieve;
use super::silo::flowing::FlowingSieve;
use super::silo::outflow::Outflow;
use super::tank::fluid::FluidSieve;
use super::tank::pinned::PinnedSieve;
use super::tank::run::TankRun;
use super::tank::settle::SettleSieve;
use super::tank::spout::SpoutSieve;
use super::{ClassifyError, Family};
use crate::scene::{Scene, UsualColumns};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

// Tables of studies and results folders say which sieves they were judged by. What a family has of
// new ones does not concern the others.
fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Declares all sieves once, by families: the keys of `[sieves]`, the list of each family, and a
/// function that sifts a run of the family through all of them, in this order.
macro_rules! sieves {
    ($(
        $LIST:ident, $sift:ident($Run:ident): {
            $($(#[$about:meta])+ $name:ident: $Sieve:ident,)+
        }
    )+) => {
        /// Thresholds of all sieves; the defaults for a tank are from the thesis's listing.
        #[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
        #[serde(deny_unknown_fields, default)]
        pub struct Sieves {
            $($($(#[$about])+ pub $name: $Sieve,)+)+
            /// Labels and measures that the file states itself: its tables `[[label]]` and
            /// `[[measure]]`.
            #[serde(skip_serializing_if = "Rules::is_empty")]
            #[schemars(skip)]
            pub rules: Rules,
        }

        $(
            pub(super) static $LIST: &[SieveOfFamily] = &[$(SieveOfFamily {
                name: stringify!($name),
                labels: $Sieve::LABELS,
                measures: $Sieve::MEASURES,
                check: |sieves, scene| sieves.$name.check(scene),
                window: |sieves| sieves.$name.window(),
            }),+];

            impl Sieves {
                pub(super) fn $sift(&self, run: &mut $Run<'_>) -> Vec<Sifted> {
                    vec![$(self.$name.sift(run)),+]
                }
            }
        )+
    };
}

sieves! {
    TANK_SIEVES, sift_tank(TankRun): {
        /// Tank: when a run counts as steady.
        settle: SettleSieve,
        /// Tank: when a surface counts as a fluid's.
        fluid: FluidSieve,
        /// Tank: when a hole counts as pinned.
        pinned: PinnedSieve,
        /// Tank: when rising spheres count as a spout.
        spout: SpoutSieve,
    }
    SILO_SIEVES, sift_silo(Outflow): {
        /// Silo: when an arch has stopped the outflow.
        arching: ArchingSieve,
        /// Silo: when grains are still leaving.
        flowing: FlowingSieve,
    }
    DRAINAGE_SIEVES, sift_drainage(DrainageRun): {
        /// Drainage: when an opening counts as blocked.
        #[serde(skip_serializing_if = "is_default")]
        blocked: BlockedSieve,
    }
}

impl Sieves {
    /// The default sieves, whatever the rules of a scene's own file are.
    pub fn without_rules() -> Self {
        Self {
            rules: Rules {
                sieves: true,
                ..Rules::default()
            },
            ..Self::default()
        }
    }

    /// The family of a scene with these rules.
    pub fn family(&self, scene: &Scene) -> &'static Family {
        let base = Family::of(scene);
        let of_scene = Rules::of(scene);
        let own = &self.rules;
        let rules = match own.is_empty() && !own.sieves {
            true => &of_scene,
            false => own,
        };
        match rules.is_empty() {
            true => base,
            // Rules that are wrong were refused with their file.
            false => rules::family(rules, base, scene).unwrap_or(base),
        }
    }

    /// Whether these sieves can judge runs of this scene, as far as this is known before a run.
    /// Sieves of other families do not matter.
    ///
    /// # Errors
    /// A threshold is out of range; a tank has no gravity to measure energy by, or does not count
    /// the rising spheres that the spout sieve asks for; a silo has no outlet.
    pub fn check(&self, scene: &Scene) -> Result<(), ClassifyError> {
        let base = Family::of(scene);
        if !self.family(scene).needs_sieves(scene) {
            return Ok(());
        }
        if let (UsualColumns::Named(_), [_, ..]) = (&scene.output.usual, base.sieves) {
            return Err(ClassifyError::NoColumns { family: base.name });
        }
        for sieve in base.sieves {
            (sieve.check)(self, scene)?;
        }
        (base.check)(self, scene)
    }

    /// Sieves whose windows (s) are longer than a run of this scene, by their names: it can have
    /// none of their labels. A silo's sieves shorten their windows instead.
    pub fn without_room(&self, scene: &Scene) -> Vec<(&'static str, f64)> {
        let windows = self.family(scene).windows(self);
        windows
            .filter(|(_, window)| *window > scene.time.duration)
            .collect()
    }
}
