//! The right to write where another process may want to write too.

use std::fs::{self, File, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

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

    /// Whether another process has locked a file.
    pub fn is_taken(path: &Path) -> bool {
        let lock = File::open(path).map(|file| file.try_lock_shared());
        matches!(lock, Ok(Err(TryLockError::WouldBlock)))
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

/// Makes and locks a file. None if another process has it locked.
fn lock(path: &Path) -> io::Result<Option<File>> {
    // `is_taken` of another process holds the lock for an instant, so one look is not enough.
    for _ in 0..10 {
        let file = File::create(path)?;
        match file.try_lock() {
            // Else its owner removed it since it was opened: another file has its name.
            Ok(()) if has_name(&file)? => return Ok(Some(file)),
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => std::thread::sleep(Duration::from_millis(20)),
            Err(TryLockError::Error(source)) => return Err(source),
        }
    }
    Ok(None)
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
