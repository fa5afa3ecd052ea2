//! From a sweep file to a sweep.

use super::axis::AxisEntry;
use super::job::{PointError, PointScenes, points};
use super::refining::RefineEntry;
use super::seeds::{SeedsEntry, expand_seeds};
use super::variant::{SceneTree, VariantEntry, expand_variants};
use super::{Axis, PlotSettings, Sweep};
use crate::classify::{ClassifyError, Family, Sieves};
use crate::document::{Document, LoadError, Problem, Schema, one_of, suggest};
use crate::run::{self, Reading};
use crate::scene::{FileKind, Scene, settings};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::Path;
use std::sync::LazyLock;

/// Largest number of axes.
const MOST_AXES: usize = 4;

/// Largest number of jobs: their scenes are held in memory.
pub(super) const MOST_JOBS: usize = 1_000_000;

/// The keys of a sweep file.
pub(crate) static SWEEP: LazyLock<Schema> = LazyLock::new(Schema::of::<SweepFile>);

/// What a sweep file says.
#[derive(Deserialize, JsonSchema)]
pub(crate) struct SweepFile {
    /// A study of the sweep, which `phase study` makes. Absent: none.
    #[serde(rename = "study")]
    _study: Option<StudyOfSweep>,
    /// Free text, the title of figures.
    title: Option<String>,
    /// The scene that every job starts from: the path of its file, relative to this one, or the
    /// scene itself in the tables `[scene.spheres]` and so on.
    #[schemars(with = "Scene", transform = or_path)]
    scene: Value,
    /// The axes, four at most. The first varies slowest. None: only the seeds vary.
    #[serde(default)]
    axis: Vec<AxisEntry>,
    /// Named changes of the scene, which make one more axis: each point runs with each of them.
    /// The axis varies fastest, and its name is `variant`.
    #[serde(default)]
    variant: Vec<VariantEntry>,
    /// Seeds; each point of the grid runs once per seed. Absent: seed 1 alone.
    seeds: Option<SeedsEntry>,
    /// Runs only where labels need them, in place of the whole grid. Absent: the whole grid is run.
    refine: Option<RefineEntry>,
    /// Thresholds of the sieves, which label the runs.
    #[serde(default)]
    sieves: Sieves,
    /// What the phase diagram shows.
    #[serde(default)]
    plot: PlotSettings,
}

/// A study of a sweep.
#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum StudyOfSweep {
    /// Which effects the scene needs: each is taken away.
    Ablation,
}

/// For the key `scene`: the path of a file, or what the schema says.
pub(crate) fn or_path(schema: &mut schemars::Schema) {
    let description = schema.remove("description");
    let scene = std::mem::take(schema);
    schema.insert("anyOf".to_owned(), json!([{ "type": "string" }, scene]));
    schema.insert("description".to_owned(), json!(description));
}

/// Reads a sweep file and the scene file that it names, relative to itself. The scenes of all
/// points of the grid have been checked.
///
/// # Errors
/// All that is wrong with either file, each with line, column and the fix.
pub fn load(path: &Path) -> Result<Sweep, LoadError> {
    of_document(&Document::read(path)?)
}

/// Like [`load`], with `text` for the content of the file `path`.
///
/// # Errors
/// Those of [`load`].
pub fn from_str(text: &str, path: &Path) -> Result<Sweep, LoadError> {
    of_document(&Document::parse(text.to_owned(), path)?)
}

