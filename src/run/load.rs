//! From a scene file to a scene.

use super::Edits;
use crate::classify::Rules;
use crate::dem::SAFETY_FACTOR;
use crate::document::{Document, LoadError, Problem, one_of, suggest};
use crate::observe::Observations;
use crate::scene::{AUTO, Change, FileKind, SCENE, Scene, UsualColumns, in_start_file, settings};
use serde_json::Value;
use std::path::Path;

impl Scene {
    /// Reads a scene file. Files of radii and of spheres that it names, relative to itself, are
    /// read too: the returned scene names no file and passes [`Scene::problems`].
    ///
    /// # Errors
    /// All problems of the file, each with line, column and the fix.
    pub fn load(path: &Path) -> Result<Self, LoadError> {
        of_document(&Document::read(path)?)
    }

    /// Like [`load`](Self::load), for a scene that will be varied: with `dt = "auto"`,
    /// `time.safety_factor` is kept in addition to the chosen number, so that
    /// [`Scene::with_chosen_step`] can choose again after other keys have changed. So are
    /// `shaking.frames_per_period` and `shaking.periods`.
    ///
    /// # Errors
    /// As for [`load`](Self::load).
    pub fn load_base(path: &Path) -> Result<Self, LoadError> {
        load_base_with(path, Reading::RUN)
    }

    /// Like [`load`](Self::load), with keys set or removed by a command line.
    ///
    /// # Errors
    /// As for [`load`](Self::load), where problems of a setting point to it; and edits that
    /// contradict each other.
    pub fn load_with(path: &Path, edits: Edits<'_>) -> Result<Self, LoadError> {
        let document = Document::read(path)?;
        FileKind::Scene.expect(&document)?;
        let settings = edits.set.iter().map(|text| setting(text));
        let settings: Vec<Document> = settings.collect::<Result<_, _>>()?;
        let mut tree = document.tree().clone();
        let refuse = |problems: Vec<Problem>| refuse(&document, &settings, &problems);
        let removed = edits.remove.iter();
        let absent = removed
            .filter(|path| !document.holds(path))
            .map(|path| Problem::new("", format!("--without {path}: the scene has no such key")));
        let mut problems: Vec<Problem> = absent.collect();
        let change = Change {
            set: edits.set.iter().zip(&settings).flat_map(entries).collect(),
            remove: edits.remove.to_vec(),
            ..Change::default()
        };
        problems.extend(edits.contradictions(&change.paths()));
        if let Err(path) = change.apply(&mut tree) {
            problems.push(Problem::new(
                "",
                format!("--set {path}: not in a table, or in no entry of a list"),
            ));
        }
        if !problems.is_empty() {
            return Err(refuse(problems));
        }
        let scene = base_of_tree(&tree, document.folder(), Reading::RUN).map_err(refuse)?;
        Ok(to_be_run(scene))
    }

    /// Like [`load`](Self::load), with `text` as the content of the file `path`.
    ///
    /// # Errors
    /// As for [`load`](Self::load).
    pub fn from_toml(text: &str, path: &Path) -> Result<Self, LoadError> {
        of_document(&Document::parse(text.to_owned(), path)?)
    }
}

/// A setting of a command line as a file of one line.
fn setting(text: &str) -> Result<Document, LoadError> {
    let path = Path::new("--set");
    let text = &quoted_entries(text);
    let parsed = Document::parse(text.to_owned(), path);
    match text.split_once('=') {
        // Texts need no quotes, which the shell would remove.
        Some((key, value)) if parsed.is_err() => {
            let quoted = format!("{key}={}", Value::from(value.trim()));
            Document::parse(quoted, path).or(parsed)
        }
        _ => parsed,
    }
}

/// The setting with quotes about entries of lists, such as `wall[0]` in `wall[0].is_door=true`,
/// which are no names of TOML.
fn quoted_entries(text: &str) -> String {
    let Some((key, value)) = text.split_once('=').filter(|(key, _)| !key.contains('"')) else {
        return text.to_owned();
    };
    let quoted = |part: &str| match part.trim() {
        part if part.ends_with(']') => format!("\"{part}\""),
        part => part.to_owned(),
    };
    let parts: Vec<String> = key.split('.').map(quoted).collect();
    format!("{}={value}", parts.join("."))
}

/// What a setting sets: the key before its equals sign, or all tables of one with several lines.
fn entries((text, setting): (&String, &Document)) -> Vec<(String, Value)> {
    let key = text.split('=').next().unwrap_or_default();
    let parts = key
        .split('.')
        .map(|part| part.trim().trim_matches(['"', '\'']));
    let parts: Vec<&str> = parts.collect();
    let value = parts.iter().try_fold(setting.tree(), |tree, part| {
        let table = tree.as_object().filter(|table| table.len() == 1)?;
        table.get(*part)
    });
    match value {
        Some(value) => vec![(parts.join("."), value.clone())],
        None => setting.entries(),
    }
}

