//! The curves of the critical rotation, without and with friction, drawn over a figure.

use super::PlotError;
use super::chart::samples;
use super::contour::{Nodes, Piece};
use super::grid::{GridAxis, GridPanel, PanelGrid};
use super::panel_curve::{PanelCurve, Stroke};
use super::scale::AxisSpan;
use crate::classify::LabelTable;
use crate::grid::Variant;
use crate::scene::Scene;
use crate::sweep::Sweep;
use crate::theory::{critical_rotation, critical_rotation_with_friction};

const OMEGA: &str = "swirl.omega";

/// What the legend calls the curves without and with friction.
pub(super) const WORDS: [&str; 2] = ["critical rotation $Ω_c$", "with friction, $Ω_μ$"];

/// The curves Omega = Omega_c and Omega = Omega_mu inside a panel, in shown values; empty if the
/// figure has no axis for Omega or the scene lacks what they need. What a panel or a variant is for
/// counts instead of the scene's value. On a strip y goes from 0 to 1.
pub(super) fn curves<P>(
    sweep: &Sweep,
    grid: &PanelGrid<P>,
    panel: &GridPanel<P>,
) -> Vec<PanelCurve> {
    let (omega, other, upright) = match grid.axes(panel) {
        (x, Some(y)) if y.key == OMEGA => (y, Some(x), true),
        (x, y) if x.key == OMEGA => (x, y, false),
        _ => return Vec::new(),
    };
    let parts: Vec<(Option<f64>, Vec<f64>)> = match other {
        Some(axis) if !axis.words.is_empty() => {
            let edges = axis.edges();
            let cells = axis.values.iter().zip(edges.windows(2));
            let part = |(place, ends): (&f64, &[f64])| (Some(*place), ends.to_vec());
            cells.map(part).collect()
        }
        _ => {
            let place = |fraction| other.map_or(fraction, |axis| axis.along(fraction));
            vec![(grid.variant(panel), samples(0.0, 1.0).map(place).collect())]
        }
    };
    let curve = |critical: fn(&PanelScene<'_, P>, f64) -> Option<f64>, stroke: Stroke| {
        let of_part = |(variant, places): &(Option<f64>, Vec<f64>)| {
            let scene = PanelScene {
                scene: sweep.scene_of_variant(*variant),
                variant: variant.and_then(|place| sweep.variant(place)),
                grid,
                panel,
                other,
            };
            pieces(omega, places, &|place| {
                Some(critical(&scene, place)? / scene.factor(omega))
            })
        };
        let mut pieces: Vec<Piece> = parts.iter().flat_map(of_part).collect();
        if !upright {
            let points = pieces.iter_mut().flatten();
            points.for_each(|(place, omega)| std::mem::swap(place, omega));
        }
        PanelCurve { pieces, stroke }
    };
    vec![
        curve(|scene, place| scene.with_friction(place), Stroke::Dashed),
        curve(|scene, place| scene.without_friction(place), Stroke::Full),
    ]
}

/// A curve of theory over two axes of a sweep, in values of their keys.
#[derive(Clone, Debug, PartialEq)]
pub struct TheoryCurve {
    /// Its name, with markup.
    pub name: &'static str,
    /// Whether it is a line of advice rather than a border between states.
    pub is_advice: bool,
    /// Indices of the horizontal and the vertical axis.
    pub axes: [usize; 2],
    /// Index and value of each other axis that it is for.
    pub slice: Vec<(usize, f64)>,
    /// Pieces of the curve: points (x, y).
    pub pieces: Vec<Vec<(f64, f64)>>,
}

