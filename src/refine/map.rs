//! The probability of each label at each place of a lattice.

use super::model::Fitted;
use super::{Code, Lattice};

/// Probabilities of labels at all places of a lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct ProbabilityMap {
    codes: Vec<Code>,
    places: usize,
    probabilities: Vec<f64>,
}

impl ProbabilityMap {
    /// The predictions of a fitted model for all places. `codes` are the labels that it has learnt,
    /// as in [`Training::codes`](super::Training::codes).
    pub fn new(lattice: &Lattice, codes: &[Code], fitted: &dyn Fitted) -> Self {
        let units: Vec<&[f64]> = (0..lattice.places())
            .map(|place| lattice.unit(place))
            .collect();
        Self {
            codes: codes.to_vec(),
            places: lattice.places(),
            probabilities: fitted.predict(&units).concat(),
        }
    }

    /// The codes of the labels, ascending.
    pub fn codes(&self) -> &[Code] {
        &self.codes
    }

    /// Number of places.
    pub fn places(&self) -> usize {
        self.places
    }

    /// Probability of each label at a place, in the order of [`codes`](Self::codes).
    pub fn at(&self, place: usize) -> &[f64] {
        let labels = self.codes.len();
        &self.probabilities[place * labels..(place + 1) * labels]
    }

    /// Logarithm of the probability of each label at a place; finite for 0 too.
    pub(super) fn logs(&self, place: usize) -> Vec<f64> {
        let logs = self.at(place).iter().map(|p| libm::log(p.max(1e-300)));
        logs.collect()
    }

    /// The most probable label of a place, as an index into the codes; among equals the first.
    pub fn best(&self, place: usize) -> usize {
        let at = self.at(place);
        (1..at.len()).fold(
            0,
            |best, label| if at[label] > at[best] { label } else { best },
        )
    }

    /// The code of the most probable label of a place.
    pub fn label(&self, place: usize) -> Code {
        self.codes[self.best(place)]
    }

    /// Probability of the most probable label of a place.
    pub fn certainty(&self, place: usize) -> f64 {
        self.at(place)[self.best(place)]
    }

    /// The map with labels of equal `code_of` merged: their probabilities are added.
    pub fn merged(&self, code_of: impl Fn(Code) -> Code) -> Self {
        let mut codes: Vec<Code> = self.codes.iter().map(|code| code_of(*code)).collect();
        codes.sort_unstable();
        codes.dedup();
        let mut probabilities = vec![0.0; codes.len() * self.places()];
        for place in 0..self.places() {
            for (code, probability) in self.codes.iter().zip(self.at(place)) {
                let label = codes.partition_point(|other| *other < code_of(*code));
                probabilities[place * codes.len() + label] += probability;
            }
        }
        Self {
            codes,
            places: self.places,
            probabilities,
        }
    }
}
