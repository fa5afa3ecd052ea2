//! Files that appear whole or not at all.

use super::StoreError;
use super::process::{ProcessIdentity, is_alive};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use tempfile::NamedTempFile;

/// How the name of an unfinished file begins. The machine and the process that write it follow.
const PREFIX: &str = ".phase-";
/// How the name of an unfinished file ends.
const SUFFIX: &str = ".tmp";

/// Writes `bytes` to `path`, replacing what was there, all or nothing.
///
/// The bytes go to a temporary file in the same folder, which is made durable and then
/// renamed. Whenever the program or the machine stops, `path` holds either the old content or
/// the new one.
///
/// # Errors
/// [`StoreError::DiskFull`] or [`StoreError::Write`]; the old content is still there.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    replace(path, Durable::Yes, |file| file.write_all(bytes))
        .map_err(|error| StoreError::writing(path, error))
}

/// The same for one of many files that can be made again: it is not made durable, which takes
/// longer than all the rest. After a crash of the machine, not of the program, it may be empty.
///
/// # Errors
/// As for [`write_atomic`].
pub(super) fn write_one_of_many(path: &Path, bytes: &[u8]) -> Result<(), StoreError> {
    replace(path, Durable::No, |file| file.write_all(bytes))
        .map_err(|error| StoreError::writing(path, error))
}

/// The same for a file too large to be in memory: `fill` writes it.
///
/// # Errors
/// As for [`write_atomic`].
pub(super) fn write_atomic_with(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<&mut File>) -> io::Result<()>,
) -> Result<(), StoreError> {
    replace(path, Durable::Yes, |file| {
        let mut buffer = BufWriter::new(file);
        fill(&mut buffer)?;
        buffer.flush()
    })
    .map_err(|error| StoreError::writing(path, error))
}

/// Whether a file is made durable before it gets its name.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Durable {
    Yes,
    No,
}

fn replace(
    path: &Path,
    durable: Durable,
    fill: impl FnOnce(&mut File) -> io::Result<()>,
) -> io::Result<()> {
    let folder = folder_of(path);
    remove_those_of_the_dead(folder);
    let mut temporary = temporary_in(folder)?;
    fill(temporary.as_file_mut())?;
    if durable == Durable::Yes {
        temporary.as_file().sync_all()?;
    }
    temporary.persist(path)?;
    // The new name must be durable too; only Unix can open a folder for that.
    #[cfg(unix)]
    if durable == Durable::Yes {
        File::open(folder)?.sync_all()?;
    }
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// The name of an unfinished file of this process beside a file.
pub(super) fn unfinished_beside(path: &Path) -> PathBuf {
    static FILES: AtomicU64 = AtomicU64::new(0);
    let (process, number) = (std::process::id(), FILES.fetch_add(1, Ordering::Relaxed));
    let name = format!("{PREFIX}{}-{process}-lease-{number}{SUFFIX}", machine());
    folder_of(path).join(name)
}

/// An unfinished file in a folder.
fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let prefix = format!("{PREFIX}{}-{}-", machine(), std::process::id());
    let mut builder = tempfile::Builder::new();
    builder.prefix(&prefix).suffix(SUFFIX);
    // Temporary files are private by default; results are as readable as other files.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder)
}

/// Checks whether [`write_atomic`] could replace a file, as far as that can be told before.
///
/// # Errors
/// [`StoreError::Write`] if a folder is in the place of the file, or nothing can be written to its
/// folder.
pub fn check_writable(path: &Path) -> Result<(), StoreError> {
    let tried = match path.is_dir() {
        true => Err(io::ErrorKind::IsADirectory.into()),
        false => temporary_in(folder_of(path)).map(drop),
    };
    tried.map_err(|error| StoreError::writing(path, error))
}

