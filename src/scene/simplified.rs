//! A scene with a simpler stand-in for one of its parts.

use super::{Scene, Start};
use crate::document::Problem;
use crate::forces::simplification::Simplification;
use serde::Deserialize;
use serde_json::{Map, Value};

impl Scene {
    /// This scene with a simplification. It may have problems of its own.
    ///
    /// # Errors
    /// If what comes out is no scene.
    pub fn simplified(&self, change: &Simplification) -> Result<Self, Problem> {
        let mut tree = self.for_keys(&[]).tree();
        for (path, value) in &change.set {
            if let Some((table, key)) = table_and_key(&mut tree, path) {
                table.insert(key.to_owned(), value.clone());
            }
        }
        for path in &change.remove {
            if let Some((table, key)) = table_and_key(&mut tree, path) {
                table.remove(key);
            }
        }
        let mut scene = Self::deserialize(&tree)
            .map_err(|error| Problem::new("", format!("{}: not a scene: {error}", change.name)))?;
        if let Start::List { .. } = self.start {
            scene.start = self.start.clone();
        }
        Ok(scene)
    }
}

/// The table that a path leads to, if it is there, and the last part of the path.
fn table_and_key<'a, 'p>(
    tree: &'a mut Value,
    path: &'p str,
) -> Option<(&'a mut Map<String, Value>, &'p str)> {
    let (table, key) = match path.rsplit_once('.') {
        Some((table, key)) => (format!("/{}", table.replace('.', "/")), key),
        None => (String::new(), path),
    };
    Some((tree.pointer_mut(&table)?.as_object_mut()?, key))
}
