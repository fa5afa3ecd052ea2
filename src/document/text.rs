//! Plain tables of numbers: lines, fields, and what to do when a file cannot be read.

use std::path::Path;
use std::{fs, io};

/// The text of a file, without the byte order mark that some programs put before it.
pub(crate) fn read(path: &Path) -> io::Result<String> {
    let mut text = fs::read_to_string(path)?;
    if text.starts_with('\u{feff}') {
        text.remove(0);
    }
    Ok(text)
}

/// The lines with content, neither blank nor a `#` comment, with their numbers from 1.
pub(crate) fn lines(text: &str) -> impl Iterator<Item = (u64, &str)> {
    (1..)
        .zip(text.lines())
        .map(|(number, line)| (number, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

/// Parses a finite number, or says what is wrong.
pub(crate) fn number(field: &str) -> Result<f64, String> {
    match field.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("`{field}` is not a finite number")),
        Err(_) if field.is_empty() => Err("a number is missing".to_owned()),
        Err(_) => Err(format!("`{field}` is not a number")),
    }
}

/// Parses a radius (m), or says what is wrong.
pub(crate) fn radius(field: &str) -> Result<f64, String> {
    match number(field)? {
        value if value > 0.0 => Ok(value),
        _ => Err(format!(
            "a radius must be above zero (in metres), but is `{field}`"
        )),
    }
}

/// What to do about a system error, if this is not obvious from its text. Begins with a semicolon,
/// or is empty.
pub fn advice(error: &io::Error) -> &'static str {
    match error.kind() {
        io::ErrorKind::NotFound => "; check the path",
        io::ErrorKind::PermissionDenied => "; check the permissions of the file and its folder",
        io::ErrorKind::InvalidData => "; save the file as UTF-8 text",
        io::ErrorKind::IsADirectory => "; give a file, not a folder",
        io::ErrorKind::NotADirectory => "; a part of the path is a file, not a folder",
        io::ErrorKind::AlreadyExists => "; a file of that name is in the way",
        io::ErrorKind::ReadOnlyFilesystem => "; choose a place that can be written to",
        _ => "",
    }
}
