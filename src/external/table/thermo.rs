//! Logs of LAMMPS: the tables of all their runs.

use super::NumberTable;
use super::bytes::{Line, lines};
use super::columns::{RowReader, number};
use super::error::{TableError, list, quote};
use std::path::Path;

/// How the line before the names of columns begins, in new and in old versions.
const BEFORE_NAMES: [&str; 2] = [
    "Per MPI rank memory allocation",
    "Memory usage per processor",
];
/// How the line after the last row begins.
const AFTER_ROWS: &str = "Loop time of";
/// The column that shows whether a run goes on from the one before.
const STEP: &str = "Step";

/// Where in the log the reader is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    /// Outside of all runs.
    Between,
    /// Before the line of names.
    Names,
    /// Before the first row of a run.
    FirstRow,
    /// Behind it.
    Rows,
}

struct Log<'p> {
    path: &'p Path,
    part: Part,
    /// The columns, and the index of the one with the steps.
    columns: Option<(RowReader<'p>, Option<usize>)>,
    /// Number of runs whose names were read.
    runs: usize,
}

/// Reads the tables of all runs, one after the other.
pub(super) fn read(path: &Path, text: &str) -> Result<NumberTable, TableError> {
    let mut log = Log {
        path,
        part: Part::Between,
        columns: None,
        runs: 0,
    };
    let mut last = 1;
    for line in lines(text) {
        log.read_line(line)?;
        last = line.number;
    }
    if log.part != Part::Between {
        let message = format!("the log ends within a run, without a line `{AFTER_ROWS} ...`");
        let help = "LAMMPS was stopped or still computes: let it come to its end";
        return Err(TableError::in_line(path, last, message, help));
    }
    match log.columns {
        Some((columns, _)) => columns.finish(),
        None => {
            let before = BEFORE_NAMES[0];
            let message = format!("it has no run: no line begins with `{before}`");
            let help = "give the whole log of LAMMPS, not a part of it";
            Err(TableError::in_file(path, message, help))
        }
    }
}

impl Log<'_> {
    fn read_line(&mut self, line: Line<'_>) -> Result<(), TableError> {
        let text = line.text.trim();
        if text.starts_with("ERROR") {
            let message = format!("LAMMPS failed: {}", quote(text));
            let help = "correct the input of LAMMPS and run it again";
            return Err(self.wrong(line, message, help));
        }
        if BEFORE_NAMES.iter().any(|before| text.starts_with(before)) {
            if self.part != Part::Between {
                let message = format!("a run begins before the last one has its `{AFTER_ROWS}`");
                let help = "give the log of one LAMMPS, which ran to its end";
                return Err(self.wrong(line, message, help));
            }
            self.part = Part::Names;
        } else if self.part == Part::Between || text.is_empty() || text.starts_with("WARNING") {
        } else if self.part == Part::Names {
            self.read_names(line)?;
            self.part = Part::FirstRow;
        } else if text.starts_with(AFTER_ROWS) {
            self.part = Part::Between;
        } else if text.split_whitespace().next().and_then(number).is_some() {
            // The end of the log says better what is wrong with a line that was not finished.
            if line.is_ended {
                self.read_row(line)?;
                self.part = Part::Rows;
            }
        }
        // Other lines between rows are further lines of a warning, or of `fix print`.
        Ok(())
    }

    fn read_names(&mut self, line: Line<'_>) -> Result<(), TableError> {
        let text = line.text.trim();
        let style = if text == "---" || text.starts_with("keywords:") {
            Some("yaml")
        } else if text.starts_with("----") {
            Some("multi")
        } else {
            None
        };
        if let Some(style) = style {
            let message = format!("this run has the thermo style `{style}`, which is not read");
            let help = "write `thermo_style custom` and `thermo_modify line one` in the input";
            return Err(self.wrong(line, message, help));
        }
        let names: Vec<_> = text.split_whitespace().map(str::to_owned).collect();
        if let Some(word) = names.iter().find(|name| number(name).is_some()) {
            let message = format!(
                "the names of columns should be here, but {} is",
                quote(word)
            );
            let help = "give the log as LAMMPS wrote it";
            return Err(self.wrong(line, message, help));
        }
        self.runs += 1;
        match &self.columns {
            Some((columns, _)) if columns.names() != names => {
                let (known, names) = (list(columns.names()), list(&names));
                let message = format!(
                    "run {} of the log has the columns {names}, but those before have {known}",
                    self.runs
                );
                let help = "keep one `thermo_style` for all runs, or write a log for each";
                Err(self.wrong(line, message, help))
            }
            Some(_) => Ok(()),
            None => {
                let step = names.iter().position(|name| name == STEP);
                let columns = RowReader::new(self.path, names, Some(line.number))?;
                self.columns = Some((columns, step));
                Ok(())
            }
        }
    }

    fn read_row(&mut self, line: Line<'_>) -> Result<(), TableError> {
        let Some((columns, step)) = &mut self.columns else {
            return Ok(());
        };
        let before = step.and_then(|step| columns.last(step));
        columns.push(line.into(), line.text.split_whitespace())?;
        let now = step.and_then(|step| columns.last(step));
        // A run that goes on writes the state at its start again.
        if self.part == Part::FirstRow && before.is_some() && before == now {
            columns.pop();
        }
        Ok(())
    }

    fn wrong(&self, line: Line<'_>, message: impl Into<String>, help: &str) -> TableError {
        TableError::in_line(self.path, line.number, message, help)
    }
}
