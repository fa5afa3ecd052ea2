//! Rows whose entries spaces or tabs separate.

use super::NumberTable;
use super::bytes::{Line, lines};
use super::columns::{NAMES_NEEDED, RowPlace, RowReader, given_names, no_rows, number};
use super::error::{TableError, count};
use std::path::Path;

/// Names that stand in a line of the file.
struct NamesInLine<'t> {
    names: Vec<&'t str>,
    line: u64,
}

/// Reads a table.
pub(super) fn read(path: &Path, text: &str, names: &[String]) -> Result<NumberTable, TableError> {
    let (mut comment, mut header) = (None, None);
    let mut columns: Option<RowReader<'_>> = None;
    for line in lines(text) {
        let (content, remark) = match line.text.split_once('#') {
            Some((content, remark)) => (content, Some(remark)),
            None => (line.text, None),
        };
        let mut words = content.split_whitespace().peekable();
        if words.peek().is_none() {
            if let Some(remark) = remark {
                comment = Some(names_in(remark, line))
                    .filter(|it| !it.names.is_empty())
                    .or(comment);
            }
            continue;
        }
        if let Some(columns) = &mut columns {
            columns.push(line.into(), words)?;
        } else if header.is_none() && words.clone().all(|word| number(word).is_none()) {
            header = Some(names_in(content, line));
        } else {
            let width = words.clone().count();
            let found = (header.as_ref(), comment.as_ref());
            let mut first = first_columns(path, found, names, line, width)?;
            first.push(line.into(), words)?;
            columns = Some(first);
        }
    }
    match (columns, header) {
        (Some(columns), _) => columns.finish(),
        (None, Some(_)) => Err(no_rows(path)),
        (None, None) => {
            let help = "write rows of numbers, whose entries spaces separate";
            Err(TableError::in_file(path, "it has no rows", help))
        }
    }
}

impl From<Line<'_>> for RowPlace {
    fn from(line: Line<'_>) -> Self {
        Self {
            line: line.number,
            is_ended: line.is_ended,
        }
    }
}

fn names_in<'t>(text: &'t str, line: Line<'_>) -> NamesInLine<'t> {
    NamesInLine {
        names: text.split_whitespace().collect(),
        line: line.number,
    }
}

/// The columns of the first row: their names are in a line of words, in a comment, or given.
fn first_columns<'p>(
    path: &'p Path,
    (header, comment): (Option<&NamesInLine<'_>>, Option<&NamesInLine<'_>>),
    names: &[String],
    row: Line<'_>,
    width: usize,
) -> Result<RowReader<'p>, TableError> {
    let comment = comment.filter(|it| it.names.len() == width);
    if let Some(NamesInLine { names, line }) = header.or(comment) {
        let owned = names.iter().map(|name| (*name).to_owned()).collect();
        let columns = RowReader::new(path, owned, Some(*line))?;
        let is_cut = !row.is_ended && width < names.len();
        if names.len() != width && !is_cut {
            let (entries, written) = (count(width, "entry"), count(names.len(), "name"));
            let message = format!("this row has {entries}, but line {line} has {written}");
            let help = "give each column one name without spaces; to leave out row numbers, write \
                        `index=False` with pandas";
            return Err(TableError::in_line(path, row.number, message, help));
        }
        return Ok(columns);
    }
    let names = given_names(names, width).map_err(|message| {
        let help = format!("write them before the first row as `# time energy`, or {NAMES_NEEDED}");
        TableError::in_line(path, row.number, message, help)
    })?;
    RowReader::new(path, names, None)
}
