//! What a study of stability finds of each integrator.

use super::StabilityStudy;
use crate::classify::{Label, LabelRow, LabelTable, NUMERICS, Verdict};
use crate::grid::{Axis, Variant};
use crate::study::comparison::{RunRow, Sample};
use crate::sweep::Sweep;
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
}

impl StabilityStudy {
    /// The study as a sweep whose last axis is the integrator, and the labels of its runs.
    pub fn labels(&self, rows: &[Option<RunRow>]) -> (Sweep, LabelTable) {
        let settings = &self.comparison.settings;
        let variants = settings.iter().map(|setting| Variant {
            name: setting.name.clone(),
            scale: Vec::new(),
            scene: setting.sweep.scene.clone(),
        });
        let mut sweep = settings[0].sweep.clone();
        sweep.axes.push(Axis::of_variants(variants.collect()));
        let mut table = LabelTable {
            family: &NUMERICS,
            axes: sweep.axes.iter().map(|axis| axis.name.clone()).collect(),
            variants: sweep.variants(),
            rows: Vec::new(),
        };
        for (place, setting) in settings.iter().enumerate() {
            let runs = self.comparison.sample(place, rows).points;
            for (mut values, runs) in setting.sweep.grid().zip(runs) {
                values.push(place as f64);
                let row = |run: &RunRow| LabelRow {
                    id: run.id.clone(),
                    values: values.clone(),
                    seed: setting.sweep.scene.seed,
                    verdict: Verdict {
                        label: run.label,
                        family: &NUMERICS,
                        steady: None,
                        values: run.values.clone(),
                    },
                };
                table.rows.extend(runs.into_iter().flatten().map(row));
            }
        }
        (sweep, table)
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
