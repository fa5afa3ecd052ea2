//! Speeds of air and spheres over time (Rice, 2012, figure 4).

use super::chart::{Chart, Line, Panel};
use super::page::columns;
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, Source, choice, palette};
use crate::classify::{Family, TANK};
use crate::record::RunRecord;

/// Speeds of air and spheres over time.
pub(super) struct Speeds;

impl Figure for Speeds {
    fn name(&self) -> &'static str {
        "speeds"
    }

    fn description(&self) -> String {
        "mean speeds of the spheres, and of the swirling air where they are, over time".to_owned()
    }

    fn default_runs(&self) -> Option<&'static str> {
        Some("the corners of the grid and between them")
    }

    fn families(&self) -> Vec<&'static Family> {
        vec![&TANK]
    }

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let runs = choice::runs(source, choice::corners)?;
        let (common, places) = choice::places(&runs);
        let panels = runs
            .iter()
            .zip(places)
            .map(|(run, place)| Ok(panel(place, &run.record()?)))
            .collect::<Result<Vec<_>, PlotError>>()?;
        Chart {
            name: self.name(),
            common,
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
        .draw(source)
    }
}

const AIR: plotters::style::RGBColor = palette::LINES[2];
const SPHERES: plotters::style::RGBColor = palette::LINES[0];

fn panel(head: Vec<String>, record: &RunRecord) -> Panel {
    let observations = &record.observations;
    let line = |values, color| Line::over(&observations.time, values, color);
    let lines = vec![
        line(&observations.air_speed_mean, AIR),
        line(&observations.speed_mean, SPHERES),
    ];
    Panel::new(head, (0.0, record.scene.time.duration), lines).down_to_zero()
}
