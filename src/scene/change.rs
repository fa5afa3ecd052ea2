//! Changes of a scene's keys: a simpler law, another step, an effect left out.

use crate::forces::simplification::Simplification;
use serde::Serialize;
use serde_json::{Map, Value};

/// A change of a scene: keys with their new values, and tables that are left out.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Change {
    /// Paths of keys or tables, such as `time.dt`, with their new values, in order. A table
    /// replaces the whole table of the scene.
    pub set: Vec<(String, Value)>,
    /// Paths of tables or keys that are left out, such as `friction`.
    pub remove: Vec<String>,
    /// Factors on the values of axes, by the names of these.
    pub scale: Vec<(String, f64)>,
}

impl Change {
    /// One key with another value.
    pub fn of_key(path: &str, value: Value) -> Self {
        Self {
            set: vec![(path.to_owned(), value)],
            ..Self::default()
        }
    }

    /// The change that takes something away.
    pub fn of_simplification(simplification: &Simplification) -> Self {
        let set = simplification.set.iter();
        Self {
            set: set
                .map(|(key, value)| ((*key).to_owned(), value.clone()))
                .collect(),
            remove: simplification
                .remove
                .iter()
                .map(|&table| table.to_owned())
                .collect(),
            scale: Vec::new(),
        }
    }

    /// Whether nothing is changed.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// The change that makes this one and then another. The second may set a table that the first
    /// leaves out.
    pub fn then(&self, next: &Self) -> Self {
        let replaced = |path: &String| next.set.iter().any(|(new, _)| new == path);
        let first = self.set.iter().filter(|(path, _)| {
            !replaced(path) && !next.remove.iter().any(|removed| is_within(path, removed))
        });
        let removed = self
            .remove
            .iter()
            .filter(|path| !next.remove.contains(path));
        Self {
            set: first.chain(&next.set).cloned().collect(),
            remove: removed.chain(&next.remove).cloned().collect(),
            scale: self.scale.iter().chain(&next.scale).cloned().collect(),
        }
    }

    /// Paths of all keys that it sets, those inside tables one by one.
    pub fn paths(&self) -> Vec<String> {
        let mut paths = Vec::new();
        for (path, value) in &self.set {
            collect(path, value, &mut paths);
        }
        paths
    }

    /// Whether both change a key, or one changes what the other leaves out.
    pub fn touches(&self, other: &Self) -> bool {
        let places = |change: &Self| {
            let mut places = change.paths();
            places.extend(change.remove.iter().cloned());
            places
        };
        let others = places(other);
        let meets = |one: &String, other: &String| is_within(one, other) || is_within(other, one);
        places(self)
            .iter()
            .any(|one| others.iter().any(|other| meets(one, other)))
    }

    /// The value that it gives to a key.
    pub fn value(&self, key: &str) -> Option<&Value> {
        let (path, value) = self
            .set
            .iter()
            .rev()
            .find(|(path, _)| is_within(key, path))?;
        let mut rest = key[path.len()..].split('.').filter(|part| !part.is_empty());
        rest.try_fold(value, |value, part| value.get(part))
    }

    /// Changes the tree of a scene.
    ///
    /// # Errors
    /// The path of a key whose parent is not a table.
    pub(crate) fn apply(&self, tree: &mut Value) -> Result<(), String> {
        for path in &self.remove {
            remove(tree, path);
        }
        for (path, value) in &self.set {
            let place = place(tree, path).ok_or_else(|| path.clone())?;
            *place = value.clone();
        }
        let is_number = |key: &str| self.value(key).is_some_and(Value::is_number);
        if is_number("time.dt") && self.value("time.safety_factor").is_none() {
            // It is only valid if the program chooses the step.
            remove(tree, "time.safety_factor");
        }
        Ok(())
    }
}

/// Whether the key at `path` is `table` or in it.
pub(crate) fn is_within(path: &str, table: &str) -> bool {
    path.strip_prefix(table)
        .is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

fn collect(path: &str, value: &Value, paths: &mut Vec<String>) {
    match value.as_object() {
        Some(table) => {
            for (name, value) in table {
                collect(&format!("{path}.{name}"), value, paths);
            }
        }
        None => paths.push(path.to_owned()),
    }
}

/// The place of a key, such as `time.dt` or `wall[0].friction_coefficient`. Missing tables are
/// created, missing entries of lists are not.
fn place<'a>(tree: &'a mut Value, path: &str) -> Option<&'a mut Value> {
    let mut place = tree;
    for part in path.split('.') {
        if place.is_null() {
            *place = Value::Object(Map::new());
        }
        let (name, index) = part.split_once('[').map_or((part, None), |(name, index)| {
            (name, index.strip_suffix(']'))
        });
        place = place.as_object_mut()?.entry(name).or_insert(Value::Null);
        if let Some(index) = index {
            place = place.get_mut(index.parse::<usize>().ok()?)?;
        }
    }
    Some(place)
}