pub(crate) fn of_document(document: &Document) -> Result<Sweep, LoadError> {
    FileKind::Sweep.expect(document)?;
    let mut tree = document.tree().clone();
    let mut problems = settings::complete_scene_of(&mut tree);
    SWEEP.kind.check(&tree, "", &mut problems);
    document.accept(&problems)?;
    let file = SweepFile::deserialize(&tree)
        .map_err(|error| document.refuse(&[Problem::new("", format!("not a sweep: {error}"))]))?;
    let mut scene = base_scene(&file.scene, document, Reading::RUN)?;
    let mut axes = expand_axes(&file.axis, &scene, &mut problems);
    check_steps(&axes, &mut problems);
    if !file.variant.is_empty() {
        let source = SceneTree::of_entry(document)?;
        axes.extend(expand_variants(
            &file.variant,
            &source,
            &axes,
            &mut problems,
        ));
    }
    if axes.iter().any(|axis| axis.key == "time.dt") {
        // The axis has a number for every point.
        scene.time.safety_factor = None;
    }
    let entry = file.seeds.as_ref();
    let seeds = match &file.refine {
        Some(refine) => refine.seeds(entry, &mut problems),
        None => expand_seeds(entry, &mut problems),
    };
    let mut sweep = Sweep {
        title: file.title,
        scene,
        axes,
        seeds,
        refine: None,
        sieves: file.sieves,
        plot: file.plot,
    };
    if file.axis.is_empty() && file.variant.is_empty() && file.seeds.is_none() {
        let help = "add [[axis]] with `key` and `values`; a single run needs no sweep";
        problems.push(Problem::new("", "the sweep varies nothing").help(help));
    }
    check_number_of_axes(&sweep.axes, &mut problems);
    check_axes(&sweep.axes, &mut problems);
    check_sieves(&sweep, document.tree(), &mut problems);
    document.accept(&problems)?;
    if let Some(refine) = &file.refine {
        refine.refine(&mut sweep, &mut problems);
        document.accept(&problems)?;
    }
    check_plot(&sweep, &mut problems);
    check_grid(&sweep, document, &mut problems);
    document.accept(&problems)?;
    Ok(sweep)
}

/// The scene that the sweep starts from: in a file of its own, or in the table `scene`, in which no
/// key that follows from others is left open.
pub(crate) fn base_scene(
    scene: &Value,
    document: &Document,
    reading: Reading,
) -> Result<Scene, LoadError> {
    let Some(path) = scene.as_str() else {
        let scene = run::base_of_completed(scene.clone(), document.folder(), reading);
        return scene.map_err(|problems| {
            let within = |problem: Problem| problem.within("scene");
            document.refuse(&problems.into_iter().map(within).collect::<Vec<_>>())
        });
    };
    let file = document.folder().join(path);
    let names_another = Document::read(&file).is_ok_and(|it| it.tree().get("scene").is_some());
    if names_another {
        let message = format!("{} is a sweep, not a scene", file.display());
        let help = "name the scene that it names";
        return Err(document.refuse(&[Problem::new("scene", message).help(help)]));
    }
    match run::load_base_with(&file, reading) {
        Err(error @ LoadError::Read { .. }) => {
            let help = "the path is relative to the folder of this file";
            Err(document.refuse(&[Problem::new("scene", error.to_string()).help(help)]))
        }
        other => other,
    }
}

/// The axes of a file, as far as they are right.
pub(crate) fn expand_axes(
    entries: &[AxisEntry],
    scene: &Scene,
    problems: &mut Vec<Problem>,
) -> Vec<Axis> {
    let mut axes = Vec::new();
    for (index, entry) in entries.iter().enumerate() {
        match entry.expand(scene, &format!("axis[{index}]")) {
            Ok(axis) => axes.push(axis),
            Err(problem) => problems.push(problem),
        }
    }
    axes
}

/// A sweep has so many axes at most.
pub(crate) fn check_number_of_axes(axes: &[Axis], problems: &mut Vec<Problem>) {
    if axes.len() > MOST_AXES {
        let message = format!("{} axes are too many", axes.len());
        let problem = Problem::new(format!("axis[{MOST_AXES}]"), message);
        problems.push(problem.help(format!("{MOST_AXES} are the most")));
    }
}

/// No two axes may have the same key or name.
pub(crate) fn check_axes(axes: &[Axis], problems: &mut Vec<Problem>) {
    for (index, axis) in axes.iter().enumerate() {
        let earlier = &axes[..index];
        if earlier.iter().any(|other| other.key == axis.key) {
            let path = format!("axis[{index}].key");
            let message = format!("another axis varies `{}` already", axis.key);
            problems.push(Problem::new(path, message).help("join the two lists of values"));
        } else if earlier.iter().any(|other| other.name == axis.name) {
            let path = format!("axis[{index}].name");
            let message = format!("another axis has the name \"{}\" already", axis.name);
            let help = format!("add a `name`, such as \"{}\"", axis.key);
            problems.push(Problem::new(path, message).help(help));
        }
    }
}

