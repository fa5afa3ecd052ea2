//! The sieves: from the observables of a run to its label.
//!
//! Each of the two [families](Family) of scenes has sieves of its own. Of a tank (Rice, 2012, section
//! 3) a run first has to settle; each further sieve then looks for its state in what follows, and
//! [`classify`] lets the first of them in a fixed order decide. Of a silo the sieves look at what
//! leaves it once its door is open. Every sieve is one file, its windows are durations, and it reads
//! records, never simulations.

mod error;
mod family;
mod fluid;
mod label;
mod order_parameters;
mod pinned;
mod run;
mod settle;
mod silo;
mod spout;
#[cfg(test)]
mod synthetic;
mod table;
mod tank;
mod window;

pub use error::ClassifyError;
pub use family::Family;
pub use fluid::FluidSieve;
pub use label::Label;
pub use order_parameters::OrderParameters;
pub use pinned::PinnedSieve;
pub use settle::SettleSieve;
pub use silo::{
    ArchingSieve, EmptiedSieve, FlowingSieve, SiloEvidence, SiloMeasures, SiloOrder,
    packing_fraction,
};
pub use spout::SpoutSieve;
pub use table::{LabelRow, LabelTable, Point};
pub use tank::{Evidence, TankMeasures};

use crate::record::{Outcome, RunRecord};
use crate::scene::Scene;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Thresholds of all sieves; every default of a tank's is that of the thesis's listing.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Sieves {
    /// Tank: when a run counts as steady.
    pub settle: SettleSieve,
    /// Tank: when a surface counts as a fluid's.
    pub fluid: FluidSieve,
    /// Tank: when a hole counts as pinned.
    pub pinned: PinnedSieve,
    /// Tank: when rising spheres count as a spout.
    pub spout: SpoutSieve,
    /// Silo: when it counts as empty.
    pub emptied: EmptiedSieve,
    /// Silo: when an arch has stopped the outflow.
    pub arching: ArchingSieve,
    /// Silo: when grains are still leaving.
    pub flowing: FlowingSieve,
}

impl Sieves {
    /// Whether these sieves can judge runs of this scene, which needs no run to tell. Those of the
    /// other family do not matter.
    ///
    /// # Errors
    /// A threshold is out of range; a tank has no energy scale m g R, or does not count the rising
    /// spheres that the spout sieve asks for; a silo has no outlet.
    pub fn check(&self, scene: &Scene) -> Result<(), ClassifyError> {
        let interval = scene.time.frame_interval;
        match Family::of(scene) {
            Family::Tank => {
                self.settle.check(interval)?;
                self.fluid.check(interval)?;
                self.pinned.check(interval)?;
                self.spout.check(interval)?;
                self.spout.column(&scene.output)?;
                run::energy_scale(scene).map(|_| ())
            }
            Family::Silo => {
                self.emptied.check()?;
                self.arching.check(interval)?;
                self.flowing.check(interval)?;
                let outlet = scene.outlet.as_ref();
                outlet.map(|_| ()).ok_or(ClassifyError::NoOutlet)
            }
        }
    }

    /// Sieves whose windows (s) are longer than a run of this scene, by their names: it can have none of their labels.
    /// Those of a silo take what there is of a window.
    pub fn without_room(&self, scene: &Scene) -> Vec<(&'static str, f64)> {
        if Family::of(scene) == Family::Silo {
            return Vec::new();
        }
        let windows = [
            ("settle", self.settle.window),
            ("fluid", self.fluid.window),
            ("pinned", self.pinned.window),
            ("spout", self.spout.window),
        ];
        let too_long = |(_, window): &(&str, f64)| *window > scene.time.duration;
        windows.into_iter().filter(too_long).collect()
    }

    /// Names of the sieves of a family, as in `[sieves.NAME]`.
    pub(crate) fn names(family: Family) -> &'static [&'static str] {
        match family {
            Family::Tank => &["settle", "fluid", "pinned", "spout"],
            Family::Silo => &["emptied", "arching", "flowing"],
        }
    }
}

/// What the sieves say of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The label.
    pub label: Label,
    /// What was measured besides.
    pub measures: Measures,
}

/// What is measured of a run besides its label, by its family. Nothing is measured on an unstable
/// run, whose numbers mean nothing.
#[derive(Clone, Debug, PartialEq)]
pub enum Measures {
    /// Of a tank.
    Tank(TankMeasures),
    /// Of a silo.
    Silo(SiloMeasures),
}

impl Measures {
    /// No measures of a family.
    pub fn none(family: Family) -> Self {
        match family {
            Family::Tank => Self::Tank(TankMeasures::default()),
            Family::Silo => Self::Silo(SiloMeasures::default()),
        }
    }

    /// The family whose measures these are.
    pub fn family(&self) -> Family {
        match self {
            Self::Tank(_) => Family::Tank,
            Self::Silo(_) => Family::Silo,
        }
    }
}

impl Verdict {
    /// The measures of a tank; none of a silo.
    pub fn tank(&self) -> Option<&TankMeasures> {
        match &self.measures {
            Measures::Tank(measures) => Some(measures),
            Measures::Silo(_) => None,
        }
    }

    /// The measures of a silo; none of a tank.
    pub fn silo(&self) -> Option<&SiloMeasures> {
        match &self.measures {
            Measures::Silo(measures) => Some(measures),
            Measures::Tank(_) => None,
        }
    }
}

/// Labels one run.
///
/// The first of these that applies is the label, of a tank: unstable, large spout, small spout,
/// pinned, fluid, settled, unsettled; of a silo: unstable, emptied, arching, flowing, unsettled.
///
/// # Errors
/// The sieves cannot judge runs of this scene (see [`Sieves::check`]), or the record contradicts
/// itself.
pub fn classify(record: &RunRecord, sieves: &Sieves) -> Result<Verdict, ClassifyError> {
    sieves.check(&record.scene)?;
    let family = Family::of(&record.scene);
    if let Outcome::Unstable(_) = record.outcome {
        return Ok(Verdict {
            label: Label::Unstable,
            measures: Measures::none(family),
        });
    }
    let (label, measures) = match family {
        Family::Tank => {
            let (label, measures) = tank::judge(record, sieves)?;
            (label, Measures::Tank(measures))
        }
        Family::Silo => {
            let (label, measures) = silo::judge(record, sieves)?;
            (label, Measures::Silo(measures))
        }
    };
    Ok(Verdict { label, measures })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_label_is_of_a_family_and_in_the_order_of_codes() {
        for label in Label::ALL {
            let of = |family: Family| family.labels().contains(&label);
            assert!(of(Family::Tank) || of(Family::Silo), "{label:?}");
        }
        for family in [Family::Tank, Family::Silo] {
            assert!(family.labels().is_sorted());
        }
        let codes = Label::ALL.map(Label::code);
        assert_eq!(codes, [-1, 0, 1, 2, 3, 4, 5, 6, 7, 8]);
    }

    #[test]
    fn every_sieve_is_of_one_family() {
        let all = serde_json::to_value(Sieves::default()).unwrap();
        let mut names: Vec<&str> = all
            .as_object()
            .unwrap()
            .keys()
            .map(String::as_str)
            .collect();
        let mut known = [Sieves::names(Family::Tank), Sieves::names(Family::Silo)].concat();
        names.sort_unstable();
        known.sort_unstable();
        assert_eq!(names, known);
    }
}
