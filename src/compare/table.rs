//! The numbers of several drainages, one row per number.

use super::quantities::PROCESSOR_TIME;
use super::{MeasuredDrainage, QUANTITIES};
use crate::record::RunRecord;
use crate::scene::Units;
use crate::statistics::Estimate;

/// A number of several drainages.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparisonRow {
    /// Name of the quantity.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its values, in the order of the records; `None` if undefined.
    pub values: Vec<Option<Estimate>>,
}

impl ComparisonRow {
    /// Its unit as a reader of scenes in these units sees it.
    pub fn shown_unit(&self, units: Units) -> &str {
        match &self.name[..] {
            PROCESSOR_TIME => &self.unit,
            _ => units.shown(&self.unit),
        }
    }

    /// The second of two values less the first. The interval is infinite if either is, and zero for
    /// a run compared with itself: nothing scatters.
    pub fn difference(&self, is_of_one_run: bool) -> Option<Estimate> {
        let [Some(first), Some(second)] = self.values[..] else {
            return None;
        };
        let value = second.value - first.value;
        Some(Estimate {
            value,
            half_width: match is_of_one_run && value == 0.0 {
                true => 0.0,
                false => libm::hypot(first.half_width, second.half_width),
            },
        })
    }
}

/// The numbers of several drainages.
#[derive(Clone, Debug, PartialEq)]
pub struct DrainageComparison {
    /// One row per quantity.
    pub rows: Vec<ComparisonRow>,
    /// First and last time (s) since the opening of what was measured, of each record.
    pub windows: Vec<[f64; 2]>,
}

/// Whether two columns are of the same run: all numbers but the processor time are the same.
pub fn are_of_one_run(rows: &[ComparisonRow]) -> bool {
    let mut measured = rows.iter().filter(|row| row.name != PROCESSOR_TIME);
    measured.all(|row| matches!(row.values[..], [one, other] if one == other))
}

impl DrainageComparison {
    /// Measures records, one or more; `times` as in [`MeasuredDrainage::new`].
    ///
    /// # Errors
    /// What a record lacks, and its place among them.
    pub fn new(
        records: &[&RunRecord],
        times: Option<[f64; 2]>,
    ) -> Result<Self, (usize, &'static str)> {
        let drainages = records.iter().enumerate();
        let drainages = drainages
            .map(|(place, record)| {
                MeasuredDrainage::new(record, times).map_err(|lacks| (place, lacks))
            })
            .collect::<Result<Vec<MeasuredDrainage<'_>>, _>>()?;
        let row = |quantity: &super::DrainageQuantity| ComparisonRow {
            name: quantity.name.to_owned(),
            unit: quantity.unit.to_owned(),
            values: drainages.iter().map(quantity.measure).collect(),
        };
        Ok(Self {
            rows: QUANTITIES.iter().map(row).collect(),
            windows: drainages.iter().map(MeasuredDrainage::held).collect(),
        })
    }
}
