//! The processor time of a step per sphere: against an axis with a line a setting, or against the
//! key of a ladder with a line a point (Remmers, 2009, assignments 7 and 8).

use super::color;
use crate::grid::describe_point;
use crate::plot::PlotError;
use crate::plot::chart::{self, Chart, ChartLine, ChartPanel};
use crate::plot::style::px;
use crate::plot::svg::Svg;
use crate::record::Program;
use crate::scene::leaf;
use crate::study::comparison::{BASE, Comparison, RunRow, Setting};

/// A line of the figure.
struct Times {
    name: String,
    /// Pairs of x and time (s), in order of x.
    points: Vec<(f64, f64)>,
}

/// Draws it against `x`, the name of an axis, or the last part of a ladder's key.
///
/// # Errors
/// [`PlotError`] if the figure cannot be drawn.
pub(super) fn draw(
    x: &str,
    comparison: &Comparison,
    rows: &[Option<RunRow>],
    program: &Program,
) -> Result<Svg, PlotError> {
    let sweep = comparison.sweep_of(BASE);
    let axis = sweep.axes.iter().position(|axis| axis.name == x);
    let (key, times) = match axis {
        Some(axis) => (
            sweep.axes[axis].key.clone(),
            against_axis(axis, comparison, rows),
        ),
        None => against_ladder(x, comparison, rows),
    };
    let count = times.len();
    let line = |(place, it): (usize, &Times)| ChartLine {
        points: it.points.clone(),
        color: color(place, count),
    };
    let lines: Vec<ChartLine> = times.iter().enumerate().map(line).collect();
    let legend = lines.iter().zip(&times);
    let legend = legend.map(|(line, it)| (line.color, it.name.clone()));
    let legend = legend.collect();
    let ends = times
        .iter()
        .flat_map(|line| &line.points)
        .map(|point| point.0);
    let largest = ends.fold(0.0, f64::max);
    let mut panels = vec![ChartPanel::new(Vec::new(), (0.0, largest), lines).down_to_zero()];
    let unit = chart::scaled("s", &mut panels);
    let x_label = match sweep.scene.notation(&key) {
        Some(it) if it.unit.is_empty() => format!("${}$", it.symbol),
        Some(it) => format!("${}$ ({})", it.symbol, it.unit),
        None => x.to_owned(),
    };
    let chart = Chart {
        legend,
        panels,
        columns: 1,
        height: px(380),
        x_label,
        y_label: format!("processor time of a step per sphere ({unit})"),
        ..Chart::default()
    };
    let title = sweep.title.as_deref().or(sweep.scene.title.as_deref());
    let body = chart.body(title)?;
    let title = title.unwrap_or_default().to_owned();
    Ok(Svg::of_program(
        &format!("step-time-{x}"),
        title,
        program,
        &body,
    ))
}

/// The mean over runs that there are (s).
fn mean<'a>(runs: impl Iterator<Item = &'a RunRow>) -> Option<f64> {
    let runs = runs.filter(|run| run.force_evaluations > 0);
    let (seconds, evaluations) = runs.fold((0.0, 0.0), |(seconds, evaluations), run| {
        (
            seconds + run.cpu_seconds,
            evaluations + run.force_evaluations as f64,
        )
    });
    (evaluations > 0.0).then(|| seconds / evaluations)
}

/// A line for each setting that is no rung of a ladder, over all values of the other axes.
fn against_axis(axis: usize, comparison: &Comparison, rows: &[Option<RunRow>]) -> Vec<Times> {
    let settings = comparison.settings.iter().enumerate();
    let line = |(place, setting): (usize, &Setting)| {
        let points = comparison.sample(place, rows).points;
        let sweep = comparison.sweep_of(place);
        let grid: Vec<Vec<f64>> = sweep.grid().collect();
        let at = |&value: &f64| {
            let own = grid.iter().zip(&points);
            let own = own.filter(|(values, _)| values[axis] == value);
            let runs = own.flat_map(|(_, runs)| runs.iter().copied().flatten());
            Some((value, mean(runs)?))
        };
        Times {
            name: setting.name.clone(),
            points: sweep.axes[axis].values.iter().filter_map(at).collect(),
        }
    };
    settings
        .filter(|(_, setting)| setting.rung.is_none())
        .map(line)
        .collect()
}

/// The key of a ladder, and a line for each point of the grid.
fn against_ladder(
    x: &str,
    comparison: &Comparison,
    rows: &[Option<RunRow>],
) -> (String, Vec<Times>) {
    let rungs = comparison.settings.iter().enumerate();
    let rungs = rungs.filter_map(|(place, setting)| {
        let (key, value) = setting.rung.as_ref().filter(|(key, _)| leaf(key) == x)?;
        Some((key, *value, comparison.sample(place, rows).points))
    });
    let mut rungs: Vec<_> = rungs.collect();
    rungs.sort_by(|(_, one, _), (_, other, _)| one.total_cmp(other));
    let sweep = comparison.sweep_of(BASE);
    let line = |(point, values): (usize, Vec<f64>)| Times {
        name: describe_point(&sweep.axes, &values),
        points: rungs
            .iter()
            .filter_map(|(_, value, points)| {
                let runs = points[point].iter().copied().flatten();
                Some((*value, mean(runs)?))
            })
            .collect(),
    };
    let lines = sweep.grid().enumerate().map(line).collect();
    let key = rungs
        .first()
        .map_or(String::new(), |(key, ..)| (*key).clone());
    (key, lines)
}
