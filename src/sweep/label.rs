//! Labels every run of a results folder from its record.

use super::{Folder, Job, LabelRow, LabelTable, Sweep, work};
use crate::classify::{self, Family, Label};
use std::collections::{BTreeMap, HashMap, HashSet};

/// Labels of the runs in a results folder.
#[derive(Clone, Debug)]
pub struct Labelling {
    /// One row per job whose record can be read, in the sweep's order.
    pub table: LabelTable,
    /// Number of jobs without a record.
    pub missing: usize,
    /// What is wrong with records that cannot be labelled.
    pub problems: Vec<String>,
}

impl Labelling {
    /// Labels the jobs of a sweep from the records in `folder`, with that many workers.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn new(
        folder: &Folder,
        sweep: &Sweep,
        jobs: &[Job],
        workers: usize,
    ) -> Result<Self, rayon::ThreadPoolBuildError> {
        let found = work::map(workers, jobs, |job| label(folder, sweep, job))?;
        let mut labelling = Self {
            table: LabelTable {
                family: Family::of(&sweep.scene),
                axes: sweep.axes.iter().map(|axis| axis.name.clone()).collect(),
                rows: Vec::new(),
            },
            missing: 0,
            problems: Vec::new(),
        };
        for row in found {
            match row {
                Ok(Some(row)) => labelling.table.rows.push(row),
                Ok(None) => labelling.missing += 1,
                Err(problem) => labelling.problems.push(problem),
            }
        }
        Ok(labelling)
    }
}

fn label(folder: &Folder, sweep: &Sweep, job: &Job) -> Result<Option<LabelRow>, String> {
    let path = folder.record(&job.id);
    if !path.exists() {
        return Ok(None);
    }
    let record = folder
        .read_record(&job.id)
        .map_err(|error| error.to_string())?;
    let verdict = classify::classify(&record, &sweep.sieves)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(Some(LabelRow {
        id: job.id.clone(),
        values: job.values.clone(),
        seed: job.seed,
        verdict,
    }))
}

/// How many labels of a table are of runs that are neither among those `kept` nor have a record in
/// the folder: without the table they would be gone.
pub fn irreplaceable<'a>(
    table: &LabelTable,
    folder: &Folder,
    kept: impl IntoIterator<Item = &'a str>,
) -> usize {
    let kept: HashSet<&str> = kept.into_iter().collect();
    let is_lost = |id: &str| !kept.contains(id) && !folder.record(id).exists();
    table.rows.iter().filter(|row| is_lost(&row.id)).count()
}

/// How many runs went from one label to another, by label. Runs that only one of the tables has
/// do not count.
pub fn changes(before: &LabelTable, after: &LabelTable) -> BTreeMap<(Label, Label), usize> {
    let labels: HashMap<_, _> = before
        .rows
        .iter()
        .map(|row| (&row.id, row.verdict.label))
        .collect();
    let mut changes = BTreeMap::new();
    for row in &after.rows {
        if let Some(&label) = labels.get(&row.id)
            && label != row.verdict.label
        {
            *changes.entry((label, row.verdict.label)).or_default() += 1;
        }
    }
    changes
}
