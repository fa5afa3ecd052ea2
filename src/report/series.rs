//! Columns over time on a page, thinned to look at.

use super::codes::{Codes, ends, rounded};
use super::document::{ColumnEntry, SeriesEntry};
use crate::record::RunRecord;

/// Columns that are drawn at first, where there are any of them.
const USUAL: [&str; 3] = ["height_mean", "hole_radius", "discharged"];

/// The columns over time of several runs, added one by one.
pub(super) struct SeriesOfRuns {
    points: usize,
    columns: Vec<ColumnEntry>,
    runs: Vec<usize>,
    times: Vec<[f64; 2]>,
    frames: Vec<usize>,
    ranges: Vec<f64>,
    codes: Codes,
}

impl SeriesOfRuns {
    /// None yet; of each run so many points are kept, in codes of so many bytes.
    pub(super) fn new(points: usize, width: u32) -> Self {
        Self {
            points,
            columns: Vec::new(),
            runs: Vec::new(),
            times: Vec::new(),
            frames: Vec::new(),
            ranges: Vec::new(),
            codes: Codes::new(width),
        }
    }

    /// Adds the columns of a run by its place among all. Columns that the first run lacks are left
    /// out; those that this one lacks have no values.
    pub(super) fn add(&mut self, run: usize, record: &RunRecord) {
        let observations = &record.observations;
        let time = &observations.time;
        let (Some(first), Some(last)) = (time.first(), time.last()) else {
            return;
        };
        let scalars = observations.scalars();
        if self.runs.is_empty() {
            let columns = scalars.iter().map(|series| ColumnEntry {
                name: series.name.to_owned(),
                quantity: series.name.replace('_', " "),
                unit: if series.unit == "1" { "" } else { series.unit }.to_owned(),
                description: series.description.to_owned(),
                is_usual: USUAL.contains(&series.name),
            });
            self.columns = columns.collect();
            if let Some(first) = self.columns.first_mut() {
                first.is_usual |= !scalars.iter().any(|it| USUAL.contains(&it.name));
            }
        }
        self.runs.push(run);
        self.times.push([rounded(*first), rounded(*last)]);
        self.frames.push(time.len());
        // Evenly spread; with fewer frames some are there twice.
        let steps = (self.points - 1).max(1);
        let frame = |point: usize| (point * (time.len() - 1) + steps / 2) / steps;
        for column in &self.columns {
            let own = scalars.iter().find(|series| series.name == column.name);
            let value = |point| {
                let value = own.and_then(|series| series.values.get(frame(point)));
                value.map_or(f64::NAN, |value| f64::from(*value))
            };
            let values: Vec<f64> = (0..self.points).map(value).collect();
            let range = ends(&values);
            self.codes.add(&values, range);
            self.ranges.extend(range);
        }
    }

    /// All of them, if there are any.
    pub(super) fn entry(self, width: u32) -> Option<SeriesEntry> {
        (!self.runs.is_empty()).then(|| SeriesEntry {
            columns: self.columns,
            runs: self.runs,
            points: self.points,
            times: self.times,
            frames: self.frames,
            width,
            ranges: self.ranges,
            data: self.codes.text(),
        })
    }
}
