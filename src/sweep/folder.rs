//! The results folder of a sweep: what lies where in it.

use super::plan::standing;
use super::{Job, Refining, Standing, Sweep, read_failures};
use crate::classify::{LabelRow, LabelTable};
use crate::external::RunFolder;
use crate::grid::Axis;
use crate::record::RunRecord;
use crate::refusal::Refusal;
use crate::resume::Checkpoints;
use crate::store::{self, Holder, StoreError};
use serde::Serialize;
use serde_json::Value;
use std::collections::{HashMap, HashSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The results folder of a sweep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folder {
    root: PathBuf,
    /// Whether runs that have a label count as done without their records.
    keeps_labels: bool,
}

/// What can be wrong with a results folder.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// Nothing is at the path.
    #[error("{}: there is no such file or folder; check the path", .0.display())]
    Missing(PathBuf),
    /// The path is a file.
    #[error(
        "{}: this is a file; give the results folder that `phase sweep` made, or one of them all",
        .0.display()
    )]
    NotAFolder(PathBuf),
    /// Neither the folder nor those in it are results of a sweep.
    #[error(
        "{}: neither this folder nor one in it holds a sweep.json; give the results folder that \
         `phase sweep` made",
        .0.display()
    )]
    NoSweep(PathBuf),
    /// There are results, but `sweep.json` is not there, or no file.
    #[error("{}: {reason}", path.display())]
    NoFile {
        /// The file.
        path: PathBuf,
        /// What is there in its place, and what to do.
        reason: &'static str,
    },
    /// `sweep.json` holds a sweep of another version.
    #[error(
        "{}: not a sweep of this version of phase ({reason}); run `phase sweep` again",
        path.display()
    )]
    BadSweep {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// `sweep.json` is not of this program, or damaged.
    #[error(
        "{}: this is no sweep of phase ({reason}); give the results folder that `phase sweep` \
         made, or move the file away and run `phase sweep` again",
        path.display()
    )]
    NotASweep {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// Another process writes to the folder.
    #[error(
        "{}: another `phase` is at work in this folder{}; wait until it ends, or choose another \
         folder with --out",
        path.display(),
        holder.as_ref().map(|it| format!(", {it}")).unwrap_or_default()
    )]
    Locked {
        /// The folder.
        path: PathBuf,
        /// Which process, if it is known.
        holder: Option<Box<Holder>>,
    },
    /// The file system says no.
    #[error("{}: {source}{}", path.display(), store::advice(source))]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A file of the folder cannot be read or written.
    #[error(transparent)]
    Store(#[from] store::StoreError),
}

/// A path that leads to no results, or a folder in use. What a results folder holds is no fault of
/// who names it.
impl Refusal for FolderError {
    fn is_refusal(&self) -> bool {
        matches!(
            self,
            Self::Missing(_) | Self::NotAFolder(_) | Self::NoSweep(_) | Self::Locked { .. }
        )
    }
}

impl Folder {
    /// The results folder at `root`, which need not exist yet.
    pub fn new(root: impl Into<PathBuf>) -> Self {
        Self {
            root: root.into(),
            keeps_labels: false,
        }
    }

    /// The same folder, in which runs that have a label count as done without their records.
    pub fn keeping_labels(self) -> Self {
        Self {
            keeps_labels: true,
            ..self
        }
    }

    /// The labels that count without records, by the identities of their runs.
    pub(super) fn kept_labels(&self) -> HashMap<String, LabelRow> {
        let table = self.keeps_labels.then(|| self.read_labels());
        let rows = table.and_then(Result::ok).map(|table| table.rows);
        let rows = rows.unwrap_or_default().into_iter();
        rows.map(|row| (row.id.clone(), row)).collect()
    }

    /// The results folder at `path`, or all of them that lie directly in it, by name. A folder of
    /// results counts even if its `sweep.json` is missing or is no file: reading it says why.
    ///
    /// # Errors
    /// If there is none.
    pub fn find(path: &Path) -> Result<Vec<Self>, FolderError> {
        if !path.is_dir() {
            let path = path.to_owned();
            return Err(match path.exists() {
                true => FolderError::NotAFolder(path),
                false => FolderError::Missing(path),
            });
        }
        let folder = Self::new(path);
        if folder.holds_sweep() {
            return Ok(vec![folder]);
        }
        let io_error = |source| FolderError::Io {
            path: path.to_owned(),
            source,
        };
        let mut found = Vec::new();
        for entry in fs::read_dir(path).map_err(io_error)? {
            let folder = Self::new(entry.map_err(io_error)?.path());
            if folder.holds_sweep() || folder.holds_results() {
                found.push(folder);
            }
        }
        if found.is_empty() {
            return Err(FolderError::NoSweep(path.to_owned()));
        }
        found.sort_by(|a, b| a.root.cmp(&b.root));
        Ok(found)
    }

