//! The curves of the critical rotation, without and with friction, drawn over a figure.

use super::chart::samples;
use super::contour::{Nodes, Piece};
use super::diagram::{PanelCurve, Stroke};
use super::grid::{GridAxis, GridPanel, PanelGrid};
use super::scale::AxisSpan;
use crate::scene::Scene;
use crate::theory::{critical_rotation, critical_rotation_with_friction};

const OMEGA: &str = "swirl.omega";

/// What the legend calls the curves without and with friction.
pub(super) const WORDS: [&str; 2] = ["critical rotation $Ω_c$", "with friction, $Ω_μ$"];

/// The curves Omega = Omega_c and Omega = Omega_mu inside a panel, in shown values; empty if the
/// figure has no axis for Omega or the scene lacks what they need. What a panel is for counts
/// instead of the scene's value. On a strip y goes from 0 to 1.
pub(super) fn curves<P>(
    scene: &Scene,
    grid: &PanelGrid<P>,
    panel: &GridPanel<P>,
) -> Vec<PanelCurve> {
    let upright = grid.y.as_ref().is_some_and(|axis| axis.key == OMEGA);
    let (omega, other) = match &grid.y {
        Some(y) if y.key == OMEGA => (y, Some(&grid.x)),
        y if grid.x.key == OMEGA => (&grid.x, y.as_ref()),
        _ => return Vec::new(),
    };
    let along = |critical: &dyn Fn(f64) -> Option<f64>| {
        let mut pieces = pieces(omega, other, critical);
        if !upright {
            let points = pieces.iter_mut().flatten();
            points.for_each(|(place, omega)| std::mem::swap(place, omega));
        }
        pieces
    };
    let value = |key: &str, place: f64| match other {
        Some(axis) if axis.key == key => Some(axis.value(place)),
        _ => fixed(key, grid, panel),
    };
    let without = |place: f64| {
        let value = |key: &str| value(key, place).or_else(|| of_scene(key, scene));
        Some(critical_rotation(
            value("spheres.count")?,
            value("spheres.radius")?,
            value("tank.radius")?,
            value("gravity.acceleration")?,
        ))
    };
    let with = |place: f64| {
        let axes = [
            Some(&grid.x),
            grid.y.as_ref(),
            grid.columns.as_ref(),
            grid.rows.as_ref(),
        ];
        let numbers = axes
            .into_iter()
            .flatten()
            .filter(|axis| axis.words.is_empty());
        let keys = numbers.map(|axis| axis.key.as_str());
        let values = keys.filter(|key| *key != OMEGA).filter_map(|key| {
            let value = value(key, place)?;
            // Between whole numbers of spheres there is no scene.
            let is_number = key == "spheres.count";
            Some((key, if is_number { value.round() } else { value }))
        });
        critical_rotation_with_friction(&scene.with_values(values).ok()?)
    };
    vec![
        PanelCurve {
            pieces: along(&with),
            stroke: Stroke::Dashed,
        },
        PanelCurve {
            pieces: along(&without),
            stroke: Stroke::Full,
        },
    ]
}

/// The pieces of a curve of critical rotations over the places of the other axis.
fn pieces(
    omega: &GridAxis,
    other: Option<&GridAxis>,
    critical: &dyn Fn(f64) -> Option<f64>,
) -> Vec<Piece> {
    let places = samples(0.0, 1.0);
    let places: Vec<f64> = places
        .map(|fraction| other.map_or(fraction, |axis| axis.along(fraction)))
        .collect();
    let shown = |place: &f64| {
        let critical = omega.show(critical(*place)?);
        Some(critical).filter(|critical| critical.is_finite())
    };
    let curve: Vec<Option<f64>> = places.iter().map(shown).collect();
    let AxisSpan { low, high, .. } = omega.span();
    let ends = [low, high];
    Nodes {
        x: &places,
        y: &ends,
        value: &|i, j| Some(ends[j] - curve[i]?),
        logarithmic: [false, false],
    }
    .contour()
}

/// Value of a key that the panel stands for.
fn fixed<P>(key: &str, grid: &PanelGrid<P>, panel: &GridPanel<P>) -> Option<f64> {
    [(&grid.columns, panel.column), (&grid.rows, panel.row)]
        .into_iter()
        .find_map(|(axis, value)| match axis {
            Some(axis) if axis.key == key => value,
            _ => None,
        })
}

