//! Simpler stand-ins for effects and laws, as changes of a scene's keys.

use serde_json::Value;

/// A simpler stand-in for a part of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Simplification {
    /// What it makes of what, such as `quadratic drag to linear`.
    pub name: String,
    /// Keys with their new values: paths such as `drag.quadratic`, or a table as a whole.
    pub set: Vec<(&'static str, Value)>,
    /// Tables and keys that go.
    pub remove: Vec<&'static str>,
}

impl Simplification {
    /// Other values at some keys.
    pub(crate) fn setting<const N: usize>(
        name: impl Into<String>,
        set: [(&'static str, Value); N],
    ) -> Self {
        Self {
            name: name.into(),
            set: set.into(),
            remove: Vec::new(),
        }
    }

    /// The same, also without some keys.
    pub(crate) fn removing<const N: usize>(mut self, keys: [&'static str; N]) -> Self {
        self.remove.extend(keys);
        self
    }
}

/// A sphere of the mean radius, for stand-ins that are to act on it as what they stand for.
pub(crate) struct MeanSphere {
    /// Radius (m).
    pub(crate) radius: f64,
    /// Mass (kg).
    pub(crate) mass: f64,
    /// Density (kg/m3).
    pub(crate) density: f64,
}