    /// Whether something has the name of the resolved sweep, or may have it: the system does not
    /// let everybody look into every folder.
    fn holds_sweep(&self) -> bool {
        match self.sweep().symlink_metadata() {
            Ok(_) => true,
            Err(error) => error.kind() == io::ErrorKind::PermissionDenied,
        }
    }

    /// Whether a sweep has left labels or records here. Dumps may have labels, too.
    fn holds_results(&self) -> bool {
        let of_end = |folder: &Path, end: &str| {
            let entries = fs::read_dir(folder).into_iter().flatten().flatten();
            let mut paths = entries.map(|entry| entry.path());
            paths.any(|path| path.extension().is_some_and(|it| it == end))
        };
        let labels = self.labels();
        let has_labels = labels.is_file() && store::is_own_file(&labels);
        of_end(&self.records(), "h5") || (has_labels && !of_end(&self.root, "npy"))
    }

    /// The folder itself.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The resolved sweep.
    pub fn sweep(&self) -> PathBuf {
        self.root.join("sweep.json")
    }

    /// How far the refining of the sweep is.
    pub fn progress(&self) -> PathBuf {
        self.root.join("progress.json")
    }

    /// The folder of all records.
    pub fn records(&self) -> PathBuf {
        self.root.join("records")
    }

    /// The record of the run with that identity.
    pub fn record(&self, id: &str) -> PathBuf {
        self.records().join(format!("{id}.h5"))
    }

    /// Identities of the runs that have a record, good or not, from one look at the folder.
    ///
    /// # Errors
    /// If there is such a folder, but it cannot be read.
    pub fn recorded(&self) -> Result<HashSet<String>, FolderError> {
        self.files_of_runs(".h5")
    }

    /// Identities of the runs that have a checkpoint, from one look at the folder.
    pub(super) fn with_checkpoint(&self) -> Result<HashSet<String>, FolderError> {
        self.files_of_runs(".checkpoint")
    }

    /// Whether a job has a good record.
    pub(super) fn is_done(&self, job: &Job) -> bool {
        matches!(standing(job, &self.record(&job.id)), Standing::Done(_))
    }

    /// Identities of the runs that have a file with this end of its name beside the records.
    fn files_of_runs(&self, end: &str) -> Result<HashSet<String>, FolderError> {
        let path = self.records();
        let io_error = |source| FolderError::Io {
            path: path.clone(),
            source,
        };
        let entries = match fs::read_dir(&path) {
            Ok(entries) => entries,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(HashSet::new()),
            Err(error) => return Err(io_error(error)),
        };
        let mut ids = HashSet::new();
        for entry in entries {
            let name = entry.map_err(io_error)?.file_name();
            let id = name.to_str().and_then(|name| name.strip_suffix(end));
            ids.extend(id.map(str::to_owned));
        }
        Ok(ids)
    }

    /// Number of jobs that have neither a record, nor a label that counts without one, nor a
    /// failure.
    ///
    /// # Errors
    /// If the folder or its table of failures cannot be read.
    pub(super) fn lacking(&self, jobs: &[&Job], axes: &[Axis]) -> Result<usize, FolderError> {
        let mut there = self.recorded()?;
        there.extend(self.kept_labels().into_keys());
        let failures = read_failures(axes, &self.failures())?;
        there.extend(failures.into_iter().map(|failure| failure.id));
        Ok(jobs.iter().filter(|job| !there.contains(&job.id)).count())
    }

    /// The name of the lease of the run with that identity.
    pub(super) fn lease(&self, id: &str) -> PathBuf {
        self.records().join(id)
    }

    /// The checkpoints of the run with that identity, beside its record.
    pub fn checkpoints(&self, id: &str, interval: Duration) -> Checkpoints {
        Checkpoints::beside(&self.record(id), interval)
    }

    /// The folder in which the program of the run with that identity runs.
    pub fn run_folder(&self, id: &str) -> RunFolder {
        RunFolder::of_sweep(&self.record(id))
    }

    /// Reads the record of the run with that identity.
    ///
    /// # Errors
    /// Those of [`store::read_record`], or [`StoreError::OtherRun`] if the record is of another
    /// run.
    pub fn read_record(&self, id: &str) -> Result<RunRecord, StoreError> {
        let path = self.record(id);
        let record = store::read_record(&path)?;
        match record.scene.identity() {
            found if found == id => Ok(record),
            found => Err(StoreError::OtherRun { path, found }),
        }
    }

    /// The table of labels, one row per job.
    pub fn labels(&self) -> PathBuf {
        self.root.join("labels.csv")
    }

    /// Reads the table of labels, as the sweep of the folder names them.
    ///
    /// # Errors
    /// Those of [`store::read_labels`].
    pub fn read_labels(&self) -> Result<LabelTable, StoreError> {
        let family = self.read_sweep().ok().map(|sweep| sweep.family());
        store::read_labels_of(&self.labels(), family)
    }

    /// The table of the runs of a study, one row per run.
    pub fn runs(&self) -> PathBuf {
        self.root.join("runs.csv")
    }

