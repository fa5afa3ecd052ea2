//! Which process may write to a results folder.

use super::{Folder, FolderError, Sweep};
use crate::store::{self, Lock, retry};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The right to write to a results folder, given back when it is dropped.
#[derive(Debug)]
pub enum Access {
    /// No other process writes to it.
    Alone(Lock),
    /// Other processes run the same sweep.
    Shared(Lock),
}

/// How often a process tries to enter a folder, and the time in between: ten seconds in all.
const TRIES: usize = 50;
const BETWEEN_TRIES: Duration = Duration::from_millis(200);

/// How processes share a folder: each [enters](Folder::enter) it with its sweep. One that is alone
/// then may still change what the folder holds, until it [opens](Folder::open) the folder for
/// others that run the same sweep. What changes labels or runs everything again
/// [locks](Folder::lock) the folder and keeps all others out.
impl Folder {
    /// Takes the right to change the folder, which must exist, while no other process writes to it.
    ///
    /// # Errors
    /// [`FolderError::Locked`] if another process writes to it.
    pub fn lock(&self) -> Result<Lock, FolderError> {
        let lock = Lock::take(&self.lock_file()).map_err(self.io_error())?;
        lock.ok_or_else(|| FolderError::Locked(self.root().to_owned()))
    }

    /// Takes the right to run a sweep into the folder, which must exist: alone if no other process
    /// writes to it, or else beside those that run the same sweep. Waits some seconds for a process
    /// that has the folder alone.
    ///
    /// # Errors
    /// [`FolderError::Locked`] if another process changes the folder, or runs another sweep into
    /// it.
    pub fn enter(&self, sweep: &Sweep) -> Result<Access, FolderError> {
        let path = self.lock_file();
        let access = retry(TRIES, BETWEEN_TRIES, || {
            Ok(match Lock::take(&path)? {
                Some(lock) => Some(Access::Alone(lock)),
                None => Lock::share(&path)?.map(Access::Shared),
            })
        });
        match access.map_err(self.io_error())? {
            Some(Access::Shared(_)) if !self.is_run_with(sweep) => None,
            access => access,
        }
        .ok_or_else(|| FolderError::Locked(self.root().to_owned()))
    }

    /// Whether what is run into the folder goes together with a sweep: it is the same, or a study
    /// of the same grid. Which settings a study has may follow from its first runs.
    fn is_run_with(&self, sweep: &Sweep) -> bool {
        let basis = |sweep: &Sweep| match sweep.study {
            None => sweep.clone(),
            Some(_) => Sweep {
                axes: sweep.axes[..sweep.axes.len().saturating_sub(1)].to_vec(),
                ..sweep.clone()
            },
        };
        self.read_sweep().is_ok_and(|it| basis(&it) == basis(sweep))
    }

    /// Lets other processes run the same sweep into the folder. If no other process is there, what
    /// killed processes left behind is removed before.
    ///
    /// # Errors
    /// If the sweep cannot be written, or the right is lost.
    pub fn open(&self, access: Access, sweep: &Sweep) -> Result<Lock, FolderError> {
        let alone = match access {
            Access::Shared(lock) => return Ok(lock),
            Access::Alone(lock) => lock,
        };
        self.remove_leftovers()?;
        self.write_sweep(sweep)?;
        let shared = alone
            .into_shared(&self.lock_file())
            .map_err(self.io_error())?;
        shared.ok_or_else(|| FolderError::Locked(self.root().to_owned()))
    }

    /// Removes the temporary files and leases that killed processes left behind. Only a process
    /// that has the folder alone may call this.
    ///
    /// # Errors
    /// If the folder cannot be read or a file not be removed.
    pub fn remove_leftovers(&self) -> Result<(), FolderError> {
        store::remove_leftovers(self.root())?;
        store::remove_leftovers(&self.records())?;
        for entry in fs::read_dir(self.records()).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.extension().is_some_and(|it| it == "lease") {
                // One that cannot be removed is taken over.
                let _ = fs::remove_file(path);
            }
        }
        Ok(())
    }

    /// The sweep file that was last run into the folder on this machine, if it is known and there.
    pub fn source(&self) -> Option<PathBuf> {
        let text = fs::read_to_string(self.lock_file()).ok()?;
        let path = PathBuf::from(text.trim_end());
        path.is_file().then_some(path)
    }

    /// Notes which sweep file is run into the folder. Only a process that has the folder alone may
    /// call this. Of a path that no text can name nothing is noted.
    ///
    /// # Errors
    /// If the note cannot be written.
    pub fn note_source(&self, file: &Path) -> Result<(), FolderError> {
        let path = file.canonicalize().ok();
        let text = path.as_deref().and_then(Path::to_str).unwrap_or_default();
        fs::write(self.lock_file(), text).map_err(self.io_error())
    }

    /// Whether another process writes to the folder.
    pub fn is_locked(&self) -> bool {
        Lock::is_taken(&self.lock_file())
    }

    fn lock_file(&self) -> PathBuf {
        self.root().join(".lock")
    }

    fn io_error(&self) -> impl Fn(io::Error) -> FolderError + use<> {
        let path = self.lock_file();
        move |source| FolderError::Io {
            path: path.clone(),
            source,
        }
    }
}
