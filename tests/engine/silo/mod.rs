//! The grain silo: fill, rest, door, drain; what it must do and what it must not.

mod contacts;
mod phases;
mod reports;
mod searches;
mod whole_run;

use phase::record::{MilestoneKind, RunRecord};
use phase::run;
use phase::scene::{self, Scene};
use std::ops::ControlFlow;
use std::path::Path;

/// A small hopper with rough grains of two sizes, which fill it in two seconds.
const HOPPER: &str = r#"
    spheres = { count = 60, radius = [{ radius = 0.04, share = 1 }, { radius = 0.03, share = 1 }], density = 1.0, shape = "disc" }
    contact = { law = "linear", stiffness = 100.0, damping = 0.05, drag = "normal" }
    friction = { law = "cundall-strack", coefficient = 0.2, stiffness = 70.0, damping = 0.02 }
    gravity = { acceleration = 9.81 }
    geometry = { kind = "hopper", half_width = 0.4, top = 1.5, foot = 0.4, slope = 0.6, opening = 0.3, spacing = 0.05, radius = 0.03 }
    start = { kind = "feed", position = [0.0, 0.0, 1.4], velocity = [0.0, 0.0, -2.0], interval = 0.05, spread = 0.1 }
    rest = { kinetic_energy = 1e-4 }
    door = {}
    outlet = { height = -0.5 }
    time = { dt = 5e-4, duration = 30.0, frame_interval = 0.05, integrator = "velocity-verlet" }
"#;

/// The small hopper, with some of its lines in place of others.
fn hopper(changes: &[(&str, &str)]) -> Scene {
    let mut text = HOPPER.to_owned();
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    scene::Scene::from_toml(&text, Path::new("hopper.toml"))
        .unwrap_or_else(|error| panic!("{error}"))
}

/// A scene that is shipped.
fn shipped(name: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/scenes");
    scene::Scene::load(&folder.join(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn record(scene: &Scene) -> RunRecord {
    run::run(scene, &mut |_| ControlFlow::Continue(())).unwrap()
}

fn time_of(record: &RunRecord, kind: MilestoneKind) -> f64 {
    let mut milestones = record.milestones.iter();
    let found = milestones.find(|milestone| milestone.kind == kind);
    found
        .unwrap_or_else(|| panic!("never {}", kind.name()))
        .time
}
