//! The table of labels: one row per job, and the points where replicates are put together.

use super::{Family, Label, Verdict};

/// Labels of all jobs of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelTable {
    /// Whose labels and measures these are: all rows are of this family.
    pub family: &'static Family,
    /// Names of the axes, in the sweep's order.
    pub axes: Vec<String>,
    /// Names of the variants, for which places among them are the values of the axis
    /// [`VARIANT`](Self::VARIANT). Empty without that axis.
    pub variants: Vec<String>,
    /// One row per job, in the sweep's order.
    pub rows: Vec<LabelRow>,
}

/// Label of one job.
#[derive(Clone, Debug, PartialEq)]
pub struct LabelRow {
    /// Identity of the run.
    pub id: String,
    /// Value on each axis.
    pub values: Vec<f64>,
    /// Seed.
    pub seed: u64,
    /// The evidence of the sieves.
    pub verdict: Verdict,
}

/// One point of the grid, its replicate seeds put together.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// Value on each axis.
    pub values: Vec<f64>,
    /// The majority label; of equally frequent ones that with the lower code.
    pub label: Label,
    /// Share of the seeds that agree with the majority.
    pub agreement: f64,
    /// The rows of this point, as indices into the table.
    pub rows: Vec<usize>,
}

impl LabelTable {
    /// Name of the axis whose values are variants.
    pub const VARIANT: &'static str = "variant";

    /// The place of the axis of variants, if the sweep has one.
    pub fn axis_of_variants(&self) -> Option<usize> {
        let mut names = self.axes.iter();
        names.position(|name| name == Self::VARIANT)
    }

    /// The same table with variants in this order, as another source has them, and after these
    /// those that it does not have.
    #[must_use]
    pub fn with_variants(mut self, mut names: Vec<String>) -> Self {
        let Some(axis) = self.axis_of_variants() else {
            return self;
        };
        let place = |name: &String| {
            names.iter().position(|own| own == name).unwrap_or_else(|| {
                names.push(name.clone());
                names.len() - 1
            })
        };
        let places: Vec<f64> = self
            .variants
            .iter()
            .map(place)
            .map(|it| it as f64)
            .collect();
        for row in &mut self.rows {
            if let Some(place) = places.get(row.values[axis] as usize) {
                row.values[axis] = *place;
            }
        }
        self.variants = names;
        self
    }

    /// Whether runs end when they are steady, as far as any row says.
    pub fn has_steady(&self) -> bool {
        self.rows.iter().any(|row| row.verdict.steady.is_some())
    }

    /// Number of runs that were still not steady when their time was up.
    pub fn unsteady(&self) -> usize {
        let rows = self.rows.iter();
        rows.filter(|row| row.verdict.steady == Some(false)).count()
    }

    /// Whether a run of a point was still not steady when its time was up.
    pub fn is_unsteady(&self, point: &Point) -> bool {
        let mut rows = point.rows.iter();
        rows.any(|row| self.rows[*row].verdict.steady == Some(false))
    }

    /// The points of the grid, in order of their first row.
    pub fn points(&self) -> Vec<Point> {
        let mut points: Vec<Point> = Vec::new();
        let mut index = std::collections::HashMap::new();
        let labels = self.family.labels();
        for (row, entry) in self.rows.iter().enumerate() {
            let key: Vec<u64> = entry.values.iter().map(|value| value.to_bits()).collect();
            let at = *index.entry(key).or_insert_with(|| {
                points.push(Point {
                    values: entry.values.clone(),
                    label: entry.verdict.label,
                    agreement: 1.0,
                    rows: Vec::new(),
                });
                points.len() - 1
            });
            points[at].rows.push(row);
        }
        for point in &mut points {
            let count = |label: Label| {
                point
                    .rows
                    .iter()
                    .filter(|&&row| self.rows[row].verdict.label == label)
                    .count()
            };
            let labels = labels.iter().copied();
            let (label, votes) = labels.map(|label| (label, count(label))).fold(
                (Label::UNSTABLE, 0),
                |best, next| {
                    if next.1 > best.1 { next } else { best }
                },
            );
            point.label = label;
            point.agreement = votes as f64 / point.rows.len() as f64;
        }
        points
    }
}
