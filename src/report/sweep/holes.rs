//! What would be pinned if the hole had another radius: evidence that the table does not hold, read
//! from records.

use crate::classify::{Family, Sieves, TANK, pinned_shares};
use crate::record::RunRecord;

/// Radii of the hole, in radii of the spheres.
const STOPS: [f64; 15] = [
    0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0, 3.25, 3.5, 4.0, 5.0,
];

/// The shares of frames with a hole of several radii, of all runs.
pub(super) struct HolesOfRuns {
    /// The radii, ascending; the one of the sieves among them.
    pub(super) stops: Vec<f64>,
    /// For each radius, the share of each run.
    pub(super) columns: Vec<Vec<Option<f64>>>,
    known: usize,
}

impl HolesOfRuns {
    /// For so many runs, none of them read; none if tank sieves do not judge them.
    pub(super) fn new(family: &Family, sieves: &Sieves, runs: usize) -> Option<Self> {
        let mut stops: Vec<f64> = STOPS.to_vec();
        stops.push(sieves.pinned.hole);
        stops.sort_by(f64::total_cmp);
        stops.dedup();
        family.is_labelled_by(&TANK).then(|| Self {
            columns: vec![vec![None; runs]; stops.len()],
            stops,
            known: 0,
        })
    }

    /// Shares of a run, one for each radius; none if the sieves cannot judge it.
    pub(super) fn shares(&self, record: &RunRecord, sieves: &Sieves) -> Option<Vec<Option<f64>>> {
        pinned_shares(record, sieves, &self.stops).ok()
    }

    /// Adds the shares of a run.
    pub(super) fn add(&mut self, run: usize, shares: Vec<Option<f64>>) {
        for (column, share) in self.columns.iter_mut().zip(shares) {
            column[run] = share;
        }
        self.known += 1;
    }

    /// These, if all runs have theirs.
    pub(super) fn of_all(self) -> Option<Self> {
        let runs = self.columns.first().map_or(0, Vec::len);
        (self.known == runs).then_some(self)
    }
}
