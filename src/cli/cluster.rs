//! What is handed to other machines: the runs of a sweep or study, and how long they take.

use super::exit::Failure;
use super::{folders, programs};
use phase::cost::{self, Forecast};
use phase::study::comparison::{Comparison, RunTable};
use phase::study::{AnyFile, AnyStudy};
use phase::sweep::{Folder, Job, NextJobs, Plan, Sweep};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How long jobs are tried for a forecast.
const TRIAL: Duration = Duration::from_secs(4);

/// The jobs of a file, and what runs them.
pub(super) struct Handed {
    pub(super) next: NextJobs,
    pub(super) sweep: Sweep,
    pub(super) folder: Folder,
    /// The command that runs the file.
    pub(super) command: &'static str,
}

impl Handed {
    /// The next jobs of a sweep or study.
    pub(super) fn load(
        file: &Path,
        out: Option<&PathBuf>,
        workers: usize,
    ) -> Result<Self, Failure> {
        match AnyFile::load(file)? {
            AnyFile::Sweep(mut sweep) => {
                let root = out.cloned();
                let folder = Folder::new(root.unwrap_or_else(|| folders::default_folder(file)));
                programs::take_versions(&mut sweep, &folder);
                Ok(Self {
                    next: NextJobs::new(&folder, &sweep, workers)?,
                    sweep: *sweep,
                    folder,
                    command: "sweep",
                })
            }
            AnyFile::Study(study) => Self::of_study(study, file, out, workers),
            AnyFile::Scene(_) => {
                Err(Failure::refused("this is a scene, one run: `phase run` makes it").at(file))
            }
        }
    }

    /// The runs of a study that are next: of an ablation pairs of effects, once all runs of single
    /// ones are there.
    fn of_study(
        mut study: AnyStudy,
        file: &Path,
        out: Option<&PathBuf>,
        workers: usize,
    ) -> Result<Self, Failure> {
        let by_default = || folders::default_folder_of_study(study.name(), file);
        let folder = Folder::new(out.cloned().unwrap_or_else(by_default));
        if let Some(comparison) = study.comparison_mut()
            && programs::take_versions(&mut comparison.sweep, &folder)
        {
            comparison.choose_runs()?;
        }
        let Some(comparison) = study.comparison() else {
            let message = "the runs of a verification case take seconds: `phase study` makes them";
            return Err(Failure::refused(message).at(file));
        };
        let handed = Self::of_comparison(comparison, folder.clone(), workers)?;
        let ablation = match &study {
            AnyStudy::Ablation(it) if handed.next.missing.is_empty() => it,
            _ => return Ok(handed),
        };
        let mut table = RunTable::read(comparison, &folder).map_err(Failure::refused)?;
        table.add_records(comparison, &folder, workers)?;
        match ablation.with_pairs(&table.rows)? {
            Some(pairs) => Self::of_comparison(&pairs.comparison, folder, workers),
            None => Ok(handed),
        }
    }

    fn of_comparison(
        comparison: &Comparison,
        folder: Folder,
        workers: usize,
    ) -> Result<Self, Failure> {
        let table = RunTable::read(comparison, &folder).map_err(Failure::refused)?;
        let plan = Plan::new(&folder, comparison.jobs.clone(), workers)?;
        Ok(Self {
            next: NextJobs::of_plan(table.applied_to(plan)),
            sweep: comparison.sweep.clone(),
            folder,
            command: "study",
        })
    }
}

/// What the jobs at these places take on one core of this machine. No program is started to find
/// out: the runs of the folder tell.
pub(super) fn forecast(
    next: &NextJobs,
    places: &[usize],
    folder: &Folder,
) -> Result<Forecast, Failure> {
    if places.iter().any(|&it| next.jobs[it].scene().is_external()) {
        let plan = Plan::new(folder, next.jobs.clone(), 1)?;
        let mean = programs::seconds_of_runs(&plan).ok_or_else(|| {
            Failure::refused(
                "how long a run of its program takes is not known until one is done: make one \
                 first, such as `phase sweep FILE --job \"$(phase jobs FILE | head -1)\"`",
            )
        })?;
        return Ok(Forecast {
            tried: 0,
            work: places.len() as u64,
            rate: 1.0 / mean.max(1e-3),
            seconds: mean * places.len() as f64,
            memory: 0.0,
            disk: 0.0,
        });
    }
    let jobs: Vec<Job> = places.iter().map(|&it| next.jobs[it].clone()).collect();
    cost::forecast(&jobs, 1, TRIAL).map_err(Failure::failed)
}
