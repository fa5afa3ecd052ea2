//! A job of a sweep that is run again.

use crate::cli::console::Console;
use crate::cli::exit::Failure;
use phase::grid::Axis;
use phase::record::{Program, RunRecord};
use phase::store::{self, StoreError};
use phase::sweep::{Folder, Job, Selection, Sweep, parse_point};
use std::path::{Path, PathBuf};

/// A job of a sweep, and where its record is.
pub(super) struct Original {
    folder: Folder,
    axes: Vec<Axis>,
    pub(super) job: Job,
    /// The sweep's record, if it has one.
    before: Option<Before>,
}

/// The earlier result with which a repeated run is compared.
struct Before {
    digest: String,
    program: Program,
}

impl Before {
    /// Of a record, if it exists.
    fn read(path: &Path) -> Result<Option<Self>, Failure> {
        if !path.exists() {
            return Ok(None);
        }
        let refuse = |error: StoreError| {
            Failure::refused(format_args!(
                "{error}; the run cannot be compared with it. `phase sweep` replaces it"
            ))
        };
        let record = store::read_record(path).map_err(refuse)?;
        Ok(Some(Self {
            digest: store::motion_digest(&record).map_err(Failure::failed)?,
            program: record.program,
        }))
    }
}

impl Original {
    /// The job of that point in a results folder.
    pub(super) fn find(folder: &Path, point: &str, console: &Console) -> Result<Self, Failure> {
        let folder = one_folder(folder)?;
        let sweep = folder.read_sweep()?;
        let refuse = |reason: String| Failure::refused(format_args!("--point: {reason}"));
        let point = match point {
            "" => Selection::default(),
            text => parse_point(text).map_err(|error| refuse(error.to_string()))?,
        };
        let chosen = sweep
            .select(&point)
            .map_err(|error| refuse(error.to_string()))?;
        if let Some(axis) = chosen.axes.iter().find(|axis| axis.values.len() > 1) {
            let values = axis.words();
            return Err(refuse(format!(
                "add {}=... to choose a run; values: {}",
                axis.name,
                values.join(", ")
            )));
        }
        let refining = folder.read_refining(&sweep)?;
        let jobs = chosen.jobs_so_far(refining.as_ref());
        let mut jobs = jobs?;
        if jobs.is_empty() {
            // A point at which a refined sweep has no run.
            let whole = Sweep {
                refine: None,
                ..chosen.clone()
            };
            jobs = whole.jobs()?;
        }
        if jobs.is_empty() {
            return Err(refuse("the sweep has no seeds".to_owned()));
        }
        if jobs.len() > 1 {
            console.note(format_args!(
                "the point has {} seeds; using the first, seed={}",
                jobs.len(),
                jobs[0].seed
            ));
        }
        let job = jobs.swap_remove(0);
        Ok(Self {
            before: Before::read(&folder.record(&job.id))?,
            folder,
            axes: chosen.axes,
            job,
        })
    }

    /// `DIR/runs/radius-0.003_omega-6_seed-1.h5`.
    pub(super) fn default_path(&self) -> PathBuf {
        let values = self.axes.iter().zip(&self.job.values);
        let mut name: String = values
            .map(|(axis, value)| format!("{}-{}_", axis.name, axis.word(*value)))
            .collect();
        name += &format!("seed-{}.h5", self.job.seed);
        self.folder.root().join("runs").join(name)
    }

    fn record(&self) -> PathBuf {
        self.folder.record(&self.job.id)
    }

    /// Refuses to replace the record of the sweep, whose output would then differ from the sweep's.
    pub(super) fn refuse_to_replace(&self, path: &Path) -> Result<(), Failure> {
        let same = |a: &Path, b: &Path| {
            let (a, b) = (a.canonicalize(), b.canonicalize());
            a.is_ok_and(|a| b.is_ok_and(|b| a == b))
        };
        if same(path, &self.record()) {
            return Err(Failure::refused(
                "this is the sweep's own record; choose another name with --out",
            )
            .at(path));
        }
        Ok(())
    }

    /// Checks that a run gave the same bits as in the sweep. `None` if the sweep has no record of
    /// it.
    pub(super) fn compare(
        &self,
        again: &RunRecord,
        console: &Console,
    ) -> Result<Option<bool>, Failure> {
        let path = self.record();
        let Some(before) = &self.before else {
            console.result(format_args!(
                "the sweep has no record of this job to compare with ({})",
                path.display()
            ));
            return Ok(None);
        };
        if before.digest == store::motion_digest(again).map_err(Failure::failed)? {
            console.result(format_args!(
                "same bits as in the sweep: {} frames of observables and the last state of all \
                 spheres ({})",
                again.observations.frames(),
                path.display()
            ));
            return Ok(Some(true));
        }
        let by =
            |program: &Program| format!("phase {}, commit {}", program.version, program.commit);
        Err(Failure::failed(format_args!(
            "the run differs from the sweep's record {}, which was made by {}; this run was made \
             by {}. Builds may differ in bits; run the sweep again to compare runs of one build",
            path.display(),
            by(&before.program),
            by(&again.program)
        )))
    }
}

/// The results folder at that path.
fn one_folder(path: &Path) -> Result<Folder, Failure> {
    let mut folders = Folder::find(path)?;
    if folders.len() > 1 {
        let names: Vec<String> = folders
            .iter()
            .map(|folder| folder.root().display().to_string())
            .collect();
        return Err(Failure::refused(format_args!(
            "{} holds several results folders; give one of them: {}",
            path.display(),
            names.join(", ")
        )));
    }
    Ok(folders.swap_remove(0))
}
