//! What the tests share: runs without a break, and interrupted ones.

use crate::support::{Answer, Workplace, end, signal, wait_until};
use phase::record::RunRecord;
use phase::scene::Scene;
use phase::store::{content_digest, read_record};
use std::ops::ControlFlow;
use std::path::Path;

/// Runs a scene to its end without a break.
pub(crate) fn whole(scene: &Scene) -> RunRecord {
    phase::run::run(scene, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// A scene that takes a second or two with a checkpoint at every frame.
pub(crate) fn slow_scene() -> String {
    crate::support::scene_file().replace("duration = 2.0", "duration = 12.0")
}

pub(crate) fn digest(path: &Path) -> String {
    content_digest(&read_record(path).unwrap()).unwrap()
}

/// A place where a run of `scene.toml` was interrupted: its record is to be `run.h5`.
pub(crate) fn interrupted_by(name: &str) -> Workplace {
    let place = Workplace::new();
    place.write("scene.toml", &slow_scene());
    let arguments = [
        "run",
        "scene.toml",
        "--out",
        "run.h5",
        "--checkpoint-interval",
        "0",
    ];
    let mut child = place.start(&arguments);
    wait_until(|| place.path("run.checkpoint").exists());
    if name == "KILL" {
        child.kill().unwrap();
        child.wait().unwrap();
    } else {
        signal(&child, name);
        end(child)
            .code(130)
            .complains("interrupted at frame ")
            .complains("the same command with --resume continues from there (run.checkpoint)");
    }
    assert!(!place.path("run.h5").exists());
    place
}

pub(crate) fn resume(place: &Workplace, more: &[&str]) -> Answer {
    let arguments = ["run", "scene.toml", "--out", "run.h5", "--resume"];
    place.phase(&[&arguments[..], more].concat())
}
