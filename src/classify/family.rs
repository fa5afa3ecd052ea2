//! Families of scenes, each with labels, sieves and measures of its own: one table.

use super::drainage::DRAINAGE;
use super::none::NONE;
use super::rules::{LabelOfRule, MeasureOfRule};
use super::sieve::SieveOfFamily;
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
    /// Its labels by rules, which come before those of its sieves.
    pub(super) rules: &'static [LabelOfRule],
    /// Its sieves, from which labels, measures, windows and checks follow.
    pub sieves: &'static [SieveOfFamily],
    /// The labels that neither a rule nor a sieve gives.
    pub(super) without_sieve: &'static [Label],
    /// Further measures of its runs.
    pub(super) order: &'static [Measure],
    /// Measures by rules of a file.
    pub(super) measured: &'static [MeasureOfRule],
    /// Names of the figures that say most of a sweep.
    pub default_figures: &'static [&'static str],
    /// Whether a scene is of the family, if it is of none before.
    pub(super) takes: fn(&Scene) -> bool,
    /// Whether runs of a scene can be judged at all; each sieve checks its own thresholds.
    pub(super) check: fn(&Sieves, &Scene) -> Result<(), ClassifyError>,
    /// Label and measures by its sieves of a run that no guard ended.
    pub(super) judge: Judge,
    /// The family of its scenes, if rules of a file made this one.
    pub(super) base: Option<&'static Family>,
}

/// From a run that no guard ended to the label of its family's sieves, and to the values of their
/// measures and of the further ones.
pub(super) type Judge = fn(&RunRecord, &Sieves) -> Result<(Label, Vec<Option<f64>>), ClassifyError>;

impl Family {
    /// The family of a scene, without rules of its own.
    pub fn of(scene: &Scene) -> &'static Self {
        let mut families = FAMILIES.into_iter();
        families
            .find(|family| (family.takes)(scene))
            .unwrap_or(&NONE)
    }

    /// Whether it is another family with further labels and measures.
    pub fn extends(&self, other: &Self) -> bool {
        self.is_made_of(other) && !self.has_rules_alone()
    }

    /// Whether rules of a file made it for scenes of that family.
    pub fn is_made_of(&self, other: &Self) -> bool {
        self.base.is_some_and(|base| base == other)
    }

    /// Whether rules alone label its runs.
    pub fn has_rules_alone(&self) -> bool {
        self.without_sieve.contains(&Label::OTHER)
    }

    /// Whether it has the labels and measures of another one, whatever the thresholds of its rules.
    pub(super) fn has_columns_of(&self, other: &Self) -> bool {
        let names = |family: &Self| family.measures().map(|it| it.name);
        self.name == other.name && self.labels() == other.labels() && names(self).eq(names(other))
    }

    /// The labels that its runs can have, in the order of their codes.
    pub fn labels(&self) -> Vec<Label> {
        let of_sieves = self.sieves.iter().flat_map(|sieve| sieve.labels);
        let of_rules = self.rules.iter().map(|rule| &rule.label);
        let labels = self.without_sieve.iter().chain(of_sieves).chain(of_rules);
        let mut labels: Vec<Label> = labels.copied().collect();
        labels.sort_unstable();
        labels
    }

    /// Its label of that name.
    pub fn label(&self, name: &str) -> Option<Label> {
        self.labels().into_iter().find(|label| label.name == name)
    }

    /// The measures of its runs, in the order of the columns.
    pub fn measures(&self) -> impl Iterator<Item = &'static Measure> + use<> {
        let of_rules = self.rules.iter().flat_map(|rule| rule.evidence);
        let of_file = self.measured.iter().map(|rule| &rule.measure);
        of_rules.chain(self.measures_of_sieves()).chain(of_file)
    }

    /// What its sieves measure, and the further measures.
    pub(super) fn measures_of_sieves(&self) -> impl Iterator<Item = &'static Measure> + use<> {
        let of_sieves = self.sieves.iter().flat_map(|sieve| sieve.measures);
        of_sieves.chain(self.order)
    }

    /// Windows (s) for which a run must be long enough, by the names of their sieves.
    pub(super) fn windows(&self, sieves: &Sieves) -> impl Iterator<Item = (&'static str, f64)> {
        let windows = self.sieves.iter();
        windows.filter_map(|sieve| Some((sieve.name, (sieve.window)(sieves)?)))
    }
}

impl PartialEq for Family {
    fn eq(&self, other: &Self) -> bool {
        std::ptr::eq(self, other)
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
            let labels = family.labels();
            assert_eq!(labels[..1], [Label::UNSTABLE], "{family:?}");
            for label in labels {
                assert_eq!(*names.entry(label.code).or_insert(label), label);
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
            .map(|sieve| sieve.name)
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
