//! The time of a step with each way to find neighbours, against the number of spheres or the side
//! of a cell (Remmers, 2009, assignments 7 and 8).

use super::chart::{self, Chart, Line, Panel};
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
    let points = || times.iter().flat_map(|line| &line.points);
    let longest = points().map(|point| point.1).fold(0.0, f64::max);
    let (unit, factor) = chart::prefixed("s", longest);
    let largest = points().map(|point| point.0).fold(0.0, f64::max);
    let colors = || palette::LINES.into_iter().cycle();
    let chart = Chart {
        name: match against {
            Against::Count => "step-time-count",
            Against::Length => "step-time-length",
        },
        common: Vec::new(),
        legend: times
            .iter()
            .zip(colors())
            .map(|(line, color)| (color, line.name.clone()))
            .collect(),
        panels: vec![Panel {
            head: Vec::new(),
            bars: Vec::new(),
            x: (0.0, largest),
            y: (0.0, 1.04 * factor * longest),
            lines: times
                .iter()
                .zip(colors())
                .map(|(line, color)| Line {
                    points: line.points.iter().map(|(x, y)| (*x, y * factor)).collect(),
                    color,
                })
                .collect(),
        }],
        columns: 1,
        height: px(380),
        x_label: match against {
            Against::Count => "number of spheres that move $n$".to_owned(),
            Against::Length => "side of a cell $L$ (m)".to_owned(),
        },
        y_label: format!("processor time of a step ({unit})"),
        notes: Vec::new(),
    };
    let (size, body) = chart.body(scene.title.as_deref())?;
    Ok(Svg::of_scene(chart.name, scene, program, size, &body))
}