/// An error that points to the places of problems in a file or in settings.
fn refuse(document: &Document, settings: &[Document], problems: &[Problem]) -> LoadError {
    let mut findings = Vec::new();
    for problem in problems {
        let holder = settings.iter().find(|it| it.holds(&problem.path));
        let refused = holder
            .unwrap_or(document)
            .refuse(std::slice::from_ref(problem));
        match refused {
            LoadError::Invalid(found) => findings.extend(found),
            read @ LoadError::Read { .. } => return read,
        }
    }
    LoadError::Invalid(findings)
}

/// Like [`Scene::load_base`], for another purpose.
pub(crate) fn load_base_with(path: &Path, reading: Reading) -> Result<Scene, LoadError> {
    base_of_document(&Document::read(path)?, reading)
}

fn of_document(document: &Document) -> Result<Scene, LoadError> {
    let scene = base_of_document(document, Reading::RUN)?;
    Ok(to_be_run(scene))
}

/// A scene that is not varied.
fn to_be_run(mut scene: Scene) -> Scene {
    scene.time.safety_factor = None;
    scene.forget_periods();
    Rules::of(&scene).choose_columns(&mut scene);
    scene
}

pub(crate) fn base_of_document(document: &Document, reading: Reading) -> Result<Scene, LoadError> {
    FileKind::Scene.expect(document)?;
    let scene = base_of_tree(document.tree(), document.folder(), reading);
    scene.map_err(|problems| document.refuse(&problems))
}

/// The purpose for which a scene is read.
#[derive(Clone, Copy)]
pub(crate) struct Reading {
    /// Replaces keys that do not matter for the purpose.
    pub(crate) prepare: fn(&mut Scene),
    /// Finds the problems of a scene whose step is given and whose numbers are in range.
    pub(crate) check: fn(&Scene) -> Vec<Problem>,
}

impl Reading {
    /// To be run unchanged.
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
    match settings::complete(&mut tree) {
        problems if problems.is_empty() => base_of_completed(tree, folder, reading),
        problems => Err(problems),
    }
}

/// The same for a tree in which all keys that follow from others are set.
pub(crate) fn base_of_completed(
    tree: Value,
    folder: &Path,
    reading: Reading,
) -> Result<Scene, Vec<Problem>> {
    let start_file = match &tree["start"]["kind"] {
        kind if kind == "file" => tree["start"]["path"].as_str().map(|it| folder.join(it)),
        _ => None,
    };
    let read = base_with_files(tree, folder, reading);
    match start_file {
        Some(path) => read.map_err(|problems| {
            let placed = problems.into_iter().map(|it| in_start_file(&path, it));
            placed.collect()
        }),
        None => read,
    }
}

fn base_with_files(
    mut tree: Value,
    folder: &Path,
    reading: Reading,
) -> Result<Scene, Vec<Problem>> {
    let mut problems = Vec::new();
    SCENE.kind.check(&tree, "", &mut problems);
    if !problems.is_empty() {
        return Err(problems);
    }
    let is_auto = tree["time"]["dt"] == AUTO;
    if is_auto {
        // An arbitrary number, until the step is chosen for the complete scene.
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
    scene.set_times_of_shaking();
    if is_auto {
        let safety_factor = *scene.time.safety_factor.get_or_insert(SAFETY_FACTOR);
        let shaking = scene.dem.effects.shaking.clone();
        scene = scene.with_chosen_step_in_range()?;
        scene.time.safety_factor = Some(safety_factor);
        scene.dem.effects.shaking = shaking;
        return with_rules(scene);
    }
    match (reading.check)(&scene) {
        problems if problems.is_empty() => with_rules(scene),
        problems => Err(problems),
    }
}

/// The same with the columns that the scene's own rules read.
fn with_rules(mut scene: Scene) -> Result<Scene, Vec<Problem>> {
    let rules = Rules::of(&scene);
    let mut problems = rules.problems(&scene, &[]);
    problems.extend(unknown_columns(&scene));
    if !problems.is_empty() {
        return Err(problems);
    }
    rules.ask_for_columns(&mut scene);
    Ok(scene)
}

/// Names of usual columns that no scene has.
fn unknown_columns(scene: &Scene) -> Vec<Problem> {
    let UsualColumns::Named(names) = &scene.output.usual else {
        return Vec::new();
    };
    let unknown = names.iter().enumerate();
    let unknown = unknown.filter(|(_, name)| !Observations::is_usual(name));
    let problems = unknown.map(|(place, name)| {
        let known = Observations::COLUMNS.iter().map(|column| column.name);
        let path = format!("output.usual[{place}]");
        let help = match suggest(name, known.clone()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("those are {}", one_of(known)),
        };
        Problem::new(path, format!("there is no usual column `{name}`")).help(help)
    });
    problems.collect()
}
