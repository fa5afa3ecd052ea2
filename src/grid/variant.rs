//! Variants: named changes of a scene, which are the values of an axis.

use super::Axis;
use super::file::give_the_step_to_an_axis;
use crate::classify::LabelTable;
use crate::document::{Document, LoadError, Problem};
use crate::run::{self, Reading};
use crate::scene::{Change, Scene, is_within};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Name of the axis of variants.
pub const VARIANT: &str = LabelTable::VARIANT;

/// A named change of the scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variant {
    /// Name, as in tables and figures.
    pub name: String,
    /// Factors on the values of other axes, by the names of these.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scale: Vec<(String, f64)>,
    /// The changed scene, before other axes' values are put in.
    #[serde(deserialize_with = "Scene::by_tree")]
    pub scene: Scene,
}

impl Variant {
    /// The factor on the values of an axis, by its name.
    pub fn factor(&self, axis: &str) -> f64 {
        let own = self.scale.iter().filter(|(name, _)| name == axis);
        own.map(|(_, factor)| factor).product()
    }
}

/// A named setting of several keys, as files write it.
#[derive(Deserialize, JsonSchema)]
pub(crate) struct VariantEntry {
    /// Name, as in tables and figures.
    pub(crate) name: String,
    /// Keys of the scene and their values, such as `"time.dt" = 1e-4`. A table, such as
    /// `friction = { law = "coulomb", ... }`, replaces the whole table of the scene.
    #[serde(default)]
    set: BTreeMap<String, Value>,
    /// Tables or keys of the scene that are left out, such as `"spin_damping"`.
    #[serde(default)]
    without: Vec<String>,
    /// Factors on the values of axes, by the names of these: what another size of the scene calls
    /// for.
    #[serde(default)]
    scale: BTreeMap<String, f64>,
}

impl VariantEntry {
    /// What it changes.
    pub(crate) fn change(&self) -> Change {
        let pairs = self.set.iter();
        Change {
            set: pairs.map(|(key, it)| (key.clone(), it.clone())).collect(),
            remove: self.without.clone(),
            scale: self
                .scale
                .iter()
                .map(|(key, it)| (key.clone(), *it))
                .collect(),
        }
    }
}

/// Names must be plain and differ, and each variant must change something.
pub(crate) fn check_variants(
    entries: &[VariantEntry],
    taken: &[&str],
    problems: &mut Vec<Problem>,
) {
    for (index, VariantEntry { name, .. }) in entries.iter().enumerate() {
        let path = format!("variant[{index}]");
        if entries[..index].iter().any(|earlier| earlier.name == *name) {
            let message = format!("duplicate name \"{name}\"");
            let problem = Problem::new(format!("{path}.name"), message);
            problems.push(problem.help("choose another one"));
        }
        if !is_plain(name) || taken.contains(&name.as_str()) {
            let message = format!("{name:?} cannot be the name of a variant");
            let problem = Problem::new(format!("{path}.name"), message);
            problems.push(problem.help(
                "choose a name that no other setting has, of at most 60 letters, digits, spaces \
                 and the characters . _ - + = ( ) %; it begins with a letter or digit and is not a \
                 number",
            ));
        }
        if entries[index].change().is_empty() {
            let problem = Problem::new(path, "the variant changes nothing");
            problems.push(problem.help("add `set`, `without` or `scale`"));
        }
    }
}

/// Whether a name can stand in tables, in points of the command line and in names of files.
fn is_plain(name: &str) -> bool {
    let is_allowed = |it: char| it.is_alphanumeric() || " ._-+=()%".contains(it);
    name.starts_with(char::is_alphanumeric)
        && !name.ends_with(' ')
        && name.chars().all(is_allowed)
        && name.chars().count() <= 60
        && name.parse::<f64>().is_err()
}

/// The axis of variants of a scene beside other axes; none without variants.
pub(crate) fn expand_variants(
    entries: &[VariantEntry],
    source: &SceneTree,
    axes: &[Axis],
    problems: &mut Vec<Problem>,
) -> Option<Axis> {
    check_variants(entries, &[], problems);
    let mut variants = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        let path = format!("variant[{index}]");
        let change = entry.change();
        for absent in source.not_there(&change) {
            problems.push(nothing_to_leave_out(&path, absent));
        }
        let changed = check_change(&change, axes).and_then(|()| source.changed(&change)?.scene());
        match changed {
            Ok(mut scene) => {
                give_the_step_to_an_axis(&mut scene, axes);
                variants.push(Variant {
                    name: entry.name.clone(),
                    scale: change.scale,
                    scene,
                });
            }
            Err(found) => problems.extend(found.into_iter().map(|problem| Problem {
                path: path.clone(),
                message: format!("with {}: {}", entry.name, problem.message),
                ..problem
            })),
        }
    }
    (!variants.is_empty()).then(|| Axis::of_variants(variants))
}

