//! The folder of a run of another program.

use crate::scene::{Keep, Scene, TemplateText};
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// What the program says. The folder of a run is known by it.
const OUTPUT: &str = "phase-output.txt";

/// Why a run failed. Such a run begins anew.
const FAILURE: &str = "phase-failed.txt";

/// Most of the output that is read for its last lines (bytes).
const TAIL: u64 = 4096;

/// Most of its last lines that are shown, and most of a line (characters).
const SHOWN: (usize, usize) = (6, 200);

/// The folder of a run of another program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunFolder {
    path: PathBuf,
}

impl RunFolder {
    /// `NAME.run` beside the record `NAME.h5`.
    pub fn beside(record: &Path) -> Self {
        let is_plain = record.extension().is_some_and(|it| it == "h5");
        let path = match is_plain {
            true => record.with_extension("run"),
            false => record.with_added_extension("run"),
        };
        Self { path }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What the program says, which is kept here.
    pub(super) fn output(&self) -> PathBuf {
        self.path.join(OUTPUT)
    }

    /// Whether a run that did not fail has left a file here.
    pub(super) fn goes_on_from(&self, file: &str) -> bool {
        self.output().is_file()
            && !self.path.join(FAILURE).exists()
            && self.path.join(file).is_file()
    }

    /// Makes the folder anew, with these files.
    pub(super) fn make(&self, files: &[TemplateText]) -> io::Result<()> {
        self.remove()?;
        fs::create_dir_all(&self.path)?;
        File::create(self.output())?;
        for file in files {
            let path = self.path.join(&file.name);
            if let Some(folder) = path.parent() {
                fs::create_dir_all(folder)?;
            }
            fs::write(path, &file.text)?;
        }
        Ok(())
    }

    /// Refuses a folder that is no run's, with something in it.
    pub(super) fn check(&self) -> io::Result<()> {
        let entries = match fs::read_dir(&self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            entries => entries?,
        };
        match self.output().is_file() || entries.count() == 0 {
            true => Ok(()),
            false => Err(io::Error::other(
                "this is no folder of a run, and would be emptied; move it away",
            )),
        }
    }

    /// Removes it after a run that ended well, if the scene says so. One that cannot be removed does
    /// no harm.
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
        match fs::remove_dir_all(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        }
    }

    /// The end of the file of what the program says.
    pub(super) fn open_output(&self) -> io::Result<File> {
        let mut options = OpenOptions::new();
        options.append(true).create(true).open(self.output())
    }

    /// Notes that the run has failed. Without the note it may go on from what it has left.
    pub(super) fn note_failure(&self, reason: &str) {
        let _ = fs::write(self.path.join(FAILURE), format!("{reason}\n"));
    }

    /// The last lines that the program said, in one.
    pub(super) fn last_lines(&self) -> String {
        let tail = self.tail().unwrap_or_default();
        let text = String::from_utf8_lossy(&tail);
        let plain = |line: &str| -> String {
            let signs = line.trim().chars().filter(|it| !it.is_control());
            signs.take(SHOWN.1).collect()
        };
        let lines: Vec<String> = text
            .lines()
            .map(plain)
            .filter(|it| !it.is_empty())
            .collect();
        let first = lines.len().saturating_sub(SHOWN.0);
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
