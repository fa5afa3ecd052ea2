//! `ablation.csv`: what each simplification of a scene changes and saves, one row each.
//!
//! Columns: `without` (what was simplified), `verdict`, `runs`, `missing`, `cpu_seconds` and
//! `force_evaluations` of a run on average, `time_ratio` and `work_ratio` (over those of the scene
//! as it is), `chance`, `floor` and `excess` of labels that disagree, `excess_low`, `excess_high`,
//! and of each order parameter `NAME_shift_rms` with the ends of its interval.

use super::Ablated;
use crate::store::{StoreError, write_atomic};
use crate::study::comparison::Cost;
use std::path::Path;

/// Writes the table of an ablation; `cost` is that of the scene as it is.
///
/// # Errors
/// If the file cannot be written.
pub fn write_ablation(ablated: &[Ablated], cost: &Cost, path: &Path) -> Result<(), StoreError> {
    let fail = |error: &dyn std::fmt::Display| StoreError::content(path, error);
    let mut table = csv::Writer::from_writer(Vec::new());
    let mut columns: Vec<String> = [
        "without",
        "verdict",
        "runs",
        "missing",
        "cpu_seconds",
        "force_evaluations",
        "time_ratio",
        "work_ratio",
        "chance",
        "floor",
        "excess",
        "excess_low",
        "excess_high",
    ]
    .map(str::to_owned)
    .into();
    for it in ablated
        .first()
        .map_or(&[][..], |first| &first.states.shifts)
    {
        let name = format!("{}_shift_rms", it.quantity);
        columns.extend([name.clone(), format!("{name}_low"), format!("{name}_high")]);
    }
    table.write_record(&columns).map_err(|error| fail(&error))?;
    for row in ablated {
        let labels = row.states.disagreement.as_ref();
        let shifts = row.states.shifts.iter().flat_map(|it| {
            let shift = it.shift.map(|it| it.root_mean_square);
            [
                shift.map(|it| it.value),
                shift.map(|it| it.low),
                shift.map(|it| it.high),
            ]
        });
        let cells = (
            (&row.name, row.verdict.words(), row.runs, row.missing),
            (
                row.cost.cpu_seconds,
                row.cost.force_evaluations,
                row.cost.cpu_seconds / cost.cpu_seconds,
                row.cost.force_evaluations / cost.force_evaluations,
            ),
            (
                labels.map(|it| it.chance.value),
                labels.map(|it| it.floor.value),
                labels.map(|it| it.excess.value),
                labels.map(|it| it.excess.low),
                labels.map(|it| it.excess.high),
            ),
            shifts.collect::<Vec<_>>(),
        );
        table.serialize(cells).map_err(|error| fail(&error))?;
    }
    let bytes = table.into_inner().map_err(|error| fail(&error))?;
    write_atomic(path, &bytes)
}