fn remove(tree: &mut Value, path: &str) {
    let (table, name) = path.rsplit_once('.').unwrap_or(("", path));
    let mut parts = table.split('.').filter(|part| !part.is_empty());
    let table = parts.try_fold(tree, |place, part| place.get_mut(part));
    if let Some(Value::Object(table)) = table {
        table.remove(name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn applied(change: &Change) -> Value {
        let mut tree = json!({
            "friction": { "law": "spin", "coefficient": 0.01 },
            "drag": { "law": "diameter", "linear": 1.0, "quadratic": 2.0 },
            "time": { "dt": "auto", "safety_factor": 0.1, "duration": 1.0 },
        });
        change.apply(&mut tree).unwrap();
        tree
    }

    #[test]
    fn keys_of_entries_of_lists_are_set() {
        let change = |path: &str| Change::of_key(path, json!(2));
        let mut tree = json!({"wall": [{"plane": {"tilt": 0}}, {"friction_coefficient": 1}]});
        for path in ["wall[0].plane.tilt", "wall[1].friction_coefficient"] {
            change(path).apply(&mut tree).unwrap();
        }
        let expected = json!({"wall": [{"plane": {"tilt": 2}}, {"friction_coefficient": 2}]});
        assert_eq!(tree, expected);
        for path in ["wall[2].is_door", "wall[x].is_door", "tank[0].radius"] {
            assert_eq!(change(path).apply(&mut tree), Err(path.to_owned()));
        }
    }

    #[test]
    fn keys_are_set_and_tables_removed() {
        let change = Change {
            set: vec![
                ("time.dt".to_owned(), json!(1e-4)),
                ("magnus.density".to_owned(), json!(1.2)),
            ],
            remove: vec!["friction".to_owned(), "drag.quadratic".to_owned()],
            scale: Vec::new(),
        };
        let expected = json!({
            "drag": { "law": "diameter", "linear": 1.0 },
            "time": { "dt": 1e-4, "duration": 1.0 },
            "magnus": { "density": 1.2 },
        });
        assert_eq!(applied(&change), expected);
    }

    /// Symptom: a table kept keys of the scene that it did not name, unless it named another law.
    /// Cause: tables were merged, unless `law`, `kind` or `search` changed.
    #[test]
    fn a_table_replaces_the_old_one_and_a_key_keeps_the_others() {
        for table in [
            json!({ "law": "constant", "linear": 3.0 }),
            json!({ "law": "diameter", "linear": 3.0 }),
            json!({ "linear": 3.0 }),
        ] {
            let tree = applied(&Change::of_key("drag", table.clone()));
            assert_eq!(tree["drag"], table);
        }
        let tree = applied(&Change::of_key("drag.law", json!("constant")));
        let kept = json!({ "law": "constant", "linear": 1.0, "quadratic": 2.0 });
        assert_eq!(tree["drag"], kept);
    }

    #[test]
    fn the_later_of_two_changes_prevails() {
        let first = Change::of_key("time.dt", json!(1e-3));
        let both = first.then(&Change::of_key("time.dt", json!(1e-4)));
        assert_eq!(both.value("time.dt"), Some(&json!(1e-4)));
        let without = Change {
            remove: vec!["time".to_owned()],
            ..Change::default()
        };
        assert_eq!(first.then(&without).set, []);
        let nested = Change::of_key("drag", json!({ "law": "constant" }));
        assert_eq!(nested.value("drag.law"), Some(&json!("constant")));
        assert_eq!(nested.paths(), ["drag.law"]);
    }

    #[test]
    fn a_key_inside_a_number_has_no_place() {
        let mut tree = json!({ "time": 3.0 });
        let change = Change::of_key("time.dt", json!(1.0));
        assert_eq!(change.apply(&mut tree), Err("time.dt".to_owned()));
    }
}
