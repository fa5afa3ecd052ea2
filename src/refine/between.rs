//! Interpolation between two places: logarithms of probabilities change at a constant rate. Tables
//! and pictures of borders both use it.

/// A change of the most probable label on the way from one place to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LabelChange {
    /// Where it is, as a fraction of the distance.
    pub(super) share: f64,
    /// The label before it and the label after it, as indices.
    pub(super) labels: [usize; 2],
}

/// Whether a label is more probable than another; among equals the first wins.
pub(super) fn is_ahead(logs: &[f64], label: usize, other: usize) -> bool {
    match label < other {
        true => logs[label] >= logs[other],
        false => logs[label] > logs[other],
    }
}

/// Where two labels whose order changes between two places are equally probable, as a fraction of
/// the distance. `logs` are the logarithms of the probabilities of all labels at both places.
pub(super) fn equal(logs: [&[f64]; 2], one: usize, other: usize) -> f64 {
    let [from, to] = logs.map(|at| at[one] - at[other]);
    let share = from / (from - to);
    // Labels that are equally probable at both places have no unique crossing.
    if share.is_finite() { share } else { 0.5 }
}

/// The changes of the most probable label on the way between two places, in their order.
pub(super) fn changes(logs: [&[f64]; 2]) -> Vec<LabelChange> {
    let [from, to] = logs;
    let labels = 0..from.len();
    let mut changes: Vec<LabelChange> = Vec::new();
    let ahead = |best: usize, label: usize| match is_ahead(from, label, best) {
        true => label,
        false => best,
    };
    let mut best = labels.clone().fold(0, ahead);
    // Every change leads to a label that is more probable at the end.
    loop {
        let passing = labels.clone().filter(|label| is_ahead(to, *label, best));
        let passing = passing.filter(|label| *label != best);
        let next = passing.map(|label| (equal(logs, best, label), label));
        let next = next.reduce(|first, next| {
            let is_earlier = next.0 < first.0;
            match is_earlier || (next.0 == first.0 && is_ahead(to, next.1, first.1)) {
                true => next,
                false => first,
            }
        });
        let Some((share, label)) = next else {
            return changes;
        };
        let before = changes.last().map_or(0.0, |change| change.share);
        changes.push(LabelChange {
            share: share.max(before),
            labels: [best, label],
        });
        best = label;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Symptom: `borders.csv` had a border between two labels although a third is the most probable
    /// between them. Cause: only the labels at both ends were compared.
    #[test]
    fn a_label_between_two_others_has_both_borders() {
        let (from, to) = ([0.0, -1.0, -4.0], [-4.0, -1.0, 0.0]);
        let found = changes([&from, &to]);
        let labels: Vec<[usize; 2]> = found.iter().map(|it| it.labels).collect();
        assert_eq!(labels, [[0, 1], [1, 2]]);
        assert_eq!((found[0].share, found[1].share), (0.25, 0.75));
    }

    proptest! {
        #[test]
        fn the_label_before_and_after_a_change_are_the_two_most_probable(
            logs in prop::collection::vec((-9.0..0.0_f64, -9.0..0.0_f64), 2..6),
        ) {
            let (from, to): (Vec<f64>, Vec<f64>) = logs.into_iter().unzip();
            let found = changes([&from, &to]);
            let at = |share: f64, label: usize| from[label] + share * (to[label] - from[label]);
            for change in &found {
                let [one, other] = change.labels.map(|label| at(change.share, label));
                prop_assert!((one - other).abs() < 1e-9);
                let all = (0..from.len()).map(|label| at(change.share, label));
                prop_assert!(all.fold(f64::NEG_INFINITY, f64::max) < one + 1e-9);
            }
            for pair in found.windows(2) {
                prop_assert_eq!(pair[0].labels[1], pair[1].labels[0]);
                prop_assert!(pair[0].share <= pair[1].share);
            }
        }
    }
}
