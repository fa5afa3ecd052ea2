//! The net vertical force on a sphere that has just entered the single layer in the middle of the
//! tank, over its radius (Rice, 2012, eq. 46 and figure 21).
//!
//! The thesis leaves the factor of its eq. 44 open, a lift proportional to Omega^2. Here it is such
//! that the lift at the scene's own Omega is the scene's updraught, whether that depends on Omega
//! or not.

use super::chart::{self, Chart, ChartLine, ChartPanel, samples};
use super::critical_rotation::{radii, volume};
use super::page::columns;
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, Source, choice, numbers, palette};
use crate::classify::TANK;
use crate::scene::Scene;
use crate::theory::unshielded_lift;
use plotters::style::RGBColor;

/// Name of the figure.
const NAME: &str = "net-force";

/// Rotations that are shown, over the rotation of the scene.
const ROTATIONS: [f64; 3] = [0.5, 0.75, 1.0];

/// Keys that vary in the figure.
const SHOWN: [&str; 2] = ["spheres.radius", "swirl.omega"];

pub(super) fn figure() -> Figure {
    Figure::of_sweep(
        NAME,
        "theory: net vertical force in a single layer over the radius, three rotations (eq. 46)",
        draw,
    )
    .for_families([&TANK])
}

fn draw(source: &Source<'_>) -> Result<Svg, PlotError> {
    let scenes = source.sweep.scenes();
    let largest = radii(source).1;
    let mut panels = Vec::new();
    for (index, &scene) in scenes.iter().enumerate() {
        let variant = source.sweep.variant(index as f64);
        let head = variant.map(|variant| variant.name.clone());
        let lines = lines(scene, largest).ok_or_else(needs)?;
        let x = (0.0, largest * 1e3);
        panels.push(ChartPanel::new(Vec::from_iter(head), x, lines));
    }
    let unit = chart::scaled("N", &mut panels);
    Chart {
        name: NAME,
        common: common(source),
        legend: legend(&scenes).ok_or_else(needs)?,
        columns: columns(panels.len()),
        height: if panels.len() == 1 { px(400) } else { px(240) },
        panels,
        x_label: "radius of the sphere $r$ (mm)".to_owned(),
        y_label: format!("net vertical force $F_z$ ({unit})"),
        notes: notes(&scenes),
    }
    .draw(&source.origin())
}

/// The lines of a scene, one for each rotation.
fn lines(scene: &Scene, largest: f64) -> Option<Vec<ChartLine>> {
    let line = |(share, color): (f64, RGBColor)| {
        let point = |radius: f64| Some((radius * 1e3, net_force(scene, radius, share)?));
        let points: Option<Vec<_>> = samples(0.0, largest).map(point).collect();
        Some(ChartLine {
            points: points?,
            color,
        })
    };
    ROTATIONS
        .into_iter()
        .zip(palette::LINES)
        .map(line)
        .collect()
}

/// The rotations of the lines, over those of the scenes if these have several.
fn legend(scenes: &[&Scene]) -> Option<Vec<(RGBColor, String)>> {
    let omegas = scenes.iter().map(|scene| {
        let swirl = scene.dem.effects.swirl.as_ref()?;
        Some(swirl.omega)
    });
    let omegas: Vec<f64> = omegas.collect::<Option<_>>()?;
    let is_one = omegas.iter().all(|omega| *omega == omegas[0]);
    let name = |share: f64| {
        let own = if share == 1.0 {
            ", as in the scene"
        } else {
            ""
        };
        match is_one {
            true => format!("$Ω$ = {} rad/s{own}", numbers::number(share * omegas[0])),
            false => format!("{} $Ω$ of the variant", numbers::number(share)),
        }
    };
    let lines = palette::LINES.into_iter().zip(ROTATIONS.map(name));
    Some(lines.collect())
}

/// The values that axes vary and the figure takes from the scene, where all variants share them.
fn common(source: &Source<'_>) -> Vec<String> {
    let scenes = source.sweep.scenes();
    let axes = source
        .sweep
        .axes
        .iter()
        .filter(|axis| !axis.is_of_variants());
    let others = axes.filter(|axis| !SHOWN.contains(&axis.key.as_str()));
    others
        .filter_map(|axis| {
            let mut values = scenes.iter().map(|scene| scene.number(&axis.key));
            let first = values.next()??;
            let is_one = values.all(|value| value == Some(first));
            is_one.then(|| choice::quantity(source, &axis.key, first))
        })
        .collect()
}

fn needs() -> PlotError {
    PlotError::needs(NAME, "gravity, drag, swirl and updraught")
}

/// What the curves assume and the scene does not.
fn notes(scenes: &[&Scene]) -> Vec<String> {
    let mut updraughts = scenes
        .iter()
        .filter_map(|it| it.dem.effects.updraught.as_ref());
    if updraughts.all(|updraught| updraught.reference_omega.is_some()) {
        return Vec::new();
    }
    vec![
        "In this scene the updraught does not depend on $Ω$. The curves of other rotations assume \
         a lift proportional to $Ω$² (Rice, 2012, eq. 44)."
            .to_owned(),
    ]
}

/// Lift at `share` of the scene's rotation less weight (N), of a sphere at rest on the floor.
fn net_force(scene: &Scene, radius: f64, share: f64) -> Option<f64> {
    let updraught = scene.dem.effects.updraught.as_ref()?;
    let floor = scene.tank.as_ref().and_then(|tank| tank.floor);
    let height = floor.unwrap_or(updraught.origin) + radius;
    let (swirl, drag) = (&scene.dem.effects.swirl, &scene.dem.effects.drag);
    let lift = unshielded_lift(updraught, swirl.as_ref(), drag.as_ref()?, radius, height);
    let mass = scene.spheres.density * volume(radius);
    Some(share * share * lift - mass * scene.gravity_in_fluid()?.acceleration)
}
