//! Speeds of air and spheres over time (Rice, 2012, figure 4).

use super::chart::{Chart, ChartLine, ChartPanel};
use super::page::columns;
use super::runs::Runs;
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, choice, palette};
use crate::classify::TANK;
use crate::record::RunRecord;

/// Name of the figure.
const NAME: &str = "speeds";

pub(super) fn figure() -> Figure {
    Figure::of_runs(
        NAME,
        "mean speeds of the spheres, and of the swirling air where they are, over time",
        &choice::CORNERS,
        draw,
    )
    .for_families([&TANK])
    .of_columns(&["speed_mean", "air_speed_mean"])
}

fn draw(runs: &Runs<'_>) -> Result<Svg, PlotError> {
    let shown = runs.shown.iter();
    let panels = shown
        .map(|run| Ok(panel(run.name.clone(), run.record()?.as_ref())))
        .collect::<Result<Vec<_>, PlotError>>()?;
    Chart {
        name: NAME,
        common: runs.common.clone(),
        columns: columns(panels.len()),
        height: if panels.len() == 1 { px(360) } else { px(190) },
        panels,
        x_label: "time (s)".to_owned(),
        y_label: "mean speed (m/s)".to_owned(),
        legend: vec![
            (AIR, "air at the spheres".to_owned()),
            (SPHERES, "spheres".to_owned()),
        ],
        ..Chart::default()
    }
    .draw(&runs.origin)
}

const AIR: plotters::style::RGBColor = palette::LINES[2];
const SPHERES: plotters::style::RGBColor = palette::LINES[0];

fn panel(head: Vec<String>, record: &RunRecord) -> ChartPanel {
    let observations = &record.observations;
    let line = |values, color| ChartLine::over(&observations.time, values, color);
    let lines = vec![
        line(&observations.air_speed_mean, AIR),
        line(&observations.speed_mean, SPHERES),
    ];
    ChartPanel::new(head, (0.0, record.scene.time.duration), lines).down_to_zero()
}
