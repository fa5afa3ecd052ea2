//! The net vertical force on a sphere that has just entered the single layer in the middle of the
//! tank, over its radius (Rice, 2012, eq. 46 and figure 21).
//!
//! The thesis leaves the factor of its eq. 44 open, a lift proportional to Omega^2. Here it is such
//! that the lift at the scene's own Omega is the scene's updraught, whether that depends on Omega
//! or not.

use super::chart::{self, Chart, ChartLine, ChartPanel, samples};
use super::critical_rotation::{radii, volume};
use super::style::px;
use super::svg::Svg;
use super::{Figure, PlotError, Source, numbers, palette};
use crate::classify::TANK;
use crate::scene::Scene;
use crate::theory::unshielded_lift;

/// Name of the figure.
const NAME: &str = "net-force";

/// Rotations that are shown, over the rotation of the scene.
const ROTATIONS: [f64; 3] = [0.5, 0.75, 1.0];

pub(super) fn figure() -> Figure {
    Figure::of_sweep(
        NAME,
        "theory: net vertical force in a single layer over the radius, three rotations (eq. 46)",
        draw,
    )
    .for_families([&TANK])
}

fn draw(source: &Source<'_>) -> Result<Svg, PlotError> {
    let scene = &source.sweep.scene;
    let largest = radii(source).1;
    let mut lines = Vec::new();
    for (share, color) in ROTATIONS.into_iter().zip(palette::LINES) {
        let point = |radius: f64| Some((radius * 1e3, net_force(scene, radius, share)?));
        let points: Option<Vec<_>> = samples(0.0, largest).map(point).collect();
        let points = points.ok_or_else(needs)?;
        lines.push(ChartLine { points, color });
    }
    let mut panels = vec![ChartPanel::new(Vec::new(), (0.0, largest * 1e3), lines)];
    let unit = chart::scaled("N", &mut panels);
    let omega = scene.dem.effects.swirl.as_ref().ok_or_else(needs)?.omega;
    let name = |share: f64| {
        let own = if share == 1.0 {
            ", as in the scene"
        } else {
            ""
        };
        format!("$Ω$ = {} rad/s{own}", numbers::number(share * omega))
    };
    Chart {
        name: NAME,
        legend: palette::LINES
            .into_iter()
            .zip(ROTATIONS.map(name))
            .collect(),
        panels,
        columns: 1,
        height: px(400),
        x_label: "radius of the sphere $r$ (mm)".to_owned(),
        y_label: format!("net vertical force $F_z$ ({unit})"),
        notes: notes(scene),
        ..Chart::default()
    }
    .draw(&source.origin())
}

fn needs() -> PlotError {
    PlotError::needs(NAME, "gravity, drag, swirl and updraught")
}

/// What the curves assume and the scene does not.
fn notes(scene: &Scene) -> Vec<String> {
    let updraught = scene.dem.effects.updraught.as_ref();
    if updraught.is_none_or(|updraught| updraught.reference_omega.is_some()) {
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