    /// The table of points, one row per point of the grid.
    pub fn points(&self) -> PathBuf {
        self.root.join("points.csv")
    }

    /// The table of probabilities of a refined sweep, one row per point of the grid.
    pub fn refined(&self) -> PathBuf {
        self.root.join("refined.csv")
    }

    /// The table of borders of a refined sweep.
    pub fn borders(&self) -> PathBuf {
        self.root.join("borders.csv")
    }

    /// The table of failed jobs; absent if none failed.
    pub fn failures(&self) -> PathBuf {
        self.root.join("failed.csv")
    }

    /// Makes the folder and the one for records, if they are not there.
    ///
    /// # Errors
    /// If the system does not allow it.
    pub fn create(&self) -> Result<(), FolderError> {
        let path = self.records();
        fs::create_dir_all(&path).map_err(|source| FolderError::Io { path, source })
    }

    /// Reads the resolved sweep.
    ///
    /// # Errors
    /// If `sweep.json` is absent or does not hold a sweep.
    pub fn read_sweep(&self) -> Result<Sweep, FolderError> {
        let path = self.sweep();
        match fs::read(&path) {
            Ok(text) => sweep_of(&text).map_err(|error| bad(path, error.to_string())),
            Err(source) => Err(match in_place_of_file(&path, &source) {
                Some(reason) => FolderError::NoFile { path, reason },
                None => FolderError::Io { path, source },
            }),
        }
    }

    /// Writes the resolved sweep, unless the file says the same already.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_sweep(&self, sweep: &Sweep) -> Result<(), FolderError> {
        write_unless_equal(&self.sweep(), sweep)
    }

    /// How far the refining of the folder's sweep is: none if the sweep is not refined, and the
    /// beginning if what the folder keeps is of another one.
    ///
    /// # Errors
    /// If `progress.json` is there and does not hold the progress of the sweep.
    pub fn read_refining(&self, sweep: &Sweep) -> Result<Option<Refining>, FolderError> {
        if sweep.refine.is_none() {
            return Ok(None);
        }
        let path = self.progress();
        let text = match fs::read(&path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Ok(Some(Refining::new(sweep)));
            }
            Err(source) => return Err(FolderError::Io { path, source }),
        };
        let stored: Refining =
            serde_json::from_slice(&text).map_err(|error| bad(path.clone(), error.to_string()))?;
        if stored.basis != sweep.basis_of_runs() {
            return Ok(Some(Refining::new(sweep)));
        }
        match stored.check(sweep) {
            Ok(()) => Ok(Some(stored)),
            Err(reason) => Err(bad(path, reason)),
        }
    }

    /// Writes how far refining is, unless the file says the same already.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_refining(&self, refining: &Refining) -> Result<(), FolderError> {
        write_unless_equal(&self.progress(), refining)
    }
}

/// Sieves that are rules by now, with their default thresholds, which the rules have too.
const FORMER_SIEVES: [(&str, &str, f64); 3] = [
    ("emptied", "share", 0.95),
    ("drained", "share", 0.95),
    ("stagnant", "height", 3.0),
];

/// A sweep as a folder holds it.
fn sweep_of(text: &[u8]) -> serde_json::Result<Sweep> {
    serde_json::from_slice(text).or_else(|error| {
        let mut tree: Value = serde_json::from_slice(text)?;
        let Some(sieves) = tree.get_mut("sieves").and_then(Value::as_object_mut) else {
            return Err(error);
        };
        for (name, key, default) in FORMER_SIEVES {
            if sieves.get(name).is_some_and(|it| it[key] == default) {
                sieves.remove(name);
            }
        }
        serde_json::from_value(tree).map_err(|_| error)
    })
}

/// The error of a file that does not hold what it should.
fn bad(path: PathBuf, reason: String) -> FolderError {
    match store::is_own_file(&path) {
        true => FolderError::BadSweep { path, reason },
        false => FolderError::NotASweep { path, reason },
    }
}

/// Writes a file of JSON, unless it says the same already.
fn write_unless_equal(path: &Path, content: &impl Serialize) -> Result<(), FolderError> {
    let mut text =
        serde_json::to_string_pretty(content).expect("a sweep holds no map with odd keys");
    text.push('\n');
    if fs::read(path).is_ok_and(|stored| stored == text.as_bytes()) {
        return Ok(());
    }
    Ok(store::write_atomic(path, text.as_bytes())?)
}

/// What is there in the place of a file that cannot be read, if it is not just the system that says
/// no; and what to do.
fn in_place_of_file(path: &Path, error: &io::Error) -> Option<&'static str> {
    match error.kind() {
        _ if path.is_dir() => Some("this is a folder in the place of a file; move it away"),
        io::ErrorKind::NotFound if path.is_symlink() => {
            Some("this link leads nowhere; bring back the file that it names")
        }
        io::ErrorKind::NotFound => {
            Some("this file is missing; bring it back, or run `phase sweep` into this folder again")
        }
        _ => None,
    }
}
