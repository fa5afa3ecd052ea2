//! Further columns that follow from the spheres of a frame: one loop, or two, for each that a scene
//! asks for.

mod packing;
mod profile;
mod shear;
mod spread;
mod surface;
mod temperature;
#[cfg(test)]
mod tests;

use super::OwnSeries;
use crate::measure::LayerOfScene;
use crate::particles::Domain;
use crate::scene::{ColumnProfile, FurtherColumn, Scene, Shape};
use crate::simulation::{Column, Frame, FrameView};
use serde::{Deserialize, Serialize};

/// The columns of a scene, and what they need to know of it.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct SphereColumns {
    columns: Vec<FurtherColumn>,
    profiles: Vec<ColumnProfile>,
    /// Cross-section of the tank (m2).
    area: f64,
    /// Periods along x, y and z (m).
    periods: [Option<f64>; 3],
    /// Numbers of axes along which spheres move and about which they turn.
    degrees: [f64; 2],
    diameter: f64,
    layer: Option<LayerOfScene>,
}

impl SphereColumns {
    /// Those that a scene asks for, whose spheres have this mean radius (m).
    pub(super) fn new(scene: &Scene, mean_radius: f64) -> Self {
        let asked = scene.output.columns.iter().copied();
        let mut columns: Vec<FurtherColumn> = asked.filter(|it| !it.is_of_contacts()).collect();
        columns.sort_unstable();
        Self {
            columns,
            profiles: scene.output.profiles.clone(),
            area: scene.cross_section().unwrap_or(f64::NAN),
            periods: scene.domain().periods(),
            degrees: match scene.spheres.shape {
                Shape::Sphere => [3.0, 3.0],
                Shape::Disc => [2.0, 1.0],
            },
            diameter: 2.0 * mean_radius,
            layer: LayerOfScene::new(scene),
        }
    }

    /// Their declarations.
    pub(super) fn declared(&self) -> impl Iterator<Item = OwnSeries> {
        let columns = self
            .columns
            .iter()
            .map(|&column| Column::from(column).into());
        let of_profile = |profile: &ColumnProfile| {
            let (of, profile) = (profile.of, *profile);
            let names = profile.columns().enumerate();
            names.map(move |(bin, name)| {
                let [from, to] = profile.ends(bin);
                OwnSeries {
                    name,
                    unit: of.unit().to_owned(),
                    description: format!("{}, from {from} to {to} m", of.description()),
                    values: Vec::new(),
                }
            })
        };
        columns.chain(self.profiles.iter().flat_map(of_profile))
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        let bins = self.profiles.iter().map(|profile| profile.bins);
        self.columns.len() + bins.sum::<usize>()
    }

    /// Their values at a frame. Not a number where one is undefined, such as without spheres.
    pub(super) fn values(&self, frame: &dyn Frame) -> impl Iterator<Item = f64> {
        let columns = self.columns.iter().map(|&column| self.value(column, frame));
        let of_profile =
            |profile: &ColumnProfile| profile::values(profile, frame, self.area, self.degrees[0]);
        columns.chain(self.profiles.iter().flat_map(of_profile))
    }

    fn value(&self, column: FurtherColumn, frame: &dyn Frame) -> f64 {
        let [ways, turns] = self.degrees;
        let in_layer = |measure: fn(&dyn Frame, &LayerOfScene) -> f64| {
            self.layer.map_or(f64::NAN, |layer| measure(frame, &layer))
        };
        match column {
            FurtherColumn::HeightDeviation => spread::height_deviation(frame),
            FurtherColumn::GranularTemperature => temperature::translational(frame, ways),
            FurtherColumn::RotationalTemperature => temperature::rotational(frame, turns),
            FurtherColumn::SurfaceAngle => {
                surface::angle(frame, self.diameter, Domain::new(self.periods))
            }
            FurtherColumn::PackingFraction => in_layer(packing::fraction),
            FurtherColumn::ShearRate => in_layer(shear::rate),
            // The model measures these.
            _ => f64::NAN,
        }
    }
}

/// Mean over all spheres of a term of each; not a number without spheres.
fn mean<const N: usize>(
    frame: &dyn Frame,
    columns: impl for<'a> Fn(&FrameView<'a>) -> [&'a [f64]; N],
    term: impl Fn([f64; N]) -> f64,
) -> f64 {
    let mut sum = super::reduce::Sum::default();
    frame.show(&mut |block| sum.add(columns(block), &term));
    sum.total() / frame.count() as f64
}
