//! Runs that write checkpoints, and continue from them.
//!
//! A checkpoint lies next to the future record, and is removed when the record is written. It is
//! written at frames only, and changes nothing: an interrupted run that is continued has the same
//! bits as an uninterrupted one.

use crate::record::RunRecord;
use crate::run::{Progress, Run};
use crate::simulation::StateError;
use crate::store::{self, CheckpointError, StoreError};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use std::{fs, io};

/// Default time between two checkpoints.
pub const DEFAULT_INTERVAL: Duration = Duration::from_mins(2);

/// Where a run leaves its checkpoint, and how often.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Checkpoints {
    path: PathBuf,
    interval: Duration,
}

/// How a run that leaves checkpoints came back.
#[derive(Debug)]
pub enum Ending {
    /// It ended; its checkpoint may go once the record is stored.
    Finished(Box<RunRecord>),
    /// It failed, and has no record; says why.
    Failed(String),
    /// It was asked to stop, and left a checkpoint, or what its program left itself.
    Interrupted,
    /// It was asked to stop so soon that the checkpoint of an earlier run was left in place.
    EarlierKept,
    /// It was asked to stop, and the checkpoint could not be written.
    Lost(StoreError),
}

impl Checkpoints {
    /// Checkpoints of the run of that record: `NAME.checkpoint` beside `NAME.h5`. One is due at the
    /// first frame after every `interval`.
    pub fn beside(record: &Path, interval: Duration) -> Self {
        // Records of other names are not cut: two that differ behind a dot have two checkpoints.
        let is_plain = record.extension().is_some_and(|it| it == "h5");
        let path = match is_plain {
            true => record.with_extension("checkpoint"),
            false => record.with_added_extension("checkpoint"),
        };
        Self { path, interval }
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Time between two checkpoints.
    pub fn interval(&self) -> Duration {
        self.interval
    }

    /// Continues a run that is at its start from the checkpoint. False if there is none.
    ///
    /// # Errors
    /// If no run can continue from the file; file and run stay as they were.
    pub fn restore(&self, run: &mut Run) -> Result<bool, CheckpointError> {
        if !run.can_be_saved() {
            return Ok(false);
        }
        let Some(checkpoint) = store::read_checkpoint(&self.path, run.scene())? else {
            return Ok(false);
        };
        match run.restore(checkpoint.state()) {
            Ok(()) => Ok(true),
            Err(StateError::OTHER_FORM) => {
                let reason = StateError::OTHER_FORM.0;
                Err(CheckpointError::damaged(&self.path, reason))
            }
            Err(error) => Err(CheckpointError::unfit(&self.path, error)),
        }
    }

    /// Runs to the end, and leaves checkpoints on the way. `control` decides after every frame
    /// whether to go on; `warn` reports a checkpoint that could not be written, without which the
    /// run goes on.
    ///
    /// A run from the start replaces the checkpoint of an earlier run, but not before the first one
    /// is due: who started it by mistake may stop it and loses nothing.
    pub fn run(
        &self,
        mut run: Run,
        control: &mut dyn FnMut(Progress) -> ControlFlow<()>,
        warn: &mut dyn FnMut(StoreError),
    ) -> Ending {
        let mut latest = Instant::now();
        let mut is_ours = run.progress().frame > 0 || !self.path.exists();
        while !run.ended() {
            run.advance_frame();
            let stop = control(run.progress()).is_break();
            if run.ended() {
                break;
            }
            if !run.can_be_saved() {
                match stop {
                    true => return Ending::Interrupted,
                    false => continue,
                }
            }
            let due = latest.elapsed() >= self.interval;
            if stop && !due && !is_ours {
                return Ending::EarlierKept;
            }
            if !(stop || due) {
                continue;
            }
            match (self.write(&run), stop) {
                (Ok(()), true) => return Ending::Interrupted,
                (Err(error), true) => return Ending::Lost(error),
                (Ok(()), false) => is_ours = true,
                (Err(error), false) => warn(error),
            }
            latest = Instant::now();
        }
        match run.failure() {
            Some(reason) => Ending::Failed(reason.to_owned()),
            None => Ending::Finished(Box::new(run.finish())),
        }
    }

    fn write(&self, run: &Run) -> Result<(), StoreError> {
        // Its folder may have been removed while the run went on. What fails here fails again in
        // writing, which says so.
        if let Some(folder) = self.path.parent() {
            let _ = fs::create_dir_all(folder);
        }
        store::write_checkpoint(&self.path, run)
    }

    /// Removes the file, if there is one.
    ///
    /// # Errors
    /// If the system does not allow it.
    pub fn remove(&self) -> Result<(), StoreError> {
        match fs::remove_file(&self.path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => Err(StoreError::Write {
                path: self.path.clone(),
                source,
            }),
            _ => Ok(()),
        }
    }
}
