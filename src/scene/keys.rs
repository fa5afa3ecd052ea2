//! The numeric keys of a scene by their paths, so that a sweep can vary any of them.

use super::schema::SCENE;
use super::{LIST_KEY, Scene};
use crate::document::schema::Kind;
use crate::document::{Problem, any_of, number, one_of, suggest};
use serde_json::Value;
use std::borrow::Cow;

/// The key that only a scene with `dt = "auto"` has.
const SAFETY_FACTOR_KEY: &str = "time.safety_factor";

/// A key that a sweep may vary.
struct NumericKey {
    path: String,
    /// Whether it takes whole numbers only.
    whole: bool,
}

impl Scene {
    /// Paths of the keys that a sweep may vary: the numeric ones in the tables that this scene has,
    /// set or left to their defaults. Without `seed`, which has its own table in a sweep, without
    /// the keys of `output`, which change nothing, and without entries of lists, which may be varied
    /// too (`spheres.radius[1].share`).
    pub fn numeric_keys(&self) -> Vec<String> {
        let keys = self.for_keys(&[]).all_numeric_keys().into_iter();
        keys.map(|key| key.path)
            .filter(|path| !path.contains('['))
            .collect()
    }

    fn all_numeric_keys(&self) -> Vec<NumericKey> {
        let mut keys = Vec::new();
        collect(&SCENE, Some(&self.tree()), "", &mut keys);
        keys.retain(|key| key.path != "seed" && !is_without_effect(&key.path));
        if self.time.safety_factor.is_none() {
            keys.retain(|key| key.path != SAFETY_FACTOR_KEY);
        }
        keys
    }

    /// The full path of a numeric key: `key` itself, or the one path that ends in it.
    pub(crate) fn resolve_key(&self, key: &str) -> Result<String, Problem> {
        let keys = self.for_keys(&[key]).all_numeric_keys();
        if keys.iter().any(|known| known.path == key) {
            return Ok(key.to_owned());
        }
        let paths = self.numeric_keys();
        let ending = format!(".{key}");
        let matches: Vec<&String> = paths
            .iter()
            .filter(|path| path.ends_with(&ending))
            .collect();
        match matches.as_slice() {
            [path] => Ok((*path).clone()),
            [] => Err(self.unknown_key(key, &paths)),
            several => Err(
                Problem::new("", format!("`{key}` could be {}", any_of(several)))
                    .help("write the full path"),
            ),
        }
    }

    fn unknown_key(&self, key: &str, paths: &[String]) -> Problem {
        if key == "seed" {
            return Problem::new("", "seeds are not an axis").help("list them in [seeds]");
        }
        if is_without_effect(key) {
            return Problem::new("", format!("`{key}` changes nothing in the motion"))
                .help("set it in the scene; every job then has it");
        }
        if [SAFETY_FACTOR_KEY, leaf(SAFETY_FACTOR_KEY)].contains(&key) {
            return Problem::new("", format!("`{key}` goes with `dt = \"auto\"` only"))
                .help("use `dt = \"auto\"` in [time] of the scene, or vary `time.dt`");
        }
        let table = key.split('.').next().unwrap_or(key);
        if let Kind::Table(tables) = SCENE
            && table != key
            && tables.iter().any(|known| known.name == table)
            && self.for_keys(&[]).tree().get(table).is_none()
        {
            return Problem::new("", format!("the scene has no [{table}] to vary `{key}` in"))
                .help(format!("add [{table}] to the scene"));
        }
        let leaves = paths.iter().map(|path| leaf(path));
        let near = suggest(key, paths.iter().map(String::as_str).chain(leaves));
        let known = format!("this scene has {}", one_of(paths));
        Problem::new("", format!("`{key}` is no numeric key of the scene")).help(match near {
            Some(near) => format!("did you mean `{near}`? {known}"),
            None => known,
        })
    }

    /// This scene with other values at some numeric keys.
    ///
    /// # Errors
    /// If a path is none of this scene's numeric keys, or the value is of the wrong kind for it.
    pub fn with_values<'a>(
        &self,
        values: impl IntoIterator<Item = (&'a str, f64)>,
    ) -> Result<Self, Problem> {
        let values: Vec<(&str, f64)> = values.into_iter().collect();
        let paths: Vec<&str> = values.iter().map(|(path, _)| *path).collect();
        let scene = self.for_keys(&paths);
        let keys = scene.all_numeric_keys();
        let mut tree = scene.tree();
        for (path, value) in values {
            let Some(key) = keys.iter().find(|key| key.path == path) else {
                return Err(Problem::new(path, format!("the scene has no key `{path}`")));
            };
            let number = if key.whole && value >= 0.0 && libm::trunc(value) == value {
                Value::from(value as u64)
            } else if key.whole {
                let message = format!("`{path}` must be a whole number, but is {}", number(value));
                return Err(Problem::new(path, message).help("use whole numbers, 0 or more"));
            } else {
                Value::from(value)
            };
            set(&mut tree, path, number);
        }
        let mut varied: Self = serde_json::from_value(tree)
            .map_err(|error| Problem::new("", format!("not a scene: {error}")))?;
        if let Cow::Owned(_) = scene {
            varied.start = self.start.clone();
        }
        Ok(varied)
    }

