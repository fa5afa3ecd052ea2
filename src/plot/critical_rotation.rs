//! The critical rotation over the radius of the spheres (Rice, 2012, eq. 43 and figure 19).

use super::chart::{Chart, ChartLine, ChartPanel, ends, samples};
use super::grid::GridAxis;
use super::spacing::AxisSpacing;
use super::style::px;
use super::svg::Svg;
use super::ticks::Ticks;
use super::{Figure, PlotError, Source, choice, palette};
use crate::classify::TANK;
use crate::grid::{self, Axis, PointScenes};
use crate::scene::Scene;
use crate::theory::critical_rotation;

/// Name of the figure.
const NAME: &str = "critical-rotation";

/// Keys that move the curve. Each set of their values has a line, as far as there are colours.
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
    let curves = curves(source)
        .ok_or_else(|| PlotError::needs(NAME, "a tank with a radius, and gravity"))?;
    let (mut lines, mut legend) = (Vec::new(), Vec::new());
    for (curve, color) in curves.iter().zip(palette::LINES) {
        let [count, tank, gravity] = curve.values;
        let radii = samples(0.0, 1.0).map(|share| spacing.along(share, x.0, x.1));
        let points = radii.map(|radius| {
            let critical = critical_rotation(count, radius * 1e-3, tank, gravity);
            (radius, critical)
        });
        lines.push(ChartLine {
            points: points.collect(),
            color,
        });
        legend.push((color, curve.names.join(" or ")));
    }
    let left_out = curves.len() - lines.len();
    let left_out = (left_out > 0).then(|| format!("{left_out} more lines are not shown."));
    if curves.len() == 1 {
        legend.clear();
    }
    Chart {
        name: NAME,
        common: common(source, &curves),
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
        notes: left_out.into_iter().collect(),
    }
    .draw(&source.origin())
}

/// How radii (mm) are spaced, and where they have ticks: as on other figures of the sweep.
fn axis(source: &Source<'_>) -> (AxisSpacing, Ticks) {
    let mut axes = source.sweep.axes.iter();
    let index = axes.position(|axis| axis.key == "spheres.radius");
    let axis = index.map(|index| {
        let axis = GridAxis::new(index, source.sweep, source.table);
        GridAxis {
            factor: 1e3 * source.sweep.factors(&axis.name)[0],
            ..axis
        }
    });
    // Variants that scale radii in different ways have no common places.
    let axis = axis.filter(|axis| !axis.is_scaled);
    match axis.map(|axis| (axis.spacing(), axis.shown())) {
        Some((spacing @ AxisSpacing::Equal(_), radii)) => (spacing, Ticks::Values(radii)),
        Some((spacing, _)) => (spacing, Ticks::Round),
        None => (AxisSpacing::Linear, Ticks::Round),
    }
}

/// A curve of the figure.
struct CriticalCurve {
    /// The values of [`MOVING`].
    values: [f64; 3],
    /// The points of the axes that move curves which have these values, with markup.
    names: Vec<String>,
}

/// The curves: one for each set of values that points of the sweep have; none if a scene lacks
/// one.
fn curves(source: &Source<'_>) -> Option<Vec<CriticalCurve>> {
    let sweep = source.sweep;
    let moves = |axis: &Axis| axis.is_of_variants() || MOVING.contains(&axis.key.as_str());
    let axes = sweep.axes.iter().filter(|axis| moves(axis));
    let axes: Vec<Axis> = axes.cloned().collect();
    let scenes = PointScenes::new(&sweep.scene, &axes).ok()?;
    let mut curves: Vec<CriticalCurve> = Vec::new();
    for point in grid::points(&axes) {
        // What moves no curve was not put in, so that this need not be a scene that runs.
        let values = values(&scenes.unchecked(&point).ok()?)?;
        let name = choice::quantities_of(source, &axes, &point).join(", ");
        match curves.iter_mut().find(|curve| curve.values == values) {
            Some(curve) => curve.names.push(name),
            None => curves.push(CriticalCurve {
                values,
                names: vec![name],
            }),
        }
    }
    Some(curves)
}

/// The values of [`MOVING`] in a scene.
fn values(scene: &Scene) -> Option<[f64; 3]> {
    Some([
        scene.spheres.count as f64,
        scene.tank.as_ref()?.radius?,
        scene.dem.effects.gravity.as_ref()?.acceleration,
    ])
}

/// What all curves are for: number of spheres, tank and gravity, where these do not differ.
fn common(source: &Source<'_>, curves: &[CriticalCurve]) -> Vec<String> {
    let Some((first, others)) = curves.split_first() else {
        return Vec::new();
    };
    let pairs = MOVING.into_iter().zip(first.values).enumerate();
    pairs
        .filter(|(index, (_, value))| others.iter().all(|it| it.values[*index] == *value))
        .map(|(_, (key, value))| choice::quantity(source, key, value))
        .collect()
}

/// The radii of the figure (m): the range of the sweep, or else around the radius of its scenes.
pub(super) fn radii(source: &Source<'_>) -> (f64, f64) {
    let sweep = source.sweep;
    let axis = sweep.axes.iter().find(|axis| axis.key == "spheres.radius");
    let values = axis.map_or(&[][..], |axis| &axis.values);
    let factors = axis.map_or_else(Vec::new, |axis| sweep.factors(&axis.name));
    let scaled = factors
        .iter()
        .flat_map(|factor| values.iter().map(move |value| factor * value));
    let (low, high) = ends(scaled);
    if low < high {
        (low, high)
    } else {
        let radii = sweep.scenes().into_iter();
        let (low, high) = ends(radii.map(|scene| scene.spheres.radius.of_mean_volume()));
        (0.5 * low, 1.5 * high)
    }
}

/// Volume of a sphere (m3).
pub(super) fn volume(radius: f64) -> f64 {
    4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius
}
