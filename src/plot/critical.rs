//! The curve of the critical rotation, drawn over a figure.

use super::grid::{Grid, GridAxis, Panel};
use crate::scene::{Radii, Scene};
use crate::theory::critical_rotation;

const OMEGA: &str = "swirl.omega";

/// Points on the curve.
const SAMPLES: usize = 300;

/// Name of the curve in legends.
pub(super) const NAME: &str = "critical rotation $Ω_c$";

/// The pieces of the curve Omega = Omega_c inside a panel, in shown values; none if the figure
/// has no axis for Omega or the scene lacks a tank, gravity or one radius. What a panel is for
/// (n, r, R or g) counts instead of the scene's value. On a strip y goes from 0 to 1.
pub(super) fn curve(scene: &Scene, grid: &Grid, panel: &Panel) -> Vec<Vec<(f64, f64)>> {
    let upright = grid.y.as_ref().is_some_and(|axis| axis.key == OMEGA);
    let (omega, other) = match &grid.y {
        Some(y) if y.key == OMEGA => (y, Some(&grid.x)),
        y if grid.x.key == OMEGA => (&grid.x, y.as_ref()),
        _ => return Vec::new(),
    };
    let points = (0..=SAMPLES).filter_map(|sample| {
        let fraction = sample as f64 / SAMPLES as f64;
        let place = other.map_or(fraction, |axis| along(axis, fraction));
        let value = |key: &str| match other {
            Some(axis) if axis.key == key => Some(place / axis.factor),
            _ => fixed(key, grid, panel).or_else(|| of_scene(key, scene)),
        };
        let critical = critical_rotation(
            value("spheres.count")?,
            value("spheres.radius")?,
            value("tank.radius")?,
            value("gravity.acceleration")?,
        );
        critical
            .is_finite()
            .then_some((place, critical * omega.factor))
    });
    let edges = omega.edges();
    let (Some(&low), Some(&high)) = (edges.first(), edges.last()) else {
        return Vec::new();
    };
    let mut pieces = clipped(&points.collect::<Vec<_>>(), low, high);
    if !upright {
        let points = pieces.iter_mut().flatten();
        points.for_each(|(place, omega)| std::mem::swap(place, omega));
    }
    pieces
}

/// The shown value at a fraction of an axis.
fn along(axis: &GridAxis, fraction: f64) -> f64 {
    let edges = axis.edges();
    let (low, high) = (edges[0], edges[edges.len() - 1]);
    if axis.logarithmic() {
        low * libm::pow(high / low, fraction)
    } else {
        low + (high - low) * fraction
    }
}

/// Value of a key that the panel stands for.
fn fixed(key: &str, grid: &Grid, panel: &Panel) -> Option<f64> {
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
        "spheres.radius" => radius_of_mean_volume(&scene.spheres.radius),
        "tank.radius" => scene.tank.as_ref()?.radius,
        "gravity.acceleration" => Some(scene.gravity.as_ref()?.acceleration),
        _ => None,
    }
}

/// Cube root of the mean of r^3, as eq. 42 sums it.
fn radius_of_mean_volume(radii: &Radii) -> Option<f64> {
    let weighted: Vec<(f64, f64)> = match radii {
        Radii::One(radius) => return Some(*radius),
        Radii::Shares(shares) => shares
            .iter()
            .map(|part| (part.radius, part.share))
            .collect(),
        Radii::Each(radii) => radii.iter().map(|&radius| (radius, 1.0)).collect(),
        Radii::File { .. } => return None,
    };
    let (volume, weight) = weighted.iter().fold((0.0, 0.0), |sum, (radius, weight)| {
        (sum.0 + weight * radius * radius * radius, sum.1 + weight)
    });
    Some(libm::cbrt(volume / weight))
}

/// The pieces of a polyline whose second coordinate lies between `low` and `high`.
fn clipped(points: &[(f64, f64)], low: f64, high: f64) -> Vec<Vec<(f64, f64)>> {
    let mut pieces: Vec<Vec<(f64, f64)>> = Vec::new();
    for pair in points.windows(2) {
        let (from, to) = (pair[0], pair[1]);
        let rise = to.1 - from.1;
        // The share of the segment that is inside.
        let (enter, leave) = if rise == 0.0 {
            if (low..=high).contains(&from.1) {
                (0.0, 1.0)
            } else {
                continue;
            }
        } else {
            let (a, b) = ((low - from.1) / rise, (high - from.1) / rise);
            (a.min(b).max(0.0), a.max(b).min(1.0))
        };
        if enter >= leave {
            continue;
        }
        let at = |share: f64| match share {
            0.0 => from,
            1.0 => to,
            _ => (from.0 + share * (to.0 - from.0), from.1 + share * rise),
        };
        match pieces.last_mut() {
            Some(piece) if piece.last() == Some(&at(enter)) => piece.push(at(leave)),
            _ => pieces.push(vec![at(enter), at(leave)]),
        }
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::RadiusShare;

    #[test]
    fn clipping() {
        let points = [(0.0, 0.0), (1.0, 2.0), (2.0, 4.0), (3.0, 2.0), (4.0, 2.0)];
        assert_eq!(
            clipped(&points, 1.0, 3.0),
            [
                vec![(0.5, 1.0), (1.0, 2.0), (1.5, 3.0)],
                vec![(2.5, 3.0), (3.0, 2.0), (4.0, 2.0)],
            ]
        );
        assert!(clipped(&points, 5.0, 6.0).is_empty());
    }

    #[test]
    fn radius_of_unequal_spheres() {
        let share = |radius, share| RadiusShare { radius, share };
        let radii = Radii::Shares(vec![share(1.0, 3.0), share(3.0, 1.0)]);
        let expected = libm::cbrt((3.0 + 27.0) / 4.0);
        assert!((radius_of_mean_volume(&radii).unwrap() - expected).abs() < 1e-12);
        let radii = Radii::Each(vec![1.0, 1.0, 1.0, 3.0]);
        assert!((radius_of_mean_volume(&radii).unwrap() - expected).abs() < 1e-12);
    }
}
