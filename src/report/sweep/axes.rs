//! The axes of a sweep on a page.

use super::SweepResults;
use crate::grid::Axis;
use crate::plot;
use crate::refine::AxisScale;
use crate::report::document::{AxisOfPage, ShownEntry};
use crate::report::records::changes_of;

/// An axis with all values that runs have.
pub(super) struct AxisWithPlaces {
    pub(super) entry: AxisOfPage,
}

impl AxisWithPlaces {
    /// The axis at `place` of a sweep.
    pub(super) fn new(axis: &Axis, place: usize, results: &SweepResults<'_>) -> Self {
        let rows = results.table.rows.iter().map(|row| row.values[place]);
        let failed = results.failures.iter().map(|it| it.values[place]);
        let mut values: Vec<f64> = axis
            .values
            .iter()
            .copied()
            .chain(rows)
            .chain(failed)
            .collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        let scene = &results.sweep.scene;
        let notation = scene.notation(&axis.key);
        let changes = axis.variants.iter();
        let shown = plot::shown_axis(place, results.sweep, results.table);
        Self {
            entry: AxisOfPage {
                name: axis.name.clone(),
                key: axis.key.clone(),
                quantity: notation.map_or(axis.name.clone(), |it| format!("${}$", it.symbol)),
                unit: notation.map_or("", |it| it.unit).to_owned(),
                words: match axis.is_of_variants() {
                    true => values.iter().map(|value| axis.word(*value)).collect(),
                    false => Vec::new(),
                },
                shown: shown.filter(|it| it.factor != 1.0).map(|it| ShownEntry {
                    factor: it.factor,
                    quantity: it.symbol,
                    unit: it.unit,
                }),
                spacing: match results.sweep.plot.equal_steps.contains(&axis.name) {
                    true => "even",
                    false => spacing(&values),
                },
                changes: changes.map(|it| changes_of(scene, &it.scene)).collect(),
                values,
            },
        }
    }

    /// The place of a value.
    pub(super) fn place(&self, value: f64) -> usize {
        let values = &self.entry.values;
        values.iter().position(|it| *it == value).unwrap_or(0)
    }
}

/// How far values stand apart.
fn spacing(values: &[f64]) -> &'static str {
    match AxisScale::of(values) {
        AxisScale::Linear => "linear",
        AxisScale::Log => "logarithmic",
        AxisScale::Rank => "even",
    }
}

impl AxisOfPage {
    /// An axis of numbers, of which nothing but the name is known.
    pub(in crate::report) fn of_values(name: &str, mut values: Vec<f64>) -> Self {
        values.sort_by(f64::total_cmp);
        values.dedup();
        Self {
            spacing: spacing(&values),
            values,
            ..Self::named(name)
        }
    }

    /// An axis of words.
    pub(in crate::report) fn of_words(name: &str, words: Vec<String>) -> Self {
        Self {
            values: (0..words.len()).map(|place| place as f64).collect(),
            words,
            ..Self::named(name)
        }
    }

    fn named(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            key: String::new(),
            quantity: name.replace('_', " "),
            unit: String::new(),
            values: Vec::new(),
            shown: None,
            words: Vec::new(),
            spacing: "linear",
            changes: Vec::new(),
        }
    }
}
