//! Records on a page: one, or several beside each other.

use super::document::{
    ChartEntry, LineEntry, QuantityEntry, QuantityWithUnit, RecordEntry, RecordsSection, SceneEntry,
};
use super::series::SeriesOfRuns;
use super::states::states;
use crate::classify::{Sieves, classify};
use crate::compare::{ComparisonRow, DRAWN_HEIGHTS, MeasuredDrainage, cross_profile, profile_at};
use crate::document::differing_keys;
use crate::measure::ProfilePoint;
use crate::record::{Outcome, RunRecord};
use crate::scene::{Scene, Units};

/// Points of each column over time, and bytes of each.
const POINTS: usize = 600;
const WIDTH: u32 = 2;

/// A record and what a page calls it.
pub struct NamedRecord<'a> {
    /// The name, without markup.
    pub name: String,
    /// The record.
    pub record: &'a RunRecord,
}

/// The section of records, of which `rows` are the numbers to compare; with their spheres where
/// they are animated.
pub fn records(
    records: &[NamedRecord<'_>],
    rows: &[ComparisonRow],
    units: Units,
    are_animated: bool,
) -> RecordsSection {
    let first = records.first();
    let mut series = SeriesOfRuns::new(POINTS, WIDTH);
    for (place, it) in records.iter().enumerate() {
        series.add(place, it.record);
    }
    let all = records.iter();
    RecordsSection {
        title: first.and_then(|it| it.record.scene.title.clone()),
        records: all
            .map(|it| entry(it, first.map(|it| &it.record.scene)))
            .collect(),
        series: series.entry(WIDTH),
        states: records
            .iter()
            .enumerate()
            .filter(|_| are_animated)
            .filter_map(|(place, it)| states(place, it.record))
            .collect(),
        scene: first.and_then(|it| SceneEntry::of(&it.record.scene)),
        quantities: rows.iter().map(|row| quantity(row, units)).collect(),
        charts: charts(records, units),
    }
}

/// A record with its label, and with the keys in which its scene differs from that of the first.
fn entry(named: &NamedRecord<'_>, first: Option<&Scene>) -> RecordEntry {
    let record = named.record;
    let mut notes = Vec::new();
    if let Outcome::Unstable(broken) = &record.outcome {
        notes.push(format!("unstable: {broken}"));
    } else if let Ok(verdict) = classify(record, &Sieves::default()) {
        notes.push(format!("label: {}", verdict.label.name));
    }
    RecordEntry {
        name: named.name.clone(),
        notes,
        changes: first.map_or(Vec::new(), |first| changes_of(first, &record.scene)),
    }
}

/// The keys in which a scene differs from another, with their values as TOML; none for those that
/// it leaves out.
pub(super) fn changes_of(base: &Scene, scene: &Scene) -> Vec<(String, Option<String>)> {
    let tree = serde_json::to_value(scene).unwrap_or_default();
    let keys = differing_keys(base, scene).into_iter();
    keys.map(|key| {
        let value = tree.pointer(&format!("/{}", key.replace('.', "/")));
        let value = value.filter(|value| !value.is_null());
        let text = value.map(ToString::to_string);
        (key, text)
    })
    .collect()
}

fn quantity(row: &ComparisonRow, units: Units) -> QuantityEntry {
    let finite = |value: f64| Some(value).filter(|it| it.is_finite());
    let values = row.values.iter();
    QuantityEntry {
        quantity: row.name.clone(),
        unit: row.shown_unit(units).to_owned(),
        values: values
            .clone()
            .map(|it| finite(it.as_ref()?.value))
            .collect(),
        half_widths: values.map(|it| finite(it.as_ref()?.half_width)).collect(),
    }
}

/// Profiles of drainages; none of other runs.
fn charts(records: &[NamedRecord<'_>], units: Units) -> Vec<ChartEntry> {
    let drainages = records
        .iter()
        .map(|it| MeasuredDrainage::new(it.record, None));
    let Ok(drainages) = drainages.collect::<Result<Vec<_>, _>>() else {
        return Vec::new();
    };
    let axis = |quantity: &str, unit: &str| QuantityWithUnit::new(quantity, units.shown(unit));
    let chart = |title: &str, x, y, line: &dyn Fn(&MeasuredDrainage<'_>) -> [Vec<f64>; 2]| {
        let all = records.iter().zip(&drainages);
        let lines = all.map(|(named, drainage)| {
            let [x, y] = line(drainage);
            LineEntry {
                name: named.name.clone(),
                x,
                y,
            }
        });
        ChartEntry {
            title: title.to_owned(),
            x,
            y,
            lines: lines.collect(),
        }
    };
    let profile = |points: Vec<ProfilePoint>| -> [Vec<f64>; 2] {
        let points = points.iter().filter(|it| it.value.value.is_finite());
        let (places, values) = points.map(|it| (it.place, it.value.value)).unzip();
        [places, values]
    };
    let velocity = "downward velocity over its mean";
    vec![
        chart(
            "Spheres that have left",
            axis("time since the opening", "s"),
            axis("spheres", ""),
            &|it| thinned(it.left()),
        ),
        chart(
            "Velocity over the width, at 27 % of the height at the start",
            axis("$x$", "m"),
            axis(velocity, ""),
            &|it| profile(profile_at(it, DRAWN_HEIGHTS[1]).normalized()),
        ),
        chart(
            "Velocity through the depth",
            axis("$y$", "m"),
            axis(velocity, ""),
            &|it| profile(cross_profile(it).normalized()),
        ),
    ]
}

/// Points of a line, no more than a page shows of columns.
fn thinned([x, y]: [Vec<f64>; 2]) -> [Vec<f64>; 2] {
    let steps = x.len().div_ceil(POINTS).max(1);
    [x, y].map(|values| values.into_iter().step_by(steps).collect())
}