/// Before this process first writes to a folder: removes the temporary files that processes of this
/// machine left there when they were killed. What cannot be removed stays and does no harm.
fn remove_those_of_the_dead(folder: &Path) {
    static CLEANED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let mut cleaned = CLEANED.lock().unwrap_or_else(PoisonError::into_inner);
    if !cleaned.insert(folder.to_owned()) {
        return;
    }
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        if writer_of(&name.to_string_lossy()).is_some_and(|writer| !is_alive(writer)) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The process of this machine that writes, or wrote, the unfinished file of that name.
fn writer_of(name: &str) -> Option<u32> {
    let name = name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?;
    let name = name.strip_prefix(&machine())?.strip_prefix('-')?;
    name.split('-').next()?.parse().ok()
}

/// The name of this machine, as far as it may stand in the name of a file.
fn machine() -> String {
    let name = ProcessIdentity::this().host.chars();
    name.filter(char::is_ascii_alphanumeric).collect()
}

/// Removes the temporary files that killed programs left in `folder`; returns their number. What
/// cannot be removed stays, which harms nobody.
///
/// Call it only while nothing else writes there.
///
/// # Errors
/// [`StoreError::Read`] if the folder cannot be listed.
pub fn remove_leftovers(folder: &Path) -> Result<usize, StoreError> {
    let mut removed = 0;
    for entry in fs::read_dir(folder).map_err(|error| StoreError::reading(folder, error))? {
        let entry = entry.map_err(|error| StoreError::reading(folder, error))?;
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with(PREFIX) && name.ends_with(SUFFIX) {
            removed += usize::from(fs::remove_file(entry.path()).is_ok());
        }
    }
    Ok(removed)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn replaces_the_whole_file_and_leaves_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        write_atomic(&path, b"a longer first content").unwrap();
        write_atomic(&path, b"second").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(names(folder.path()), ["table.csv"]);
    }

    #[test]
    fn a_failed_write_keeps_the_old_content() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        write_atomic(&path, b"old").unwrap();
        let error = replace(&path, Durable::Yes, |file| {
            file.write_all(b"half of the n")?;
            Err(io::ErrorKind::StorageFull.into())
        })
        .unwrap_err();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["table.csv"]);

        let error = StoreError::writing(&path, error);
        assert!(matches!(error, StoreError::DiskFull { .. }));
        let message = error.to_string();
        assert!(message.starts_with("disk full while writing "), "{message}");
        assert!(message.contains("table.csv"), "{message}");
        assert!(message.contains("run the same command again"), "{message}");
    }

    #[test]
    fn a_missing_folder_is_named_with_the_fix() {
        let folder = tempfile::tempdir().unwrap();
        let message = write_atomic(&folder.path().join("no/table.csv"), b"")
            .unwrap_err()
            .to_string();
        assert!(message.contains("no/table.csv"), "{message}");
        assert!(message.ends_with("; check the path"), "{message}");
    }

    #[test]
    fn what_cannot_be_replaced_is_known_before() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        check_writable(&path).unwrap();
        assert!(names(folder.path()).is_empty());
        fs::create_dir(&path).unwrap();
        for (path, reason) in [
            (path, "a file, not a folder"),
            (folder.path().join("no/x"), "path"),
        ] {
            let message = check_writable(&path).unwrap_err().to_string();
            assert!(message.starts_with("cannot write "), "{message}");
            assert!(message.ends_with(reason), "{message}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn others_may_read_what_is_written() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let mode = |name: &str| {
            let metadata = fs::metadata(folder.path().join(name)).unwrap();
            metadata.permissions().mode() & 0o777
        };
        write_atomic(&folder.path().join("ours"), b"").unwrap();
        File::create(folder.path().join("ordinary")).unwrap();
        assert_eq!(mode("ours"), mode("ordinary"));
    }

    /// Symptom: files `.phase-*.tmp` of killed commands stayed for ever. Cause: only a sweep
    /// removed them, in its own folder.
    #[cfg(target_os = "linux")]
    #[test]
    fn what_the_dead_left_goes_when_somebody_writes_there() {
        let folder = tempfile::tempdir().unwrap();
        let mut child = std::process::Command::new("true").spawn().unwrap();
        let dead = child.id();
        child.wait().unwrap();
        let name = |process: u32| format!("{PREFIX}{}-{process}-a1b2c3{SUFFIX}", machine());
        let other = format!("{PREFIX}elsewhere-{dead}-a1b2c3{SUFFIX}");
        for name in [&name(dead), &name(std::process::id()), &other] {
            File::create(folder.path().join(name)).unwrap();
        }
        write_atomic(&folder.path().join("table.csv"), b"").unwrap();
        let mut left = vec![name(std::process::id()), other, "table.csv".to_owned()];
        left.sort();
        assert_eq!(names(folder.path()), left);
    }

    #[test]
    fn leftovers_go_and_everything_else_stays() {
        let folder = tempfile::tempdir().unwrap();
        for name in [".phase-a1b2c3.tmp", "run.h5", "other.tmp", ".phase-notes"] {
            File::create(folder.path().join(name)).unwrap();
        }
        assert_eq!(remove_leftovers(folder.path()).unwrap(), 1);
        assert_eq!(
            names(folder.path()),
            [".phase-notes", "other.tmp", "run.h5"]
        );
    }
}
