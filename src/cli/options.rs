//! Options that several commands have.

use super::values;
use phase::sweep::work;
use std::path::PathBuf;

/// How much is done at the same time.
#[derive(clap::Args)]
pub(super) struct Workers {
    /// Jobs to work on at the same time [default: all cores].
    #[arg(short, long, value_name = "N", value_parser = values::at_least_one)]
    jobs: Option<usize>,
}

impl Workers {
    /// Their number.
    pub(super) fn count(&self) -> usize {
        self.jobs.unwrap_or_else(work::default_workers)
    }
}

/// Which states of runs are measured, and what goes with their files.
#[derive(clap::Args)]
pub(super) struct Measured {
    #[command(flatten)]
    pub(super) window: Window,
    /// Scene of files of other programs [default: the scene of the first record].
    #[arg(long, value_name = "TOML")]
    pub(super) scene: Option<PathBuf>,
    /// Name of a record; once for each record, in their order [default: the keys in which they
    /// differ].
    #[arg(long = "label", value_name = "TEXT")]
    pub(super) labels: Vec<String>,
}

/// Which states of a drainage are measured.
#[derive(clap::Args)]
pub(super) struct Window {
    /// First and last time (s) of the states to measure, counted from the opening [default: from a
    /// fifth of the drainage to its end].
    #[arg(long, value_name = "FROM,TO", value_parser = values::times)]
    pub(super) times: Option<[f64; 2]>,
}
