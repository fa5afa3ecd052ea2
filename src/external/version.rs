//! The version of a program.

use super::process::ChildProcess;
use crate::document::shown;
use std::fs::File;
use std::io::Read;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How long a program may take to say its version.
const LIMIT: Duration = Duration::from_mins(1);

/// Most of what a program says that is read (bytes).
const MOST_SAID: u64 = 100_000;

/// Longest version (characters).
const LONGEST: usize = 200;

/// Why the version of a program is not known.
#[derive(Debug, thiserror::Error)]
#[error("`{command}`, which should print the version of the program, {reason}")]
pub struct VersionError {
    command: String,
    reason: String,
}

/// Starts a command that prints the version of a program, in an empty folder: the first line that
/// is not blank.
///
/// # Errors
/// If it cannot be started, fails, prints nothing, takes longer than a minute, or `stop` is set.
pub fn find_version(command: &[String], stop: &AtomicBool) -> Result<String, VersionError> {
    let refuse = |reason: String| VersionError {
        command: shown(&command.join(" ")),
        reason,
    };
    let failed = |error: std::io::Error| refuse(format!("cannot be started: {error}"));
    let folder = tempfile::tempdir().map_err(failed)?;
    let path: PathBuf = folder.path().join("version.txt");
    let output = File::create(&path).map_err(failed)?;
    let mut process = ChildProcess::start(command, folder.path(), &output).map_err(failed)?;
    let status = loop {
        if let Some(status) = process.look().map_err(failed)? {
            break status;
        }
        if stop.load(Ordering::Relaxed) {
            return Err(refuse("was interrupted".to_owned()));
        }
        if process.age() > LIMIT {
            return Err(refuse("takes longer than a minute".to_owned()));
        }
    };
    if !status.success() {
        return Err(refuse(format!("failed ({status})")));
    }
    let mut said = Vec::new();
    let file = File::open(&path).map_err(failed)?;
    file.take(MOST_SAID)
        .read_to_end(&mut said)
        .map_err(failed)?;
    let said = String::from_utf8_lossy(&said);
    let mut lines = said.lines().map(str::trim).filter(|it| !it.is_empty());
    let line = lines.next();
    line.map(|line| line.chars().take(LONGEST).collect())
        .ok_or_else(|| refuse("prints nothing".to_owned()))
}
