//! Words that choose numerical settings for a required accuracy.

use crate::document::Problem;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

/// Required accuracy: a word that chooses integrator, time step and frames. docs/accuracy.md gives
/// the measured cost and error of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Accuracy {
    /// Coarse: for a first look at a diagram.
    Draft,
    /// For results.
    Standard,
    /// A reference for comparisons: its error is far below the noise of seeds.
    Reference,
}

/// The settings that a word stands for.
struct AccuracySettings {
    integrator: &'static str,
    safety_factor: f64,
    /// Frames in the time sqrt(r / g), in which a sphere falls from rest by half its radius.
    frames_per_fall: f64,
}

/// Frames of a run without gravity, where this time is undefined.
const FRAMES_WITHOUT_GRAVITY: f64 = 1000.0;

impl Accuracy {
    /// All words.
    pub const ALL: [Self; 3] = [Self::Draft, Self::Standard, Self::Reference];

    /// The word, as in a scene file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Standard => "standard",
            Self::Reference => "reference",
        }
    }

    /// Chosen by the studies of `sweeps/accuracy`: `words.toml` compares the three.
    fn settings(self) -> AccuracySettings {
        match self {
            Self::Draft => AccuracySettings {
                integrator: "symplectic-euler",
                safety_factor: 1.0,
                frames_per_fall: 5.0,
            },
            Self::Standard => AccuracySettings {
                integrator: "symplectic-euler",
                safety_factor: 0.5,
                frames_per_fall: 10.0,
            },
            Self::Reference => AccuracySettings {
                integrator: "synchronised-verlet",
                safety_factor: 0.2,
                frames_per_fall: 20.0,
            },
        }
    }

    /// Replaces the key `accuracy` in a scene's tree by the settings that it stands for. Settings
    /// given in the scene take precedence.
    pub(super) fn choose_settings(tree: &mut Value) -> Vec<Problem> {
        let Ok(Some(accuracy)) = Option::<Self>::deserialize(&tree["accuracy"]) else {
            // Absent, or an unknown word, which the check of keys reports.
            return Vec::new();
        };
        if !tree["time"].is_object() {
            return Vec::new();
        }
        let is_given = |key: &str| !tree["time"][key].is_null();
        if tree["friction"]["law"] == "spin" && !is_given("dt") {
            let message = "\"spin\" friction is an impulse mu per step: its step is part of the \
                           law, and `accuracy` cannot choose it";
            let help = "give `time.dt`, or use another friction law";
            return vec![Problem::new("accuracy", message).help(help)];
        }
        let settings = accuracy.settings();
        let mut chosen = Vec::new();
        if !is_given("integrator") {
            chosen.push(("integrator", json!(settings.integrator)));
        }
        if !is_given("dt") {
            chosen.push(("dt", json!(super::AUTO)));
        }
        let is_auto = !is_given("dt") || tree["time"]["dt"] == super::AUTO;
        if is_auto && !is_given("safety_factor") {
            chosen.push(("safety_factor", json!(settings.safety_factor)));
        }
        if !is_given("frame_interval")
            && let Some(interval) = frame_interval(tree, settings.frames_per_fall)
        {
            chosen.push(("frame_interval", json!(interval)));
        }
        for (key, value) in chosen {
            tree["time"][key] = value;
        }
        if let Some(table) = tree.as_object_mut() {
            table.remove("accuracy");
        }
        Vec::new()
    }
}

/// The largest round time that divides the duration and gives this many frames in sqrt(r / g);
/// `None` if the scene does not give its duration.
fn frame_interval(tree: &Value, frames_per_fall: f64) -> Option<f64> {
    let duration = tree["time"]["duration"].as_f64().filter(|it| *it > 0.0)?;
    let gravity = tree["gravity"]["acceleration"]
        .as_f64()
        .filter(|it| *it > 0.0);
    let radius = smallest_radius(&tree["spheres"]["radius"]);
    let longest = match (radius, gravity) {
        (Some(radius), Some(gravity)) => (radius / gravity).sqrt() / frames_per_fall,
        _ => duration / FRAMES_WITHOUT_GRAVITY,
    };
    let divides = |interval: &f64| {
        let frames = duration / interval;
        frames >= 1.0 && (frames - frames.round()).abs() < 1e-6
    };
    let round = round_numbers_below(longest.min(duration))
        .into_iter()
        .find(divides);
    round.or_else(|| Some(duration / libm::ceil(duration / longest).max(1.0)))
}

/// Numbers of one digit 1, 2 or 5, the largest first, over three decades.
fn round_numbers_below(value: f64) -> Vec<f64> {
    let decade = libm::floor(libm::log10(value)) as i32;
    let decades = (decade - 2..=decade).rev();
    let numbers = decades.flat_map(|decade| {
        [5.0, 2.0, 1.0].map(|digit| match decade {
            // Quotients of whole numbers are the nearest to what is written.
            ..0 => digit / libm::pow(10.0, f64::from(-decade)),
            _ => digit * libm::pow(10.0, f64::from(decade)),
        })
    });
    numbers
        .filter(|number| *number <= value * (1.0 + 1e-9))
        .collect()
}

fn smallest_radius(radius: &Value) -> Option<f64> {
    match radius {
        Value::Number(number) => number.as_f64().filter(|it| *it > 0.0),
        Value::Array(shares) => {
            let radii = shares.iter().filter_map(|it| it["radius"].as_f64());
            radii.filter(|it| *it > 0.0).reduce(f64::min)
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chosen(accuracy: &str, time: Value) -> Value {
        let mut tree = json!({
            "accuracy": accuracy,
            "spheres": { "radius": 0.004 },
            "gravity": { "acceleration": 9.8 },
            "time": time,
        });
        assert_eq!(Accuracy::choose_settings(&mut tree), []);
        assert!(tree.get("accuracy").is_none());
        tree["time"].clone()
    }

    #[test]
    fn a_word_stands_for_settings_and_what_is_given_stays() {
        let time = chosen("standard", json!({ "duration": 5.0 }));
        assert_eq!(
            time,
            json!({
                "duration": 5.0,
                "dt": "auto",
                "safety_factor": 0.5,
                "integrator": "symplectic-euler",
                "frame_interval": 2e-3,
            })
        );
        let own = json!({ "duration": 5.0, "dt": 1e-4, "frame_interval": 1e-3 });
        let time = chosen("draft", own);
        let expected = json!({
            "duration": 5.0,
            "dt": 1e-4,
            "frame_interval": 1e-3,
            "integrator": "symplectic-euler",
        });
        assert_eq!(time, expected);
    }

    #[test]
    fn frames_divide_the_duration() {
        for duration in [5.0, 0.3, 1.0 / 3.0, 7.77, 1e-5] {
            let time = chosen("reference", json!({ "duration": duration }));
            let frames = duration / time["frame_interval"].as_f64().unwrap();
            assert!(
                (frames - frames.round()).abs() < 1e-6,
                "{duration}: {frames}"
            );
        }
    }

    #[test]
    fn the_step_of_spin_friction_is_not_chosen() {
        let mut tree = json!({
            "accuracy": "draft",
            "friction": { "law": "spin", "coefficient": 0.01 },
            "time": { "duration": 1.0 },
        });
        let problems = Accuracy::choose_settings(&mut tree);
        assert!(problems[0].message.contains("impulse"), "{problems:?}");
    }
}
