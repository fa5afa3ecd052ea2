//! The bytes of a file, and its lines if it is a text.

use super::error::TableError;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// The bytes of a file, if there are no more than `most`.
pub(super) fn read(path: &Path, most: u64) -> Result<Vec<u8>, TableError> {
    let cannot = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => {
            let help = "check the name in [[program.read]], and what the program writes";
            TableError::in_file(path, "the program left no such file", help)
        }
        _ => {
            let help = "check the path and the permissions";
            TableError::in_file(path, format!("it cannot be read: {error}"), help)
        }
    };
    // To open a pipe would wait for its writer.
    let metadata = std::fs::metadata(path).map_err(cannot)?;
    if !metadata.is_file() {
        let help = "give the path of a file";
        return Err(TableError::in_file(
            path,
            "it is a folder or a device",
            help,
        ));
    }
    let too_large = |size: String| {
        let message = format!("it has {size} bytes, but at most {most} are read");
        let help = "let the program write fewer rows, or raise the limit";
        TableError::in_file(path, message, help)
    };
    if metadata.len() > most {
        return Err(too_large(metadata.len().to_string()));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(cannot)?;
    // A program may still write to it.
    file.take(most.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(cannot)?;
    match bytes.len() as u64 > most {
        true => Err(too_large(format!("more than {most}"))),
        false => Ok(bytes),
    }
}

/// The text of a file, without the byte order mark that some programs put before it.
pub(super) fn text<'b>(path: &Path, bytes: &'b [u8]) -> Result<&'b str, TableError> {
    let text = std::str::from_utf8(bytes).map_err(|error| {
        let line = line_after(&bytes[..error.valid_up_to()]);
        let help = "save it as UTF-8, or say another format if it is no text";
        TableError::in_line(path, line, "this line is no text in UTF-8", help)
    })?;
    Ok(text.strip_prefix('\u{feff}').unwrap_or(text))
}

/// The number of the line that stands behind these bytes, from 1.
pub(super) fn line_after(bytes: &[u8]) -> u64 {
    bytes.split(|byte| *byte == b'\n').count() as u64
}

/// A line of a text.
#[derive(Clone, Copy)]
pub(super) struct Line<'t> {
    /// Its number, from 1.
    pub(super) number: u64,
    /// What it says, without its end.
    pub(super) text: &'t str,
    /// Whether it has an end. The last line has none if the program was stopped while it wrote.
    pub(super) is_ended: bool,
}

/// The lines of a text.
pub(super) fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    (1..)
        .zip(text.split_inclusive('\n'))
        .map(|(number, line)| Line {
            number,
            text: line.trim_end_matches(['\n', '\r']),
            is_ended: line.ends_with('\n'),
        })
}
