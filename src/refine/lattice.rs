//! Axes and the places where runs may be made.

use super::RefineError;

/// How an axis is stretched before distances are measured on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AxisScale {
    /// Equal differences are equal distances.
    Linear,
    /// Equal ratios are equal distances; all values are above 0.
    Log,
    /// Neighbours in the list of values are at equal distances.
    Rank,
}

/// Largest difference between steps that count as equal, as a share of one.
const UNEVEN: f64 = 1e-6;

impl AxisScale {
    /// The scale in which values are evenly spaced: linear if they have equal differences,
    /// logarithmic if they have equal ratios, and else that of their ranks.
    pub fn of(values: &[f64]) -> Self {
        let steps = |forward: fn(f64) -> f64| -> Vec<f64> {
            let pairs = values.windows(2);
            pairs
                .map(|pair| forward(pair[1]) - forward(pair[0]))
                .collect()
        };
        let is_even = |steps: Vec<f64>| {
            let mean = steps.iter().sum::<f64>() / steps.len().max(1) as f64;
            steps
                .iter()
                .all(|step| (step - mean).abs() <= UNEVEN * mean.abs())
        };
        if is_even(steps(|value| value)) {
            Self::Linear
        } else if values.iter().all(|value| *value > 0.0) && is_even(steps(libm::log)) {
            Self::Log
        } else {
            Self::Rank
        }
    }
}

/// One axis: a parameter of the runs and the values of candidates for runs.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeAxis {
    name: String,
    values: Vec<f64>,
    scale: AxisScale,
}

impl LatticeAxis {
    /// An axis with these values in ascending order, in any unit.
    ///
    /// # Errors
    /// If there are no values, if they are not finite or do not ascend, or if they are not above 0
    /// on a logarithmic axis.
    pub fn new(name: &str, values: Vec<f64>, scale: AxisScale) -> Result<Self, RefineError> {
        let refuse = |reason| Err(RefineError::axis(name, reason));
        if values.is_empty() {
            return refuse("it has no values");
        }
        if values.iter().any(|value| !value.is_finite()) {
            return refuse("a value is not finite");
        }
        if values.windows(2).any(|pair| pair[0] >= pair[1]) {
            return refuse("the values do not ascend");
        }
        if scale == AxisScale::Log && values[0] <= 0.0 {
            return refuse("a logarithmic axis needs values above 0");
        }
        Ok(Self {
            name: name.to_owned(),
            values,
            scale,
        })
    }

    /// The axis with every step between values cut into `parts` equal ones in its scale: candidates
    /// off the grid. The old values stay as they are.
    #[must_use]
    pub fn finer(&self, parts: usize) -> Self {
        let mut values = Vec::new();
        for pair in self.values.windows(2) {
            values.push(pair[0]);
            values.extend((1..parts).map(|part| {
                let share = part as f64 / parts as f64;
                match self.scale {
                    AxisScale::Log => pair[0] * libm::pow(pair[1] / pair[0], share),
                    AxisScale::Linear | AxisScale::Rank => pair[0] + (pair[1] - pair[0]) * share,
                }
            }));
        }
        values.push(self.values[self.values.len() - 1]);
        Self {
            values,
            ..self.clone()
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its values, ascending.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Its scale.
    pub fn scale(&self) -> AxisScale {
        self.scale
    }

    /// Place of a value between the first value (0) and the last (1), in the scale of the axis;
    /// below 0 and above 1 outside of them. It is 0 on an axis with one value.
    pub fn unit(&self, value: f64) -> f64 {
        let last = self.values.len() - 1;
        let (from, to) = (self.values[0], self.values[last]);
        if last == 0 {
            return 0.0;
        }
        match self.scale {
            AxisScale::Linear => (value - from) / (to - from),
            AxisScale::Log => libm::log(value / from) / libm::log(to / from),
            AxisScale::Rank => {
                let step = self.values[1..last].partition_point(|it| *it <= value);
                let (low, high) = (self.values[step], self.values[step + 1]);
                (step as f64 + (value - low) / (high - low)) / last as f64
            }
        }
    }

    /// The value at a place between 0 and 1: the inverse of [`LatticeAxis::unit`].
    pub fn value(&self, unit: f64) -> f64 {
        let last = self.values.len() - 1;
        let (from, to) = (self.values[0], self.values[last]);
        if last == 0 {
            return from;
        }
        match self.scale {
            AxisScale::Linear => from + (to - from) * unit,
            AxisScale::Log => from * libm::pow(to / from, unit),
            AxisScale::Rank => {
                let place = unit * last as f64;
                let step = (place.max(0.0) as usize).min(last - 1);
                let (low, high) = (self.values[step], self.values[step + 1]);
                low + (high - low) * (place - step as f64)
            }
        }
    }
}

/// All places where a run may be made: every combination of the values of the axes. The index of
/// the last axis changes fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    axes: Vec<LatticeAxis>,
    /// Places on the unit cube, one after the other.
    units: Vec<f64>,
}

impl Lattice {
    /// The lattice of these axes.
    ///
    /// # Errors
    /// If there are no axes, or more than 2³² places.
    pub fn new(axes: Vec<LatticeAxis>) -> Result<Self, RefineError> {
        let refuse = |name: &str, reason| Err(RefineError::axis(name, reason));
        if axes.is_empty() {
            return refuse("", "there are no axes");
        }
        let places = axes.iter().try_fold(1_u32, |places, axis| {
            places.checked_mul(u32::try_from(axis.values.len()).ok()?)
        });
        let Some(places) = places else {
            return refuse(axes[0].name(), "with the others it gives too many places");
        };
        let scaled: Vec<Vec<f64>> = axes
            .iter()
            .map(|axis| axis.values.iter().map(|value| axis.unit(*value)).collect())
            .collect();
        let mut lattice = Self {
            axes,
            units: Vec::new(),
        };
        lattice.units = (0..places as usize)
            .flat_map(|place| {
                let indices = lattice.indices(place);
                let scaled = &scaled;
                (0..indices.len()).map(move |axis| scaled[axis][indices[axis]])
            })
            .collect();
        Ok(lattice)
    }