/// The step of a point is given or chosen, not both.
pub(crate) fn check_steps(axes: &[Axis], problems: &mut Vec<Problem>) {
    let position = |key: &str| axes.iter().position(|axis| axis.key == key);
    if let (Some(_), Some(index)) = (position("time.dt"), position("time.safety_factor")) {
        let message = "`time.safety_factor` has no effect where another axis varies `time.dt`";
        let problem = Problem::new(format!("axis[{index}].key"), message);
        problems.push(problem.help("remove one of the two axes"));
    }
}

/// Sieves must be those of the scene's family, and the spout sieve reads counts that the scene must
/// have asked for.
fn check_sieves(sweep: &Sweep, tree: &Value, problems: &mut Vec<Problem>) {
    let family = Family::of(&sweep.scene);
    let given = tree["sieves"].as_object().into_iter().flatten();
    for (name, _) in given.filter(|(name, _)| !family.sieves.contains(&name.as_str())) {
        let message = format!("`sieves.{name}` is not a sieve of a {}", family.name);
        let help = match family.sieves {
            [] => "remove it; there are none".to_owned(),
            own => format!("remove it; those are {}", one_of(own.iter().copied())),
        };
        let problem = Problem::new(format!("sieves.{name}"), message);
        problems.push(problem.help(help).at_key());
    }
    let variants = sweep.axes.iter().flat_map(|axis| &axis.variants);
    for (index, variant) in variants.enumerate() {
        let (own, of_base) = (Family::of(&variant.scene), family);
        if own != of_base {
            let message = format!(
                "with {} the scene is a {}, and no label of it goes with those of a {}",
                variant.name, own.name, of_base.name
            );
            let help = "do not change what makes it one";
            problems.push(Problem::new(format!("variant[{index}]"), message).help(help));
        } else if let Err(error) = sweep.sieves.check(&variant.scene)
            && sweep.sieves.check(&sweep.scene).is_ok()
        {
            let message = format!("with {}: {error}", variant.name);
            problems.push(Problem::new(format!("variant[{index}]"), message));
        }
    }
    match sweep.sieves.check(&sweep.scene) {
        Err(ClassifyError::NotCounted {
            key,
            value,
            list,
            counted,
        }) => {
            let message = format!(
                "`sieves.spout.{key}` = {value} is not one of the scene's `output.{list}` = \
                 {counted:?}"
            );
            let help = format!("use one of these, or add {value} to `{list}` in [output]");
            problems.push(Problem::new(format!("sieves.spout.{key}"), message).help(help));
        }
        Err(error @ ClassifyError::SteadyTooShort { sieve, .. }) => {
            let text = error.to_string();
            let (message, help) = text.split_once("; ").unwrap_or((&text, ""));
            let path = format!("sieves.{sieve}.window");
            let path = match tree.pointer(&format!("/{}", path.replace('.', "/"))) {
                Some(_) => path,
                None => "scene".to_owned(),
            };
            problems.push(Problem::new(path, message).help(help));
        }
        _ => {}
    }
}

fn check_plot(sweep: &Sweep, problems: &mut Vec<Problem>) {
    let PlotSettings {
        x,
        y,
        panels,
        equal_steps,
    } = &sweep.plot;
    let names = || sweep.axes.iter().map(|axis| axis.name.as_str());
    let mut used: Vec<&str> = Vec::new();
    for (key, name) in [("x", x), ("y", y), ("panels", panels)] {
        let Some(name) = name else { continue };
        let path = format!("plot.{key}");
        if !names().any(|known| known == name) {
            problems.push(no_axis(sweep, name, path));
        } else if used.contains(&name.as_str()) {
            let message = format!("the axis \"{name}\" cannot be shown twice");
            problems.push(Problem::new(path, message).help("choose another axis"));
        }
        used.push(name);
    }
    for (index, name) in equal_steps.iter().enumerate() {
        if !names().any(|known| known == name) {
            let path = format!("plot.equal_steps[{index}]");
            problems.push(no_axis(sweep, name, path));
        }
    }
}

