//! Keys of a scene file that follow from others, added to its tree of values before it is read.

use super::validate::{complete_program, multiple};
use super::{Accuracy, Gravity, Shaking};
use crate::document::{Problem, number};
use serde::Deserialize;
use serde_json::{Value, json};

/// Keys of [shaking], with those of [time] that they replace.
pub(super) const TIMES_OF_SHAKING: [(&str, &str); 2] = [
    ("frames_per_period", "frame_interval"),
    ("periods", "duration"),
];

/// Adds what a scene's tree leaves open: the settings of its `accuracy`, times in periods of the
/// shaking, and the step of a scene without steps.
pub(crate) fn complete(tree: &mut Value) -> Vec<Problem> {
    let mut problems = complete_program(tree);
    problems.extend(choose_step_of_spots(tree));
    problems.extend(choose_times_of_shaking(tree));
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

/// Frames and duration of a scene that gives them in periods of its shaking.
fn choose_times_of_shaking(tree: &mut Value) -> Vec<Problem> {
    if !tree["shaking"].is_object() || !tree["time"].is_object() {
        return Vec::new();
    }
    let mut problems = Vec::new();
    let shaking = Shaking::deserialize(&tree["shaking"]).ok();
    let gravity = Gravity::deserialize(&tree["gravity"]).ok();
    let times = shaking.and_then(|it| it.times(gravity.as_ref()));
    let (interval, duration) = times.map_or((None, None), |(a, b)| (Some(a), b));
    for ((key, of_time), time) in TIMES_OF_SHAKING.into_iter().zip([interval, duration]) {
        if tree["shaking"][key].is_null() {
            continue;
        }
        let time = time.filter(|it| (1e-15..1e15).contains(it));
        match (tree["time"][of_time].as_f64(), time) {
            (Some(given), Some(time)) if !multiple(given, time) || !multiple(time, given) => {
                let message = format!(
                    "`time.{of_time}` = {} s, but by `shaking.{key}` it is {} s",
                    number(given),
                    number(time)
                );
                let help = format!("remove `{of_time}`, or remove `{key}`");
                problems.push(Problem::new(format!("time.{of_time}"), message).help(help));
            }
            // What is wrong with the keys that it follows from is found later.
            (None, time) if tree["time"][of_time].is_null() => {
                tree["time"][of_time] = json!(time.unwrap_or(1.0));
            }
            _ => {}
        }
    }
    problems
}
