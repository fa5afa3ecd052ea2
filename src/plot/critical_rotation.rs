//! The critical rotation over the radius of the spheres (Rice, 2012, eq. 43 and figure 19).

use super::chart::{Chart, ChartLine, ChartPanel, ends, samples};
use super::grid::GridAxis;
use super::spacing::AxisSpacing;
use super::style::px;
use super::svg::Svg;
use super::ticks::Ticks;
use super::{Figure, PlotError, Source, choice, palette};
use crate::classify::TANK;
use crate::scene::Scene;
use crate::theory::critical_rotation;
use plotters::style::RGBColor;

/// Name of the figure.
const NAME: &str = "critical-rotation";

/// Axes of a sweep that move the curve, each value to one line, as many as there are colours.
const MOVING: [&str; 3] = ["spheres.count", "tank.radius", "gravity.acceleration"];

pub(super) fn figure() -> Figure {
    Figure::of_sweep(
        NAME,
        "theory: critical rotation over the radius of the spheres (eq. 43)",
        draw,
    )
    .for_families([&TANK])
}

fn draw(source: &Source<'_>) -> Result<Svg, PlotError> {
    let (low, high) = radii(source);
    let x = (low * 1e3, high * 1e3);
    let (spacing, ticks) = axis(source);
    let (mut lines, mut legend) = (Vec::new(), Vec::new());
    for (name, color, scene) in scenes(source) {
        let omega = |radius: f64| critical(&scene, radius * 1e-3).map(|omega| (radius, omega));
        let radii = samples(0.0, 1.0).map(|share| spacing.along(share, x.0, x.1));
        let points: Option<Vec<_>> = radii.map(omega).collect();
        let points =
            points.ok_or_else(|| PlotError::needs(NAME, "a tank with a radius, and gravity"))?;
        lines.push(ChartLine { points, color });
        legend.push((color, name));
    }
    if lines.len() == 1 {
        legend.clear();
    }
    Chart {
        name: NAME,
        common: fixed(source),
        panels: vec![ChartPanel {
            spacing: [spacing, AxisSpacing::Linear],
            ticks,
            ..ChartPanel::new(Vec::new(), x, lines).down_to_zero()
        }],
        columns: 1,
        height: px(400),
        x_label: "radius of the spheres $r$ (mm)".to_owned(),
        y_label: "critical rotation $Ω_c$ (rad/s)".to_owned(),
        legend,
        ..Chart::default()
    }
    .draw(&source.origin())
}

/// How radii (mm) are spaced, and where they have ticks: as on other figures of the sweep.
fn axis(source: &Source<'_>) -> (AxisSpacing, Ticks) {
    let mut axes = source.sweep.axes.iter();
    let index = axes.position(|axis| axis.key == "spheres.radius");
    let axis = index.map(|index| GridAxis {
        factor: 1e3,
        ..GridAxis::new(index, source.sweep, source.table)
    });
    match axis.map(|axis| (axis.spacing(), axis.shown())) {
        Some((spacing @ AxisSpacing::Equal(_), radii)) => (spacing, Ticks::Values(radii)),
        Some((spacing, _)) => (spacing, Ticks::Round),
        None => (AxisSpacing::Linear, Ticks::Round),
    }
}

fn critical(scene: &Scene, radius: f64) -> Option<f64> {
    let omega = critical_rotation(
        scene.spheres.count as f64,
        radius,
        scene.tank.as_ref()?.radius?,
        scene.dem.effects.gravity.as_ref()?.acceleration,
    );
    Some(omega)
}

/// The scenes to draw a line of, each with its name and colour: one, or one for each value of an
/// axis that moves the curve.
fn scenes(source: &Source<'_>) -> Vec<(String, RGBColor, Scene)> {
    let sweep = source.sweep;
    let moving = |key: &str| MOVING.contains(&key);
    let Some(axis) = sweep.axes.iter().find(|axis| moving(&axis.key)) else {
        return vec![(String::new(), palette::LINES[0], sweep.scene.clone())];
    };
    let values = axis.values.iter().zip(palette::LINES);
    values
        .filter_map(|(&value, color)| {
            let scene = sweep.scene.with_values([(axis.key.as_str(), value)]).ok()?;
            let name = choice::quantity(source, &axis.key, &axis.name, value);
            Some((name, color, scene))
        })
        .collect()
}

/// What the curve is for: number of spheres, tank and gravity, where no axis moves them.
fn fixed(source: &Source<'_>) -> Vec<String> {
    let scene = &source.sweep.scene;
    let mut keys = source.sweep.axes.iter().map(|axis| axis.key.as_str());
    let moved = keys.find(|key| MOVING.contains(key));
    let values = [
        Some(scene.spheres.count as f64),
        scene.tank.as_ref().and_then(|tank| tank.radius),
        scene
            .dem
            .effects
            .gravity
            .as_ref()
            .map(|gravity| gravity.acceleration),
    ];
    let pairs = MOVING.into_iter().zip(values);
    let fixed = pairs.filter(|(key, _)| Some(*key) != moved);
    fixed
        .filter_map(|(key, value)| Some(choice::quantity(source, key, key, value?)))
        .collect()
}

/// The radii of the figure (m): the range of the sweep, or else around the radius of the scene.
pub(super) fn radii(source: &Source<'_>) -> (f64, f64) {
    let sweep = source.sweep;
    let axis = sweep.axes.iter().find(|axis| axis.key == "spheres.radius");
    let values = axis.map_or(&[][..], |axis| &axis.values);
    let (low, high) = ends(values.iter().copied());
    if low < high {
        (low, high)
    } else {
        let radius = sweep.scene.spheres.radius.of_mean_volume();
        (0.5 * radius, 1.5 * radius)
    }
}

/// Volume of a sphere (m3).
pub(super) fn volume(radius: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius
}
