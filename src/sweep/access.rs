//! Which processes may write to a results folder, on any machine.

use super::{Folder, FolderError, Sweep};
use crate::store::{self, Holder, Lease, ProcessIdentity, Tenure};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

/// The right to write to a results folder, given back when it is dropped.
#[derive(Debug)]
pub struct Access {
    /// The door, which lets others in one by one: who keeps it is alone.
    door: Option<Lease>,
    _presence: Lease,
}

impl Access {
    /// Whether no other process writes to the folder.
    pub fn is_alone(&self) -> bool {
        self.door.is_some()
    }
}

/// How long a process waits at the door of a folder that another one has alone.
const AT_THE_DOOR: Duration = Duration::from_secs(10);
const BETWEEN_TRIES: Duration = Duration::from_millis(50);

/// How the name of the lease begins that says that a process is in a folder.
const PRESENCE: &str = ".at-work-";

/// The lease of who labels the runs.
const LABELS: &str = ".labels";

/// A sweep; of a study without its last axis, the settings.
fn without_settings(sweep: &Sweep) -> Sweep {
    match sweep.study {
        None => sweep.clone(),
        Some(_) => Sweep {
            axes: sweep.axes[..sweep.axes.len().saturating_sub(1)].to_vec(),
            ..sweep.clone()
        },
    }
}

/// How processes share a folder: each [enters](Folder::enter) it with its sweep. One that is alone
/// then may still change what the folder holds, until it [opens](Folder::open) the folder for
/// others that run the same sweep. What changes labels or runs everything again
/// [locks](Folder::lock) the folder and keeps all others out.
///
/// `wait` is called once if a process on another machine may be dead, which takes up to two minutes
/// to tell.
impl Folder {
    /// Takes the right to change the folder, which must exist, while no other process writes to it.
    ///
    /// # Errors
    /// [`FolderError::Locked`] if another process writes to it.
    pub fn lock(&self, wait: &dyn Fn(&Holder)) -> Result<Access, FolderError> {
        let door = self.pass_the_door(wait)?;
        match self.other_for_sure(wait)? {
            Some(other) => Err(self.locked_by(Some(other))),
            None => self.come_in(Some(door)),
        }
    }

    /// Takes the right to run a sweep into the folder, which must exist: alone if no other process
    /// writes to it, or else beside those that run the same sweep. Waits some seconds for a process
    /// that has the folder alone.
    ///
    /// # Errors
    /// [`FolderError::Locked`] if another process changes the folder, or runs another sweep into
    /// it.
    pub fn enter(&self, sweep: &Sweep, wait: &dyn Fn(&Holder)) -> Result<Access, FolderError> {
        let door = self.pass_the_door(wait)?;
        if self.at_work()?.is_empty() {
            return self.come_in(Some(door));
        }
        if self.is_run_with(sweep) {
            return self.come_in(None);
        }
        match self.other_for_sure(wait)? {
            Some(other) => Err(self.locked_by(Some(other))),
            None => self.come_in(Some(door)),
        }
    }

    /// Whether what is run into the folder goes together with a sweep: it is the same, or a study
    /// of the same grid. Which settings a study has may follow from its first runs.
    fn is_run_with(&self, sweep: &Sweep) -> bool {
        self.read_sweep()
            .is_ok_and(|it| without_settings(&it) == without_settings(sweep))
    }

    /// The study of the folder, if it is that of a sweep with more settings.
    pub(super) fn extension_of(&self, sweep: &Sweep) -> Option<Sweep> {
        let stored = self.read_sweep().ok().filter(|it| it.study.is_some())?;
        let [more, own] = [&stored, sweep].map(|it| it.axes.last().map(|axis| &axis.variants));
        let is_longer = more?.len() > own?.len() && more?.starts_with(own?);
        let is_extended = is_longer && without_settings(&stored) == without_settings(sweep);
        is_extended.then_some(stored)
    }