    /// The scene, without the spheres that its start lists if none of these keys is theirs: a tree of values takes
    /// more than a kilobyte for each.
    fn for_keys(&self, keys: &[&str]) -> Cow<'_, Self> {
        match self.apart_from_list() {
            Some((scene, _)) if !keys.iter().any(|key| key.starts_with(LIST_KEY)) => {
                Cow::Owned(scene)
            }
            _ => Cow::Borrowed(self),
        }
    }
}

/// The last part of a path, without index: `radius` of `spheres.radius`.
pub(crate) fn leaf(path: &str) -> &str {
    let last = path.rsplit('.').next().unwrap_or(path);
    last.split('[').next().unwrap_or(last)
}

/// Whether a key never changes the motion.
fn is_without_effect(key: &str) -> bool {
    key.starts_with("output.") || key.starts_with("neighbours.")
}

fn collect(kind: &Kind, value: Option<&Value>, path: &str, keys: &mut Vec<NumericKey>) {
    let mut push = |whole| {
        keys.push(NumericKey {
            path: path.to_owned(),
            whole,
        });
    };
    match kind {
        Kind::Number(_) => push(false),
        Kind::Whole(_) => push(true),
        Kind::Either(kinds) => {
            if kinds.iter().any(|kind| matches!(kind, Kind::Number(_))) {
                push(false);
            }
            let lists = kinds.iter().filter(|kind| matches!(kind, Kind::List(_)));
            for kind in lists.filter(|kind| value.is_some_and(|value| kind.fits_type_of(value))) {
                collect(kind, value, path, keys);
            }
        }
        Kind::Table(table) => collect_table(table, value, path, keys),
        Kind::Tagged(tag, variants) => {
            let word = value.and_then(|value| value.get(tag)?.as_str());
            let variant = variants.iter().find(|(name, _)| Some(*name) == word);
            if let Some((_, table)) = variant {
                collect_table(table, value, path, keys);
            }
        }
        Kind::List(entry) => {
            for (index, value) in entries(value) {
                collect(entry, Some(value), &format!("{path}[{index}]"), keys);
            }
        }
        Kind::Vector => {
            for (index, _) in entries(value) {
                keys.push(NumericKey {
                    path: format!("{path}[{index}]"),
                    whole: false,
                });
            }
        }
        Kind::Text | Kind::Flag | Kind::Choice(_) => {}
    }
}

fn collect_table(
    table: &[crate::document::schema::Key],
    value: Option<&Value>,
    path: &str,
    keys: &mut Vec<NumericKey>,
) {
    // The keys of a table that is not there would bring an effect that is not there.
    let Some(value) = value else { return };
    for key in table {
        let path = match path {
            "" => key.name.to_owned(),
            path => format!("{path}.{}", key.name),
        };
        collect(&key.kind, value.get(key.name), &path, keys);
    }
}

fn entries(value: Option<&Value>) -> impl Iterator<Item = (usize, &Value)> {
    value
        .and_then(Value::as_array)
        .into_iter()
        .flatten()
        .enumerate()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Start, StartSphere};
    use std::path::Path;
    use std::sync::Arc;

    fn scene() -> Scene {
        let text = r#"
            spheres = { count = 3, radius = [{ radius = 0.004, share = 1 }, { radius = 0.005, share = 2 }], density = 1e3 }
            tank = { radius = 0.06 }
            start = { kind = "random", z_min = 0.0, z_max = 0.3 }
            time = { dt = 1e-4, duration = 1.0, frame_interval = 1e-3 }
        "#;
        crate::scene::Scene::from_toml(text, Path::new("scene.toml")).unwrap()
    }

    #[test]
    fn every_numeric_key_can_be_set() {
        let scene = scene();
        for key in scene.all_numeric_keys() {
            let changed = scene.with_values([(key.path.as_str(), 7.0)]).unwrap();
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

    /// Symptom: a sweep over a scene that lists many spheres held them once for each job. Cause: each job's scene was made
    /// of a tree of values.
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

    #[test]
    fn keys_are_found_by_their_last_part() {
        let scene = scene();
        assert_eq!(scene.resolve_key("dt").unwrap(), "time.dt");
        assert_eq!(scene.resolve_key("time.dt").unwrap(), "time.dt");
        assert_eq!(scene.resolve_key("vertical").unwrap(), "guards.vertical");
        for key in [
            "radius",
            "seed",
            "output.profile_bins",
            "omega",
            "swirl.omega",
            "law",
        ] {
            assert!(scene.resolve_key(key).is_err(), "{key}");
        }
    }
}
