//! The motion of every shipped scene, bit by bit: what is added to the program may not change what
//! scenes do that do not name it. `BLESS=1` writes the table anew.

use phase::run::Run;
use phase::scene::{Scene, Start};
use std::collections::BTreeMap;
use std::path::Path;

/// The table of digests, by the path of the scene.
const TABLE: &str = "tests/motion.txt";

/// Sphere-steps of each scene, about: enough for contacts, and a second for all scenes.
const WORK: u64 = 400_000;

fn scenes(folder: &Path, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            scenes(&path, found);
        } else if path.extension().is_some_and(|end| end == "toml") {
            // Windows separates folders otherwise.
            found.push(
                path.to_str()
                    .unwrap()
                    .replace(std::path::MAIN_SEPARATOR, "/"),
            );
        }
    }
}

/// A hash of places, velocities and spins after the first frames of a scene.
fn digest(path: &str) -> String {
    let mut scene = Scene::load(Path::new(path)).unwrap();
    if matches!(scene.start, Start::Packing {}) {
        // The packing alone of all spheres would take minutes.
        scene.spheres.count = scene.spheres.count.min(600);
        scene.dem.door = None;
    }
    let steps = (WORK / scene.spheres.count as u64).max(1) as f64;
    let frames = (steps / scene.time.steps_per_frame() as f64)
        .clamp(1.0, 200.0)
        .floor();
    let frames = match &scene.spot {
        Some(_) => 2.0,
        // Grains come in one by one.
        None if matches!(scene.start, Start::Feed { .. }) => 400.0,
        None => frames,
    };
    if frames < scene.time.frames() as f64 {
        scene.time.duration = frames * scene.time.frame_interval;
    }
    let mut run = Run::new(&scene).unwrap();
    while !run.ended() {
        run.advance_frame();
    }
    let record = run.finish();
    let end = record.snapshots.last().unwrap();
    let mut hasher = blake3::Hasher::new();
    for value in [&end.position, &end.velocity, &end.spin]
        .into_iter()
        .flatten()
    {
        hasher.update(&value.to_le_bytes());
    }
    hasher.finalize().to_hex()[..32].to_owned()
}

#[test]
fn shipped_scenes_move_as_before() {
    let mut paths = Vec::new();
    scenes(Path::new("sweeps/scenes"), &mut paths);
    let digests: BTreeMap<String, String> = paths
        .into_iter()
        .map(|path| (path.clone(), digest(&path)))
        .collect();
    let text: String = digests
        .iter()
        .map(|(path, digest)| format!("{digest} {path}\n"))
        .collect();
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(TABLE, &text).unwrap();
    }
    let kept = std::fs::read_to_string(TABLE).unwrap_or_default();
    assert_eq!(
        text, kept,
        "a shipped scene moves otherwise; BLESS=1 takes that for right"
    );
}
