//! From a scene file to a scene.

use crate::dem::SAFETY_FACTOR;
use crate::document::{Document, LoadError, Problem};
use crate::scene::{AUTO, FileKind, SCENE, Scene, settings};
use serde_json::Value;
use std::path::Path;

impl Scene {
    /// Reads a scene file. Files of radii and of spheres that it names, relative to itself, are
    /// read too: what comes back names no file and passes [`Scene::problems`].
    ///
    /// # Errors
    /// All that is wrong with the file, each with line, column and the fix.
    pub fn load(path: &Path) -> Result<Self, LoadError> {
        of_document(&Document::read(path)?)
    }

    /// Like [`load`](Self::load), for a scene that is to be varied: where the file says
    /// `dt = "auto"`, `time.safety_factor` is kept beside the number that is chosen for the scene
    /// as it stands, so that [`Scene::with_chosen_step`] can choose another after other keys have
    /// changed.
    ///
    /// # Errors
    /// Those of [`load`](Self::load).
    pub fn load_base(path: &Path) -> Result<Self, LoadError> {
        load_base_with(path, Reading::RUN)
    }

    /// Like [`load`](Self::load), with `text` for the content of the file `path`.
    ///
    /// # Errors
    /// Those of [`load`](Self::load).
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, LoadError> {
        of_document(&Document::parse(text.to_owned(), path)?)
    }
}

/// Like [`Scene::load_base`], for another purpose.
pub(crate) fn load_base_with(path: &Path, reading: Reading) -> Result<Scene, LoadError> {
    base_of_document(&Document::read(path)?, reading)
}

fn of_document(document: &Document) -> Result<Scene, LoadError> {
    let mut scene = base_of_document(document, Reading::RUN)?;
    scene.time.safety_factor = None;
    Ok(scene)
}

pub(crate) fn base_of_document(document: &Document, reading: Reading) -> Result<Scene, LoadError> {
    FileKind::Scene.expect(document)?;
    let scene = base_of_tree(document.tree(), document.folder(), reading);
    scene.map_err(|problems| document.refuse(&problems))
}

/// What a scene is read for.
#[derive(Clone, Copy)]
pub(crate) struct Reading {
    /// Puts what the purpose asks for in the place of keys that do not matter to it.
    pub(crate) prepare: fn(&mut Scene),
    /// Finds the problems of a scene whose step is given and whose numbers are in range.
    pub(crate) check: fn(&Scene) -> Vec<Problem>,
}

impl Reading {
    /// To be run as it stands.
    pub(crate) const RUN: Self = Self {
        prepare: |_| {},
        check: Scene::problems_in_range,
    };
}

/// The scene that a tree of values describes, as [`Scene::load_base`] returns it; files it names
/// are relative to `folder`.
pub(crate) fn base_of_tree(
    tree: &Value,
    folder: &Path,
    reading: Reading,
) -> Result<Scene, Vec<Problem>> {
    let mut tree = tree.clone();
    let mut problems = settings::complete(&mut tree);
    SCENE.kind.check(&tree, "", &mut problems);
    if !problems.is_empty() {
        return Err(problems);
    }
    let is_auto = tree["time"]["dt"] == AUTO;
    if is_auto {
        // Any number, until the scene is there that one follows from.
        tree["time"]["dt"] = tree["time"]["frame_interval"].clone();
    }
    let mut scene: Scene = serde_json::from_value(tree)
        .map_err(|error| vec![Problem::new("", format!("not a scene: {error}"))])?;
    if scene.names_files() {
        scene.read_files(folder, &mut problems);
        if problems.is_empty() {
            problems = scene.problems_of_values();
        }
        if !problems.is_empty() {
            return Err(problems);
        }
    }
    (reading.prepare)(&mut scene);
    if is_auto {
        let safety_factor = *scene.time.safety_factor.get_or_insert(SAFETY_FACTOR);
        scene = scene.with_chosen_step_in_range()?;
        scene.time.safety_factor = Some(safety_factor);
        return Ok(scene);
    }
    match (reading.check)(&scene) {
        problems if problems.is_empty() => Ok(scene),
        problems => Err(problems),
    }
}
