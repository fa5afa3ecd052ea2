//! The meaning of the spheres' colours.

use crate::color::ColorMap;
use crate::measure::{CellBounds, Centres, Layers, voronoi_cells};
use crate::observe::Snapshot;
use std::f64::consts::PI;

/// Red, green and blue.
pub type Rgb = [u8; 3];

/// The meaning of the spheres' colours.
#[derive(Clone, Debug, PartialEq)]
pub enum ColorBy {
    /// No meaning: all spheres have one colour.
    Nothing,
    /// Speed, from zero to `fastest` (m/s).
    Speed {
        /// The speed of the last colour; faster spheres have it too.
        fastest: f64,
    },
    /// Height of the centre, from `low` to `high` (m).
    Height {
        /// The height of the first colour.
        low: f64,
        /// The height of the last colour.
        high: f64,
    },
    /// Radius, from `low` to `high` (m).
    Radius {
        /// The radius of the first colour.
        low: f64,
        /// The radius of the last colour.
        high: f64,
    },
    /// Index of the sphere: consecutive indices differ in colour, so that single spheres can be
    /// followed.
    Index,
    /// The layer in which a sphere started, in two alternating colours.
    Layer {
        /// Thickness of a layer (m).
        thickness: f64,
        /// The layer of every sphere that was in at the start.
        of: Vec<Option<usize>>,
    },
    /// Packing fraction: volume of the sphere over the volume of its Voronoi cell, from
    /// [`LOOSEST`](Self::LOOSEST) to [`DENSEST`](Self::DENSEST).
    PackingFraction {
        /// Where cells end.
        walls: CellBounds,
    },
}

/// Alternating colours of layers (Okabe and Ito, 2008).
const LAYERS: [Rgb; 2] = [[0xf0, 0xe4, 0x42], [0x56, 0xb4, 0xe9]];
/// How far cells reach from centres at a free surface, in diameters.
const FARTHEST: f64 = 0.75;

/// Colour of spheres whose colour has no meaning.
const PLAIN: Rgb = [0xd8, 0xb4, 0x6a];

/// The golden ratio minus 1: consecutive multiples, modulo 1, are far apart.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

impl ColorBy {
    /// Packing fractions of the first and of the last colour.
    pub const LOOSEST: f64 = 0.45;
    /// See [`LOOSEST`](Self::LOOSEST).
    pub const DENSEST: f64 = 0.75;

    /// By the layers of the state at the start.
    pub fn layers_of(start: &Snapshot, layers: &Layers) -> Self {
        Self::Layer {
            thickness: layers.thickness,
            of: layers.of(start),
        }
    }

    /// By packing fraction, for spheres of this diameter (m) between walls at x = -reach\[0\] and
    /// reach\[0\], and the same for y, above a floor (m); without walls, cells end near the
    /// spheres.
    pub fn packing_fraction(reach: [Option<f64>; 2], floor: Option<f64>, diameter: f64) -> Self {
        let [x, y] = reach.map(|it| it.unwrap_or(f64::MAX));
        let walls = CellBounds {
            low: [-x, -y, floor.unwrap_or(-f64::MAX)],
            high: [x, y, f64::MAX],
            farthest: FARTHEST * diameter,
        };
        Self::PackingFraction { walls }
    }

    /// By speed, up to the highest in these snapshots.
    pub fn speed_of<'a>(snapshots: impl IntoIterator<Item = &'a Snapshot>) -> Self {
        let fastest = snapshots
            .into_iter()
            .flat_map(|snapshot| (0..snapshot.velocity.nrows()).map(|s| speed(snapshot, s)))
            .fold(0.0, f64::max);
        Self::Speed { fastest }
    }

    /// By height, over the range in these snapshots.
    pub fn height_of<'a>(snapshots: impl IntoIterator<Item = &'a Snapshot>) -> Self {
        let heights = snapshots
            .into_iter()
            .flat_map(|snapshot| snapshot.position.column(2))
            .filter(|height| height.is_finite());
        let (low, high) = range(heights);
        Self::Height { low, high }
    }

    /// By radius, over the range of these (m).
    pub fn radius_of<'a>(radius: impl IntoIterator<Item = &'a f64>) -> Self {
        let (low, high) = range(radius);
        Self::Radius { low, high }
    }

    /// The colour of every sphere of a snapshot; `radius` holds the radius of each (m).
    pub fn colors(&self, snapshot: &Snapshot, radius: &[f64]) -> Vec<Rgb> {
        if let Self::PackingFraction { walls } = self {
            return by_packing_fraction(snapshot, radius, walls);
        }
        (0..snapshot.position.nrows())
            .map(|sphere| match *self {
                Self::Nothing => PLAIN,
                Self::Speed { fastest } => mapped(speed(snapshot, sphere), 0.0, fastest),
                Self::Height { low, high } => mapped(snapshot.position[[sphere, 2]], low, high),
                Self::Radius { low, high } => mapped(radius[sphere], low, high),
                Self::Index => ColorMap::Sequential.at((GOLDEN * sphere as f64) % 1.0),
                Self::Layer { ref of, .. } => {
                    let layer = of.get(sphere).copied().flatten();
                    layer.map_or(PLAIN, |layer| LAYERS[Layers::color(layer)])
                }
                Self::PackingFraction { .. } => PLAIN,
            })
            .collect()
    }
}

fn by_packing_fraction(snapshot: &Snapshot, radius: &[f64], walls: &CellBounds) -> Vec<Rgb> {
    let centres = Centres::of(snapshot);
    let cells = voronoi_cells(&centres, walls);
    let mut colors = vec![PLAIN; snapshot.position.nrows()];
    for (sphere, cell) in centres.number.iter().zip(cells) {
        let radius = radius[*sphere];
        let fraction = 4.0 / 3.0 * PI * radius * radius * radius / cell.volume;
        colors[*sphere] = mapped(fraction, ColorBy::LOOSEST, ColorBy::DENSEST);
    }
    colors
}

/// The least and the largest of these values.
fn range<'a>(values: impl IntoIterator<Item = &'a f64>) -> (f64, f64) {
    let all = (f64::INFINITY, f64::NEG_INFINITY);
    values
        .into_iter()
        .fold(all, |(low, high), value| (value.min(low), value.max(high)))
}

fn mapped(value: f64, low: f64, high: f64) -> Rgb {
    let fraction = (value - low) / (high - low);
    ColorMap::Sequential.at(if fraction.is_nan() { 0.0 } else { fraction })
}

fn speed(snapshot: &Snapshot, sphere: usize) -> f64 {
    let velocity = snapshot.velocity.row(sphere);
    velocity.iter().map(|v| v * v).sum::<f64>().sqrt()
}
