//! One thing that is wrong with a scene or a sweep.

/// One thing that is wrong with a scene or a sweep, with the key it concerns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// Path of the key, such as `start.spheres[3].radius`; empty for the file as a whole.
    pub path: String,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub help: Option<String>,
    /// Whether the key itself is at fault, not its value.
    pub(crate) at_key: bool,
}

impl Problem {
    /// A problem with the value of the key at `path`.
    pub(crate) fn new(path: impl Into<String>, message: impl Into<String>) -> Self {
        Self {
            path: path.into(),
            message: message.into(),
            help: None,
            at_key: false,
        }
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

    /// The same problem in a scene that stands in the table `table` of a larger file.
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
