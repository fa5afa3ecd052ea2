//! Energies over time, per sphere (Rice, 2012, figures 12 and 15): the whole run, and its begin.

use super::chart::{self, Chart, ChartLine, ChartPanel};
use super::runs::{Runs, ShownRun};
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, choice, numbers, palette};
use crate::classify::TANK;
use crate::record::RunRecord;

/// Energies over the grid (figure 15).
pub(super) fn over_the_grid() -> Figure {
    const NAME: &str = "energies";
    let description = "mean energies of a sphere over time: the whole run and its first second";
    let draw = |runs: &Runs<'_>| draw(NAME, runs, false);
    Figure::of_runs(NAME, description, &choice::CORNERS, draw)
        .for_families([&TANK])
        .of_columns(&ENERGIES)
}

/// Energies of every state (figure 12).
pub(super) fn of_every_state() -> Figure {
    const NAME: &str = "state-energies";
    let draw = |runs: &Runs<'_>| draw(NAME, runs, true);
    Figure::of_runs(
        NAME,
        "the same, one run of every state",
        &choice::STATES,
        draw,
    )
    .for_families([&TANK])
    .of_columns(&ENERGIES)
}

/// The columns of these energies.
const ENERGIES: [&str; 3] = ["kinetic", "rotational", "gravitational"];

/// The part of a run that is shown larger (s).
const BEGIN: f64 = 1.0;

/// The end of a run that stands for its rest if it never settles, as a share.
const END: f64 = 0.1;

/// Kinds of energy, in the order of [`palette::LINES`].
const KINDS: [&str; 3] = [
    "kinetic",
    "rotational",
    "potential, zero at the settled height",
];

/// Draws energies over time; `with_states`: heads name the states.
fn draw(name: &'static str, runs: &Runs<'_>, with_states: bool) -> Result<Svg, PlotError> {
    let mut panels = Vec::new();
    for run in &runs.shown {
        let mut head = run.name.clone();
        if with_states {
            let state = run.verdict.label.name.replace('-', " ");
            match head.first_mut() {
                Some(first) => *first = format!("{state}: {first}"),
                None => head.push(state),
            }
        }
        panels.extend(of_run(run, head, run.record()?.as_ref()));
    }
    let unit = chart::scaled("J", &mut panels);
    let single = runs.shown.len() == 1;
    Chart {
        name,
        common: runs.common.clone(),
        panels,
        columns: 2,
        height: if single { px(240) } else { px(130) },
        x_label: "time (s)".to_owned(),
        y_label: format!("mean energy of a sphere ({unit})"),
        legend: palette::LINES
            .into_iter()
            .zip(KINDS.map(str::to_owned))
            .collect(),
        notes: Vec::from_iter(runs.left_out.clone().filter(|_| with_states)),
    }
    .draw(&runs.origin)
}

/// Mean energies of a sphere over time (s, J): the whole run, and its begin.
fn of_run(run: &ShownRun<'_>, head: Vec<String>, record: &RunRecord) -> [ChartPanel; 2] {
    let observations = &record.observations;
    let spheres = record.radius.len().max(1) as f64;
    let duration = record.scene.time.duration;
    let settled = run.verdict.value("settle_time");
    let settled = settled.unwrap_or((1.0 - END) * duration);
    let zero = mean_after(&observations.time, &observations.gravitational, settled);
    let kinds = [
        (&observations.kinetic, 0.0),
        (&observations.rotational, 0.0),
        (&observations.gravitational, zero),
    ];
    let kinds = kinds.into_iter().zip(palette::LINES);
    let lines = kinds.map(|((values, zero), color)| {
        let mut line = ChartLine::over(&observations.time, values, color);
        for point in &mut line.points {
            point.1 = (point.1 - zero) / spheres;
        }
        line
    });
    let lines: Vec<ChartLine> = lines.collect();
    let begin = if duration > BEGIN {
        BEGIN
    } else {
        0.2 * duration
    };
    let larger = match begin {
        1.0 => "first second".to_owned(),
        _ => format!("first {} s", numbers::number(begin)),
    };
    [(head, duration), (vec![larger], begin)]
        .map(|(head, end)| ChartPanel::new(head, (0.0, end), lines.clone()))
}

/// Mean of the values from a time on; the last value if there are none.
fn mean_after(time: &[f64], values: &[f32], from: f64) -> f64 {
    let later: Vec<f64> = time
        .iter()
        .zip(values)
        .filter(|(time, _)| **time >= from)
        .map(|(_, value)| f64::from(*value))
        .collect();
    match values.last() {
        _ if !later.is_empty() => later.iter().sum::<f64>() / later.len() as f64,
        Some(last) => f64::from(*last),
        None => 0.0,
    }
}
