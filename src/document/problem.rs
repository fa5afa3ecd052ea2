//! One thing that is wrong with a scene or a sweep.

use std::ops::Range;

/// One thing that is wrong with a scene or a sweep, with the key it concerns.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Path of the key, such as `start.spheres[3].radius`; empty for the file as a whole.
    pub path: String,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Whether the key itself is at fault, not its value.
    pub(crate) at_key: bool,
    /// The largest value that the help advises, if all smaller values are allowed too. If several
    /// scenes have such a problem, the smallest of these values fixes all.
    pub(crate) most: Option<f64>,
    /// The part of a text that is at fault (bytes), if not the whole.
    pub(crate) part: Option<Range<usize>>,
}

impl Problem {
    /// A problem with the value of the key at `path`.
    pub(crate) fn new(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            message: message.into(),
            help: None,
            at_key: false,
            most: None,
            part: None,
        }
    }

    /// Only this part of the text, in bytes, is at fault.
    pub(crate) fn part(mut self, part: Range<usize>) -> Self {
        self.part = Some(part);
        self
    }

    /// What to do about it.
    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// The key itself is at fault, not its value.
    pub(crate) fn at_key(mut self) -> Self {
        self.at_key = true;
        self
    }

    /// The help advises this value or less.
    pub(crate) fn at_most(mut self, value: f64) -> Self {
        self.most = Some(value);
        self
    }

    /// The same problem in a scene in the table `table` of a larger file.
    pub(crate) fn within(mut self, table: &str) -> Self {
        self.path = match self.path.as_str() {
            "" => table.to_owned(),
            path => format!("{table}.{path}"),
        };
        self
    }
}

impl std::fmt::Display for Problem {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str(&self.message)?;
        match &self.help {
            Some(help) => write!(formatter, "; {help}"),
            None => Ok(()),
        }
    }
}