fn of_scene(key: &str, scene: &Scene) -> Option<f64> {
    match key {
        "spheres.count" => Some(scene.spheres.count as f64),
        "spheres.radius" => Some(scene.spheres.radius.of_mean_volume()),
        "tank.radius" => scene.tank.as_ref()?.radius,
        "gravity.acceleration" => Some(scene.dem.effects.gravity.as_ref()?.acceleration),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::Source;
    use super::*;
    use crate::classify::{Label, Sieves, TANK, Verdict};
    use crate::classify::{LabelRow, LabelTable};
    use crate::grid::Axis;
    use crate::record::Program;
    use crate::sweep::{PlotSettings, Sweep};
    use serde_json::json;

    const RADIUS: &str = "spheres.radius";

    fn scene() -> Scene {
        serde_json::from_value(json!({
            "spheres": { "count": 256, "radius": 0.004, "density": 1e3 },
            "tank": { "radius": 0.06 },
            "start": { "kind": "random", "z_min": 0.0, "z_max": 0.3 },
            "gravity": { "acceleration": 9.8 },
            "swirl": { "omega": 10.0 },
            "time": { "dt": 1e-4, "duration": 1.0, "frame_interval": 1e-3 },
        }))
        .unwrap()
    }

    /// The curves of all panels of a sweep over these axes, and the shown value over the value of
    /// the horizontal axis.
    fn curves(axes: &[(&str, &[f64])]) -> (Vec<Vec<Piece>>, f64) {
        let axis = |&(key, values): &(&str, &[f64])| Axis::of_numbers(key, key, values.to_vec());
        let sweep = Sweep {
            title: None,
            scene: scene(),
            axes: axes.iter().map(axis).collect(),
            seeds: vec![1],
            refine: None,
            study: None,
            sieves: Sieves::default(),
            plot: PlotSettings::default(),
        };
        let row = LabelRow {
            id: String::new(),
            values: axes.iter().map(|(_, values)| values[0]).collect(),
            seed: 1,
            verdict: Verdict::unmeasured(&TANK, Label::SETTLED),
        };
        let table = LabelTable {
            family: &TANK,
            axes: axes.iter().map(|(key, _)| (*key).to_owned()).collect(),
            variants: Vec::new(),
            rows: vec![row],
        };
        let grid = PanelGrid::new(&Source {
            sweep: &sweep,
            refining: None,
            table: &table,
            record: &|id| panic!("the grid read the record {id}"),
            points: &[],
            times: None,
            program: &Program::current(),
        })
        .unwrap();
        let of = |panel| {
            let mut curves = super::curves(&sweep.scene, &grid, panel);
            curves.pop().map(|curve| curve.pieces).unwrap_or_default()
        };
        (grid.panels.iter().map(of).collect(), grid.x.factor)
    }

    /// Whether a point lies on one of the pieces.
    fn on(pieces: &[Piece], point: (f64, f64)) -> bool {
        pieces
            .iter()
            .flat_map(|piece| piece.windows(2))
            .any(|pair| {
                let ((x0, y0), (x1, y1)) = (pair[0], pair[1]);
                let share = (point.0 - x0) / (x1 - x0);
                (0.0..=1.0).contains(&share) && (y0 + share * (y1 - y0) - point.1).abs() < 1e-3
            })
    }

    #[test]
    fn passes_through_the_critical_rotation_of_each_radius() {
        let radii = [0.002, 0.003, 0.004, 0.005, 0.006];
        let (curves, factor) = curves(&[(RADIUS, &radii), (OMEGA, &[0.0, 20.0, 40.0])]);
        assert!((factor - 1.0 / 0.06).abs() < 1e-12);
        for (radius, omega) in radii
            .into_iter()
            .zip([3.33978, 6.13557, 9.44633, 13.20165, 17.35401])
        {
            assert!(on(&curves[0], (radius / 0.06, omega)), "r = {radius}");
        }
    }

    #[test]
    fn swapped_axes_swap_the_curve() {
        let (curves, _) = curves(&[(OMEGA, &[0.0, 20.0, 40.0]), (RADIUS, &[0.002, 0.006])]);
        let swapped: Vec<Piece> = curves[0]
            .iter()
            .map(|piece| piece.iter().map(|&(x, y)| (y, x)).collect())
            .collect();
        assert!(on(&swapped, (0.004 / 0.06, 9.44633)));
    }

    #[test]
    fn panels_count_with_their_own_values() {
        let radii = [0.002, 0.006];
        let (curves, factor) = curves(&[
            (RADIUS, &radii),
            (OMEGA, &[0.0, 20.0, 40.0]),
            ("tank.radius", &[0.06, 0.12]),
            ("gravity.acceleration", &[9.8, 39.2]),
        ]);
        // The tank differs from panel to panel, so radii are not shown over it.
        assert_eq!(factor, 1.0);
        for (panel, share) in [1.0, 0.25, 2.0, 0.5].into_iter().enumerate() {
            assert!(
                on(&curves[panel], (0.004, 9.44633 * share)),
                "panel {panel}"
            );
        }
    }

    #[test]
    fn number_of_spheres_is_an_axis_too_and_density_does_not_matter() {
        let omega: &[f64] = &[0.0, 20.0, 40.0];
        let (number, _) = curves(&[("spheres.count", &[128.0, 512.0]), (OMEGA, omega)]);
        assert!(on(&number[0], (256.0, 9.44633)));
        let (density, _) = curves(&[("spheres.density", &[1e3, 2e3]), (OMEGA, omega)]);
        assert!(on(&density[0], (1e3, 9.44633)) && on(&density[0], (1500.0, 9.44633)));
        let (none, _) = curves(&[(RADIUS, &[0.002, 0.006]), ("spheres.density", &[1e3, 2e3])]);
        assert!(none[0].is_empty());
    }
}
