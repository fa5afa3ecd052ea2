//! Rows whose entries commas separate.

use super::NumberTable;
use super::bytes::line_after;
use super::columns::{NAMES_NEEDED, RowPlace, RowReader, given_names, number};
use super::error::{TableError, quote};
use csv::{ReaderBuilder, StringRecord, Trim};
use std::io::Read;
use std::path::Path;

/// Reads a table.
pub(super) fn read(path: &Path, text: &str, names: &[String]) -> Result<NumberTable, TableError> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .comment(Some(b'#'))
        .trim(Trim::All)
        // A comment without a line end would be an entry.
        .from_reader(text.as_bytes().chain(&b"\n"[..]));
    let mut record = StringRecord::new();
    let mut columns: Option<RowReader<'_>> = None;
    loop {
        let start = reader.position().byte() as usize;
        let more = reader.read_record(&mut record).map_err(|error| {
            let help = "write it as a table whose entries commas separate";
            TableError::in_file(path, format!("it is no CSV: {error}"), help)
        })?;
        if !more {
            break;
        }
        let line = || line_of(text, start);
        if record.iter().any(|entry| entry.contains('\n')) {
            let help = "write the entry in one line, with both quotation marks or without";
            let message = "a quotation mark that opens here does not close in its line";
            return Err(TableError::in_line(path, line(), message, help));
        }
        let is_row = match &mut columns {
            Some(_) => true,
            None => {
                let (header, is_row) = header(path, text, &record, names)?;
                columns = Some(header);
                is_row
            }
        };
        if let Some(columns) = columns.as_mut().filter(|_| is_row) {
            let is_last = reader.position().byte() as usize >= text.len();
            let is_ended = !is_last || text.ends_with(['\n', '\r']);
            // The line is counted only for a message: its number takes all the text before it.
            let place = RowPlace { line: 0, is_ended };
            let pushed = columns.push(place, record.iter());
            pushed.map_err(|error| TableError {
                line: Some(line()),
                ..error
            })?;
        }
    }
    match columns {
        Some(columns) => columns.finish(),
        None => {
            let help = "write a line of names and rows, whose entries commas separate";
            Err(TableError::in_file(path, "it is empty", help))
        }
    }
}

/// The columns from the first record, and whether it is a row already.
fn header<'p>(
    path: &'p Path,
    text: &str,
    record: &StringRecord,
    names: &[String],
) -> Result<(RowReader<'p>, bool), TableError> {
    let line = line_of(text, 0);
    let mut filled = record.iter().filter(|entry| !entry.is_empty()).peekable();
    if filled.peek().is_some() && filled.all(|entry| number(entry).is_some()) {
        let own = names_of_comment(text, record.len());
        let names = own.map_or_else(|| given_names(names, record.len()), Ok);
        let names = names.map_err(|message| {
            let help = format!("write a line of names before this one, or {NAMES_NEEDED}");
            TableError::in_line(path, line, message, help)
        })?;
        return Ok((RowReader::new(path, names, None)?, true));
    }
    let names: Vec<String> = record.iter().map(unquoted).collect();
    if let [name] = &names[..]
        && let Some(mark) = name.chars().find(|mark| [';', '\t'].contains(mark))
    {
        let mark_shown = quote(&mark.to_string());
        let message = format!("{mark_shown} stands between these names instead of a comma");
        let help = match mark {
            ';' => "separate the entries by commas, and write 0.5 with a point",
            _ => "separate the entries by commas, or say the format `text`",
        };
        return Err(TableError::in_line(path, line, message, help));
    }
    Ok((RowReader::new(path, names, Some(line))?, false))
}

/// The names in the last comment at the start of a text, where `numpy.savetxt` writes them, if they
/// are as many as the columns.
fn names_of_comment(text: &str, width: usize) -> Option<Vec<String>> {
    let is_before = |line: &&str| line.is_empty() || line.starts_with('#');
    let comment = text
        .lines()
        .take_while(is_before)
        .filter(|line| !line.is_empty())
        .last()?;
    let names = comment.trim_start_matches('#').split(',');
    let names: Vec<String> = names.map(|name| unquoted(name.trim())).collect();
    (names.len() == width && names.iter().all(|name| !name.is_empty())).then_some(names)
}

/// A name without the quotation marks that a space before them has kept.
fn unquoted(name: &str) -> String {
    let inner = name
        .strip_prefix('"')
        .and_then(|name| name.strip_suffix('"'));
    inner.unwrap_or(name).trim().to_owned()
}

/// The line of the record that the reader found from a byte of the text on. It passes blank lines
/// and comments first.
fn line_of(text: &str, start: usize) -> u64 {
    let (before, rest) = text.as_bytes().split_at(start.min(text.len()));
    let is_passed = |line: &&[u8]| matches!(line, [] | [b'\r'] | [b'#', ..]);
    let passed = rest.split(|byte| *byte == b'\n').take_while(is_passed);
    line_after(before) + passed.count() as u64
}
