//! The critical rotation over the radius of the spheres (Rice, 2012, eq. 43 and figure 19).

use super::chart::{self, Chart, Line, Panel};
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, Source, choice, palette};
use crate::classify::{Family, TANK};
use crate::scene::Scene;
use crate::theory::critical_rotation;
use plotters::style::RGBColor;

/// The critical rotation over the radius of the spheres.
pub(super) struct CriticalRotation;

/// Points of a curve over the radius.
pub(super) const SAMPLES: usize = 300;

/// Axes of a sweep that move the curve, each value to one line, as many as there are colours.
const MOVING: [&str; 3] = ["spheres.count", "tank.radius", "gravity.acceleration"];

impl Figure for CriticalRotation {
    fn name(&self) -> &'static str {
        "critical-rotation"
    }

    fn description(&self) -> String {
        "theory: critical rotation over the radius of the spheres (eq. 43)".to_owned()
    }

    fn family(&self) -> Option<&'static Family> {
        Some(&TANK)
    }

    fn draw(&self, source: &Source<'_>) -> Result<Svg, PlotError> {
        let (low, high) = radii(source);
        let mut curves = Vec::new();
        for (name, color, scene) in scenes(source) {
            let omega = |radius: f64| critical(&scene, radius).map(|omega| (radius * 1e3, omega));
            let points: Option<Vec<_>> = samples(low, high).map(omega).collect();
            let points = points.ok_or(PlotError::Scene {
                figure: self.name(),
                needs: "a tank with a radius, and gravity",
            })?;
            curves.push((name, Line { points, color }));
        }
        let all = curves.iter().flat_map(|(_, line)| &line.points);
        let top = chart::range(all.map(|point| point.1)).map_or(1.0, |(_, high)| high);
        let legend = match &curves[..] {
            [_] => Vec::new(),
            _ => curves
                .iter()
                .map(|(name, line)| (line.color, name.clone()))
                .collect(),
        };
        Chart {
            name: self.name(),
            common: fixed(source),
            panels: vec![Panel {
                head: Vec::new(),
                x: (low * 1e3, high * 1e3),
                y: (0.0, top),
                lines: curves.into_iter().map(|(_, line)| line).collect(),
                bars: Vec::new(),
            }],
            columns: 1,
            height: px(400),
            x_label: "radius of the spheres $r$ (mm)".to_owned(),
            y_label: "critical rotation $Ω_c$ (rad/s)".to_owned(),
            legend,
            notes: Vec::new(),
        }
        .draw(source)
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

/// The radii of the figure (m): those of the sweep, or else around that of the scene.
pub(super) fn radii(source: &Source<'_>) -> (f64, f64) {
    let sweep = source.sweep;
    let axis = sweep.axes.iter().find(|axis| axis.key == "spheres.radius");
    let values = axis.map_or(&[][..], |axis| &axis.values);
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(0.0, f64::max);
    if low < high {
        (low, high)
    } else {
        let radius = libm::cbrt(sweep.scene.spheres.radius.mean_volume() / volume(1.0));
        (0.5 * radius, 1.5 * radius)
    }
}

/// Volume of a sphere (m3).
pub(super) fn volume(radius: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius
}

/// Values from `low` to `high`.
pub(super) fn samples(low: f64, high: f64) -> impl Iterator<Item = f64> {
    (0..=SAMPLES).map(move |index| low + (high - low) * index as f64 / SAMPLES as f64)
}
