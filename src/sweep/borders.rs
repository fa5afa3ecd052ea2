//! The points of a grid at borders: those beside a point with another label.

use super::Sweep;
use super::job::point_at;
use crate::classify::{Label, LabelRow, LabelTable};
use std::collections::HashMap;

impl Sweep {
    /// The points of the grid of which a neighbour along an axis has another label, in the order of
    /// the grid. The label of a point is that of most of the sweep's `seeds`: the seeds that only
    /// border points have do not count, so that these points stay what they are while runs are
    /// added. Points without a label are no neighbours.
    pub fn points_at_borders(&self, table: &LabelTable) -> Vec<Vec<f64>> {
        let of_seeds = |row: &&LabelRow| self.seeds.contains(&row.seed);
        let table = LabelTable {
            rows: table.rows.iter().filter(of_seeds).cloned().collect(),
            ..table.clone()
        };
        let labels: HashMap<Vec<u64>, Label> = table
            .points()
            .into_iter()
            .map(|point| (bits(&point.values), point.label))
            .collect();
        let label = |index: usize| labels.get(&bits(&point_at(&self.axes, index))).copied();
        let is_at_border = |&index: &usize| {
            let Some(own) = label(index) else {
                return false;
            };
            let mut neighbours = self.neighbours(index).filter_map(label);
            neighbours.any(|other| other != own)
        };
        let points = (0..self.points()).filter(is_at_border);
        points.map(|index| point_at(&self.axes, index)).collect()
    }

    /// The points beside a point of the grid, one step along each axis: their places in its order.
    fn neighbours(&self, index: usize) -> impl Iterator<Item = usize> {
        let mut stride = self.points();
        self.axes.iter().flat_map(move |axis| {
            let count = axis.values.len();
            stride /= count;
            let place = index / stride % count;
            let below = (place > 0).then(|| index - stride);
            let above = (place + 1 < count).then(|| index + stride);
            below.into_iter().chain(above)
        })
    }
}

/// What tells points apart.
fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}
