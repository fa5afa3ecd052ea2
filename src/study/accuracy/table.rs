//! `accuracy.csv`: cost and error of every setting of a study, one row each.
//!
//! Columns: `setting`, `method`, `key`, `value` (its place on a ladder), `runs`, `unstable`,
//! `missing`, `cpu_seconds`, `sphere_steps`, `force_evaluations` (of a run on average), `within`
//! (the tolerance), then the errors. Of labels: `chance`, `floor` and `excess` with the ends of
//! their intervals, and the same for `NAME_shift` (mean) and `NAME_shift_rms` of each order
//! parameter. Of motions: `error_1` and on, one for each time. Of a case: `error_NAME` for each
//! number.

use super::evaluate::{Errors, Evaluation, Outcome};
use crate::store::{StoreError, write_atomic};
use crate::study::comparison::Interval;
use std::path::Path;

/// Writes the table of a study.
///
/// # Errors
/// If the file cannot be written.
pub fn write_accuracy(evaluation: &Evaluation, path: &Path) -> Result<(), StoreError> {
    let fail = |error: &dyn std::fmt::Display| StoreError::content(path, error);
    let mut table = csv::Writer::from_writer(Vec::new());
    let cells = evaluation.outcomes.iter().map(|outcome| {
        let mut cells = common(evaluation, outcome);
        cells.extend(errors(&outcome.errors));
        cells
    });
    let rows: Vec<Vec<(String, String)>> = cells.collect();
    // A setting without runs lacks the columns of intervals.
    let names: Vec<&String> = rows
        .iter()
        .max_by_key(|row| row.len())
        .map_or_else(Vec::new, |row| row.iter().map(|(name, _)| name).collect());
    table.write_record(&names).map_err(|error| fail(&error))?;
    for row in &rows {
        let cell = |name: &&String| {
            let own = row.iter().find(|(own, _)| own == *name);
            own.map_or("", |(_, cell)| cell.as_str())
        };
        table
            .write_record(names.iter().map(cell))
            .map_err(|error| fail(&error))?;
    }
    let bytes = table.into_inner().map_err(|error| fail(&error))?;
    write_atomic(path, &bytes)
}

fn common(evaluation: &Evaluation, outcome: &Outcome) -> Vec<(String, String)> {
    let (key, value) = match &outcome.rung {
        Some((key, value)) => (key.clone(), value.to_string()),
        None => (String::new(), String::new()),
    };
    let within = outcome.is_within(&evaluation.tolerance, evaluation.counted_time);
    [
        ("setting", outcome.name.clone()),
        ("method", outcome.method.clone()),
        ("key", key),
        ("value", value),
        ("runs", outcome.runs.to_string()),
        ("unstable", outcome.unstable.to_string()),
        ("missing", outcome.missing.to_string()),
        ("cpu_seconds", outcome.cost.cpu_seconds.to_string()),
        ("sphere_steps", outcome.cost.sphere_steps.to_string()),
        (
            "force_evaluations",
            outcome.cost.force_evaluations.to_string(),
        ),
        ("within", within.to_string()),
    ]
    .map(|(name, cell)| (name.to_owned(), cell))
    .into()
}

fn errors(errors: &Errors) -> Vec<(String, String)> {
    let of_interval = |name: &str, interval: Interval| {
        [
            (name.to_owned(), interval.value.to_string()),
            (format!("{name}_low"), interval.low.to_string()),
            (format!("{name}_high"), interval.high.to_string()),
        ]
    };
    match errors {
        Errors::States(states) => {
            let disagreement = states.disagreement.iter().flat_map(|it| {
                [
                    ("chance", it.chance),
                    ("floor", it.floor),
                    ("excess", it.excess),
                ]
            });
            let mut cells: Vec<_> = disagreement
                .flat_map(|(name, it)| of_interval(name, it))
                .collect();
            for it in &states.shifts {
                // No shift is known where the reference has no spread; its columns stay empty.
                let shift = it.shift.map(|it| [it.mean, it.root_mean_square]);
                for (place, end) in ["shift", "shift_rms"].into_iter().enumerate() {
                    let name = format!("{}_{end}", it.quantity);
                    match shift {
                        Some(shift) => cells.extend(of_interval(&name, shift[place])),
                        None => cells.extend(
                            [name.clone(), format!("{name}_low"), format!("{name}_high")]
                                .map(|name| (name, String::new())),
                        ),
                    }
                }
            }
            cells
        }
        Errors::Motion(error) => {
            let times = error.times.iter().enumerate();
            let cell = |(time, error): (usize, &Option<f64>)| {
                let error = error.map_or_else(String::new, |it| it.to_string());
                (format!("error_{}", time + 1), error)
            };
            times.map(cell).collect()
        }
        Errors::Case(errors) => {
            let cell =
                |(name, error): (&String, &f64)| (format!("error_{name}"), error.to_string());
            errors.iter().map(cell).collect()
        }
    }
}
