//! Made-up records of a silo to try its sieves on.

use crate::classify::{Sieves, Verdict, classify};
use crate::observe::{Observations, Snapshot};
use crate::record::{Milestone, MilestoneKind, Outcome, Program, RunRecord};
use ndarray::{Array2, Array3};

/// Number of grains, of mass 1 kg.
pub(super) const GRAINS: usize = 200;
/// When the grains are at rest, and when the door opens (s).
pub(super) const REST: f64 = 10.0;
pub(super) const OPENED: f64 = 10.5;
/// Duration of the scene (s).
pub(super) const DURATION: f64 = 30.0;
/// Time between frames (s).
pub(super) const INTERVAL: f64 = 0.05;

/// A silo that this many grains leave, at equal intervals from the opening of the door on, the last
/// of them this long (s) before the run ends at its duration.
pub(super) fn draining(grains: usize, pause: f64) -> RunRecord {
    draining_until(DURATION, grains, pause)
}

/// The same in a run that ends at another time (s).
pub(super) fn draining_until(end: f64, grains: usize, pause: f64) -> RunRecord {
    let frames = (end / INTERVAL).round() as usize + 1;
    let last_exit = end - pause;
    let left = |time: f64| {
        if time > last_exit - 1e-9 {
            grains
        } else {
            let share = ((time - OPENED) / (last_exit - OPENED)).max(0.0);
            ((grains as f64 * share) as usize).min(grains.saturating_sub(1))
        }
    };
    let time: Vec<f64> = (0..frames).map(|frame| frame as f64 * INTERVAL).collect();
    let discharged: Vec<f32> = time.iter().map(|&it| left(it) as f32).collect();
    let mass_inside = discharged.iter().map(|left| GRAINS as f32 - left).collect();
    let mut observations = Observations {
        released: vec![GRAINS as f32; frames],
        coordination: vec![4.0; frames],
        profile: Array2::zeros((frames, 0)),
        rising: Array3::zeros((frames, 0, 3)),
        ..Observations::default()
    };
    for name in ["kinetic", "height_max"] {
        observations.scalar_mut(name).unwrap().resize(frames, 1.0);
    }
    RunRecord {
        scene: scene(),
        program: Program::current(),
        outcome: Outcome::Completed,
        radius: vec![1.0; GRAINS],
        mass: vec![1.0; GRAINS],
        milestones: [
            (MilestoneKind::Filled, 9.0),
            (MilestoneKind::AtRest, REST),
            (MilestoneKind::DoorOpened, OPENED),
        ]
        .map(|(kind, time)| Milestone { kind, time })
        .into(),
        observations: Observations {
            time,
            discharged,
            mass_inside,
            ..observations
        },
        snapshots: vec![square_lattice(REST)],
        trajectory: Vec::new(),
        work: 0,
        cpu_seconds: 0.0,
    }
}

fn scene() -> crate::scene::Scene {
    toml::from_str(
        r#"
        spheres = { count = 200, radius = 1.0, density = 1.0, shape = "disc" }
        geometry.kind = "hopper"
        geometry.half_width = 60.0
        geometry.top = 90.0
        geometry.foot = -40.0
        geometry.slope = 0.0
        geometry.opening = 4.0
        geometry.spacing = 1.0
        geometry.radius = 1.0
        start = { kind = "feed", position = [0.0, 0.0, 80.0], interval = 0.04 }
        gravity = { acceleration = 9.8 }
        rest = { kinetic_energy = 1e-4 }
        door = {}
        outlet = { height = -80.0 }
        time = { dt = 1e-3, duration = 30.0, frame_interval = 0.05 }
        "#,
    )
    .unwrap()
}

/// All grains in 20 columns of touching discs, far from the walls.
pub(super) fn square_lattice(time: f64) -> Snapshot {
    let position = Array2::from_shape_fn((GRAINS, 3), |(grain, axis)| match axis {
        0 => 2.0 * (grain % 20) as f64 - 19.0,
        1 => 0.0,
        _ => 2.0 * (grain / 20) as f64,
    });
    Snapshot {
        time,
        velocity: Array2::zeros(position.dim()),
        spin: Array2::zeros((0, 3)),
        position,
    }
}

pub(super) fn judge(record: &RunRecord) -> Verdict {
    classify(record, &Sieves::default()).unwrap()
}

impl RunRecord {
    /// Lets the grains come to rest in the open silo at that time (s), which ends the run.
    pub(super) fn at_rest(mut self, time: f64) -> Self {
        self.milestones.push(Milestone {
            kind: MilestoneKind::AtRest,
            time,
        });
        self
    }

    /// Keeps only the milestones before this one.
    pub(super) fn before(mut self, kind: MilestoneKind) -> Self {
        let at = self.milestones.iter().position(|it| it.kind == kind);
        self.milestones.truncate(at.unwrap());
        self
    }
}
