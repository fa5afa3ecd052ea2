//! Allowed contents of files, for editors and for readers. It all follows from the schemas of the
//! structs into which files are read. `docs/` holds the output of these functions; a test compares.

mod keys;
mod notation;

pub use keys::keys;
pub use notation::notation;

use crate::document::Schema;
use crate::scene::SCENE;
use crate::study::accuracy::ACCURACY;
use crate::study::stability::STABILITY;
use crate::sweep::SWEEP;
use serde_json::{Value, json};

/// A kind of file that the program reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputFile {
    /// One simulation.
    Scene,
    /// A scene and its axes.
    Sweep,
    /// A scene and the two keys over which integrators are tested.
    Stability,
    /// A scene or sweep and the settings whose cost and error are measured.
    Accuracy,
}

impl InputFile {
    /// All kinds of files.
    pub const ALL: [Self; 4] = [Self::Scene, Self::Sweep, Self::Stability, Self::Accuracy];

    /// Name, as on the command line and in file names.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Sweep => "sweep",
            Self::Stability => "stability",
            Self::Accuracy => "accuracy",
        }
    }

    fn schema(self) -> &'static Schema {
        match self {
            Self::Scene => &SCENE,
            Self::Sweep => &SWEEP,
            Self::Stability => &STABILITY,
            Self::Accuracy => &ACCURACY,
        }
    }
}

/// The JSON schema (draft 7, which editors know best) of a kind of file.
///
/// It refuses what the loader refuses for a single key: unknown and missing keys, wrong types,
/// numbers out of range. Only the loader finds problems that concern several keys.
pub fn schema(file: InputFile) -> Value {
    let mut schema = file.schema().json.clone();
    schema["title"] = json!(format!("phase {} file", file.name()));
    need_times_without_accuracy(&mut schema);
    schema
}

/// Makes keys of `time` required only in scenes in which nothing else gives them: `accuracy` the
/// step and the frames, `shaking` the frames and the duration; spots need no time step. The program
/// chooses them before it checks keys, so its own table of keys requires them.
fn need_times_without_accuracy(schema: &mut Value) {
    match schema {
        Value::Array(entries) => entries.iter_mut().for_each(need_times_without_accuracy),
        Value::Object(table) => {
            table.values_mut().for_each(need_times_without_accuracy);
            let properties = table.get_mut("properties").and_then(Value::as_object_mut);
            let Some(properties) = properties.filter(|it| it.contains_key("accuracy")) else {
                return;
            };
            let Some(needed) = properties["time"]["required"].as_array_mut() else {
                return;
            };
            let table_of = |name: &str| json!({ "required": [name] });
            let shaking = |key: &str| {
                json!({
                    "required": ["shaking"],
                    "properties": { "shaking": { "required": [key] } },
                })
            };
            let (accuracy, spot) = (table_of("accuracy"), table_of("spot"));
            let given = [
                ("dt", vec![accuracy.clone(), spot.clone()]),
                (
                    "frame_interval",
                    vec![accuracy, spot, shaking("frames_per_period")],
                ),
                ("duration", vec![shaking("periods")]),
            ];
            needed.retain(|key| given.iter().all(|(other, _)| key != other));
            let rules = given.map(|(key, others)| {
                json!({
                    "if": { "not": { "anyOf": others } },
                    "then": { "properties": { "time": { "required": [key] } } },
                })
            });
            table.insert("allOf".to_owned(), json!(rules));
        }
        _ => {}
    }
}
