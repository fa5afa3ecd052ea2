//! Output of the program: results to the standard output, everything else to the standard error.

use super::exit::Failure;
use serde::Serialize;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Where the program writes, and how much.
pub(crate) struct Console {
    quiet: bool,
    verbose: bool,
    /// Whether only the JSON object of [`answer`](Console::answer) is printed as the result.
    json: bool,
    /// Files written so far.
    files: Mutex<Vec<PathBuf>>,
    /// Why the standard output could not be written, the first time.
    unwritten: Mutex<Option<String>>,
}

impl Console {
    pub(crate) fn new(quiet: bool, verbose: bool, json: bool) -> Self {
        Self {
            quiet,
            verbose,
            json,
            files: Mutex::default(),
            unwritten: Mutex::default(),
        }
    }

    /// Whether nothing but errors is wanted.
    pub(crate) fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Whether more than usual is wanted.
    pub(crate) fn is_verbose(&self) -> bool {
        self.verbose
    }

    /// Prints a result for people. If this fails the work continues, and the program fails when it
    /// is done.
    pub(crate) fn result(&self, text: impl Display) {
        if !(self.quiet || self.json) {
            self.print(text);
        }
    }

    /// Prints to the standard output. A reader that has ended, such as `head`, is no error.
    fn print(&self, text: impl Display) {
        let mut output = io::stdout().lock();
        match writeln!(output, "{text}").and_then(|()| output.flush()) {
            Err(error) if error.kind() != ErrorKind::BrokenPipe => self.cannot_write(&error),
            _ => {}
        }
    }

    fn cannot_write(&self, error: &dyn Display) {
        let unwritten = self.unwritten.lock();
        let mut unwritten = unwritten.unwrap_or_else(PoisonError::into_inner);
        unwritten.get_or_insert_with(|| error.to_string());
    }

    /// An error if the standard output could not be written. All files have been.
    pub(crate) fn check_output(&self) -> Result<(), Failure> {
        let unwritten = self.unwritten.lock();
        match &*unwritten.unwrap_or_else(PoisonError::into_inner) {
            None => Ok(()),
            Some(error) => Err(Failure::failed(format_args!(
                "cannot write to the standard output: {error}; the files of this command are \
                 complete"
            ))),
        }
    }

    /// A file was written: prints its path.
    pub(crate) fn file(&self, path: &Path) {
        self.locked_files().push(path.to_owned());
        self.result(path.display());
    }

    /// The files written so far, as text: JSON has no place for names that are not UTF-8.
    pub(crate) fn files(&self) -> Vec<String> {
        let files = self.locked_files();
        files
            .iter()
            .map(|file| file.display().to_string())
            .collect()
    }

    fn locked_files(&self) -> MutexGuard<'_, Vec<PathBuf>> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Prints the result as one JSON object, if requested; `docs/json.md` describes it.
    pub(crate) fn answer(&self, answer: &impl Serialize) {
        if self.json {
            match serde_json::to_string(answer) {
                Ok(text) => self.print(text),
                Err(error) => self.cannot_write(&error),
            }
        }
    }

    /// The same, with the files written.
    pub(crate) fn answer_with_files(&self, answer: &impl Serialize) {
        #[derive(Serialize)]
        struct WithFiles<'a, T> {
            #[serde(flatten)]
            answer: &'a T,
            files: Vec<String>,
        }
        let files = self.files();
        self.answer(&WithFiles { answer, files });
    }

    /// Prints a note to the standard error.
    pub(crate) fn note(&self, text: impl Display) {
        if !self.quiet {
            complain(text);
        }
    }

    /// Says what may go wrong.
    pub(crate) fn warning(&self, text: impl Display) {
        self.note(format_args!("warning: {text}"));
    }

    /// Prints a note if `--verbose` is given.
    pub(crate) fn detail(&self, text: impl Display) {
        if self.verbose {
            complain(text);
        }
    }

    /// Says what is wrong.
    pub(crate) fn error(&self, text: impl Display) {
        complain(format_args!("error: {text}"));
    }
}

/// Writes to the standard error; if this fails, nobody can be told.
fn complain(text: impl Display) {
    let _ = writeln!(io::stderr().lock(), "{text}");
}

/// How many things are named one by one.
const NAMED: usize = 20;

/// Says the first names, and how many more there are.
pub(crate) fn name_first(names: &[String], say: impl Fn(&str)) {
    names.iter().take(NAMED).for_each(|name| say(name));
    if names.len() > NAMED {
        say(&format!("and {} more", names.len() - NAMED));
    }
}
