//! Labels every run of a results folder from its record.

use super::{Folder, Job, PlotSettings, Sweep, work};
use crate::classify::{self, ClassifyError, Label, LabelRow, LabelTable, Sieves};
use crate::document::differing_keys;
use crate::refusal::Refusal;
use crate::scene::{ExternalProgram, Output, UsualColumns};
use crate::store::{self, StoreError};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::PathBuf;

/// Labels of the runs in a results folder.
#[derive(Clone, Debug)]
pub struct Labelling {
    /// One row per job whose record can be read, in the sweep's order.
    pub table: LabelTable,
    /// Number of jobs without a record.
    pub missing: usize,
    /// What is wrong with records that cannot be labelled.
    pub problems: Vec<String>,
    /// Identities of all jobs.
    pub(super) jobs: HashSet<String>,
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
        let kept = folder.kept_labels();
        let found = work::map(workers, jobs, |job| {
            let row = label(folder, sweep, job)?;
            let kept = kept.get(&job.id).cloned();
            // A table has the places of variants from what it names.
            let kept = kept.map(|row| LabelRow {
                values: job.values.clone(),
                ..row
            });
            Ok(row.or(kept))
        })?;
        let mut labelling = Self {
            table: LabelTable {
                family: sweep.family(),
                axes: sweep.axes.iter().map(|axis| axis.name.clone()).collect(),
                variants: sweep.variants(),
                rows: Vec::new(),
            },
            missing: 0,
            problems: Vec::new(),
            jobs: jobs.iter().map(|job| job.id.clone()).collect(),
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

/// A sieve that finds nothing in some runs, because these are shorter than its window.
#[derive(Clone, Debug, PartialEq)]
pub struct WithoutRoom {
    /// Name of the sieve.
    pub sieve: &'static str,
    /// Its window (s).
    pub window: f64,
    /// Number of runs that are too short.
    pub runs: usize,
    /// Duration of the longest of them (s).
    pub longest: f64,
}

/// What became of the labels of a results folder.
#[derive(Clone, Debug)]
pub struct Labelled {
    /// The labels, as written.
    pub table: LabelTable,
    /// Number of jobs without a record.
    pub missing: usize,
    /// What is wrong with records that cannot be labelled.
    pub problems: Vec<String>,
    /// How the labels differ from those that were there.
    pub since: Since,
}

/// How labels differ from those of before.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Since {
    /// There were no labels before.
    Nothing,
    /// Those of before cannot be read, for this reason.
    Unreadable(String),
    /// Runs that went from one label to another, and runs that had none.
    Labels {
        /// Number of runs, by label before and after.
        changes: BTreeMap<(Label, Label), usize>,
        /// Runs that only the new table has.
        new: usize,
        /// Runs that only the table of before has, as their records cannot be labelled any more.
        lost: usize,
        /// Runs that only the table of before has, as they are not of the sweep any more.
        unused: usize,
    },
}

/// Why a folder has no new labels.
#[derive(Debug, thiserror::Error)]
pub enum LabellingError {
    /// Labels would be lost that cannot be made again.
    #[error(
        "{}: the records of {lost} of its {rows} labels are not in {}, so that these labels would \
         be lost; bring the records back, use another folder, or remove the table first",
        table.display(), records.display()
    )]
    Lost {
        /// The table.
        table: PathBuf,
        /// Its rows.
        rows: usize,
        /// Those without a record.
        lost: usize,
        /// Where the records should be.
        records: PathBuf,
    },
    /// The system gives no threads.
    #[error("cannot start the workers: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// A table cannot be written.
    #[error(transparent)]
    Store(#[from] StoreError),
}

impl Refusal for LabellingError {
    fn is_refusal(&self) -> bool {
        matches!(self, Self::Lost { .. })
    }
}

impl Labelling {
    /// Writes `labels.csv` and `points.csv` of a folder of results, unless labels would be lost.
    ///
    /// # Errors
    /// [`LabellingError::Lost`], or if a table cannot be written.
    pub fn write(self, folder: &Folder) -> Result<Labelled, LabellingError> {
        let kept = self.table.rows.iter().map(|row| row.id.as_str());
        refuse_to_lose_labels(folder, kept)?;
        self.replace(folder)
    }

