//! The first jobs of programs: where all of them fail alike, the program is at fault, and no more
//! are begun.

use crate::sweep::{Failure, Job};
use std::collections::{BTreeMap, HashSet};

/// So many jobs are tried first, spread evenly over the sweep: a program may rightly fail at an
/// edge of a grid, which holds at most half of eight, and eight runs cost little beside a sweep.
const TRIALS: usize = 8;

/// Jobs that are tried before others.
pub(super) struct Trials {
    /// Their places in the order of the sweep.
    places: Vec<usize>,
    /// Failures that are known from an earlier call: who makes the jobs again has seen them.
    known: Vec<Failure>,
}

impl Trials {
    /// The jobs to try among all; none if these are hardly more.
    pub(super) fn among(all: &[&Job], known: Vec<Failure>) -> Option<Self> {
        let last = all.len().checked_sub(1).filter(|last| *last >= TRIALS)?;
        let places = (0..TRIALS).map(|trial| trial * last / (TRIALS - 1));
        Some(Self {
            places: places.collect(),
            known,
        })
    }

    /// The jobs in the order in which they are begun.
    pub(super) fn first<'a>(&self, all: &[&'a Job], jobs: &[&'a Job]) -> Vec<&'a Job> {
        let tried: Vec<&Job> = self.places.iter().map(|&place| all[place]).collect();
        let ids: HashSet<&str> = tried.iter().map(|job| job.id.as_str()).collect();
        let others = jobs.iter().copied();
        let others = others.filter(|job| !ids.contains(job.id.as_str()));
        tried.iter().copied().chain(others).collect()
    }

    /// Number of jobs that failed alike, if all have, in a way that was not known before. The
    /// failures are given by place.
    pub(super) fn all_failed(&self, failures: &BTreeMap<usize, Failure>) -> Option<usize> {
        let mut found = self.places.iter().map(|place| failures.get(place));
        let first = found.next()??;
        let is_like = |other: Option<&Failure>| other.is_some_and(|it| it.is_like(first));
        let is_known = || self.known.iter().any(|it| it.is_like(first));
        (found.all(is_like) && !is_known()).then_some(TRIALS)
    }
}