/// The curves of theory that figures of a sweep show, for each of their panels.
///
/// # Errors
/// A table that does not belong to the sweep; no axis, or more than four.
pub fn theory_curves(sweep: &Sweep, table: &LabelTable) -> Result<Vec<TheoryCurve>, PlotError> {
    let grid = PanelGrid::new(sweep, table)?;
    let mut all = Vec::new();
    for panel in &grid.panels {
        let (x, Some(y)) = grid.axes(panel) else {
            continue;
        };
        // Between variants there is nothing to draw a curve over.
        if !x.words.is_empty() || !y.words.is_empty() {
            continue;
        }
        let others = [(&grid.columns, panel.column), (&grid.rows, panel.row)];
        let slice = others.into_iter();
        let slice = slice.filter_map(|(axis, value)| Some((axis.as_ref()?.index, value?)));
        let slice: Vec<(usize, f64)> = slice.collect();
        let [full, dashed] = WORDS;
        let value = |piece: Piece| -> Vec<(f64, f64)> {
            let points = piece.into_iter();
            points
                .map(|(across, up)| (x.value(across), y.value(up)))
                .collect()
        };
        let curves = curves(sweep, &grid, panel).into_iter();
        all.extend(curves.filter(|it| !it.pieces.is_empty()).map(|curve| {
            let is_advice = curve.stroke == Stroke::Dashed;
            TheoryCurve {
                name: if is_advice { dashed } else { full },
                is_advice,
                axes: [x.index, y.index],
                slice: slice.clone(),
                pieces: curve.pieces.into_iter().map(value).collect(),
            }
        }));
    }
    Ok(all)
}

/// The scene of a panel, in which keys change along one of its axes.
struct PanelScene<'a, P> {
    scene: &'a Scene,
    variant: Option<&'a Variant>,
    grid: &'a PanelGrid<P>,
    panel: &'a GridPanel<P>,
    other: Option<&'a GridAxis>,
}

impl<P> PanelScene<'_, P> {
    /// The factor of the variant on values of an axis.
    fn factor(&self, axis: &GridAxis) -> f64 {
        self.variant.map_or(1.0, |it| it.factor(&axis.name))
    }

    /// The axes that keys have values of.
    fn axes(&self) -> impl Iterator<Item = &GridAxis> {
        let (x, y) = self.grid.axes(self.panel);
        let panels = [self.grid.columns.as_ref(), self.grid.rows.as_ref()];
        let all = [Some(x), y].into_iter().chain(panels).flatten();
        all.filter(|axis| axis.words.is_empty())
    }

    /// The value of a key at a place of the other axis, if an axis gives it one.
    fn value(&self, key: &str, place: f64) -> Option<f64> {
        let axis = self.axes().find(|axis| axis.key == key)?;
        let value = match self.other {
            Some(other) if other.key == key => other.value(place),
            _ => fixed(key, self.grid, self.panel)?,
        };
        Some(value * self.factor(axis))
    }

    fn without_friction(&self, place: f64) -> Option<f64> {
        let value = |key: &str| self.value(key, place).or_else(|| of_scene(key, self.scene));
        Some(critical_rotation(
            value("spheres.count")?,
            value("spheres.radius")?,
            value("tank.radius")?,
            value("gravity.acceleration")?,
        ))
    }

    fn with_friction(&self, place: f64) -> Option<f64> {
        let keys = self.axes().map(|axis| axis.key.as_str());
        let values = keys.filter(|key| *key != OMEGA).filter_map(|key| {
            let value = self.value(key, place)?;
            // Between whole numbers of spheres there is no scene.
            let is_number = key == "spheres.count";
            Some((key, if is_number { value.round() } else { value }))
        });
        critical_rotation_with_friction(&self.scene.with_values(values).ok()?)
    }
}

