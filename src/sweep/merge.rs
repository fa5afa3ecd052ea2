//! Results folders of one sweep that were made apart.

use super::failures::FailureTable;
use super::plan::{Standing, standing};
use super::{Folder, FolderError, Job, read_failures};
use crate::grid::Axis;
use crate::store::{self, StoreError};
use std::fs;

/// What a folder has taken from another one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Taken {
    /// Records of runs that it had not.
    pub new: usize,
    /// Runs that both have.
    pub both: usize,
    /// Records that were left where they are, and why.
    pub left: Vec<String>,
}

impl Folder {
    /// Takes the records of these jobs, and their failures, from another folder, which stays as it
    /// is. Where both have a good record the own one stays.
    ///
    /// # Errors
    /// If a folder cannot be read, or a record not be written.
    pub fn take_from(
        &self,
        other: &Self,
        jobs: &[Job],
        axes: &[Axis],
    ) -> Result<Taken, FolderError> {
        let (own, theirs) = (self.recorded()?, other.recorded()?);
        let mut taken = Taken::default();
        for job in jobs.iter().filter(|job| theirs.contains(&job.id)) {
            let (path, from) = (self.record(&job.id), other.record(&job.id));
            let is_good = |path| matches!(standing(job, path), Standing::Done(_));
            if !is_good(&from) {
                let reason = "is no good record of this sweep";
                taken.left.push(format!("{}: {reason}", from.display()));
            } else if own.contains(&job.id) && is_good(&path) {
                taken.both += 1;
                let digest = |path| store::read_record(path).map(|it| store::content_digest(&it));
                if digest(&path)? != digest(&from)? {
                    let reason = "has other content than the record of the same run in";
                    let place = self.root().display();
                    taken
                        .left
                        .push(format!("{}: {reason} {place}", from.display()));
                }
            } else {
                let bytes = fs::read(&from).map_err(|error| StoreError::reading(&from, error))?;
                store::write_atomic(&path, &bytes)?;
                taken.new += 1;
            }
        }
        self.take_failures(other, jobs, axes)?;
        Ok(taken)
    }

    /// Takes over the failures of jobs without a record.
    fn take_failures(&self, other: &Self, jobs: &[Job], axes: &[Axis]) -> Result<(), FolderError> {
        let failures = read_failures(axes, &other.failures())?;
        let own = self.recorded()?;
        let place = |id: &str| jobs.iter().position(|job| job.id == id);
        FailureTable::new(axes, self.failures()).tidy(
            &failures,
            |failure| !own.contains(&failure.id),
            |failure| place(&failure.id),
        )?;
        Ok(())
    }
}
