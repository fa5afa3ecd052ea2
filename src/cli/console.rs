//! What the program says: results to the standard output, everything else to the standard error.

use super::exit::Failure;
use std::fmt::Display;
use std::io::{self, ErrorKind, Write};

/// Where the program speaks, and how much.
pub(crate) struct Console {
    quiet: bool,
    verbose: bool,
}

impl Console {
    pub(crate) fn new(quiet: bool, verbose: bool) -> Self {
        Self { quiet, verbose }
    }

    /// Whether nothing but errors is wanted.
    pub(crate) fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Whether more than usual is wanted.
    pub(crate) fn is_verbose(&self) -> bool {
        self.verbose
    }

    /// Prints a result. A reader that has gone away, such as `head`, is no fault.
    pub(crate) fn result(&self, text: impl Display) -> Result<(), Failure> {
        if self.quiet {
            return Ok(());
        }
        let mut output = io::stdout().lock();
        match writeln!(output, "{text}").and_then(|()| output.flush()) {
            Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                Err(Failure::failed(format!("cannot write the result: {error}")))
            }
            _ => Ok(()),
        }
    }

    /// Says something on the way.
    pub(crate) fn note(&self, text: impl Display) {
        if !self.quiet {
            complain(text);
        }
    }

    /// Says something that only few want to know.
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

/// Writes to the standard error; where that fails there is nobody to tell.
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
