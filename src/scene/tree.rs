//! Scenes as trees of values. Texts are read by way of these, files and records alike, so that what
//! reads scenes is compiled once and not for each way a text comes.

use super::Scene;
use serde::de::{Deserialize, Deserializer, Error};
use serde_json::Value;

impl Scene {
    pub(super) fn tree(&self) -> Value {
        serde_json::to_value(self).expect("a scene holds no map with odd keys")
    }

    /// The scene that a text in JSON describes, as records and checkpoints keep it.
    pub(crate) fn from_json(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text).and_then(serde_json::from_value)
    }

    /// For serde: a scene within something larger.
    pub(crate) fn by_tree<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let tree = Value::deserialize(deserializer)?;
        serde_json::from_value(tree).map_err(D::Error::custom)
    }
}
