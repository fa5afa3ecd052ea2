//! A run as the sieves read it: observables, and the scales they are measured in.

use crate::classify::ClassifyError;
use crate::classify::lengths::check_lengths;
use crate::observe::Observations;
use crate::record::RunRecord;
use crate::scene::Scene;
use ndarray::{ArrayView1, Axis};

/// A run as the sieves read it.
pub(in crate::classify) struct TankRun<'a> {
    pub(super) observations: &'a Observations,
    pub(super) scene: &'a Scene,
    /// Number of rising spheres at every frame, for the spout sieve's distance and speed.
    pub(super) rising: ArrayView1<'a, u16>,
    /// Time between frames (s).
    pub(super) interval: f64,
    /// Number of spheres.
    pub(super) count: usize,
    /// Mean radius of the spheres (m).
    pub(super) radius: f64,
    /// Mass of all spheres (kg).
    pub(super) mass: f64,
    /// Radius R of the tank (m).
    pub(super) tank_radius: f64,
    /// Acceleration g (m/s2).
    pub(super) gravity: f64,
    /// The frame from which the run is steady by the scene's own test.
    pub(super) steady: Option<usize>,
    /// The frame from which it is settled, which the settle sieve finds.
    pub(super) start: Option<usize>,
}

impl<'a> TankRun<'a> {
    /// The run of a record, with the rising spheres of one `column` (distance and speed).
    pub(super) fn new(
        record: &'a RunRecord,
        column: (usize, usize),
    ) -> Result<Self, ClassifyError> {
        check_shapes(record)?;
        let (gravity, tank_radius) = energy_scale(&record.scene)?;
        let count = record.radius.len();
        let (distance, speed) = column;
        let observations = &record.observations;
        let within = observations.rising.index_axis(Axis(1), distance);
        Ok(Self {
            observations,
            scene: &record.scene,
            rising: within.index_axis_move(Axis(1), speed),
            interval: record.scene.time.frame_interval,
            count,
            radius: record.radius.iter().sum::<f64>() / count as f64,
            mass: record.mass.iter().sum(),
            tank_radius,
            gravity,
            steady: record
                .steady_since()
                .map(|since| observations.time.partition_point(|it| *it < since)),
            start: None,
        })
    }

    pub(super) fn frames(&self) -> usize {
        self.observations.frames()
    }

    /// Time of a frame (s).
    pub(super) fn time(&self, frame: usize) -> f64 {
        self.observations.time[frame]
    }
}

/// The acceleration g (m/s2) and the tank radius R (m) of the energy scale m g R.
pub(super) fn energy_scale(scene: &Scene) -> Result<(f64, f64), ClassifyError> {
    let gravity = scene.dem.effects.gravity.as_ref().map(|it| it.acceleration);
    let radius = scene.tank.as_ref().and_then(|tank| tank.radius);
    let missing = |missing, key| ClassifyError::NoEnergyScale { missing, key };
    Ok((
        gravity
            .filter(|&it| it > 0.0)
            .ok_or_else(|| missing("gravity", "gravity.acceleration"))?,
        radius.ok_or_else(|| missing("tank radius", "tank.radius"))?,
    ))
}

/// Whether all observables have one entry per frame, and rising spheres one per distance and
/// speed of the scene.
fn check_shapes(record: &RunRecord) -> Result<(), ClassifyError> {
    check_lengths(record)?;
    let output = &record.scene.output;
    let expected = (
        record.observations.frames(),
        output.rise_radii.len(),
        output.rise_speeds.len(),
    );
    let found = record.observations.rising.dim();
    if found != expected {
        return Err(ClassifyError::Inconsistent(format!(
            "`rising` has the shape {found:?} instead of {expected:?}"
        )));
    }
    Ok(())
}