    /// Lets other processes run the same sweep into the folder. If no other process is there, what
    /// killed processes left behind is removed before.
    ///
    /// # Errors
    /// If the sweep cannot be written.
    pub fn open(&self, access: Access, sweep: &Sweep) -> Result<Access, FolderError> {
        if access.is_alone() {
            self.remove_leftovers()?;
            self.write_sweep(sweep)?;
        }
        Ok(Access {
            door: None,
            ..access
        })
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
            let name = entry.file_name();
            if name.to_str().and_then(Lease::name_of).is_some() {
                // One that cannot be removed is broken by who wants it.
                let _ = fs::remove_file(entry.path());
            }
        }
        for entry in fs::read_dir(self.root()).into_iter().flatten().flatten() {
            let name = entry.file_name();
            let Some(name) = name.to_str().and_then(Lease::name_of) else {
                continue;
            };
            // The door and this process's own lease are held.
            if !matches!(self.look_at(name), Tenure::Held(Some(_))) {
                let _ = fs::remove_file(entry.path());
            }
        }
        Ok(())
    }

    /// The processes that write to the folder now: one on another machine that gives no sign of
    /// life may be dead. Those that are dead for sure are removed.
    ///
    /// # Errors
    /// If the folder cannot be read.
    pub fn at_work(&self) -> Result<Vec<Holder>, FolderError> {
        let mut holders = Vec::new();
        for name in self.presences()? {
            if let Tenure::Held(Some(holder)) = self.look_at(&name) {
                holders.push(holder);
            }
        }
        Ok(holders)
    }

    /// Takes the right to label the runs of the folder. None if another process has it.
    ///
    /// # Errors
    /// If the file of the lease cannot be made.
    pub fn lease_of_labels(&self, wait: &dyn Fn(&Holder)) -> Result<Option<Lease>, FolderError> {
        let name = self.root().join(LABELS);
        loop {
            let taken = Lease::take(&name).map_err(|it| self.io_error(it))?;
            if taken.is_some() || matches!(Lease::watch(&name, wait), Tenure::Held(_)) {
                return Ok(taken);
            }
        }
    }

    /// The sweep file that was last run into the folder on this machine, if it is known and there.
    pub fn source(&self) -> Option<PathBuf> {
        let text = fs::read_to_string(self.source_file()).ok()?;
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
        let note = self.source_file();
        fs::write(&note, text).map_err(|source| FolderError::Io { path: note, source })
    }

    fn source_file(&self) -> PathBuf {
        self.root().join(".source")
    }

    /// Takes the lease that each process needs to come in.
    fn pass_the_door(&self, wait: &dyn Fn(&Holder)) -> Result<Lease, FolderError> {
        let name = self.root().join(".door");
        let begun = Instant::now();
        loop {
            if let Some(door) = Lease::take(&name).map_err(|it| self.io_error(it))? {
                return Ok(door);
            }
            if begun.elapsed() > AT_THE_DOOR {
                self.begin_to_watch()?;
                if let Tenure::Held(holder) = Lease::watch(&name, wait) {
                    return Err(self.locked_by(holder));
                }
            }
            thread::sleep(BETWEEN_TRIES);
        }
    }

    /// Says that this process is in the folder.
    fn come_in(&self, door: Option<Lease>) -> Result<Access, FolderError> {
        static ENTRANCES: AtomicUsize = AtomicUsize::new(0);
        let process = ProcessIdentity::this();
        let entrance = ENTRANCES.fetch_add(1, Ordering::Relaxed);
        let name = format!("{PRESENCE}{}-{}-{entrance}", process.host, process.number);
        let presence = Lease::take(&self.root().join(name)).map_err(|it| self.io_error(it))?;
        match presence {
            Some(presence) => Ok(Access {
                door,
                _presence: presence,
            }),
            None => Err(self.locked_by(None)),
        }
    }

    /// Another process that is known to live. Watches those that are not.
    fn other_for_sure(&self, wait: &dyn Fn(&Holder)) -> Result<Option<Holder>, FolderError> {
        self.begin_to_watch()?;
        for name in self.presences()? {
            if let Tenure::Held(Some(holder)) = Lease::watch(&self.root().join(&name), wait) {
                return Ok(Some(holder));
            }
        }
        Ok(None)
    }

    /// Watches all leases from now on, so that those of dead processes are not waited for one after
    /// the other.
    fn begin_to_watch(&self) -> Result<(), FolderError> {
        for name in self.presences()?.iter().map(String::as_str).chain([LABELS]) {
            Lease::tenure(&self.root().join(name));
        }
        Ok(())
    }

    /// The names of the leases of processes that said that they are in the folder.
    fn presences(&self) -> Result<Vec<String>, FolderError> {
        let entries = fs::read_dir(self.root()).map_err(|it| self.io_error(it))?;
        let mut names = Vec::new();
        for entry in entries {
            let file = entry.map_err(|it| self.io_error(it))?.file_name();
            let name = file.to_str().and_then(Lease::name_of);
            names.extend(
                name.filter(|it| it.starts_with(PRESENCE))
                    .map(str::to_owned),
            );
        }
        Ok(names)
    }

    /// Looks at the lease of a process, and removes it if that process is dead.
    fn look_at(&self, name: &str) -> Tenure {
        let name = self.root().join(name);
        let tenure = Lease::tenure(&name);
        if matches!(tenure, Tenure::Stale(_)) {
            // Whoever takes it gives it back.
            drop(Lease::take(&name));
        }
        tenure
    }

    fn locked_by(&self, holder: Option<Holder>) -> FolderError {
        FolderError::Locked {
            path: self.root().to_owned(),
            holder: holder.map(Box::new),
        }
    }

    fn io_error(&self, source: io::Error) -> FolderError {
        FolderError::Io {
            path: self.root().to_owned(),
            source,
        }
    }
}
