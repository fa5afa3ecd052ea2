//! What `fix ave/time` of LAMMPS writes, of scalars.

use super::NumberTable;
use super::bytes::{Line, lines};
use super::columns::{RowReader, STOPPED, no_rows};
use super::error::{TableError, list, quote};
use std::path::Path;

/// How the comment that names the columns begins.
const FIRST_NAME: &str = "TimeStep";

/// Reads a table.
pub(super) fn read(path: &Path, text: &str) -> Result<NumberTable, TableError> {
    let mut columns: Option<RowReader<'_>> = None;
    let mut last = None;
    for line in lines(text).filter(|line| !line.text.trim().is_empty()) {
        last = Some(line);
        if let Some(comment) = line.text.trim_start().strip_prefix('#') {
            check_kind(path, line, comment)?;
            let names: Vec<_> = comment.split_whitespace().map(str::to_owned).collect();
            if names.first().is_some_and(|name| name == FIRST_NAME) {
                check_same(path, columns.as_ref(), &names, line)?;
                if columns.is_none() {
                    columns = Some(RowReader::new(path, names, Some(line.number))?);
                }
            }
            continue;
        }
        match &mut columns {
            Some(columns) => columns.push(line.into(), line.text.split_whitespace())?,
            None => return Err(no_names(path, line)),
        }
    }
    if let Some(line) = last.filter(|line| !line.is_ended) {
        let message = "the last line has no line end, so that its last number may be cut short";
        return Err(TableError::in_line(path, line.number, message, STOPPED));
    }
    match columns {
        Some(columns) => columns.finish(),
        None => Err(no_rows(path)),
    }
}

/// Refuses other files of LAMMPS, which have blocks of rows.
fn check_kind(path: &Path, line: Line<'_>, comment: &str) -> Result<(), TableError> {
    let fix = |name: &str, help: &str| {
        let message =
            format!("this file is one of `fix {name}`, which has a block of rows per step");
        Err(TableError::in_line(path, line.number, message, help))
    };
    let scalars = "write what you need as a scalar, such as c_1[2], with `fix ave/time`";
    let comment = comment.trim_start();
    if comment.starts_with("TimeStep Number-of-rows") || comment.starts_with("Row ") {
        fix(
            "ave/time` with `mode vector",
            "use `mode scalar` and name single entries, such as c_1[2]",
        )
    } else if comment.starts_with("Chunk-averaged data") {
        fix("ave/chunk", scalars)
    } else if comment.starts_with("Histogrammed data") {
        fix("ave/histo", scalars)
    } else if comment.starts_with("Time-correlated data") {
        fix("ave/correlate", scalars)
    } else {
        Ok(())
    }
}

/// A file to which several runs append has a line of names for each.
fn check_same(
    path: &Path,
    columns: Option<&RowReader<'_>>,
    names: &[String],
    line: Line<'_>,
) -> Result<(), TableError> {
    match columns
        .map(RowReader::names)
        .filter(|known| *known != names)
    {
        Some(known) => {
            let (known, names) = (list(known), list(names));
            let message = format!("the columns become {names} here, but were {known} before");
            let help = "write every run to a file of its own";
            Err(TableError::in_line(path, line.number, message, help))
        }
        None => Ok(()),
    }
}

fn no_names(path: &Path, line: Line<'_>) -> TableError {
    let is_yaml = line.text.starts_with("keywords:") || line.text.starts_with("---");
    let (message, help) = if is_yaml {
        let message = "this file is YAML, which LAMMPS writes if the file is named so".to_owned();
        (
            message,
            "give the file of `fix ave/time` a name without .yaml",
        )
    } else {
        let shown = quote(line.text.trim());
        let message = format!("{shown} stands before `# {FIRST_NAME}` and the names of columns");
        let help = "leave out `title2` of `fix ave/time`, or say the format `text`";
        (message, help)
    };
    TableError::in_line(path, line.number, message, help)
}
