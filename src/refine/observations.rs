//! Runs that have been made and their labels.

use super::{Code, Lattice, RefineError};
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;
use std::ops::Range;

/// A run: its place and its seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// Value on each axis, in the units of the axes.
    pub values: Vec<f64>,
    /// Seed.
    pub seed: u64,
}

impl Trial {
    /// The order of runs: by place and then by seed.
    pub fn order(&self, other: &Self) -> Ordering {
        let mut pairs = self.values.iter().zip(&other.values);
        let differing = pairs.find_map(|(one, other)| match one.total_cmp(other) {
            Ordering::Equal => None,
            order => Some(order),
        });
        let of_length = self.values.len().cmp(&other.values.len());
        differing
            .unwrap_or(of_length)
            .then(self.seed.cmp(&other.seed))
    }
}

/// What was found of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// Its label.
    pub label: Code,
    /// How clearly the rule of each label holds, by the codes of these labels in the order in which
    /// rules decide: above 0 if it does. Empty if there are no rules or nothing is known.
    pub margins: Vec<(Code, f64)>,
}

impl From<Code> for Finding {
    fn from(label: Code) -> Self {
        Self {
            label,
            margins: Vec::new(),
        }
    }
}

/// Runs and their labels, ordered by place and seed: nothing depends on the order in which runs
/// finish.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Observations {
    runs: Vec<(Trial, Finding)>,
}

impl Observations {
    /// No runs.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a run. A known run with the same label is not added again.
    ///
    /// # Errors
    /// If the run is known with another label.
    pub fn add(&mut self, run: Trial, found: impl Into<Finding>) -> Result<(), RefineError> {
        let found = found.into();
        match self.runs.binary_search_by(|(other, _)| other.order(&run)) {
            Ok(index) if self.runs[index].1.label == found.label => Ok(()),
            Ok(index) => {
                let labels = [self.runs[index].1.label, found.label];
                Err(RefineError::contradiction(&run.values, run.seed, labels))
            }
            Err(index) => {
                self.runs.insert(index, (run, found));
                Ok(())
            }
        }
    }

    /// The label of a run, if it is known.
    pub fn label(&self, run: &Trial) -> Option<Code> {
        self.found(run).map(|found| found.label)
    }

    /// What was found of a run, if it is known.
    pub fn found(&self, run: &Trial) -> Option<&Finding> {
        let place = self.runs.binary_search_by(|(other, _)| other.order(run));
        place.ok().map(|place| &self.runs[place].1)
    }

    /// Number of runs.
    pub fn len(&self) -> usize {
        self.runs.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.runs.is_empty()
    }

    /// Runs and labels, by place and seed.
    pub fn iter(&self) -> impl Iterator<Item = (&Trial, Code)> {
        self.runs.iter().map(|(run, found)| (run, found.label))
    }
}

/// Runs in the form that models take: places in the unit cube and labels counted from 0.
#[derive(Clone, Debug)]
pub struct Training {
    axes: usize,
    units: Vec<f64>,
    codes: Vec<Code>,
    labels: Vec<usize>,
    margins: Vec<Vec<(Code, f64)>>,
}

impl Training {
    /// The runs on these axes.
    ///
    /// # Errors
    /// If there are none, or if one does not lie on the axes.
    pub fn new(lattice: &Lattice, runs: &Observations) -> Result<Self, RefineError> {
        if runs.is_empty() {
            return Err(RefineError::no_runs());
        }
        let mut codes: Vec<Code> = runs.iter().map(|(_, label)| label).collect();
        codes.sort_unstable();
        codes.dedup();
        let mut units = Vec::new();
        for (run, _) in runs.iter() {
            units.extend(lattice.unit_of(&run.values)?);
        }
        let labels = runs.iter();
        let labels = labels.map(|(_, label)| codes.partition_point(|code| *code < label));
        Ok(Self {
            axes: lattice.axes().len(),
            units,
            labels: labels.collect(),
            codes,
            margins: runs
                .runs
                .iter()
                .map(|(_, found)| found.margins.clone())
                .collect(),
        })
    }

    /// Only these runs.
    pub(super) fn only(&self, runs: &[usize]) -> Self {
        Self {
            axes: self.axes,
            units: runs
                .iter()
                .flat_map(|run| self.unit(*run))
                .copied()
                .collect(),
            codes: self.codes.clone(),
            labels: runs.iter().map(|run| self.labels[*run]).collect(),
            margins: runs.iter().map(|run| self.margins[*run].clone()).collect(),
        }
    }

    /// The same runs with other labels.
    pub(super) fn relabelled(&self, code_of: impl Fn(usize) -> Code) -> Self {
        let own: Vec<Code> = (0..self.runs()).map(code_of).collect();
        let mut codes = own.clone();
        codes.sort_unstable();
        codes.dedup();
        let labels = own.iter();
        let labels = labels.map(|own| codes.partition_point(|code| code < own));
        Self {
            labels: labels.collect(),
            codes,
            ..self.clone()
        }
    }

    /// The margins of runs: of each rule in the order in which rules decide, by the code of its
    /// label. Empty for a run without margins.
    pub(super) fn margins(&self, runs: Range<usize>) -> impl Iterator<Item = &[(Code, f64)]> {
        self.margins[runs].iter().map(Vec::as_slice)
    }

    /// Number of axes.
    pub fn axes(&self) -> usize {
        self.axes
    }

    /// Number of runs.
    pub fn runs(&self) -> usize {
        self.labels.len()
    }

    /// Where a run lies in the unit cube.
    pub fn unit(&self, run: usize) -> &[f64] {
        &self.units[run * self.axes..(run + 1) * self.axes]
    }

    /// The label of a run, as an index into the codes.
    pub fn label(&self, run: usize) -> usize {
        self.labels[run]
    }

    /// The codes of the labels that occur, ascending.
    pub fn codes(&self) -> &[Code] {
        &self.codes
    }
}
