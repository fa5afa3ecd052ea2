//! The downward velocity across a box at several heights, and how fast the flow widens upwards.

use super::{MeasuredDrainage, each, of_drainages};
use crate::compare::{DRAWN_HEIGHTS, flow_spread_of, profile_at};
use crate::measure::flow_width;
use crate::plot::chart::{self, Bar, Chart, ChartLine, ChartPanel};
use crate::plot::page::columns;
use crate::plot::runs::Runs;
use crate::plot::style::px;
use crate::plot::svg::Svg;
use crate::plot::{Figure, PlotError, palette};
use crate::scene::Units;
use plotters::style::RGBColor;

/// Name of the figure.
const NAME: &str = "velocity-profile";

const COLORS: [RGBColor; 3] = [palette::LINES[0], palette::LINES[1], palette::LINES[2]];

pub(super) fn figure() -> Figure {
    of_drainages(
        NAME,
        "downward velocity across the box at three heights, and the diffusion length of the flow",
        false,
        draw,
    )
}

fn draw(runs: &Runs<'_>) -> Result<Svg, PlotError> {
    let mut time = Units::Si.of_time();
    let mut panels = each(runs, NAME, |place, drainage| {
        time = drainage.units().of_time();
        panel(place, drainage)
    })?;
    // Velocities of runs beside each other are compared by eye.
    let highest = panels.iter().map(|it| it.y.1).fold(0.0, f64::max);
    for panel in &mut panels {
        panel.y.1 = highest;
    }
    let legend = COLORS.into_iter().zip(DRAWN_HEIGHTS);
    let legend =
        legend.map(|(color, share)| (color, format!("at {:.0} % of the height", 100.0 * share)));
    Chart {
        name: NAME,
        common: runs.common.clone(),
        columns: columns(panels.len()),
        height: if panels.len() == 1 { px(340) } else { px(220) },
        panels,
        x_label: "place along the width $x$ / $d$".to_owned(),
        y_label: format!("downward velocity $v_z$ (diameters/{time})"),
        legend: legend.collect(),
        notes: vec![
            "Bars: 95 % of what was measured in layers of four diameters. Lines: Gaussians \
             with images in the side walls. The diffusion length $b$ is fitted to the widths \
             of six layers, $σ$² = 2 $b$ ($z$ − $z_0$), with its 95 % interval."
                .to_owned(),
        ],
    }
    .draw(&runs.origin)
}

fn panel(mut head: Vec<String>, drainage: &MeasuredDrainage<'_>) -> ChartPanel {
    let diameter = drainage.filled_box.diameter;
    let walls = Some(drainage.filled_box.half_width);
    if let Some(spread) = flow_spread_of(drainage) {
        let b = spread.diffusion_length;
        head.push(format!(
            "$b$ = ({:.2} ± {:.2}) $d$",
            b.value / diameter,
            b.half_width / diameter
        ));
    }
    let end = drainage.filled_box.half_width / diameter;
    let (mut lines, mut bars) = (Vec::new(), Vec::new());
    for (share, color) in DRAWN_HEIGHTS.into_iter().zip(COLORS) {
        let profile = profile_at(drainage, share);
        for point in profile.values() {
            let at = (point.place / diameter, point.value.value / diameter);
            bars.push(Bar::about(at, point.value.half_width / diameter, color));
        }
        let points = flow_width(&profile, walls).map(|fit| {
            let places = chart::samples(-end, end);
            places
                .map(|x| (x, fit.velocity(x * diameter, walls) / diameter))
                .collect()
        });
        lines.push(ChartLine {
            points: points.unwrap_or_default(),
            color,
        });
    }
    ChartPanel::new(head, (-end, end), lines)
        .with_bars(bars)
        .down_to_zero()
}
