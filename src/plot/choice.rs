//! Which runs of a sweep a figure of single runs shows.

use super::{PlotError, Source, grid, numbers};
use crate::classify::Label;
use crate::classify::{LabelRow, Point};
use crate::grid::{Axis, variant_at};
use crate::sweep::Selection;
use std::cmp::Ordering;

/// The runs of a sweep that a figure shows if none are asked for.
pub(super) struct DefaultRuns {
    /// Which runs these are.
    pub(super) words: &'static str,
    /// Their rows in the table of labels.
    choose: fn(&Source<'_>) -> Result<Vec<usize>, PlotError>,
}

pub(super) static CORNERS: DefaultRuns = DefaultRuns {
    words: "the corners of the grid and between them",
    choose: corners,
};

pub(super) static STATES: DefaultRuns = DefaultRuns {
    words: "a typical run of every state",
    choose: states,
};

/// The rows at the points asked for, or else the default ones.
pub(super) fn rows(source: &Source<'_>, default: &DefaultRuns) -> Result<Vec<usize>, PlotError> {
    match source.points {
        [] => (default.choose)(source),
        points => points.iter().map(|point| row_at(source, point)).collect(),
    }
}

/// The row at a point: of the seed it names, or the first.
fn row_at(source: &Source<'_>, point: &Selection) -> Result<usize, PlotError> {
    // The table may have seeds that the sweep has no more.
    let chosen = source.sweep.select(&Selection {
        seed: None,
        ..point.clone()
    })?;
    let written = point.to_string();
    if let Some(open) = chosen.axes.iter().find(|axis| axis.values.len() > 1) {
        return Err(PlotError::request(format_args!(
            "the point {written} leaves the axis `{}` open; it takes {}",
            open.name,
            open.words().join(", ")
        )));
    }
    let place: Vec<f64> = chosen.axes.iter().map(|axis| axis.values[0]).collect();
    let is_there =
        |row: &LabelRow| row.values == place && point.seed.is_none_or(|seed| row.seed == seed);
    let found = source.table.rows.iter().position(is_there);
    found.ok_or_else(|| {
        PlotError::request(format_args!(
            "no run at {written} is in the table of labels; run `phase sweep` again to complete \
             it, or choose another point or seed"
        ))
    })
}

/// The first run at both ends of the horizontal axis with the least value other than zero, the
/// middle one and the largest of the vertical axis; at the first value of every other axis.
fn corners(source: &Source<'_>) -> Result<Vec<usize>, PlotError> {
    let rows = &source.table.rows;
    let [x, y, ..] = grid::places(source.sweep)?;
    let values = |axis: usize| {
        let mut values: Vec<f64> = rows.iter().map(|row| row.values[axis]).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values
    };
    let three = |mut values: Vec<f64>| {
        if values.len() > 3 {
            values.retain(|&value| value != 0.0);
        }
        let last = values.len() - 1;
        [0, values.len() / 2, last]
            .map(|index| values[index])
            .to_vec()
    };
    let shown = |axis: usize| match (axis, values(axis)) {
        (axis, values) if Some(axis) == x && y.is_some() => {
            vec![values[0], values[values.len() - 1]]
        }
        (axis, values) if Some(axis) == x || Some(axis) == y => three(values),
        (axis, _) => vec![rows[0].values[axis]],
    };
    let shown: Vec<Vec<f64>> = (0..rows[0].values.len()).map(shown).collect();
    let is_shown = |&row: &usize| {
        let mut values = rows[row].values.iter().zip(&shown);
        values.all(|(value, shown)| shown.contains(value))
    };
    let mut chosen: Vec<usize> = (0..rows.len()).filter(is_shown).collect();
    let place = |row: usize| [x, y].map(|axis| axis.map_or(0.0, |axis| rows[row].values[axis]));
    chosen.sort_by(|&one, &other| {
        place(one)
            .partial_cmp(&place(other))
            .unwrap_or(Ordering::Equal)
    });
    chosen.dedup_by_key(|row| place(*row));
    Ok(chosen)
}

/// One run of every state that occurs, in the order of the labels: at the point nearest to the
/// middle of those where all seeds have it, or else the majority, or else any.
fn states(source: &Source<'_>) -> Result<Vec<usize>, PlotError> {
    let points = source.table.points();
    let has = |row: usize, label: Label| source.table.rows[row].verdict.label == label;
    let typical = |label: Label| {
        let degrees: [&dyn Fn(&Point) -> bool; 3] = [
            &|point| point.label == label && point.agreement == 1.0,
            &|point| point.label == label,
            &|point| point.rows.iter().any(|&row| has(row, label)),
        ];
        let candidates = degrees
            .iter()
            .map(|degree| points.iter().filter(|point| degree(point)).collect())
            .find(|candidates: &Vec<&Point>| !candidates.is_empty())?;
        let point = nearest_to_middle(source, &candidates)?;
        point.rows.iter().copied().find(|&row| has(row, label))
    };
    let labels = source.table.family.labels().into_iter();
    Ok(labels
        .filter(|label| *label != Label::UNSTABLE)
        .filter_map(typical)
        .collect())
}

/// Says how many runs [`states`] leaves out because they are unstable; nothing if there are none,
/// or if points are asked for.
pub(super) fn left_out(source: &Source<'_>) -> Option<String> {
    let rows = &source.table.rows;
    let unstable = rows
        .iter()
        .filter(|row| row.verdict.label == Label::UNSTABLE);
    let count = unstable.count();
    (count > 0 && source.points.is_empty())
        .then(|| format!("not shown: unstable, {count} of {} runs", rows.len()))
}

/// The point nearest to the mean of all, counted in places along the axes.
fn nearest_to_middle<'p>(source: &Source<'_>, points: &[&'p Point]) -> Option<&'p Point> {
    let place = |point: &Point| -> Vec<f64> {
        let axes = source.sweep.axes.iter().zip(&point.values);
        axes.map(|(axis, value)| {
            let index = axis.values.iter().position(|other| other == value);
            index.unwrap_or(0) as f64 / axis.values.len() as f64
        })
        .collect()
    };
    let places: Vec<Vec<f64>> = points.iter().map(|point| place(point)).collect();
    let middle = |axis: usize| places.iter().map(|p| p[axis]).sum::<f64>() / places.len() as f64;
    let middle: Vec<f64> = (0..source.sweep.axes.len()).map(middle).collect();
    let distance = |place: &[f64]| -> f64 {
        let pairs = place.iter().zip(&middle);
        pairs.map(|(a, b)| (a - b) * (a - b)).sum()
    };
    let distances = places.iter().map(|place| distance(place));
    let nearest = distances
        .enumerate()
        .min_by(|(_, one), (_, other)| one.total_cmp(other))?
        .0;
    Some(points[nearest])
}

/// The place of a run in the sweep, with markup, such as `$r$ = 4 mm` and `$Ω$ = 8 rad/s`. The seed
/// is named only if a point asks for one.
pub(super) fn place(source: &Source<'_>, row: &LabelRow) -> Vec<String> {
    let mut parts = quantities(source, &row.values);
    if source.points.iter().any(|point| point.seed.is_some()) {
        parts.push(format!("seed {}", row.seed));
    }
    parts
}

/// The same as one would write it on the command line.
pub(super) fn plainly(source: &Source<'_>, row: &LabelRow) -> String {
    let axes = source.sweep.axes.iter().zip(&row.values);
    let values = axes.map(|(axis, value)| format!("{} = {}", axis.name, axis.word(*value)));
    let seed = [format!("seed = {}", row.seed)];
    values.chain(seed).collect::<Vec<_>>().join(", ")
}

/// A point of the sweep: what each axis is there, with markup.
pub(super) fn quantities(source: &Source<'_>, values: &[f64]) -> Vec<String> {
    quantities_of(source, &source.sweep.axes, values)
}

/// The same of some axes, which have these values.
pub(super) fn quantities_of(source: &Source<'_>, axes: &[Axis], values: &[f64]) -> Vec<String> {
    let variant = variant_at(axes, values);
    let pairs = axes.iter().zip(values);
    pairs
        .map(|(axis, &value)| match axis.variant(value) {
            Some(variant) => variant.name.clone(),
            None => {
                let factor = variant.map_or(1.0, |variant| variant.factor(&axis.name));
                let others: Vec<f64> = axis.values.iter().map(|it| it * factor).collect();
                among(source, (&axis.key, &axis.name), value * factor, &others)
            }
        })
        .collect()
}

/// `symbol = value unit` of a key.
pub(super) fn quantity(source: &Source<'_>, key: &str, value: f64) -> String {
    among(source, (key, key), value, &[])
}

/// `symbol = value unit` of a key, with as many digits as tell it from others; small lengths in
/// millimetres.
fn among(source: &Source<'_>, (key, name): (&str, &str), value: f64, others: &[f64]) -> String {
    let Some(notation) = source.sweep.scene.notation(key) else {
        return format!("{name} = {}", numbers::among(value, others));
    };
    let (factor, unit) = match notation.unit {
        "m" if value.abs() < 0.1 => (1e3, "mm"),
        unit => (1.0, unit),
    };
    let others: Vec<f64> = others.iter().map(|other| other * factor).collect();
    let number = numbers::among(value * factor, &others);
    let text = format!("${}$ = {number} {unit}", notation.symbol);
    text.trim_end().to_owned()
}
