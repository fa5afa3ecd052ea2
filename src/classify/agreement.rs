//! How well two tables of labels agree.

use super::{LabelRow, LabelTable};
use crate::statistics::{Estimate, share_interval};
use std::collections::HashMap;

/// How well two tables of labels agree, run by run or, if they have no run in common, point by
/// point.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// Whether runs of the same point and seed are paired; else points, by the label of most of
    /// their seeds and the means of their measures.
    pub by_runs: bool,
    /// Number of pairs.
    pub pairs: usize,
    /// Number of the pairs with one label.
    pub equal: usize,
    /// Runs or points that the other table does not have, of each.
    pub alone: [usize; 2],
    /// The chance that two seeds of a point have one label, in each: what two programs that do the
    /// same would agree in. None without points of several seeds.
    pub between_seeds: [Option<f64>; 2],
    /// The measures that both tables have, in their order.
    pub measures: Vec<MeasureDifference>,
}

/// A measure in two tables, over the pairs in which both have it.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureDifference {
    /// Its name.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Means of both.
    pub means: [f64; 2],
    /// Mean of the differences, the second less the first, with the interval of Student's t.
    pub difference: Estimate,
}

/// A run or a point: its label, and its measures by their places.
struct Compared {
    code: i64,
    values: Vec<Option<f64>>,
}

type PairKey = Vec<u64>;

impl Agreement {
    /// The agreement of two tables.
    ///
    /// # Errors
    /// If the tables differ in their families of scenes, their axes, or all points.
    pub fn of(one: &LabelTable, other: &LabelTable) -> Result<Self, String> {
        if !one.family.has_columns_of(other.family) {
            let names = [one.family.name, other.family.name];
            return Err(match names[0] == names[1] {
                true => "their files state different labels or measures".to_owned(),
                false => format!("one is of a {}, the other of a {}", names[0], names[1]),
            });
        }
        if one.axes != other.axes {
            let axes = [&one.axes, &other.axes].map(|axes| axes.join(", "));
            return Err(format!("their axes differ: {} and {}", axes[0], axes[1]));
        }
        let aligned = other.clone().with_variants(one.variants.clone());
        let other = &aligned;
        for (by_runs, entries) in [(true, runs as fn(&LabelTable) -> _), (false, points)] {
            let found = Self::of_entries(one, by_runs, &entries(one), &entries(other));
            if found.pairs > 0 {
                return Ok(Self {
                    between_seeds: [one, other].map(between_seeds),
                    ..found
                });
            }
        }
        Err("they have no point in common".to_owned())
    }

    /// Share of the pairs with one label, and its interval of 95 % (Wilson).
    pub fn share(&self) -> (f64, [f64; 2]) {
        let share = self.equal as f64 / self.pairs as f64;
        (share, share_interval(share, self.pairs))
    }

    fn of_entries(
        table: &LabelTable,
        by_runs: bool,
        one: &[(PairKey, Compared)],
        other: &[(PairKey, Compared)],
    ) -> Self {
        let known: HashMap<&PairKey, &Compared> =
            other.iter().map(|(key, entry)| (key, entry)).collect();
        let pairs = one
            .iter()
            .filter_map(|(key, entry)| Some((entry, *known.get(key)?)));
        let pairs: Vec<(&Compared, &Compared)> = pairs.collect();
        let measures = table.family.measures().enumerate();
        let measures = measures.filter(|(_, measure)| !measure.is_evidence);
        let difference = |(place, measure): (usize, &'static super::Measure)| {
            let both = pairs.iter();
            let both = both.filter_map(|(a, b)| Some([a.values[place]?, b.values[place]?]));
            let both: Vec<[f64; 2]> = both.collect();
            let differences: Vec<f64> = both.iter().map(|[a, b]| b - a).collect();
            let mean =
                |side: usize| both.iter().map(|it| it[side]).sum::<f64>() / both.len() as f64;
            Some(MeasureDifference {
                name: measure.name,
                unit: measure.unit,
                means: [mean(0), mean(1)],
                difference: Estimate::of_mean(&differences)?,
            })
        };
        Self {
            by_runs,
            pairs: pairs.len(),
            equal: pairs.iter().filter(|(a, b)| a.code == b.code).count(),
            alone: [one.len() - pairs.len(), other.len() - pairs.len()],
            between_seeds: [None; 2],
            measures: measures.filter_map(difference).collect(),
        }
    }
}

