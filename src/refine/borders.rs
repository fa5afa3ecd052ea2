//! Borders between labels along one axis, with bands.

use super::between::changes;
use super::{Code, Lattice, ProbabilityMap, RefineError};
use serde::{Deserialize, Serialize};

/// Probability of the label of the other side at which each band ends: 68 and 95 % lie between.
const ENDS: [f64; 2] = [0.16, 0.025];

/// Where the most probable label changes along one axis, in one column of the map.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Crossing {
    /// Value on each axis; on the axis that is crossed, the border's value.
    pub values: Vec<f64>,
    /// Label below the border and label above it.
    pub labels: [Code; 2],
    /// Ends of the interval of 68 %, on the axis that is crossed, in its unit.
    pub band68: [f64; 2],
    /// Ends of the interval of 95 %.
    pub band95: [f64; 2],
    /// Length of the interval of 95 %, as a share of the axis in its scale.
    pub width: f64,
}

/// All crossings of a map along one axis.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Borders {
    /// The axis that is crossed.
    pub axis: usize,
    /// Crossings, by column and then by value.
    pub crossings: Vec<Crossing>,
}

/// How well the border between two labels is known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Width {
    /// The two labels, the smaller code first.
    pub labels: [Code; 2],
    /// The axis that is crossed.
    pub axis: usize,
    /// Number of crossings.
    pub crossings: usize,
    /// Mean length of the intervals of 95 %, as a share of the axis in its scale.
    pub mean: f64,
    /// The largest of them.
    pub widest: f64,
}

impl Borders {
    /// The columns of a table of borders, after those of the axes.
    pub(crate) const COLUMNS: [&str; 9] = [
        "along",
        "below",
        "above",
        "low_68",
        "high_68",
        "low_95",
        "high_95",
        "width_95",
        "critical_rotation",
    ];

    /// The crossings along an axis: for an Ω axis, the table of Ω*.
    ///
    /// Between two neighbouring places, a crossing lies where the probabilities of both labels are
    /// equal, and greater than all others, if their logarithms change at a constant rate. So there
    /// may be several crossings: from one label to another through a third. The band reaches as far
    /// down as the label of the upper side is probable (2.5 % for the band of 95 %), and as far up
    /// as the label of the lower side is: for a single border these are the quantiles of the place
    /// where the label of one seed changes. So the band includes both the uncertainty of the model
    /// and the scatter of seeds. Nothing is known between the two places: if both are certain of
    /// their labels, the border is anywhere between them, and the band of 95 % covers 95 % of the
    /// distance.
    ///
    /// # Errors
    /// If the lattice has no such axis.
    pub fn new(lattice: &Lattice, map: &ProbabilityMap, axis: usize) -> Result<Self, RefineError> {
        if axis < lattice.axes().len() {
            return Ok(Self::of(lattice, map, axis));
        }
        let reason = "there is no axis of this number";
        Err(RefineError::axis(&axis.to_string(), reason))
    }

    /// The crossings along an axis that the lattice has.
    fn of(lattice: &Lattice, map: &ProbabilityMap, axis: usize) -> Self {
        let crossed = &lattice.axes()[axis];
        let units: Vec<f64> = crossed
            .values()
            .iter()
            .map(|it| crossed.unit(*it))
            .collect();
        let mut crossings = Vec::new();
        for first in (0..lattice.places()).filter(|place| lattice.indices(*place)[axis] == 0) {
            let mut indices = lattice.indices(first);
            let places = (0..units.len()).map(|index| {
                indices[axis] = index;
                lattice.place(&indices)
            });
            let column = LatticeColumn {
                logs: places.map(|place| map.logs(place)).collect(),
                units: &units,
            };
            for step in 1..units.len() {
                for change in changes(column.logs(step)) {
                    let at = column.between(step, change.share);
                    let bands = column.bands(step, at, change.labels);
                    let mut values = lattice.values(first);
                    values[axis] = crossed.value(at);
                    let [band68, band95] = bands.map(|band| band.map(|unit| crossed.value(unit)));
                    crossings.push(Crossing {
                        values,
                        labels: change.labels.map(|label| map.codes()[label]),
                        band68,
                        band95,
                        width: bands[1][1] - bands[1][0],
                    });
                }
            }
        }
        Self { axis, crossings }
    }

