//! Options that several commands have.

use super::exit::Failure;
use super::values;
use phase::study::ablation::AblationOptions;
use phase::study::{AnyStudy, StudyName};
use phase::sweep::work;
use std::path::{Path, PathBuf};

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

/// Which effects of a scene or sweep are taken away.
#[derive(clap::Args)]
pub(super) struct Ablate {
    /// Take away the effects of a scene or sweep, one by one: all of them, or those whose names
    /// hold one of these words.
    #[arg(long, value_name = "WORDS", num_args = 0..=1, require_equals = true)]
    #[arg(value_delimiter = ',', value_parser = values::word)]
    ablate: Option<Vec<String>>,
    /// Number of seeds at each point of an ablation [default: those of the sweep, or 5 if it has
    /// fewer].
    #[arg(short, long, value_name = "N", value_parser = values::three_or_more)]
    seeds: Option<usize>,
}

impl Ablate {
    /// Whether an ablation is asked for.
    pub(super) fn is_given(&self) -> bool {
        self.ablate.is_some() || self.seeds.is_some()
    }

    /// The study of a file. Refuses options of ablations if it is another one: these, and those
    /// `given` besides.
    pub(super) fn load(
        &self,
        file: &Path,
        tolerance: Option<f64>,
        given: &[(&str, bool)],
    ) -> Result<AnyStudy, Failure> {
        let options = AblationOptions {
            seeds: self.seeds,
            effects: self.ablate.clone().unwrap_or_default(),
            tolerance: tolerance.unwrap_or(AblationOptions::default().tolerance),
        };
        let study = AnyStudy::load(file, self.ablate.is_some(), options)?;
        let seeds = ("--seeds", self.seeds.is_some());
        let mut given = given.iter().chain([&seeds]);
        match (study.name(), given.find(|(_, is_given)| *is_given)) {
            (StudyName::Ablation, _) | (_, None) => Ok(study),
            (name, Some((option, _))) => {
                let key = match (name, *option) {
                    (StudyName::Accuracy, "--seeds") => ", and set [seeds] in it",
                    (StudyName::Accuracy, "--tolerance") => ", and set [tolerance] in it",
                    _ => "",
                };
                Err(Failure::refused(format_args!(
                    "{option} is an option of ablations, and {} is a study of {}; leave the option \
                     out{key}",
                    file.display(),
                    name.name()
                )))
            }
        }
    }
}
