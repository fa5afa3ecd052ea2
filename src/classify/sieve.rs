//! The trait of sieves, and how a family calls them.

use super::{ClassifyError, Label, Measure, Sieves};
use crate::scene::Scene;

/// A sieve: thresholds, and what they make of a run.
pub(super) trait Sieve {
    /// A run as the sieves of the family read it.
    type Run<'a>;

    /// The labels that it gives.
    const LABELS: &'static [Label];

    /// What it measures.
    const MEASURES: &'static [Measure];

    /// Whether the thresholds can judge runs of a scene of the family.
    fn check(&self, scene: &Scene) -> Result<(), ClassifyError>;

    /// Window (s) for which a run must be long enough, if one is.
    fn window(&self) -> Option<f64> {
        None
    }

    /// Judges a run that no guard ended. What the sieves after it need to know, it notes there.
    fn sift(&self, run: &mut Self::Run<'_>) -> Sifted;
}

/// The evidence of a sieve for a run.
pub(super) struct Sifted {
    /// The label that it gives, if its answer is yes.
    pub(super) label: Option<Label>,
    /// Values of its measures.
    pub(super) values: Vec<Option<f64>>,
}

/// A sieve in the list of its family.
pub struct SieveOfFamily {
    /// Its name, as in `[sieves.NAME]`.
    pub name: &'static str,
    /// The labels that it gives.
    pub labels: &'static [Label],
    /// What it measures.
    pub measures: &'static [Measure],
    pub(super) check: fn(&Sieves, &Scene) -> Result<(), ClassifyError>,
    pub(super) window: fn(&Sieves) -> Option<f64>,
}

/// `label` if a margin says so: yes from 0 on.
pub(super) fn if_yes(label: Label, margin: Option<f64>) -> Option<Label> {
    margin.filter(|margin| *margin >= 0.0).map(|_| label)
}

/// The values of all sieves of a family and of what else it measures.
pub(super) fn values(sifted: Vec<Sifted>, others: Vec<Option<f64>>) -> Vec<Option<f64>> {
    let values = sifted.into_iter().flat_map(|it| it.values);
    values.chain(others).collect()
}
