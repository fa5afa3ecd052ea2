//! The version of a program.

use super::process::Process;
use std::fs::{self, File};
use std::path::PathBuf;
use std::time::Duration;

/// How long a program may take to say its version.
const LIMIT: Duration = Duration::from_secs(60);

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
/// If it cannot be started, fails, prints nothing, or takes longer than a minute.
pub fn find_version(command: &[String]) -> Result<String, VersionError> {
    let refuse = |reason: String| VersionError {
        command: command.join(" "),
        reason,
    };
    let failed = |error: std::io::Error| refuse(format!("cannot be started: {error}"));
    let folder = tempfile::tempdir().map_err(failed)?;
    let path: PathBuf = folder.path().join("version.txt");
    let output = File::create(&path).map_err(failed)?;
    let mut process = Process::start(command, folder.path(), &output).map_err(failed)?;
    let status = loop {
        if let Some(status) = process.look().map_err(failed)? {
            break status;
        }
        if process.age() > LIMIT {
            return Err(refuse("takes longer than a minute".to_owned()));
        }
    };
    if !status.success() {
        return Err(refuse(format!("failed ({status})")));
    }
    let said = fs::read(&path).map_err(failed)?;
    let said = String::from_utf8_lossy(&said);
    let mut lines = said.lines().map(str::trim).filter(|it| !it.is_empty());
    let line = lines.next();
    line.map(|line| line.chars().take(LONGEST).collect())
        .ok_or_else(|| refuse("prints nothing".to_owned()))
}