/// The pieces of a curve of critical rotations over places of the other axis.
fn pieces(omega: &GridAxis, places: &[f64], critical: &dyn Fn(f64) -> Option<f64>) -> Vec<Piece> {
    let shown = |place: &f64| {
        let critical = omega.show(critical(*place)?);
        Some(critical).filter(|critical| critical.is_finite())
    };
    let curve: Vec<Option<f64>> = places.iter().map(shown).collect();
    let AxisSpan { low, high, .. } = omega.span();
    let ends = [low, high];
    Nodes {
        x: places,
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
    use super::*;
    use crate::classify::{Label, Sieves, TANK, Verdict};
    use crate::classify::{LabelRow, LabelTable};
    use crate::grid::Axis;
    use crate::sweep::PlotSettings;
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
        let (curves, factors) = curves_over(axes.iter().map(axis).collect());
        (curves, factors[0])
    }

    /// The curves of all panels of a sweep over axes, and the factors of their horizontal axes.
    fn curves_over(axes: Vec<Axis>) -> (Vec<Vec<Piece>>, Vec<f64>) {
        let names: Vec<String> = axes.iter().map(|axis| axis.name.clone()).collect();
        let first = axes.iter().map(|axis| axis.values[0]).collect();
        let sweep = Sweep {
            title: None,
            scene: scene(),
            axes,
            seeds: vec![1],
            refine: None,
            study: None,
            sieves: Sieves::default(),
            plot: PlotSettings::default(),
        };
        let row = LabelRow {
            id: String::new(),
            values: first,
            seed: 1,
            verdict: Verdict::unmeasured(&TANK, Label::SETTLED),
        };
        let table = LabelTable {
            family: &TANK,
            axes: names,
            variants: sweep.variants(),
            rows: vec![row],
        };
        let grid = PanelGrid::new(&sweep, &table).unwrap();
        let of = |panel| {
            let mut curves = super::curves(&sweep, &grid, panel);
            curves.pop().map(|curve| curve.pieces).unwrap_or_default()
        };
        let factors = grid.panels.iter().map(|panel| grid.axes(panel).0.factor);
        (grid.panels.iter().map(of).collect(), factors.collect())
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

    /// A variant with this tank, this number of spheres, and factors on radius and Omega.
    fn variant(tank: f64, count: u64, factors: [f64; 2]) -> Variant {
        let values = [("tank.radius", tank), ("spheres.count", count as f64)];
        let scale = [RADIUS, OMEGA].map(str::to_owned).into_iter().zip(factors);
        Variant {
            name: format!("{tank} {count} {factors:?}"),
            scale: scale.filter(|(_, factor)| *factor != 1.0).collect(),
            scene: scene().with_values(values).unwrap(),
        }
    }

    /// Symptom: panels of variants had the curve of a scene with other radii, and radii over a tank
    /// that is not theirs. Cause: only the scene was of the variant, not the factors on its axes,
    /// and the tank was that of the sweep.
    #[test]
    fn panels_of_variants_count_with_their_own_tank_and_factors() {
        let variants = [
            (variant(0.06, 256, [1.0, 1.0]), 1.0 / 0.06, 9.44633),
            (variant(0.12, 256, [1.0, 1.0]), 1.0 / 0.12, 9.44633 / 4.0),
            (
                variant(0.12, 256, [2.0, 1.0]),
                2.0 / 0.12,
                9.44633 / libm::sqrt(2.0),
            ),
            (variant(0.06, 64, [1.0, 1.0]), 1.0 / 0.06, 9.44633 / 2.0),
            // The axis of this panel has half of the rotations.
            (variant(0.06, 256, [1.0, 0.5]), 1.0 / 0.06, 9.44633),
        ];
        let axes = vec![
            Axis::of_numbers(RADIUS, RADIUS, vec![0.002, 0.006]),
            Axis::of_numbers(OMEGA, OMEGA, vec![0.0, 20.0, 40.0]),
            Axis::of_variants(variants.iter().map(|it| it.0.clone()).collect()),
        ];
        let (curves, factors) = curves_over(axes);
        for (index, (variant, factor, omega)) in variants.iter().enumerate() {
            let (name, of_panel) = (&variant.name, factors[index]);
            assert!((of_panel - factor).abs() < 1e-9, "{name}: {of_panel}");
            assert!(on(&curves[index], (0.004 * factor, *omega)), "{name}");
        }
    }

    /// Symptom: with variants as an axis of the figure all had the curve of the base scene.
    /// Cause: only panels were known to stand for variants.
    #[test]
    fn rows_of_variants_have_pieces_of_their_own() {
        let axes = vec![
            Axis::of_numbers(OMEGA, OMEGA, vec![0.0, 20.0, 40.0]),
            Axis::of_variants(vec![
                variant(0.06, 256, [1.0, 1.0]),
                variant(0.12, 256, [1.0, 1.0]),
            ]),
        ];
        let pieces = curves_over(axes).0.remove(0);
        let expected = [9.44633, 9.44633 / 4.0];
        let upright = |(piece, omega): (&Piece, f64)| {
            piece.iter().all(|(shown, _)| (shown - omega).abs() < 1e-3)
        };
        assert_eq!(pieces.len(), 2, "{pieces:?}");
        assert!(pieces.iter().zip(expected).all(upright), "{pieces:?}");
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
