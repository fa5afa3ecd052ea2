//! The folder of a run of another program.

use crate::document::shown;
use crate::scene::{ExternalProgram, Keep, Scene, TemplateText};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// What the program says. The folder of a run is known by it.
const OUTPUT: &str = "phase-output.txt";

/// The identity of the run that may go on from what the folder holds. A run that has ended, well or
/// not, leaves none.
const IDENTITY: &str = "phase-run.txt";

/// Why a run failed.
const FAILURE: &str = "phase-failed.txt";

/// Most of the output that is read for its last lines (bytes).
const TAIL: u64 = 4096;

/// Most of its last lines that are shown.
const SHOWN: usize = 6;

/// The folder of a run of another program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunFolder {
    path: PathBuf,
    /// Whether nothing else than a run's folder can have its name.
    is_ours: bool,
}

impl RunFolder {
    /// `NAME.run` beside the record `NAME.h5`.
    pub fn beside(record: &Path) -> Self {
        let is_plain = record.extension().is_some_and(|it| it == "h5");
        let path = match is_plain {
            true => record.with_extension("run"),
            false => record.with_added_extension("run"),
        };
        Self {
            path,
            is_ours: false,
        }
    }

    /// The same in the folder of all records of a sweep, where it is a run's whatever it holds.
    pub(crate) fn of_sweep(record: &Path) -> Self {
        Self {
            is_ours: true,
            ..Self::beside(record)
        }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What the program says, which is kept here.
    pub(super) fn output(&self) -> PathBuf {
        self.path.join(OUTPUT)
    }

    /// Whether a run of this identity that has not ended has left a file here.
    pub(super) fn goes_on_from(&self, file: &str, identity: &str) -> bool {
        let own = fs::read_to_string(self.path.join(IDENTITY));
        own.is_ok_and(|it| it.trim() == identity) && self.path.join(file).is_file()
    }

    /// Makes the folder anew for a run of this identity, with these files. What its programs say
    /// goes to the file that is returned.
    pub(super) fn make(&self, identity: &str, files: &[TemplateText]) -> io::Result<File> {
        self.remove()?;
        fs::create_dir_all(&self.path)?;
        let output = self.take_output()?;
        for file in files {
            self.write(file)
                .map_err(|error| io::Error::new(error.kind(), format!("{}: {error}", file.name)))?;
        }
        fs::write(self.path.join(IDENTITY), format!("{identity}\n"))?;
        Ok(output)
    }

    fn write(&self, file: &TemplateText) -> io::Result<()> {
        if !ExternalProgram::is_inside(&file.name) || ExternalProgram::is_reserved(&file.name) {
            return Err(io::Error::other(
                "it would not lie in the folder of the run",
            ));
        }
        let path = self.path.join(&file.name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        fs::write(path, &file.text)
    }

    /// Notes that the run has ended: nothing goes on from what it has left.
    pub(super) fn note_end(&self) {
        let _ = fs::remove_file(self.path.join(IDENTITY));
    }

    /// The file of what the programs say, locked for as long as any of them has it open: a program
    /// outlives a `phase` that is killed.
    pub(super) fn take_output(&self) -> io::Result<File> {
        let mut options = OpenOptions::new();
        let output = options.append(true).create(true).open(self.output())?;
        match output.try_lock() {
            Err(TryLockError::WouldBlock) => Err(io::Error::other(
                "a program that an earlier `phase` started still runs here; end it, or wait until \
                 it ends",
            )),
            // Not all file systems have locks.
            _ => Ok(output),
        }
    }

    /// Refuses a folder that is no run's, with something in it.
    pub(super) fn check(&self) -> io::Result<()> {
        let entries = match fs::read_dir(&self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            entries => entries?,
        };
        match self.is_ours || self.output().is_file() || entries.count() == 0 {
            true => Ok(()),
            false => Err(io::Error::other(
                "this is no folder of a run, and would be emptied; move it away",
            )),
        }
    }

    /// Removes it after a run that ended well, if the scene says so. One that cannot be removed
    /// does no harm.
    pub fn tidy(&self, scene: &Scene) {
        if scene
            .program
            .as_ref()
            .is_some_and(|it| it.keep == Keep::Failed)
        {
            let _ = self.remove();
        }
    }

    /// Removes it with all that is in it.
    pub(super) fn remove(&self) -> io::Result<()> {
        self.check()?;
        if self.output().is_file() {
            self.take_output()?;
        }
        match fs::remove_dir_all(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        }
    }

    /// Notes that the run has failed.
    pub(super) fn note_failure(&self, reason: &str) {
        self.note_end();
        let _ = fs::write(self.path.join(FAILURE), format!("{reason}\n"));
    }

    /// The last lines that the program said, in one.
    pub(super) fn last_lines(&self) -> String {
        let tail = self.tail().unwrap_or_default();
        let text = String::from_utf8_lossy(&tail);
        let lines = text.lines().map(str::trim).filter(|it| !it.is_empty());
        let lines: Vec<String> = lines.map(shown).collect();
        let first = lines.len().saturating_sub(SHOWN);
        lines[first..].join(" | ")
    }

    fn tail(&self) -> io::Result<Vec<u8>> {
        let mut file = File::open(self.output())?;
        let size = file.metadata()?.len();
        file.seek(SeekFrom::Start(size.saturating_sub(TAIL)))?;
        let mut tail = Vec::new();
        file.take(TAIL).read_to_end(&mut tail)?;
        Ok(tail)
    }

    /// Size of all files (bytes). What cannot be seen does not count.
    pub(super) fn size(&self) -> u64 {
        size(&self.path)
    }
}

fn size(folder: &Path) -> u64 {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let sizes = entries.map(|entry| match entry.file_type() {
        Ok(kind) if kind.is_dir() => size(&entry.path()),
        _ => entry.metadata().map_or(0, |it| it.len()),
    });
    sizes.sum()
}
