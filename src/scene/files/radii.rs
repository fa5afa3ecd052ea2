//! A file of radii: one per line.

use super::FileError;
use crate::document::text;
use std::path::Path;

/// Reads radii (m), one per line. Blank lines and lines that start with `#` are skipped.
///
/// # Errors
/// [`FileError::Read`], or [`FileError::Line`] with the line that is not a radius.
pub(super) fn read_radii(path: &Path) -> Result<Vec<f64>, FileError> {
    let content = text::read(path).map_err(|error| FileError::reading(path, error))?;
    let radii = text::lines(&content)
        .map(|(line, field)| {
            text::radius(field).map_err(|reason| FileError::line(path, line, reason))
        })
        .collect::<Result<Vec<_>, _>>()?;
    if radii.is_empty() {
        return Err(FileError::line(
            path,
            1,
            "the file is empty; give one radius (in metres) per line",
        ));
    }
    Ok(radii)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(content: &str) -> Result<Vec<f64>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("radii.txt");
        std::fs::write(&path, content).unwrap();
        read_radii(&path).map_err(|error| {
            let message = error.to_string();
            let at = message.find("radii.txt").expect("names the file");
            message[at..].to_owned()
        })
    }

    #[test]
    fn one_radius_per_line() {
        assert_eq!(read("0.002\n3e-3\n0.004").unwrap(), [0.002, 0.003, 0.004]);
        assert_eq!(
            read("\u{feff}# metres\r\n0.002\r\n\r\n .004 \r\n").unwrap(),
            [0.002, 0.004]
        );
    }

    #[test]
    fn names_the_line_and_the_reason() {
        for (content, message) in [
            (
                "",
                "radii.txt:1: the file is empty; give one radius (in metres) per line",
            ),
            ("0.1\n# two\ntwo\n", "radii.txt:3: `two` is not a number"),
            ("0.1\nNaN\n", "radii.txt:2: `NaN` is not a finite number"),
            (
                "\n-0.1\n",
                "radii.txt:2: a radius must be above zero (in metres), but is `-0.1`",
            ),
            (
                "0",
                "radii.txt:1: a radius must be above zero (in metres), but is `0`",
            ),
            ("0.1 0.2", "radii.txt:1: `0.1 0.2` is not a number"),
        ] {
            assert_eq!(read(content).unwrap_err(), message);
        }
    }

    #[test]
    fn a_missing_file_is_named() {
        let message = read_radii(Path::new("no/such.txt"))
            .unwrap_err()
            .to_string();
        assert!(
            message.starts_with("cannot read no/such.txt: "),
            "{message}"
        );
        assert!(message.ends_with("; check the path"), "{message}");
    }
}
