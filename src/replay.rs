//! A run from the thesis's dump: observables from positions and energies only.

mod states;

pub use states::{StateTime, StatesError, WrittenState, replay_states};

use crate::observe::{FrameView, Observer};
use crate::record::{Guard, Instability, Outcome, Program, RunRecord};
use crate::scene::{Radii, Scene, Spheres, Start};
use ndarray::{Array3, ArrayView2, Axis};

/// Why a dump cannot be a run of a scene.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ReplayError {
    /// The radius of each sphere is unknown.
    #[error(
        "the scene does not give the radius of each of the {0} spheres of the dump; give \
         spheres.radius as one number, or as a file with one radius per sphere"
    )]
    Radii(usize),
    /// The number of spheres differs from the scene.
    #[error(
        "it has {found} spheres, but spheres.count of the scene is {expected}; give the scene that \
         was run"
    )]
    Count {
        /// Spheres of the dump.
        found: usize,
        /// Spheres of the scene.
        expected: usize,
    },
    /// The number of frames differs from the scene.
    #[error(
        "it has {found} frames, but time.duration and time.frame_interval of the scene make \
         {expected} with the start (or one less); export a trajectory with every frame, and give \
         the scene that was run"
    )]
    Frames {
        /// Frames of the dump.
        found: usize,
        /// Frames of the scene, with the start.
        expected: usize,
    },
}

/// The record of a run of `scene` with these positions and energies: frames x n x 4 of x, y, z (m)
/// and the translational, rotational and gravitational energy (J) of every sphere.
///
/// Observables that depend only on positions equal the original run's: heights, profile, hole,
/// rising spheres, gravitational energy. For the others:
///
/// * `kinetic` holds the translational and the rotational energy, which a dump does not separate,
///   and `rotational` is zero; their sum, which the sieves read, is right.
/// * Velocities are displacements from the frame before (at the first, to the next) over the
///   frame interval: `speed_mean`, `rotation` and `fluctuation` are means over that time.
/// * `elastic` is not a number. There are no spins, no snapshots and no trajectory.
///
/// A dump whose last frame has all coordinates at 1 (or all at 0), or that holds numbers that are
/// not finite, belongs to a run that broke off: unstable.
///
/// # Errors
/// If the dump cannot be a run of this scene.
pub fn replay(dump: &Array3<f64>, scene: &Scene) -> Result<RunRecord, ReplayError> {
    let (found, count, _) = dump.dim();
    let steps = scene.time.steps_per_frame();
    let expected = scene.time.frames() as usize + 1;
    if found != expected && found + 1 != expected {
        return Err(ReplayError::Frames { found, expected });
    }
    if count != scene.spheres.count {
        return Err(ReplayError::Count {
            found: count,
            expected: scene.spheres.count,
        });
    }
    let radius = radii(scene, count)?;
    let Spheres { shape, density, .. } = scene.spheres;
    let mass: Vec<f64> = radius.iter().map(|r| shape.mass(density, *r)).collect();
    let mut observer = Observer::new(scene, &radius);
    let outcome = outcome(dump, scene);
    let mut kinetic = Vec::with_capacity(found);
    let complete = if outcome == Outcome::Completed {
        found
    } else {
        0
    };
    for frame in 0..complete {
        let spheres = dump.index_axis(Axis(0), frame);
        let other = match frame {
            0 => 1.min(found - 1),
            frame => frame - 1,
        };
        let interval = (frame as f64 - other as f64) * scene.time.frame_interval;
        let position = columns(&spheres);
        let velocity = displacements(&spheres, &dump.index_axis(Axis(0), other), interval);
        observer.observe(
            (frame as u64 * steps) as f64 * scene.time.dt,
            &FrameView {
                position: position.each_ref().map(Vec::as_slice),
                velocity: velocity.each_ref().map(Vec::as_slice),
                spin: None,
                radius: &radius,
                mass: &mass,
                inertia: &[],
                elastic_energy: f64::NAN,
                ledger: None,
                number: None,
                flow: None,
            },
        );
        kinetic.push(moving_energy(&spheres, &mass, scene) as f32);
    }
    let mut observations = observer.finish();
    observations.kinetic = kinetic;
    Ok(RunRecord {
        scene: scene.clone(),
        program: Program::current(),
        outcome,
        radius,
        mass,
        milestones: Vec::new(),
        observations,
        snapshots: Vec::new(),
        trajectory: Vec::new(),
        work: 0,
        cpu_seconds: 0.0,
    })
}