    /// The axes.
    pub fn axes(&self) -> &[LatticeAxis] {
        &self.axes
    }

    /// Number of places.
    pub fn places(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).product()
    }

    /// Index on each axis of a place.
    pub fn indices(&self, place: usize) -> Vec<usize> {
        let mut rest = place;
        let mut indices = vec![0; self.axes.len()];
        for (index, axis) in indices.iter_mut().zip(&self.axes).rev() {
            *index = rest % axis.values.len();
            rest /= axis.values.len();
        }
        indices
    }

    /// The place with these indices on the axes.
    pub fn place(&self, indices: &[usize]) -> usize {
        let axes = self.axes.iter().zip(indices);
        axes.fold(0, |place, (axis, index)| place * axis.values.len() + index)
    }

    /// The place with these values, if they are values of the axes.
    pub fn place_of(&self, values: &[f64]) -> Option<usize> {
        let axes = self.axes.iter().zip(values);
        let indices = axes.map(|(axis, value)| axis.values.iter().position(|it| it == value));
        let indices: Option<Vec<usize>> = indices.collect();
        Some(self.place(&indices?))
    }

    /// Value on each axis of a place.
    pub fn values(&self, place: usize) -> Vec<f64> {
        let indices = self.indices(place);
        let axes = self.axes.iter().zip(indices);
        axes.map(|(axis, index)| axis.values[index]).collect()
    }

    /// Where a place lies in the unit cube.
    pub fn unit(&self, place: usize) -> &[f64] {
        let axes = self.axes.len();
        &self.units[place * axes..(place + 1) * axes]
    }

    /// Where these values lie in the unit cube; they may be off the lattice.
    ///
    /// # Errors
    /// If their number differs from the number of axes, or if one has no finite place on its axis.
    pub fn unit_of(&self, values: &[f64]) -> Result<Vec<f64>, RefineError> {
        let axes = self.axes.iter().zip(values);
        let unit: Vec<f64> = axes.map(|(axis, value)| axis.unit(*value)).collect();
        let fits = values.len() == self.axes.len() && unit.iter().all(|it| it.is_finite());
        if fits {
            Ok(unit)
        } else {
            Err(RefineError::place(values, self.axes.len()))
        }
    }

    /// The places one step along each axis from a place.
    pub fn neighbours(&self, place: usize) -> impl Iterator<Item = usize> {
        let mut stride = self.places();
        self.axes.iter().flat_map(move |axis| {
            let count = axis.values.len();
            stride /= count;
            let index = place / stride % count;
            let below = (index > 0).then(|| place - stride);
            let above = (index + 1 < count).then(|| place + stride);
            below.into_iter().chain(above)
        })
    }
}

/// Square of the distance between places of the unit cube.
pub(super) fn square_distance(one: &[f64], other: &[f64]) -> f64 {
    let pairs = one.iter().zip(other);
    pairs
        .map(|(one, other)| (one - other) * (one - other))
        .sum()
}
