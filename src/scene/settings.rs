//! Keys of a scene file that follow from others, added to its tree of values before it is read.

use super::Accuracy;
use super::validate::complete_program;
use crate::document::Problem;
use serde_json::Value;

/// Adds what a scene's tree leaves open: the settings of its `accuracy`, and the step of a scene
/// without steps.
pub(crate) fn complete(tree: &mut Value) -> Vec<Problem> {
    let mut problems = complete_program(tree);
    problems.extend(choose_step_of_spots(tree));
    if !problems.is_empty() || tree["program"].is_object() {
        return problems;
    }
    Accuracy::choose_settings(tree)
}

/// The same for a scene in the table `scene` of a file, if it has one.
pub(crate) fn complete_scene_of(tree: &mut Value) -> Vec<Problem> {
    match tree.get_mut("scene") {
        Some(scene) if scene.is_object() => {
            let problems = complete(scene).into_iter();
            problems.map(|problem| problem.within("scene")).collect()
        }
        _ => Vec::new(),
    }
}

/// Spots move at their own times: frames are the only steps of their scenes.
fn choose_step_of_spots(tree: &mut Value) -> Vec<Problem> {
    if !tree["spot"].is_object() || !tree["time"].is_object() {
        return Vec::new();
    }
    let refuse = |path: &str, message: &str| {
        let help = "remove it: spots move at their own times, set by `spot.schedule`";
        Problem::new(path, message).help(help).at_key()
    };
    let mut problems = Vec::new();
    for key in ["dt", "safety_factor", "integrator", "resolution"] {
        if !tree["time"][key].is_null() {
            let message = format!("`time.{key}` means nothing in a scene of spots");
            problems.push(refuse(&format!("time.{key}"), &message));
        }
    }
    if !tree["accuracy"].is_null() {
        let message = "`accuracy` chooses integrators and steps, which a scene of spots does not \
            have";
        problems.push(refuse("accuracy", message));
    }
    let interval = tree["time"]["frame_interval"].clone();
    if problems.is_empty() && !interval.is_null() {
        tree["time"]["dt"] = interval;
    }
    problems
}
