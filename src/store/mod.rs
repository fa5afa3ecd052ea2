//! Files: run records (HDF5), checkpoints of runs, tables (CSV), states for other programs (XYZ,
//! VTK, NPY, CSV, SVG, pages). One file per format, the only place that knows it.
//!
//! Whatever is written here appears whole or not at all (see [`write_atomic`]).

mod atomic;
mod checkpoint;
mod data_set;
mod dump;
mod export;
mod hashed;
mod import;
mod labels;
mod lease;
mod own;
mod process;
mod record;
mod refined;
mod rows;
pub(crate) mod zip;

pub use crate::document::advice;
pub use atomic::{check_writable, remove_leftovers, write_atomic};
pub use checkpoint::{
    CHECKPOINT_SIGNATURE, Checkpoint, CheckpointError, read_checkpoint, write_checkpoint,
};
pub use data_set::{DataSet, read_data_set};
pub use dump::{DumpName, read_dump, write_dump};
pub use export::{
    ARRAYS, PAGE_SIGNATURE, SPHERES_SIGNATURE, VTK_SIGNATURE, frame_name, vtk_names, write_arrays,
    write_fixed, write_fixed_xyz, write_observations, write_page, write_spheres, write_svg,
    write_vtk, write_xyz,
};
pub use import::read_states;
pub use labels::{read_labels, read_labels_of, write_labels, write_points};
pub use lease::{Holder, Lease, Tenure};
pub use own::is_own_file;
pub use process::ProcessIdentity;
pub use record::{
    HDF5_SIGNATURE, RecordHeader, content_digest, motion_digest, read_record, read_record_header,
    write_record, write_record_and_drop_states,
};
pub use refined::{BorderRow, write_borders, write_probabilities};
pub use rows::write_rows;

use crate::refusal::Refusal;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

/// Why a file could not be read or written: which file, what about it, and what to do.
#[derive(Debug, thiserror::Error)]
pub enum StoreError {
    /// The file cannot be read: it is not there, or it says something it must not.
    #[error("{0}")]
    Read(String),
    /// The file cannot be written, for a reason other than space.
    #[error("cannot write {}: {source}{}", path.display(), advice(source))]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// There is no room for the file.
    #[error(
        "disk full while writing {} ({source}); nothing already written is lost; \
         free space and run the same command again",
        path.display()
    )]
    DiskFull {
        /// The file.
        path: PathBuf,
        /// What the system said: no space, quota exceeded or file too large.
        source: io::Error,
    },
    /// The record is not what was once written.
    #[error("{} is damaged: {reason}; the run must be made again", path.display())]
    Damaged {
        /// The record.
        path: PathBuf,
        /// What shows it.
        reason: String,
    },
    /// The file is something other than a run record.
    #[error("{} is not a run record of phase: {reason}", path.display())]
    NotARecord {
        /// The file.
        path: PathBuf,
        /// What shows it.
        reason: String,
    },
    /// The record is of another run than its name says.
    #[error(
        "{} holds another run than its name says ({found}); remove it and run the sweep again",
        path.display()
    )]
    OtherRun {
        /// The record.
        path: PathBuf,
        /// Identity of the run it holds.
        found: String,
    },
    /// What should be stored does not fit together, or does not fit the format.
    #[error("cannot write {}: {reason}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        reason: String,
    },
}

/// What cannot be read was asked for; what cannot be written is no fault of who asked.
impl Refusal for StoreError {
    fn is_refusal(&self) -> bool {
        !matches!(
            self,
            Self::Write { .. } | Self::DiskFull { .. } | Self::Content { .. }
        )
    }
}

impl StoreError {
    /// Whether no other file can be written there either: the disk is full, or the quota is spent.
    /// Any other reason concerns one file alone.
    pub fn concerns_all_files(&self) -> bool {
        use io::ErrorKind::{QuotaExceeded, StorageFull};
        let Self::DiskFull { source, .. } = self else {
            return false;
        };
        matches!(source.kind(), QuotaExceeded | StorageFull)
    }

    pub(crate) fn reading(path: &Path, source: io::Error) -> Self {
        let file = path.display();
        Self::Read(format!("cannot read {file}: {source}{}", advice(&source)))
    }

    pub(crate) fn writing(path: &Path, source: io::Error) -> Self {
        use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
        let path = path.to_owned();
        match source.kind() {
            StorageFull | QuotaExceeded | FileTooLarge => Self::DiskFull { path, source },
            _ => Self::Write { path, source },
        }
    }

    fn damaged(path: &Path, reason: impl ToString) -> Self {
        Self::Damaged {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }

    pub(crate) fn content(path: &Path, reason: impl ToString) -> Self {
        Self::Content {
            path: path.to_owned(),
            reason: reason.to_string(),
        }
    }

    /// What is wrong at a line, from 1, of a text file.
    pub(crate) fn text(path: &Path, line: u64, reason: impl Display) -> Self {
        Self::Read(format!("{}:{line}: {reason}", path.display()))
    }
}
