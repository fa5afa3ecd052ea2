//! Whether a file is a scene, a sweep or a study of stability.

use super::exit::Failure;
use phase::classify::Sieves;
use phase::scene::Scene;
use phase::sweep::{PlotSettings, Sweep};
use std::path::Path;

/// Reads a scene file.
pub(super) fn load_scene(file: &Path) -> Result<Scene, Failure> {
    refuse_sweep(file)?;
    phase::scene::Scene::load(file).map_err(Failure::refused)
}

/// Reads the file of a scene that is to be varied.
pub(super) fn load_base_scene(file: &Path) -> Result<Scene, Failure> {
    refuse_sweep(file)?;
    phase::scene::Scene::load_base(file).map_err(Failure::refused)
}

fn refuse_sweep(file: &Path) -> Result<(), Failure> {
    if is_sweep(file) {
        return Err(Failure::refused(format_args!(
            "{}: this is a sweep, not a scene; `phase sweep {0}` runs it",
            file.display()
        )));
    }
    Ok(())
}

/// Reads a sweep file.
pub(super) fn load_sweep(file: &Path) -> Result<Sweep, Failure> {
    if !is_sweep(file) && keys(file).contains_key("spheres") {
        return Err(Failure::refused(format_args!(
            "{}: this is a scene, not a sweep; `phase run {0}` runs it, and a sweep names it with \
             `scene = \"...\"`",
            file.display()
        )));
    }
    phase::sweep::load(file).map_err(Failure::refused)
}

/// Reads either, a scene as the sweep of just one; and whether it is a sweep.
pub(super) fn load_scene_or_sweep(file: &Path) -> Result<(Sweep, bool), Failure> {
    if is_study(file) {
        return Err(Failure::refused(format_args!(
            "{}: this is a study of stability, neither a scene nor a sweep; `phase check {0}` says what \
             it costs",
            file.display()
        )));
    }
    let is_sweep = is_sweep(file);
    let sweep = match is_sweep {
        true => phase::sweep::load(file).map_err(Failure::refused)?,
        false => sweep_of_one(phase::scene::Scene::load_base(file).map_err(Failure::refused)?),
    };
    Ok((sweep, is_sweep))
}

/// The sweep of just one scene.
fn sweep_of_one(scene: Scene) -> Sweep {
    Sweep {
        title: None,
        axes: Vec::new(),
        seeds: vec![scene.seed],
        scene,
        sieves: Sieves::default(),
        plot: PlotSettings::default(),
    }
}

/// What a file is, in a word.
pub(super) fn name(is_sweep: bool) -> &'static str {
    if is_sweep { "sweep" } else { "scene" }
}

/// Whether a file is a sweep rather than a scene, which shows in its keys. What cannot be read is
/// left to the loader to complain of.
fn is_sweep(file: &Path) -> bool {
    let table = keys(file);
    ["axis", "scene", "sieves", "plot", "seeds"]
        .iter()
        .any(|key| table.contains_key(*key))
}

/// Whether a file is a study of stability rather than a sweep: it has keys of its own, or it could
/// be both and its steps are too long for a sweep.
pub(super) fn is_study(file: &Path) -> bool {
    let table = keys(file);
    let has = |names: &[&str]| names.iter().any(|key| table.contains_key(*key));
    has(&STUDY_KEYS)
        || has(&["axis"])
            && !has(&["sieves", "plot", "seeds"])
            && phase::sweep::load(file).is_err()
            && phase::stability::load(file).is_ok()
}

/// Keys that of these files only studies have.
const STUDY_KEYS: [&str; 3] = ["integrators", "frames", "energy_gain"];

fn keys(file: &Path) -> toml::Table {
    let text = std::fs::read_to_string(file).unwrap_or_default();
    toml::from_str(&text).unwrap_or_default()
}
