//! Further columns of spheres at given places, with given velocities.

use super::bench::{Bench, downward, unguarded};
use super::material::Material;
use super::{CaseFamily, MeasuredValues, VerifyError};
use crate::dem::DemSimulation;
use crate::observe::Observer;
use crate::scene::{
    ColumnProfile, DemScene, Effects, Friction, FurtherColumn, Layer, Output, Scene, StartSphere,
    Tank,
};
use crate::simulation::Simulation;
use serde::Deserialize;

/// Spheres at given places, measured there or after a while. The quantities are the further columns
/// of a scene's output.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Columns {
    /// Radius (m).
    radius: f64,
    material: Material,
    /// The spheres at the start.
    spheres: Vec<StartSphere>,
    /// Walls. Absent: none.
    tank: Option<Tank>,
    /// The layer of columns that have one. Absent: the whole bed.
    layer: Option<Layer>,
    /// Profiles, whose bins are quantities too.
    #[serde(default)]
    profiles: Vec<ColumnProfile>,
    /// Friction. Absent: none, and no spins.
    friction: Option<Friction>,
    /// Gravity (m/s2).
    #[serde(default)]
    gravity: f64,
    /// Time step (s).
    dt: f64,
    /// Duration (s).
    #[serde(default)]
    duration: f64,
}

impl CaseFamily for Columns {
    fn name(&self) -> &'static str {
        "columns"
    }

    fn measure(&self, bench: &mut Bench<'_>) -> Result<MeasuredValues, VerifyError> {
        let expected = FurtherColumn::ALL.iter().copied();
        let output = Output {
            columns: expected.filter(|it| bench.expects(it.name())).collect(),
            profiles: self.profiles.clone(),
            layer: self.layer,
            ..Output::default()
        };
        let mut scene = Scene {
            tank: self.tank.clone(),
            dem: DemScene {
                contact: Some(self.material.contact()),
                friction: self.friction.clone(),
                effects: Effects {
                    gravity: (self.gravity > 0.0).then(|| downward(self.gravity)),
                    ..Effects::default()
                },
                ..unguarded()
            },
            output,
            ..bench.scene(
                self.material.density,
                self.radius,
                self.spheres.clone(),
                self.dt,
            )
        };
        let asks_for_walls = (scene.wall_columns()).any(|column| bench.expects(&column.name));
        scene.output.walls = asks_for_walls;
        let mut simulation = DemSimulation::new(&scene)?;
        bench.advance_for(&mut simulation, self.duration, self.dt)?;
        let declared = simulation.columns();
        let mut observer = Observer::new(&scene, simulation.radius()).with_own(declared);
        observer.observe_own(&simulation.values());
        simulation.with_frame(|frame| observer.observe(0.0, frame));
        let observations = observer.finish();
        let all = observations.scalars().into_iter();
        let last = all.filter_map(|it| Some((it.name.to_owned(), f64::from(*it.values.last()?))));
        Ok(last.collect())
    }
}
