//! What tables of labels hold of rules.

use super::condition;
use super::names::SceneNames;
use super::of_family::{LabelOfRule, MARGIN};
use crate::classify::{Family, Label};
use crate::rule::SingleComparison;
use crate::scene::Scene;

/// A rule of a family, and the columns of its evidence in tables.
pub struct StoredRule {
    /// The label that it gives.
    pub label: Label,
    /// The condition.
    pub when: &'static str,
    /// The column with what the comparison that decides has on its left.
    pub value: &'static str,
    /// The column with the margin.
    pub margin: &'static str,
    /// The condition if it is one comparison with a number: the table then tells the label for any
    /// other number.
    pub comparison: Option<SingleComparison>,
}

impl Family {
    /// The rules of the family in the order in which they decide, for runs of a scene.
    pub fn stored_rules(&self, scene: &Scene) -> Vec<StoredRule> {
        let names = SceneNames::new(scene);
        let stored = |rule: &LabelOfRule| StoredRule {
            label: rule.label,
            when: rule.when,
            value: rule.evidence[0].name,
            margin: rule.evidence[MARGIN].name,
            comparison: condition(rule.when, &names)
                .ok()
                // Of several windows the table holds the one that decided.
                .filter(|_| rule.over.as_ref().is_none_or(|it| it.any.is_none()))
                .and_then(|condition| condition.single_comparison()),
        };
        self.rules.iter().map(stored).collect()
    }

    /// The label of a run that neither a rule nor a sieve labels; none where all have one.
    pub fn otherwise(&self) -> Option<Label> {
        let mut labels = self.without_sieve.iter().copied();
        labels.find(|label| *label != Label::UNSTABLE)
    }

    /// Whether it is that family, or rules made it before the sieves of that family.
    pub fn is_labelled_by(&self, other: &Self) -> bool {
        self == other || self.extends(other)
    }
}
