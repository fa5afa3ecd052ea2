//! Results folders of one sweep that were made apart.

use super::failures::FailureTable;
use super::{Failure, Folder, FolderError, Job, read_failures};
use crate::grid::Axis;
use crate::store::{self, StoreError};
use std::collections::HashMap;
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
            if !other.is_done(job) {
                let reason = "is no good record of this sweep";
                taken.left.push(format!("{}: {reason}", from.display()));
            } else if own.contains(&job.id) && self.is_done(job) {
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

    /// Takes over the failures of jobs without a good record.
    fn take_failures(&self, other: &Self, jobs: &[Job], axes: &[Axis]) -> Result<(), FolderError> {
        let failures = read_failures(axes, &other.failures())?;
        let places = jobs.iter().enumerate();
        let places: HashMap<&str, usize> = places
            .map(|(place, job)| (job.id.as_str(), place))
            .collect();
        let place = |failure: &Failure| places.get(failure.id.as_str()).copied();
        FailureTable::new(axes, self.failures()).tidy(
            &failures,
            |failure| place(failure).is_some_and(|it| !self.is_done(&jobs[it])),
            place,
        )?;
        Ok(())
    }
}
