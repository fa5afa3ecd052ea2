//! Made-up records to try the sieves on.

use crate::observe::Observations;
use crate::record::{Guard, Instability, Outcome, Program, RunRecord};
use ndarray::{Array2, Array3};

/// Number of spheres.
pub(super) const COUNT: usize = 256;
/// Radius of the spheres (m).
pub(super) const RADIUS: f64 = 0.004;
/// Bins of the surface profile: round(R / 2r).
pub(super) const BINS: usize = 8;

/// A steady run with a flat surface, no hole and no spout: settled at frame 251.
pub(super) fn quiet(frames: usize) -> RunRecord {
    let scene = toml::from_str(
        r#"
        spheres = { count = 256, radius = 0.004, density = 3750.0 }
        tank = { radius = 0.06, floor = -0.2 }
        start = { kind = "random", z_min = -0.1, z_max = 0.3 }
        gravity = { acceleration = 9.8 }
        swirl = { omega = 5.0 }
        time = { dt = 1e-4, duration = 5.0, frame_interval = 1e-3 }
        "#,
    )
    .unwrap();
    let mut observations = Observations {
        time: (0..frames).map(|frame| frame as f64 * 1e-3).collect(),
        profile: Array2::from_elem((frames, BINS), -0.15),
        rising: Array3::zeros((frames, 3, 3)),
        ..Observations::default()
    };
    for name in COLUMNS {
        *observations.scalar_mut(name).unwrap() = vec![0.0; frames];
    }
    RunRecord {
        scene,
        program: Program::current(),
        outcome: Outcome::Completed,
        radius: vec![RADIUS; COUNT],
        mass: vec![1e-3; COUNT],
        milestones: Vec::new(),
        observations,
        snapshots: Vec::new(),
        trajectory: Vec::new(),
        work: 0,
        cpu_seconds: 0.0,
    }
}

/// What is observed in a tank.
const COLUMNS: [&str; 11] = [
    "kinetic",
    "rotational",
    "gravitational",
    "elastic",
    "height_mean",
    "height_max",
    "hole_radius",
    "speed_mean",
    "air_speed_mean",
    "rotation",
    "fluctuation",
];

/// First frame of the steady part of a quiet run.
pub(super) const START: usize = 251;

/// Energy per sphere, in joules, that stands for m g R.
pub(super) const ENERGY_UNIT: f64 = 1e-3 * 9.8 * 0.06;

impl RunRecord {
    /// Makes the surface rise from the axis to the wall in these frames.
    pub(super) fn with_fluid(mut self, frames: std::ops::Range<usize>) -> Self {
        for frame in frames {
            for bin in 0..BINS {
                self.observations.profile[[frame, bin]] = -0.15 + 5e-4 * bin as f32;
            }
        }
        self
    }

    /// Opens a hole of this radius (m) in these frames.
    pub(super) fn with_hole(mut self, radius: f32, frames: std::ops::Range<usize>) -> Self {
        self.observations.hole_radius[frames].fill(radius);
        self
    }

    /// Lets this many spheres rise in these frames, as the default spout sieve counts them.
    pub(super) fn with_rising(mut self, count: u16, frames: std::ops::Range<usize>) -> Self {
        for frame in frames {
            self.observations.rising[[frame, 1, 1]] = count;
        }
        self
    }

    /// Ends the run by a guard.
    pub(in crate::classify) fn unstable(mut self) -> Self {
        self.outcome = Outcome::Unstable(Instability {
            guard: Guard::Overlap,
            step: 1,
            time: 1e-4,
            sphere: 0,
            detail: String::new(),
        });
        self
    }
}