/// The radius of every sphere (m).
fn radii(scene: &Scene, count: usize) -> Result<Vec<f64>, ReplayError> {
    let mut radii = match &scene.spheres.radius {
        Radii::One(radius) => vec![*radius; count],
        Radii::Each(radii) if radii.len() == count => radii.clone(),
        _ => return Err(ReplayError::Radii(count)),
    };
    if let Start::List { spheres } = &scene.start
        && spheres.iter().any(|sphere| sphere.radius.is_some())
    {
        if spheres.len() != count {
            return Err(ReplayError::Radii(count));
        }
        for (radius, sphere) in radii.iter_mut().zip(spheres.iter()) {
            *radius = sphere.radius.unwrap_or(*radius);
        }
    }
    Ok(radii)
}

fn outcome(dump: &Array3<f64>, scene: &Scene) -> Outcome {
    let mut frames = dump.axis_iter(Axis(0));
    let odd = |frame: &ArrayView2<'_, f64>| frame.iter().any(|value| !value.is_finite());
    let end = |frame: &ArrayView2<'_, f64>, place: f64| {
        (0..3).all(|axis| {
            frame
                .column(axis)
                .iter()
                .all(|coordinate| *coordinate == place)
        })
    };
    let broken = |frame: &ArrayView2<'_, f64>| odd(frame) || end(frame, 1.0) || end(frame, 0.0);
    let last = dump.index_axis(Axis(0), dump.len_of(Axis(0)) - 1);
    if !broken(&last) && !dump.iter().any(|value| !value.is_finite()) {
        return Outcome::Completed;
    }
    let frame = frames.position(|frame| broken(&frame)).unwrap_or_default();
    let steps = frame as u64 * scene.time.steps_per_frame();
    Outcome::Unstable(Instability {
        guard: if odd(&dump.index_axis(Axis(0), frame)) {
            Guard::NotANumber
        } else {
            Guard::OutOfBounds
        },
        step: steps,
        time: steps as f64 * scene.time.dt,
        sphere: 0,
        detail: "the dump breaks off; it does not say where".to_owned(),
    })
}

fn columns(spheres: &ArrayView2<'_, f64>) -> [Vec<f64>; 3] {
    [0, 1, 2].map(|axis| spheres.column(axis).to_vec())
}

/// Components of the mean velocities (m/s) from one frame to another.
fn displacements(
    now: &ArrayView2<'_, f64>,
    other: &ArrayView2<'_, f64>,
    interval: f64,
) -> [Vec<f64>; 3] {
    [0, 1, 2].map(|axis| {
        let pairs = now.column(axis).into_iter().zip(other.column(axis));
        pairs
            .map(|(now, other)| match interval {
                0.0 => 0.0,
                interval => (now - other) / interval,
            })
            .collect()
    })
}

/// Translational and rotational energy of all spheres (J): a dump's energies minus the
/// gravitational one.
fn moving_energy(spheres: &ArrayView2<'_, f64>, mass: &[f64], scene: &Scene) -> f64 {
    let gravity = scene.gravity_in_fluid();
    let rows = spheres.rows().into_iter().zip(mass);
    rows.map(|(row, &mass)| {
        row[3]
            - gravity
                .as_ref()
                .map_or(0.0, |it| it.energy(mass, row[0], row[2]))
    })
    .sum()
}
