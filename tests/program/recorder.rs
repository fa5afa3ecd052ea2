//! A recorder makes the same record of the same frames, whoever makes them.

use ndarray::Array2;
use phase::observe::{FrameView, Snapshot};
use phase::record::RunRecord;
use phase::run::{self, EndOfRun, FrameInfo, Recorder};
use phase::scene::Scene;
use std::ops::ControlFlow;
use std::path::Path;

/// Spheres that fall freely, and so far that the run is never steady.
const SCENE: &str = r#"
    spheres = { count = 3, radius = 0.004, density = 1000.0 }
    gravity = { acceleration = 9.8 }
    time = { dt = 1e-3, duration = 0.2, frame_interval = 1e-2 }
    output = { snapshot_interval = 0.05, trajectory = true }
    start.kind = "list"
    start.spheres = [
        { position = [0.0, 0.0, 1.0] },
        { position = [0.1, 0.0, 2.0], velocity = [0.0, 1.0, 0.0] },
        { position = [0.0, 0.2, 3.0], velocity = [0.3, 0.0, 2.0] },
    ]
"#;

fn recorded(scene: &Scene) -> RunRecord {
    run::run(scene, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// The columns of x, y and z.
fn columns(rows: &Array2<f64>) -> [Vec<f64>; 3] {
    [0, 1, 2].map(|axis| rows.column(axis).to_vec())
}

/// What another program would do: show states that it has made, one after the other.
fn recorded_from_states(scene: &Scene, made: &RunRecord, states: &[Snapshot]) -> RunRecord {
    let (radius, mass) = (&made.radius, &made.mass);
    let mut recorder = Recorder::new(scene, radius, mass, &[]);
    for (number, state) in states.iter().enumerate() {
        let (position, velocity) = (columns(&state.position), columns(&state.velocity));
        let frame = FrameView {
            position: position.each_ref().map(Vec::as_slice),
            velocity: velocity.each_ref().map(Vec::as_slice),
            spin: None,
            radius,
            mass,
            inertia: &[],
            elastic_energy: 0.0,
            ledger: None,
            number: None,
            flow: None,
        };
        let info = FrameInfo {
            frame: number as u64,
            time: state.time,
            own: &[],
            is_last: number + 1 == states.len(),
        };
        recorder.record(info, &frame);
        if info.is_last {
            recorder.end(state.time, &frame);
        }
    }
    recorder.finish(EndOfRun {
        outcome: made.outcome.clone(),
        radius: radius.clone(),
        mass: mass.clone(),
        milestones: Vec::new(),
        work: made.work,
        cpu_seconds: made.cpu_seconds,
    })
}

#[test]
fn frames_of_another_program_make_the_same_record() {
    let scene = Scene::from_toml(SCENE, Path::new("falling.toml")).unwrap();
    let made = recorded(&scene);
    assert_eq!((made.trajectory.len(), made.snapshots.len()), (21, 5));
    let again = recorded_from_states(&scene, &made, &made.trajectory);
    assert_eq!(again, made);
    // A frame that differs makes another one.
    let mut states = made.trajectory.clone();
    states[7].position[[1, 2]] += 1e-9;
    let other = recorded_from_states(&scene, &made, &states);
    assert_ne!(other.trajectory, made.trajectory);
    // Fewer frames are a shorter run.
    let shorter = recorded_from_states(&scene, &made, &made.trajectory[..11]);
    assert_eq!(shorter.observations.frames(), 11);
    assert_eq!(shorter.snapshots.last(), made.trajectory.get(10));
}