    /// Mean and largest width of the crossings of each pair of labels, by their codes.
    pub fn widths(&self) -> Vec<Width> {
        let mut widths: Vec<Width> = Vec::new();
        for crossing in &self.crossings {
            let mut labels = crossing.labels;
            labels.sort_unstable();
            let place = widths.partition_point(|width| width.labels < labels);
            if widths.get(place).is_none_or(|width| width.labels != labels) {
                let none = Width {
                    labels,
                    axis: self.axis,
                    crossings: 0,
                    mean: 0.0,
                    widest: 0.0,
                };
                widths.insert(place, none);
            }
            let width = &mut widths[place];
            width.crossings += 1;
            width.mean += crossing.width;
            width.widest = width.widest.max(crossing.width);
        }
        for width in &mut widths {
            width.mean /= width.crossings as f64;
        }
        widths
    }
}

/// How well each pair of neighbouring labels is separated, by their codes: along the axis on which
/// their mean width is smallest, because an axis parallel to a border says little about it.
pub fn widths(lattice: &Lattice, map: &ProbabilityMap) -> Vec<Width> {
    let mut narrowest: Vec<Width> = Vec::new();
    for axis in 0..lattice.axes().len() {
        for width in Borders::of(lattice, map, axis).widths() {
            let place = narrowest.partition_point(|other| other.labels < width.labels);
            match narrowest.get_mut(place) {
                Some(other) if other.labels == width.labels => {
                    if width.mean < other.mean {
                        *other = width;
                    }
                }
                _ => narrowest.insert(place, width),
            }
        }
    }
    narrowest
}

/// Places along the axis that is crossed.
struct LatticeColumn<'a> {
    /// Logarithms of the probabilities of all labels.
    logs: Vec<Vec<f64>>,
    units: &'a [f64],
}

impl LatticeColumn<'_> {
    /// Logarithms at places `step - 1` and `step`.
    fn logs(&self, step: usize) -> [&[f64]; 2] {
        [&self.logs[step - 1], &self.logs[step]]
    }

    /// The bands of a border between places `step - 1` and `step`.
    fn bands(&self, step: usize, at: f64, [low, high]: [usize; 2]) -> [[f64; 2]; 2] {
        let band = |end| {
            let within = [end, 1.0 - end].map(|share| self.between(step, share));
            [
                self.down(step, at, high, end).min(within[0]),
                self.up(step, at, low, end).max(within[1]),
            ]
        };
        ENDS.map(band)
    }

    /// The place at this fraction of the distance from `step - 1` to `step`.
    fn between(&self, step: usize, share: f64) -> f64 {
        self.units[step - 1] + share * (self.units[step] - self.units[step - 1])
    }

    /// The place at or below `at`, between `step - 1` and `step`, from which downwards a label is
    /// first less probable than `end`.
    fn down(&self, step: usize, at: f64, label: usize, end: f64) -> f64 {
        let bound = libm::log(end);
        for step in (1..=step).rev() {
            let [low, high] = self.logs(step).map(|logs| logs[label]);
            if low < bound {
                let share = (bound - low) / (high - low).max(bound - low);
                return self.between(step, share).min(at);
            }
        }
        self.units[0].min(at)
    }

    /// The same upwards.
    fn up(&self, step: usize, at: f64, label: usize, end: f64) -> f64 {
        let bound = libm::log(end);
        for step in step..self.logs.len() {
            let [low, high] = self.logs(step).map(|logs| logs[label]);
            if high < bound {
                let share = (bound - high) / (low - high).max(bound - high);
                return self.between(step, 1.0 - share).max(at);
            }
        }
        self.units[self.units.len() - 1].max(at)
    }
}
