//! The ledger of a run: where its energy is and went, and what the integrator got wrong.

use super::chart::{self, Chart, ChartLine, ChartPanel};
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, palette};
use crate::observe::Observations;
use crate::record::RunRecord;
use plotters::style::BLACK;

/// The name of a kind of energy, and its values over time (J).
type Account = (&'static str, ChartLine);

pub(super) fn figure() -> Figure {
    let description = "where the energy went, from the record of one run with its ledger";
    Figure::of_record("ledger", description, draw)
}

fn draw(record: &RunRecord) -> Result<Svg, PlotError> {
    let observations = &record.observations;
    if observations.residual.is_empty() {
        return Err(PlotError::nothing(
            "the record holds no ledger of energy; add `ledger = true` to [output] of the scene \
             and run it again",
        ));
    }
    let accounts = accounts(observations);
    let residual = ChartLine::over(&observations.time, &observations.residual, BLACK);
    let legend = accounts.iter();
    let legend = legend
        .map(|(name, line)| (line.color, (*name).to_owned()))
        .collect();
    let lines = accounts.into_iter().map(|(_, line)| line).collect();
    let panels = vec![
        panel("where the energy is, and went", lines),
        panel("residual, what the integrator got wrong", vec![residual]),
    ];
    let chart = Chart {
        name: "ledger",
        common: vec![format!(
            "{}, time step {} s",
            record.scene.time.integrator.name(),
            crate::document::number(record.scene.time.dt)
        )],
        panels,
        columns: 1,
        height: px(240),
        x_label: "time (s)".to_owned(),
        y_label: "energy".to_owned(),
        legend,
        ..Chart::default()
    };
    let body = chart.body(record.scene.title.as_deref())?;
    Ok(Svg::of_record("ledger", record, &body))
}

/// All kinds of energy that the run knew.
fn accounts(observations: &Observations) -> Vec<Account> {
    let [blue, red, green, pink, orange, light_blue] = palette::DISTINCT;
    let line = |values, color| ChartLine::over(&observations.time, values, color);
    let mut gravitational = line(&observations.gravitational, green);
    let start = gravitational.points.first().map_or(0.0, |point| point.1);
    for point in &mut gravitational.points {
        point.1 -= start;
    }
    let mut elastic = line(&observations.elastic, palette::LINES[0]);
    for (point, springs) in elastic.points.iter_mut().zip(&observations.springs) {
        point.1 += f64::from(*springs);
    }
    let accounts = [
        ("kinetic", line(&observations.kinetic, blue)),
        ("rotational", line(&observations.rotational, light_blue)),
        ("gravitational, from the start on", gravitational),
        ("elastic, in contacts and tangential springs", elastic),
        (
            "dissipated by damping",
            line(&observations.dissipated_by_damping, red),
        ),
        (
            "dissipated by friction",
            line(&observations.dissipated_by_friction, orange),
        ),
        ("work of the air", line(&observations.work_of_air, pink)),
        ("work of the walls", line(&observations.work_of_walls, pink)),
        (
            "work of the shaking",
            line(&observations.work_of_shaking, BLACK),
        ),
        (
            "brought by spheres",
            line(&observations.energy_brought, palette::GUIDE),
        ),
    ];
    let is_known = |(_, line): &Account| line.points.iter().any(|point| point.1 != 0.0);
    accounts.into_iter().filter(is_known).collect()
}

/// A panel in the unit that its largest value asks for, which its head names.
fn panel(head: &str, lines: Vec<ChartLine>) -> ChartPanel {
    let ends = lines.iter().filter_map(|line| line.points.last());
    let end = ends.map(|point| point.0).fold(0.0, f64::max);
    let mut panel = ChartPanel::new(Vec::new(), (0.0, end), lines);
    let unit = chart::scaled("J", std::slice::from_mut(&mut panel));
    panel.head.push(format!("{head} ({unit})"));
    panel
}
