//! Scenes as trees of values. Files and records are read through such trees, so that the code that
//! reads scenes is compiled only once.

use super::{SCENE, Scene};
use crate::document::kind::ValueKind;
use serde::de::{Deserialize, Deserializer, Error};
use serde_json::Value;

impl Scene {
    pub(super) fn tree(&self) -> Value {
        serde_json::to_value(self).expect("a scene holds no map with odd keys")
    }

    /// The scene described by a JSON text in a record or checkpoint.
    pub(crate) fn from_json(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text).and_then(Self::from_tree)
    }

    /// For serde: a scene within something larger.
    pub(crate) fn by_tree<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let tree = Value::deserialize(deserializer)?;
        Self::from_tree(tree).map_err(D::Error::custom)
    }

    /// Refuses unknown keys, for example from another version of the program: serde ignores them in
    /// tables that several structs share.
    fn from_tree(tree: Value) -> Result<Self, serde_json::Error> {
        if let (ValueKind::Table(scene), Some(keys)) = (&SCENE.kind, tree.as_object()) {
            let is_known = |name: &String| scene.keys.iter().any(|key| key.name == *name);
            if let Some(name) = keys.keys().find(|name| !is_known(name)) {
                return Err(Error::custom(format!("unknown key `{name}`")));
            }
        }
        serde_json::from_value(tree)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_kept_scene_with_a_key_of_another_version_is_refused() {
        let mut tree = json!({
            "spheres": { "count": 1, "radius": 0.004, "density": 1e3 },
            "start": { "kind": "list", "spheres": [{ "position": [0.0, 0.0, 0.0] }] },
            "time": { "dt": 1e-5, "duration": 1e-3, "frame_interval": 1e-3 },
        });
        assert!(Scene::from_json(&tree.to_string()).is_ok());
        tree["magnetism"] = json!({ "strength": 1.0 });
        let error = Scene::from_json(&tree.to_string()).unwrap_err();
        assert!(error.to_string().contains("magnetism"), "{error}");
    }
}
