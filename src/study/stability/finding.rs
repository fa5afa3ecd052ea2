//! What a study of stability finds of each integrator.

use super::StabilityStudy;
use crate::classify::{Label, LabelRow, LabelTable, NUMERICS, Verdict};
use crate::study::comparison::{RunRow, Sample};
use serde::Serialize;
use std::collections::BTreeMap;

/// How an integrator did.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Tried {
    /// Its name.
    pub integrator: String,
    /// Number of runs by label.
    pub labels: BTreeMap<&'static str, usize>,
    /// Least step over its limit of a run that is not stable.
    pub all_stable_below: Option<f64>,
    /// Largest step over its limit of a stable run.
    pub none_stable_above: Option<f64>,
}

impl StabilityStudy {
    /// How each integrator did, from the rows of all jobs.
    pub fn evaluate(&self, rows: &[Option<RunRow>]) -> Vec<Tried> {
        let settings = self.comparison.settings.iter().enumerate();
        settings
            .map(|(place, it)| Tried::of(&it.name, &self.comparison.sample(place, rows)))
            .collect()
    }

    /// The labels of its runs.
    pub fn labels(&self, rows: &[Option<RunRow>]) -> LabelTable {
        let comparison = &self.comparison;
        let of_setting = |place: usize| {
            let rows = comparison.rows_of(place, rows);
            rows.map(move |(values, seed, run)| LabelRow {
                id: run.id.clone(),
                values: [values, vec![place as f64]].concat(),
                seed,
                verdict: Verdict {
                    label: run.label,
                    family: &NUMERICS,
                    steady: None,
                    values: run.values.clone(),
                },
            })
        };
        let axes = comparison.sweep.axes.iter();
        LabelTable {
            family: &NUMERICS,
            axes: axes.map(|axis| axis.name.clone()).collect(),
            variants: comparison.sweep.variants(),
            rows: (0..comparison.settings.len())
                .flat_map(of_setting)
                .collect(),
        }
    }
}

impl Tried {
    fn of(integrator: &str, sample: &Sample<'_>) -> Self {
        let mut labels = BTreeMap::new();
        for run in sample.runs() {
            *labels.entry(run.label.name).or_default() += 1;
        }
        let place = NUMERICS
            .measures()
            .position(|it| it.name == "step_over_limit");
        let ratios = |stable: bool| {
            let chosen = sample
                .runs()
                .filter(move |run| (run.label == Label::STABLE) == stable);
            chosen.filter_map(move |run| *run.values.get(place?)?)
        };
        Self {
            integrator: integrator.to_owned(),
            labels,
            all_stable_below: ratios(false).reduce(f64::min),
            none_stable_above: ratios(true).reduce(f64::max),
        }
    }
}
