//! Families of scenes, each with labels, sieves and measures of its own: one table.

use super::drainage::DRAINAGE;
use super::none::NONE;
use super::silo::SILO;
use super::tank::TANK;
use super::{ClassifyError, Label, Measure, Sieves};
use crate::record::RunRecord;
use crate::scene::Scene;
use std::fmt;

/// All families. A scene is of the first that takes it.
pub static FAMILIES: [&Family; 4] = [&SILO, &DRAINAGE, &TANK, &NONE];

/// A family of scenes.
pub struct Family {
    /// Name, as in messages.
    pub name: &'static str,
    /// The labels that its runs can have, in the order of their codes.
    pub labels: &'static [Label],
    /// Names of its sieves, as in `[sieves.NAME]`.
    pub sieves: &'static [&'static str],
    /// What is measured of its runs, in groups.
    pub(super) measures: &'static [&'static [Measure]],
    /// Names of the figures that say most of a sweep.
    pub default_figures: &'static [&'static str],
    /// Whether a scene is of the family, if it is of none before.
    pub(super) takes: fn(&Scene) -> bool,
    /// Whether sieves can judge runs of a scene.
    pub(super) check: fn(&Sieves, &Scene) -> Result<(), ClassifyError>,
    /// Windows (s) for which a run must be long enough, by the names of their sieves.
    pub(super) windows: fn(&Sieves) -> Vec<(&'static str, f64)>,
    /// Label and measures of a run that no guard ended.
    pub(super) judge: Judge,
}

/// From a run that no guard ended to its label and to the values of its family's measures.
pub(super) type Judge = fn(&RunRecord, &Sieves) -> Result<(Label, Vec<Option<f64>>), ClassifyError>;

impl Family {
    /// The family of a scene.
    pub fn of(scene: &Scene) -> &'static Self {
        let mut families = FAMILIES.into_iter();
        families
            .find(|family| (family.takes)(scene))
            .unwrap_or(&NONE)
    }

    /// What is measured of its runs, in the order of the columns.
    pub fn measures(&self) -> impl Iterator<Item = &'static Measure> + use<> {
        self.measures.iter().copied().flatten()
    }

    /// Its label of that name.
    pub fn label(&self, name: &str) -> Option<Label> {
        self.labels.iter().copied().find(|label| label.name == name)
    }
}

impl PartialEq for Family {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Family {}

impl fmt::Debug for Family {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Schema, kind::ValueKind};
    use std::collections::{BTreeMap, BTreeSet};

    #[test]
    fn labels_are_in_the_order_of_codes_and_no_two_have_one_code() {
        let mut names = BTreeMap::new();
        for family in FAMILIES {
            assert!(family.labels.is_sorted(), "{family:?}");
            assert_eq!(family.labels[..1], [Label::UNSTABLE], "{family:?}");
            for label in family.labels {
                assert_eq!(*names.entry(label.code).or_insert(*label), *label);
            }
        }
        let codes: Vec<i8> = names.into_keys().collect();
        assert_eq!(codes, (-1..=12).collect::<Vec<_>>());
    }

    #[test]
    fn every_sieve_is_of_one_family() {
        let ValueKind::Table(all) = Schema::of::<Sieves>().kind else {
            panic!("sieves are a table");
        };
        let names: BTreeSet<&str> = all.keys.iter().map(|key| key.name.as_str()).collect();
        let known: Vec<&str> = FAMILIES
            .iter()
            .flat_map(|family| family.sieves)
            .copied()
            .collect();
        assert_eq!(names.len(), known.len());
        assert_eq!(names, known.into_iter().collect());
    }

    #[test]
    fn no_two_measures_have_one_name() {
        let measures = || FAMILIES.iter().flat_map(|family| family.measures());
        let names: BTreeSet<&str> = measures().map(|measure| measure.name).collect();
        assert_eq!(names.len(), measures().count());
        assert!(measures().all(|measure| !measure.quantity.is_empty()));
    }
}
