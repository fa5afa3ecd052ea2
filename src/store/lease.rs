//! The right of one process to make a run that others may want to make too.

use super::lock::{Lock, hold, is_locked, look};
use serde::{Deserialize, Serialize};
use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::time::{SystemTime, UNIX_EPOCH};

/// Who has a lease: what the file says to people.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Holder {
    /// Number of the process.
    pub process: u32,
    /// When it was taken (seconds since 1970).
    pub since: u64,
}

/// The right to make a run: a file `NAME.lease` beside its record NAME.h5. Only one process can
/// make the file; it is locked while the process lives, and removed with the lease. One that a
/// process left behind is taken over.
#[derive(Debug)]
pub struct Lease(#[expect(dead_code, reason = "gives the lease back when it is dropped")] Lock);

impl Lease {
    /// Takes the lease of the run of that record. None if another process has it.
    ///
    /// # Errors
    /// If the file cannot be made.
    pub fn take(record: &Path) -> io::Result<Option<Self>> {
        let path = record.with_extension("lease");
        let made = OpenOptions::new().write(true).create_new(true).open(&path);
        let file = match made {
            Ok(file) => file,
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                match OpenOptions::new().write(true).open(&path) {
                    Ok(file) => file,
                    // Given back meanwhile: its record is there, or it is free the next time.
                    Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
                    Err(error) => return Err(error),
                }
            }
            Err(error) => return Err(error),
        };
        match look(|| Ok(is_locked(file.try_lock())?.then_some(())))? {
            Some(()) => Self::of_file(file, &path),
            None => Ok(None),
        }
    }

    /// The lease of a file that has been locked.
    fn of_file(file: File, path: &Path) -> io::Result<Option<Self>> {
        let Some(lock) = hold(file, path)? else {
            return Ok(None);
        };
        lock.write(&Holder::this_process())?;
        Ok(Some(Self(lock)))
    }

    /// Whether a process is making the run of that record.
    pub fn is_taken(record: &Path) -> bool {
        Lock::is_taken(&record.with_extension("lease"))
    }
}

impl Holder {
    fn this_process() -> Self {
        let since = SystemTime::now().duration_since(UNIX_EPOCH);
        Self {
            process: std::process::id(),
            since: since.map_or(0, |it| it.as_secs()),
        }
    }
}

impl Lock {
    /// Writes who has a file that is locked.
    fn write(&self, holder: &Holder) -> io::Result<()> {
        let mut file: &File = self.file();
        file.set_len(0)?;
        let text = serde_json::to_string(holder).map_err(io::Error::other)?;
        file.write_all(text.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Barrier;
    use std::thread;

    #[test]
    fn one_at_a_time_has_a_lease() {
        let folder = tempfile::tempdir().unwrap();
        let record = folder.path().join("0123.h5");
        let path = folder.path().join("0123.lease");
        let first = Lease::take(&record).unwrap().unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        let holder: Holder = serde_json::from_str(&text).unwrap();
        assert_eq!(holder.process, std::process::id());
        assert!(Lease::is_taken(&record));
        assert!(Lease::take(&record).unwrap().is_none());
        drop(first);
        assert!(!path.exists() && !Lease::is_taken(&record));
        // Left by a process that was killed.
        std::fs::write(&path, "{\"process\":1,\"since\":0}").unwrap();
        assert!(!Lease::is_taken(&record));
        let second = Lease::take(&record).unwrap();
        assert!(second.is_some() && Lease::is_taken(&record));
    }

    #[test]
    fn of_many_that_want_it_at_once_one_has_it() {
        let folder = tempfile::tempdir().unwrap();
        for round in 0..20 {
            let record = folder.path().join(format!("{round}.h5"));
            if round % 2 == 1 {
                std::fs::write(record.with_extension("lease"), "left behind").unwrap();
            }
            let start = Barrier::new(8);
            let taken = thread::scope(|scope| {
                let threads: Vec<_> = (0..8)
                    .map(|_| {
                        scope.spawn(|| {
                            start.wait();
                            let lease = Lease::take(&record).unwrap();
                            // Nobody gives it back before all have asked.
                            start.wait();
                            lease.is_some()
                        })
                    })
                    .collect();
                let taken = threads.into_iter().map(|it| it.join().unwrap());
                taken.filter(|it| *it).count()
            });
            assert_eq!(taken, 1, "{round}");
        }
    }
}
