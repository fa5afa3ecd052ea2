//! The time of a step with each way to find neighbours, against the number of spheres or the side
//! of a cell (Remmers, 2009, assignments 7 and 8).

use super::chart::{self, Chart, ChartLine, ChartPanel};
use super::style::px;
use super::svg::Svg;
use super::{PlotError, palette};
use crate::record::Program;
use crate::scene::Scene;

/// One line of the figure: what was measured, against what.
pub struct StepTimes {
    /// Name of the search, with its parameters.
    pub name: String,
    /// Pairs of x and the time of a step (s), in order of x.
    pub points: Vec<(f64, f64)>,
}

/// What stands below the figure.
#[derive(Clone, Copy, Debug)]
pub enum Against {
    /// Number of spheres that move.
    Count,
    /// Side of a cell (m).
    Length,
}

/// Draws times of a step.
///
/// # Errors
/// [`PlotError`] if the figure cannot be drawn.
pub fn draw(
    times: &[StepTimes],
    against: Against,
    scene: &Scene,
    program: &Program,
) -> Result<Svg, PlotError> {
    let colors = palette::LINES.into_iter().cycle();
    let line = |(line, color): (&StepTimes, _)| ChartLine {
        points: line.points.clone(),
        color,
    };
    let lines: Vec<ChartLine> = times.iter().zip(colors).map(line).collect();
    let legend = lines.iter().zip(times);
    let legend = legend
        .map(|(line, time)| (line.color, time.name.clone()))
        .collect();
    let largest = times.iter().flat_map(|line| &line.points);
    let largest = largest.map(|point| point.0).fold(0.0, f64::max);
    let mut panels = vec![ChartPanel::new(Vec::new(), (0.0, largest), lines).down_to_zero()];
    let unit = chart::scaled("s", &mut panels);
    let chart = Chart {
        name: match against {
            Against::Count => "step-time-count",
            Against::Length => "step-time-length",
        },
        legend,
        panels,
        columns: 1,
        height: px(380),
        x_label: match against {
            Against::Count => "number of spheres that move $n$".to_owned(),
            Against::Length => "side of a cell $L$ (m)".to_owned(),
        },
        y_label: format!("processor time of a step ({unit})"),
        ..Chart::default()
    };
    let body = chart.body(scene.title.as_deref())?;
    Ok(Svg::of_scene(chart.name, scene, program, &body))
}
