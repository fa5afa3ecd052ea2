//! The runs of one setting, by point and seed.

use super::RunRow;
use crate::classify::Label;
use serde::Serialize;

/// The runs of one setting.
#[derive(Clone, Debug, Default)]
pub struct Sample<'a> {
    /// One list for each point, with the run of each seed; none where a run failed.
    pub points: Vec<Vec<Option<&'a RunRow>>>,
}

/// What a run of a setting costs on average.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// Processor time (s).
    pub cpu_seconds: f64,
    /// Spheres times steps.
    pub sphere_steps: f64,
    /// Evaluations of the force on a sphere: those of sub-steps too.
    pub force_evaluations: f64,
}

impl<'a> Sample<'a> {
    /// All runs that there are.
    pub fn runs(&self) -> impl Iterator<Item = &'a RunRow> + '_ {
        self.points.iter().flatten().copied().flatten()
    }

    /// Runs that there are not: they failed, or are left.
    pub fn missing(&self) -> usize {
        let all: usize = self.points.iter().map(Vec::len).sum();
        all - self.runs().count()
    }

    /// What a run costs on average.
    pub fn cost(&self) -> Cost {
        let count = self.runs().count().max(1) as f64;
        let mean = |value: fn(&RunRow) -> f64| self.runs().map(value).sum::<f64>() / count;
        Cost {
            cpu_seconds: mean(|run| run.cpu_seconds),
            sphere_steps: mean(|run| run.sphere_steps as f64),
            force_evaluations: mean(|run| run.force_evaluations as f64),
        }
    }

    /// Labels of the seeds of which both samples have a run, point by point: those of this one and
    /// of the other.
    pub(super) fn labels_with(&self, other: &Self) -> Vec<[Vec<Label>; 2]> {
        self.pairs_with(other, |run| Some(run.label))
    }

    /// The same for the values of a quantity: seeds count of which both runs have one.
    pub(super) fn values_with(&self, other: &Self, quantity: usize) -> Vec<[Vec<f64>; 2]> {
        self.pairs_with(other, |run| *run.values.get(quantity)?)
    }

    fn pairs_with<T>(&self, other: &Self, of: impl Fn(&RunRow) -> Option<T>) -> Vec<[Vec<T>; 2]> {
        let points = self.points.iter().zip(&other.points);
        let pairs = points.map(|(own, other)| {
            let seeds = own.iter().zip(other);
            let pairs = seeds.filter_map(|(own, other)| Some((of((*own)?)?, of((*other)?)?)));
            let (own, other) = pairs.unzip();
            [own, other]
        });
        pairs.collect()
    }

    /// The value of a quantity in the first run that has it.
    pub fn first_value(&self, quantity: usize) -> Option<f64> {
        self.runs().find_map(|run| *run.values.get(quantity)?)
    }
}
