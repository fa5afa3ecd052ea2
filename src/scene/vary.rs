//! A scene with other values for some of its keys.

use super::keys::NumericKey;
use super::{Scene, Start};
use crate::document::Problem;
use crate::document::kind::ValueKind;
use serde::Deserialize;
use serde_json::Value;
use std::borrow::Cow;
use std::sync::{Mutex, PoisonError};

/// A scene in which the values of some keys are set repeatedly. Keys are looked up once, and each
/// scene is read from the tree of values without copying it.
pub(crate) struct Template {
    tree: Mutex<Value>,
    keys: Vec<NumericKey>,
    /// Keys of parameters of a program that the scene gives as whole numbers: they stay whole.
    whole_parameters: Vec<String>,
    /// The start shared by all scenes, if it lists spheres and no key belongs to one of them. In a
    /// tree of values a sphere takes more than a kilobyte.
    start: Option<Start>,
}

impl Template {
    /// A template for values at these paths.
    ///
    /// # Errors
    /// If a path is not a numeric key of the scene.
    pub(crate) fn new(scene: &Scene, paths: &[&str]) -> Result<Self, Problem> {
        let whole = scene;
        let scene = whole.for_keys(paths);
        let key = |path: &&str| {
            let mut keys = scene.all_numeric_keys().into_iter();
            let absent = || Problem::new(*path, format!("the scene has no key `{path}`"));
            keys.find(|key| key.path == **path).ok_or_else(absent)
        };
        Ok(Self {
            tree: Mutex::new(scene.tree()),
            keys: paths.iter().map(key).collect::<Result<_, _>>()?,
            whole_parameters: whole_parameters(whole),
            start: matches!(scene, Cow::Owned(_)).then(|| whole.start.clone()),
        })
    }

    /// The scene with these values, one for each key.
    ///
    /// # Errors
    /// Values of the wrong type or out of range.
    pub(crate) fn with(&self, values: &[f64]) -> Result<Scene, Vec<Problem>> {
        let mut problems = Vec::new();
        // All keys are set each time, so that a tree left half set does no harm.
        let mut tree = self.tree.lock().unwrap_or_else(PoisonError::into_inner);
        for (key, &value) in self.keys.iter().zip(values) {
            let is_count = matches!(key.kind, ValueKind::Whole(_)) && value >= 0.0;
            let is_whole = libm::trunc(value) == value;
            let number = match (is_count, self.whole_parameters.contains(&key.path)) {
                (true, _) if is_whole => Value::from(value as u64),
                (_, true) if is_whole => Value::from(value as i64),
                _ => Value::from(value),
            };
            key.kind.check(&number, &key.path, &mut problems);
            set(&mut tree, &key.path, number);
        }
        if !problems.is_empty() {
            return Err(problems);
        }
        let mut scene = Scene::deserialize(&*tree)
            .map_err(|error| vec![Problem::new("", format!("not a scene: {error}"))])?;
        if let Some(start) = &self.start {
            scene.start = start.clone();
        }
        Ok(scene)
    }
}

/// Paths of the parameters of a program that are whole numbers.
fn whole_parameters(scene: &Scene) -> Vec<String> {
    let parameters = scene.parameters.iter();
    let whole = parameters.filter(|(_, value)| value.is_i64() || value.is_u64());
    whole
        .map(|(name, _)| format!("parameters.{name}"))
        .collect()
}

/// Puts a value at a path whose tables and lists exist.
fn set(tree: &mut Value, path: &str, new: Value) {
    let mut place = tree;
    for part in path.split(['.', '[']) {
        place = match part.strip_suffix(']') {
            Some(index) => {
                let index: usize = index.parse().expect("the path was made from a list");
                &mut place[index]
            }
            None => &mut place[part],
        };
    }
    *place = new;
}

impl Scene {
    /// This scene with other values at some numeric keys.
    ///
    /// # Errors
    /// If a path is not a numeric key of this scene, or the value has the wrong type or is out of
    /// range.
    pub fn with_values<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Result<Self, Vec<Problem>> {
        let (paths, values): (Vec<&str>, Vec<f64>) = values.into_iter().unzip();
        let template = Template::new(self, &paths);
        template.map_err(|problem| vec![problem])?.with(&values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::StartSphere;
    use crate::scene::keys::tests::scene;
    use std::sync::Arc;

    #[test]
    fn every_numeric_key_can_be_set() {
        let scene = scene();
        for key in scene.all_numeric_keys() {
            // Not all of them may be as large as 7.
            let changed = [7.0, 0.25].map(|value| scene.with_values([(key.path.as_str(), value)]));
            let changed = changed.into_iter().find_map(Result::ok).unwrap();
            assert_ne!(changed, scene, "{}", key.path);
        }
        let changed = scene
            .with_values([("spheres.radius[1].share", 5.0)])
            .unwrap();
        assert!(matches!(
            &changed.spheres.radius,
            crate::scene::Radii::Shares(shares) if shares[1].share == 5.0
        ));
    }

    /// Symptom: a sweep over a scene that lists many spheres held a copy of them for each job.
    /// Cause: each job's scene was read from a tree of values.
    #[test]
    fn listed_spheres_are_shared_unless_they_vary() {
        let mut scene = scene();
        scene.start = Start::list(vec![StartSphere::at([0.0; 3]); 3]);
        let list = |scene: &Scene| match &scene.start {
            Start::List { spheres } => Arc::clone(spheres),
            other => panic!("{other:?}"),
        };
        let denser = scene.with_values([("spheres.density", 7.0)]).unwrap();
        assert_eq!(denser.spheres.density, 7.0);
        assert!(Arc::ptr_eq(&list(&denser), &list(&scene)));
        let key = "start.spheres[1].position[2]";
        assert_eq!(scene.resolve_key(key).unwrap(), key);
        let moved = scene.with_values([("spheres.density", 7.0), (key, 0.5)]);
        let moved = list(&moved.unwrap());
        assert_eq!(moved[1], StartSphere::at([0.0, 0.0, 0.5]));
        assert_eq!(moved[2], list(&scene)[2]);
    }
}
