//! What the plain tables of numbers have in common.

use super::StoreError;
use std::fs;
use std::path::Path;

/// The text of a file, without the byte order mark that some programs put before it.
pub(super) fn read(path: &Path) -> Result<String, StoreError> {
    let mut text = fs::read_to_string(path).map_err(|error| StoreError::reading(path, error))?;
    if text.starts_with('\u{feff}') {
        text.remove(0);
    }
    Ok(text)
}

/// The lines that say something, with their numbers from 1: neither blank nor a `#` comment.
pub(super) fn lines(text: &str) -> impl Iterator<Item = (u64, &str)> {
    (1..)
        .zip(text.lines())
        .map(|(number, line)| (number, line.trim()))
        .filter(|(_, line)| !line.is_empty() && !line.starts_with('#'))
}

/// The finite number that `field` is, or what is wrong with it.
pub(super) fn number(field: &str) -> Result<f64, String> {
    match field.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("`{field}` is not a finite number")),
        Err(_) if field.is_empty() => Err("a number is missing".to_owned()),
        Err(_) => Err(format!("`{field}` is not a number")),
    }
}

/// The radius (m) that `field` is, or what is wrong with it.
pub(super) fn radius(field: &str) -> Result<f64, String> {
    match number(field)? {
        value if value > 0.0 => Ok(value),
        _ => Err(format!(
            "a radius must be above zero (in metres), but is `{field}`"
        )),
    }
}
