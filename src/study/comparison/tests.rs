//! Intervals cover: settings that are alike are called alike as often as promised, and one that is
//! not is found.

use super::bootstrap::{below, stream};
use super::{Disagreement, RunRow, Sample, Shift};
use crate::classify::Label;
use rand_pcg::Pcg64;

const LABELS: [Label; 3] = [Label::SETTLED, Label::FLUID, Label::PINNED];

/// Points of a map, each with its own chances of three labels in hundredths, and an order parameter
/// with its own mean and spread.
struct Map {
    chances: Vec<[usize; 2]>,
    means: Vec<f64>,
}

impl Map {
    /// Most points are certain, as in real maps, and some lie on borders.
    fn new(points: usize, random: &mut Pcg64) -> Self {
        let chances = (0..points).map(|point| match point % 4 {
            0 => [below(60, random), 30],
            1 => [90 + below(10, random), 5],
            _ => [100, 0],
        });
        Self {
            chances: chances.collect(),
            means: (0..points).map(|point| point as f64).collect(),
        }
    }

    /// Runs of so many seeds at each point. The share `changed` of the points, in hundredths, has
    /// another label whatever the seed; order parameters are shifted by `shift` spreads.
    fn runs(&self, seeds: usize, changed: usize, shift: f64, random: &mut Pcg64) -> Vec<RunRow> {
        let mut rows = Vec::new();
        for (point, &[first, second]) in self.chances.iter().enumerate() {
            for _ in 0..seeds {
                let drawn = below(100, random);
                let label = match drawn {
                    _ if point * 100 < changed * self.chances.len() => Label::LARGE_SPOUT,
                    drawn if drawn < first => LABELS[0],
                    drawn if drawn < first + second => LABELS[1],
                    _ => LABELS[2],
                };
                // Twelve uniform numbers add up to a normal one of spread one.
                let normal: f64 = (0..12).map(|_| below(1 << 20, random) as f64).sum();
                let normal = normal / f64::from(1 << 20) - 6.0;
                rows.push(RunRow {
                    id: String::new(),
                    label,
                    values: vec![Some(self.means[point] + shift + normal)],
                    sphere_steps: 1,
                    force_evaluations: 1,
                    cpu_seconds: 1.0,
                });
            }
        }
        rows
    }
}

fn sample(rows: &[RunRow], seeds: usize) -> Sample<'_> {
    Sample {
        points: rows
            .chunks(seeds)
            .map(|rows| rows.iter().map(Some).collect())
            .collect(),
    }
}

/// How many of so many trials see a difference in labels, and in the order parameter.
fn differences(seeds: usize, changed: usize, shift: f64, trials: usize) -> [usize; 2] {
    let mut random = stream(&format!(
        "{seeds} seeds, {changed} changed, {shift} shifted"
    ));
    let mut seen = [0, 0];
    for trial in 0..trials {
        let map = Map::new(25, &mut random);
        let reference = map.runs(seeds, 0, 0.0, &mut random);
        let runs = map.runs(seeds, changed, shift, &mut random);
        let (own, other) = (sample(&runs, seeds), sample(&reference, seeds));
        let purpose = format!("trial {trial}");
        let labels = Disagreement::of(&own, &other, &purpose).unwrap();
        seen[0] += usize::from(labels.excess.is_clear());
        let parameter = Shift::of(&own, &other, 0, &purpose, 1).unwrap();
        seen[1] += usize::from(parameter.mean.is_clear());
    }
    seen
}

/// At 95 % two of 40 false alarms are expected; five or more come with a chance of 5 %, so that the
/// streams of this test were looked at once: they are fixed.
#[test]
fn what_is_alike_is_called_alike() {
    for seeds in [3, 5, 10] {
        let [labels, parameter] = differences(seeds, 0, 0.0, 40);
        assert!(
            labels <= 4,
            "{labels} of 40 false alarms in labels, {seeds} seeds"
        );
        assert!(
            parameter <= 4,
            "{parameter} of 40 false alarms in shifts, {seeds} seeds"
        );
    }
}

#[test]
fn what_differs_is_found() {
    let [labels, parameter] = differences(5, 20, 0.5, 20);
    assert_eq!((labels, parameter), (20, 20));
}

#[test]
fn the_same_runs_do_not_differ_but_something_may_have_hidden() {
    let map = Map::new(25, &mut stream("the same runs"));
    let runs = map.runs(4, 0, 0.0, &mut stream("their labels"));
    let own = sample(&runs, 4);
    let labels = Disagreement::of(&own, &own, "itself").unwrap();
    assert_eq!((labels.excess.value, labels.excess.low), (0.0, 0.0));
    // Three in a hundred pairs of runs, by the rule of three.
    assert!(
        (labels.excess.high - 0.03).abs() < 1e-3,
        "{}",
        labels.excess.high
    );
    let parameter = Shift::of(&own, &own, 0, "itself", 1).unwrap();
    assert_eq!(parameter.mean.value, 0.0);
    assert_eq!(parameter.root_mean_square.value, 0.0);
}

#[test]
fn two_seeds_tell_nothing() {
    let map = Map::new(5, &mut stream("two seeds"));
    let runs = map.runs(2, 0, 0.0, &mut stream("their labels"));
    let own = sample(&runs, 2);
    assert_eq!(Disagreement::of(&own, &own, "itself"), None);
    assert_eq!(Shift::of(&own, &own, 0, "itself", 1), None);
}