/// The problem of a name that no axis has.
fn no_axis(sweep: &Sweep, name: &str, path: String) -> Problem {
    let names = || sweep.axes.iter().map(|axis| axis.name.as_str());
    let known = match sweep.axes.is_empty() {
        true => "it has no axes; remove the key".to_owned(),
        false => format!("the axes are {}", one_of(names())),
    };
    let help = match suggest(name, names()) {
        Some(near) => format!("did you mean \"{near}\"? {known}"),
        None => known,
    };
    Problem::new(path, format!("the sweep has no axis \"{name}\"")).help(help)
}

fn check_grid(sweep: &Sweep, document: &Document, problems: &mut Vec<Problem>) {
    let jobs = sweep.points().saturating_mul(sweep.seeds.len());
    if !check_jobs(jobs, "use fewer values or seeds", problems) {
        return;
    }
    let mut scenes = match PointScenes::new(&sweep.scene, &sweep.axes) {
        Ok(scenes) => scenes,
        Err(error) => return problems.extend(error.problems),
    };
    let errors = sweep
        .grid()
        .filter_map(|values| scenes.checked(&values).err());
    check_points(errors, &sweep.axes, document.tree(), problems);
}

/// Whether that many jobs fit into memory.
pub(crate) fn check_jobs(jobs: usize, help: &str, problems: &mut Vec<Problem>) -> bool {
    if jobs > MOST_JOBS {
        let message = format!("the grid has {jobs} jobs");
        let help = format!("{MOST_JOBS} are the most; {help}");
        problems.push(Problem::new("axis", message).help(help));
    }
    jobs <= MOST_JOBS
}

/// Adds what is wrong with the points of a grid: the problems of the first point, with help that
/// serves all others too, and the number of other points with problems.
pub(crate) fn check_points(
    mut errors: impl Iterator<Item = PointError>,
    axes: &[Axis],
    tree: &Value,
    problems: &mut Vec<Problem>,
) {
    let Some(mut first) = errors.next() else {
        return;
    };
    let mut more = 0;
    for other in errors {
        more += 1;
        first
            .problems
            .iter_mut()
            .for_each(|problem| advise_for(problem, &other));
    }
    let others = match more {
        0 => String::new(),
        more => format!(" (and at {more} more of the {} points)", points(axes)),
    };
    for problem in first.problems {
        let message = format!("at {}{others}: {}", first.point, problem.message);
        let path = place(&problem.path, axes, tree, first.variant);
        problems.push(Problem {
            path,
            message,
            ..problem
        });
    }
}

/// Gives a problem the help of another point where that asks for a lesser value: it serves both.
fn advise_for(problem: &mut Problem, other: &PointError) {
    for stricter in &other.problems {
        let is_stricter = stricter.most.is_some() && stricter.most < problem.most;
        if stricter.path != problem.path || !is_stricter {
            continue;
        }
        let help = stricter.help.as_deref().unwrap_or_default();
        problem.help = Some(format!("{help} at {}", other.point));
        problem.most = stricter.most;
    }
}

/// The place in the file that is shown for the problem of a point: the axis that sets the key, the
/// variant, or the scene.
fn place(path: &str, axes: &[Axis], tree: &Value, variant: Option<usize>) -> String {
    let sets = |axis: &Axis| {
        let rest = path.strip_prefix(&axis.key);
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
    };
    match (axes.iter().position(sets), variant) {
        (Some(index), _) => format!("axis[{index}].key"),
        (None, Some(variant)) => format!("variant[{variant}]"),
        (None, None) if tree["scene"].is_object() => format!("scene.{path}"),
        (None, None) => "scene".to_owned(),
    }
}
