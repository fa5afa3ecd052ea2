//! Scenes without a tank and without an outlet, such as a box or a cradle: their labels only say
//! whether a guard ended the run.

use super::{Family, Label};

impl Label {
    /// No guard ended the run, and there are no sieves.
    pub const STABLE: Self = Self::new(9, "stable", 0xe6_e2_f7);
}

/// Scenes that are neither tank nor silo.
pub static NONE: Family = Family {
    name: "scene without tank or outlet",
    rules: &[],
    sieves: &[],
    without_sieve: &[Label::UNSTABLE, Label::STABLE],
    order: &[],
    default_figures: &["phase"],
    takes: |_| true,
    check: |_, _| Ok(()),
    judge: |_, _| Ok((Label::STABLE, Vec::new())),
    measured: &[],
    base: None,
};