/// The chance that two seeds of a point have one label: over all pairs of seeds of all points.
fn between_seeds(table: &LabelTable) -> Option<f64> {
    let (mut pairs, mut equal) = (0_usize, 0_usize);
    for point in table.points() {
        for (place, row) in point.rows.iter().enumerate() {
            let label = |row: &usize| table.rows[*row].verdict.label;
            let later = &point.rows[place + 1..];
            pairs += later.len();
            equal += later.iter().filter(|it| label(it) == label(row)).count();
        }
    }
    (pairs > 0).then(|| equal as f64 / pairs as f64)
}

fn key(values: &[f64]) -> PairKey {
    values.iter().map(|it| it.to_bits()).collect()
}

fn runs(table: &LabelTable) -> Vec<(PairKey, Compared)> {
    let entry = |row: &LabelRow| {
        let mut key = key(&row.values);
        key.push(row.seed);
        let entry = Compared {
            code: i64::from(row.verdict.label.code),
            values: row.verdict.values.clone(),
        };
        (key, entry)
    };
    table.rows.iter().map(entry).collect()
}

fn points(table: &LabelTable) -> Vec<(PairKey, Compared)> {
    let measures = table.family.measures().count();
    let points = table.points().into_iter();
    let entry = |point: super::Point| {
        let mean = |place: usize| {
            let rows = point.rows.iter();
            let values = rows.filter_map(|row| table.rows[*row].verdict.values[place]);
            Some(Estimate::of_mean(&values.collect::<Vec<_>>())?.value)
        };
        let entry = Compared {
            code: i64::from(point.label.code),
            values: (0..measures).map(mean).collect(),
        };
        (key(&point.values), entry)
    };
    points.map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::classify::{TANK, Verdict};

    fn table(rows: &[(f64, u64, &str, f64)]) -> LabelTable {
        let row = |(radius, seed, label, rotation): &(f64, u64, &str, f64)| {
            let label = TANK.label(label).unwrap();
            LabelRow {
                id: format!("{radius} {seed}"),
                values: vec![*radius],
                seed: *seed,
                verdict: Verdict::unmeasured(&TANK, label)
                    .with("rotation", Some(*rotation))
                    .unwrap(),
            }
        };
        LabelTable {
            family: &TANK,
            axes: vec!["radius".to_owned()],
            variants: Vec::new(),
            rows: rows.iter().map(row).collect(),
        }
    }

    #[test]
    fn runs_are_paired_by_point_and_seed() {
        let one = table(&[
            (1.0, 1, "settled", 0.1),
            (2.0, 1, "pinned", 0.2),
            (3.0, 1, "pinned", 0.3),
        ]);
        let other = table(&[
            (3.0, 1, "pinned", 0.5),
            (2.0, 1, "settled", 0.4),
            (4.0, 1, "settled", 0.1),
        ]);
        let agreement = Agreement::of(&one, &other).unwrap();
        assert!(agreement.by_runs);
        assert_eq!((agreement.pairs, agreement.equal), (2, 1));
        assert_eq!(agreement.alone, [1, 1]);
        let rotation = agreement.measures.iter().find(|it| it.name == "rotation");
        let rotation = rotation.unwrap();
        assert!((rotation.means[0] - 0.25).abs() < 1e-12);
        assert!((rotation.difference.value - 0.2).abs() < 1e-12);
        assert_eq!(agreement.share().0, 0.5);
    }

    #[test]
    fn points_are_paired_where_no_run_is_in_both() {
        let one = table(&[(1.0, 1, "settled", 0.1), (1.0, 2, "settled", 0.3)]);
        let other = table(&[(1.0, 7, "settled", 0.4)]);
        let agreement = Agreement::of(&one, &other).unwrap();
        assert!(!agreement.by_runs);
        assert_eq!((agreement.pairs, agreement.equal), (1, 1));
        let rotation = agreement.measures.iter().find(|it| it.name == "rotation");
        assert!((rotation.unwrap().difference.value - 0.2).abs() < 1e-12);
        assert_eq!(agreement.between_seeds, [Some(1.0), None]);
        let three = [
            (1.0, 1, "settled", 0.1),
            (1.0, 2, "settled", 0.3),
            (1.0, 3, "pinned", 0.3),
        ];
        assert_eq!(between_seeds(&table(&three)), Some(1.0 / 3.0));
        let nowhere = table(&[(9.0, 1, "settled", 0.4)]);
        assert!(Agreement::of(&one, &nowhere).is_err());
    }
}
