//! The right to write where another process may want to write too.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

/// Tries up to `tries` times, with a pause in between, until `attempt` gives something.
pub(crate) fn retry<T, E>(
    tries: usize,
    pause: Duration,
    mut attempt: impl FnMut() -> Result<Option<T>, E>,
) -> Result<Option<T>, E> {
    for number in 0..tries {
        if number > 0 {
            thread::sleep(pause);
        }
        if let Some(found) = attempt()? {
            return Ok(Some(found));
        }
    }
    Ok(None)
}

/// Tries for a lock a few times: a process that only looks whether a file [is
/// locked](Lock::is_taken) holds the lock for an instant.
pub(super) fn look<T>(attempt: impl FnMut() -> io::Result<Option<T>>) -> io::Result<Option<T>> {
    retry(5, Duration::from_millis(4), attempt)
}

/// Whether a try for a lock has it, and no other process is in the way.
pub(super) fn is_locked(tried: Result<(), TryLockError>) -> io::Result<bool> {
    match tried {
        Ok(()) => Ok(true),
        Err(TryLockError::WouldBlock) => Ok(false),
        Err(TryLockError::Error(source)) => Err(source),
    }
}

/// The right to write to a place: a locked file. Unlocked when dropped, or however the process
/// ends.
#[derive(Debug)]
pub struct Lock {
    file: File,
    /// The path of the file, if it is removed with the lock.
    passing: Option<PathBuf>,
}

impl Lock {
    /// Locks a file, which is made if it is absent, and stays. None if another process has locked
    /// it.
    ///
    /// # Errors
    /// If the file cannot be made or locked.
    pub fn take(path: &Path) -> io::Result<Option<Self>> {
        let file = lock(path)?;
        let passing = None;
        Ok(file.map(|file| Self { file, passing }))
    }

    /// Takes the right to write a file NAME: locks `.NAME.lock` beside it, which is removed with
    /// the lock. None if another process has locked it.
    ///
    /// # Errors
    /// Those of [`Lock::take`].
    pub fn take_beside(file: &Path) -> io::Result<Option<Self>> {
        let mut name = std::ffi::OsString::from(".");
        name.push(file.file_name().unwrap_or_default());
        name.push(".lock");
        let path = file.with_file_name(name);
        let file = lock(&path)?;
        let passing = Some(path);
        Ok(file.map(|file| Self { file, passing }))
    }

    /// Shares the lock of a file with others. `None` if another process has [taken](Self::take) it
    /// alone.
    ///
    /// # Errors
    /// If the file cannot be made or locked.
    pub fn share(path: &Path) -> io::Result<Option<Self>> {
        let file = locked(path, File::try_lock_shared)?;
        let passing = None;
        Ok(file.map(|file| Self { file, passing }))
    }

    /// Lets others share a file that was taken alone.
    ///
    /// # Errors
    /// If it cannot be locked again.
    pub fn into_shared(self, path: &Path) -> io::Result<Option<Self>> {
        drop(self);
        Self::share(path)
    }

    /// Whether another process has locked a file, alone or with others.
    pub fn is_taken(path: &Path) -> bool {
        let lock = File::open(path).map(|file| file.try_lock());
        matches!(lock, Ok(Err(TryLockError::WouldBlock)))
    }

    /// The file.
    pub(super) fn file(&self) -> &File {
        &self.file
    }

    /// Unlocks the file. If it is to be removed, it is removed first, so that no other process can
    /// lock it under this name.
    fn give_back(&self) -> io::Result<()> {
        if let Some(path) = &self.passing {
            fs::remove_file(path)?;
        }
        self.file.unlock()
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // If it cannot be removed, an empty file stays, which does no harm.
        let _ = self.give_back();
    }
}

/// Takes a file that this process has locked, unless it has lost its name since it was opened. It
/// is removed with the lock.
pub(super) fn hold(file: File, path: &Path) -> io::Result<Option<Lock>> {
    let passing = Some(path.to_owned());
    Ok(has_name(&file)?.then_some(Lock { file, passing }))
}

/// Makes and locks a file alone. None if another process has it locked.
fn lock(path: &Path) -> io::Result<Option<File>> {
    locked(path, File::try_lock)
}

/// Makes a file and locks it in one of two ways. None if another process is in the way.
fn locked(
    path: &Path,
    lock: impl Fn(&File) -> Result<(), TryLockError>,
) -> io::Result<Option<File>> {
    look(|| {
        let file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)?;
        // One without a name was removed by its owner since it was opened.
        let is_ours = is_locked(lock(&file))? && has_name(&file)?;
        Ok(is_ours.then_some(file))
    })
}

/// Whether a file can still be found under a name.
#[cfg(unix)]
fn has_name(file: &File) -> io::Result<bool> {
    Ok(std::os::unix::fs::MetadataExt::nlink(&file.metadata()?) > 0)
}

/// Open files cannot be removed here.
#[cfg(not(unix))]
fn has_name(_: &File) -> io::Result<bool> {
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_at_a_time_has_the_right() {
        let folder = tempfile::tempdir().unwrap();
        let record = folder.path().join("tank.h5");
        let first = Lock::take_beside(&record).unwrap().unwrap();
        let path = folder.path().join(".tank.h5.lock");
        assert!(Lock::is_taken(&path));
        assert!(Lock::take_beside(&record).unwrap().is_none());
        drop(first);
        assert!(!path.exists());
        let second = Lock::take_beside(&record).unwrap();
        assert!(second.is_some() && path.exists());
    }

    /// While a file is locked alone, as by a long `phase classify`, nobody shares it.
    #[test]
    fn a_file_is_locked_alone_or_shared() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lock");
        let alone = Lock::take(&path).unwrap().unwrap();
        assert!(Lock::share(&path).unwrap().is_none());
        let shared = alone.into_shared(&path).unwrap().unwrap();
        let other = Lock::share(&path).unwrap().unwrap();
        assert!(Lock::take(&path).unwrap().is_none());
        drop(shared);
        assert!(Lock::take(&path).unwrap().is_none());
        drop(other);
        assert!(Lock::take(&path).unwrap().is_some());
    }

    /// A process that opened the file before its owner removed it would hold a lock that no other
    /// process sees.
    #[cfg(unix)]
    #[test]
    fn a_removed_file_has_no_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("lock");
        let file = File::create(&path).unwrap();
        assert!(has_name(&file).unwrap());
        fs::remove_file(&path).unwrap();
        assert!(!has_name(&file).unwrap());
    }
}