    /// The same for a folder of dumps, from which labels can always be made again.
    ///
    /// # Errors
    /// If a table cannot be written.
    pub fn replace(self, folder: &Folder) -> Result<Labelled, LabellingError> {
        let since = match folder.labels() {
            path if !path.exists() => Since::Nothing,
            _ => match folder.read_labels() {
                Ok(before) => {
                    let gone = rows_only_in(&before, &self.table);
                    let is_lost = |row: &&&LabelRow| self.jobs.contains(&row.id);
                    let lost = gone.iter().filter(is_lost).count();
                    Since::Labels {
                        changes: changes(&before, &self.table),
                        new: rows_only_in(&self.table, &before).len(),
                        lost,
                        unused: gone.len() - lost,
                    }
                }
                Err(error) => Since::Unreadable(error.to_string()),
            },
        };
        store::write_labels(&self.table, &folder.labels())?;
        store::write_points(&self.table, &folder.points())?;
        Ok(Labelled {
            table: self.table,
            missing: self.missing,
            problems: self.problems,
            since,
        })
    }
}

/// Refuses to replace a table of labels that cannot be made again, as of results that were
/// published without their records. The new table has the runs that are `kept`.
///
/// # Errors
/// [`LabellingError::Lost`].
pub fn refuse_to_lose_labels<'a>(
    folder: &Folder,
    kept: impl IntoIterator<Item = &'a str>,
) -> Result<(), LabellingError> {
    // A table that cannot be read need not be kept.
    let Ok(table) = folder.read_labels() else {
        return Ok(());
    };
    let kept: HashSet<&str> = kept.into_iter().collect();
    let is_lost = |id: &str| !kept.contains(id) && !folder.record(id).exists();
    match table.rows.iter().filter(|row| is_lost(&row.id)).count() {
        0 => Ok(()),
        lost => Err(LabellingError::Lost {
            table: folder.labels(),
            rows: table.rows.len(),
            lost,
            records: folder.records(),
        }),
    }
}

/// Rows of runs that another table has not.
fn rows_only_in<'a>(table: &'a LabelTable, other: &LabelTable) -> Vec<&'a LabelRow> {
    let known: HashSet<&str> = other.rows.iter().map(|row| row.id.as_str()).collect();
    let is_alone = |row: &&LabelRow| !known.contains(row.id.as_str());
    table.rows.iter().filter(is_alone).collect()
}

impl Sweep {
    /// Whether the sieves of the sweep can judge all of its jobs.
    ///
    /// # Errors
    /// Why they cannot.
    pub fn check_sieves(&self, jobs: &[Job]) -> Result<(), ClassifyError> {
        jobs.iter()
            .try_for_each(|job| self.sieves.check(&job.scene()))
    }

    /// Sieves that find nothing in some runs, or in all, because these are too short.
    pub fn sieves_without_room(&self, jobs: &[Job]) -> Vec<WithoutRoom> {
        let mut found: Vec<WithoutRoom> = Vec::new();
        for scene in jobs.iter().map(Job::scene) {
            let duration = scene.time.duration;
            for (sieve, window) in self.sieves.without_room(&scene) {
                match found.iter_mut().find(|known| known.sieve == sieve) {
                    Some(known) => {
                        known.runs += 1;
                        known.longest = known.longest.max(duration);
                    }
                    None => found.push(WithoutRoom {
                        sieve,
                        window,
                        runs: 1,
                        longest: duration,
                    }),
                }
            }
        }
        found
    }

    /// Keys in which the runs of this sweep differ from those of an edited one. Titles, thresholds,
    /// further columns and plot settings may differ.
    pub fn keys_of_other_runs(&self, edited: &Self) -> Vec<String> {
        let runs = |sweep: &Self| {
            let mut runs = Self {
                title: None,
                sieves: Sieves::default(),
                plot: PlotSettings::default(),
                ..sweep.clone()
            };
            runs.scene.title = None;
            for scene in runs.scenes_mut() {
                let Output {
                    usual,
                    columns,
                    profiles,
                    walls,
                    ..
                } = &mut scene.output;
                *usual = UsualColumns::default();
                columns.clear();
                profiles.clear();
                *walls = false;
                scene.forget_names_of_walls();
                scene.program = scene.program.take().map(ExternalProgram::without_limits);
            }
            runs
        };
        differing_keys(&runs(self), &runs(edited))
    }
}

/// How many runs went from one label to another, by label. Runs that only one of the tables has
/// do not count.
fn changes(before: &LabelTable, after: &LabelTable) -> BTreeMap<(Label, Label), usize> {
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