/// A key that is left out although it is not there: a slip of the pen.
pub(crate) fn nothing_to_leave_out(path: &str, absent: &str) -> Problem {
    let message = format!("the scene has no `{absent}` to leave out");
    Problem::new(path, message).help("check its spelling, or remove it here")
}

/// No change may touch what an axis varies, and it scales axes that there are.
pub(crate) fn check_change(change: &Change, axes: &[Axis]) -> Result<(), Vec<Problem>> {
    let taken = change.paths().into_iter().chain(change.remove.clone());
    for path in taken {
        if path == "seed" {
            let message = "`seed` is changed, but every run has a seed of [seeds]";
            return Err(vec![
                Problem::new(path, message).help("use [seeds], or remove it here"),
            ]);
        }
        if let Some(axis) = axes.iter().find(|axis| is_within(&axis.key, &path)) {
            let message = format!(
                "`{path}` is changed, but the axis `{}` varies it",
                axis.name
            );
            let help = "leave the axis out, or do not change the key";
            return Err(vec![Problem::new(path, message).help(help)]);
        }
    }
    for (name, factor) in &change.scale {
        if !axes.iter().any(|axis| axis.name == *name) {
            let names: Vec<&str> = axes.iter().map(|axis| axis.name.as_str()).collect();
            let message = format!("there is no axis \"{name}\" to scale");
            let help = match names.is_empty() {
                true => "add the axis, or remove `scale`".to_owned(),
                false => format!("the axes are {}", names.join(", ")),
            };
            return Err(vec![Problem::new("", message).help(help)]);
        }
        if !(*factor > 0.0 && factor.is_finite()) {
            let message = format!("the axis \"{name}\" cannot be scaled by {factor}");
            return Err(vec![Problem::new("", message).help("use a factor above 0")]);
        }
    }
    Ok(())
}

/// A scene as its file has it, whose keys can be changed.
#[derive(Clone, Debug)]
pub(crate) struct SceneTree {
    tree: Value,
    /// What files that the scene names are relative to.
    folder: PathBuf,
}

impl SceneTree {
    /// The tree of a scene file.
    pub(crate) fn of_document(document: &Document) -> Self {
        Self::within(document.tree(), document.folder())
    }

    /// A tree in which files are relative to a folder.
    pub(crate) fn within(tree: &Value, folder: &Path) -> Self {
        Self {
            tree: tree.clone(),
            folder: folder.to_owned(),
        }
    }

    /// What the key `scene` of a file says: the path of a scene file, or a scene itself.
    pub(crate) fn of_entry(document: &Document) -> Result<Self, LoadError> {
        let entry = &document.tree()["scene"];
        match entry.as_str() {
            Some(path) => Ok(Self::of_document(&Document::read(
                &document.folder().join(path),
            )?)),
            None => Ok(Self::within(entry, document.folder())),
        }
    }

    /// The tree with a change.
    ///
    /// # Errors
    /// If a key of it is in no table.
    pub(crate) fn changed(&self, change: &Change) -> Result<Self, Vec<Problem>> {
        let mut tree = self.tree.clone();
        change.apply(&mut tree).map_err(|path| {
            let message = format!("`{path}` is not in a table");
            vec![Problem::new(path, message)]
        })?;
        Ok(Self {
            tree,
            folder: self.folder.clone(),
        })
    }

    /// The scene, as [`Scene::load_base`] returns it.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn scene(&self) -> Result<Scene, Vec<Problem>> {
        run::base_of_tree(&self.tree, &self.folder, Reading::RUN)
    }

    /// The number at a key, if the file has one there.
    pub(crate) fn number(&self, table: &str, key: &str) -> Option<f64> {
        self.tree[table][key].as_f64()
    }

    /// Tables and keys that a change leaves out although they are not there.
    pub(crate) fn not_there<'a>(&self, change: &'a Change) -> Vec<&'a str> {
        let pointer = |path: &str| format!("/{}", path.replace('.', "/"));
        let absent = |path: &&String| self.tree.pointer(&pointer(path)).is_none();
        let removed = change.remove.iter().filter(absent);
        removed.map(String::as_str).collect()
    }
}
