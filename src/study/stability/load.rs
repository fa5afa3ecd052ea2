//! From a study file to a study.

use super::StabilityStudy;
use crate::classify::{ENERGY_GAIN, NUMERICS};
use crate::document::{Document, LoadError, Problem, Schema, unit};
use crate::grid::{
    Axis, AxisEntry, PointError, Variant, base_scene, check_axes, check_jobs, check_points,
    check_steps, expand_axes, give_the_step_to_an_axis, or_path,
};
use crate::run::Reading;
use crate::scene::{Change, FileKind, Integrator, Scene, settings};
use crate::study::StudyName;
use crate::study::comparison::{Comparison, Measurement, Setting};
use crate::sweep::{RunScenes, StudyRuns, Sweep, fit_frames, output_of_balance};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use std::path::Path;
use std::sync::LazyLock;

/// Most frames of a run: their observables are held in memory.
const MOST_FRAMES: u64 = 1_000_000;

/// The keys of a study file.
pub(crate) static STABILITY: LazyLock<Schema> = LazyLock::new(Schema::of::<StabilityFile>);

/// What a study file says.
#[derive(Deserialize, JsonSchema)]
pub(crate) struct StabilityFile {
    /// Which study the file describes.
    #[serde(rename = "study")]
    _study: OwnName,
    /// Free text, the title of the figure.
    title: Option<String>,
    /// The scene that every run starts from: the path of its file, relative to this one, or the
    /// scene itself in the tables `[scene.spheres]` and so on. Its time step may be above the
    /// limit.
    #[schemars(with = "Scene", transform = or_path)]
    scene: Value,
    /// The two axes, any numeric keys of the scene: the horizontal one, then the vertical one.
    axis: Vec<AxisEntry>,
    /// The integrators, each of which runs at every point (default: all).
    #[serde(default = "all_integrators")]
    integrators: Vec<Integrator>,
    /// Frames of a run, at which energies are looked at. A run lasts the scene's `duration`,
    /// rounded to whole steps and frames, whatever its `frame_interval` says.
    #[serde(default = "hundred")]
    #[schemars(range(min = 1))]
    frames: u64,
    /// Energy out of nothing above which a run is labelled "energy gain", over the largest energy
    /// in motion and contacts so far, or over what lifts every sphere by its radius, if that is
    /// more.
    #[serde(default = "default_gain")]
    #[schemars(transform = unit("").above(0.0))]
    energy_gain: f64,
}

/// The name of this study.
#[derive(Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
enum OwnName {
    /// Where integrators are stable, over two keys of a scene.
    Stability,
}

fn all_integrators() -> Vec<Integrator> {
    Integrator::ALL.to_vec()
}

fn hundred() -> u64 {
    100
}

fn default_gain() -> f64 {
    ENERGY_GAIN
}

/// A scene is read for a study without its frames and output, which are the study's.
const READING: Reading = Reading {
    prepare: |scene| {
        scene.output = output_of_balance();
        scene.time.frame_interval = scene.time.duration;
        scene.steady = None;
    },
    check: |scene| {
        let mut scene = scene.clone();
        fit_frames(&mut scene.time, 1);
        scene.problems_but_of_limit()
    },
};

/// Reads a study file and the scene file that it names, relative to itself. The scenes of all
/// points have been checked, but for their time steps, which may be above the limit.
///
/// # Errors
/// All that is wrong with either file, each with line, column and the fix.
pub fn load(path: &Path) -> Result<StabilityStudy, LoadError> {
    of_document(&Document::read(path)?)
}

/// Like [`load`], with `text` for the content of the file `path`.
///
/// # Errors
/// Those of [`load`].
pub fn from_str(text: &str, path: &Path) -> Result<StabilityStudy, LoadError> {
    of_document(&Document::parse(text.to_owned(), path)?)
}

pub(crate) fn of_document(document: &Document) -> Result<StabilityStudy, LoadError> {
    FileKind::Study.expect(document)?;
    StudyName::Stability.expect(document)?;
    let mut tree = document.tree().clone();
    let mut problems = settings::complete_scene_of(&mut tree);
    STABILITY.kind.check(&tree, "", &mut problems);
    document.accept(&problems)?;
    let file = StabilityFile::deserialize(&tree)
        .map_err(|error| document.refuse(&[Problem::new("", format!("not a study: {error}"))]))?;
    let mut scene = base_scene(&file.scene, document, READING)?;
    let axes = expand_axes(&file.axis, &scene, &mut problems);
    check_steps(&axes, &mut problems);
    give_the_step_to_an_axis(&mut scene, &axes);
    check_axes(&axes, &mut problems);
    check_study(&file, &axes, &mut problems);
    document.accept(&problems)?;
    let sweep = Sweep {
        title: file.title,
        axes,
        study: Some(StudyRuns::Numerics {
            frames: file.frames,
        }),
        ..Sweep::of_scene(scene)
    };
    let settings = file.integrators.iter().map(|it| setting(&sweep, *it));
    let settings: Vec<_> = settings.collect();
    check_runs(&sweep, &settings, document)?;
    let measurement = Measurement::Numerics(file.energy_gain);
    let comparison = Comparison::new(&sweep, settings, 0, measurement);
    Ok(StabilityStudy {
        comparison: comparison
            .map_err(|error| document.refuse(&[Problem::new("", error.to_string())]))?,
    })
}

/// The setting of an integrator, and the variant that it is.
fn setting(sweep: &Sweep, integrator: Integrator) -> (Setting, Variant) {
    let mut scene = sweep.scene.clone();
    scene.time.integrator = integrator;
    let name = integrator.name().to_owned();
    let setting = Setting {
        method: name.clone(),
        rung: None,
        change: Change::of_key("time.integrator", integrator.name().into()),
        note: None,
        name: name.clone(),
    };
    let scale = Vec::new();
    (setting, Variant { name, scale, scene })
}

/// Checks the runs of each integrator.
fn check_runs(
    sweep: &Sweep,
    settings: &[(Setting, Variant)],
    document: &Document,
) -> Result<(), LoadError> {
    let mut problems = Vec::new();
    let points = sweep.points().saturating_mul(settings.len());
    check_jobs(points, "use fewer values", &mut problems);
    document.accept(&problems)?;
    for (_, variant) in settings {
        let own = Sweep {
            scene: variant.scene.clone(),
            ..sweep.clone()
        };
        let errors: Vec<PointError> = match RunScenes::new(&own) {
            Ok(scenes) => own.grid().filter_map(|it| scenes.at(&it).err()).collect(),
            Err(error) => vec![error],
        };
        // What is wrong does not depend on the integrator, but for a step that is chosen.
        check_points(
            errors.into_iter(),
            &sweep.axes,
            document.tree(),
            &mut problems,
        );
        document.accept(&problems)?;
    }
    Ok(())
}

fn check_study(file: &StabilityFile, axes: &[Axis], problems: &mut Vec<Problem>) {
    if file.axis.len() != 2 {
        let message = format!("a study has two axes, not {}", file.axis.len());
        let problem = match file.axis.len() {
            0 | 1 => Problem::new("axis", message).help("add [[axis]] with `key` and `values`"),
            _ => Problem::new("axis[2]", message).help("keep two, and set the others in the scene"),
        };
        problems.push(problem);
    }
    for (index, axis) in axes.iter().enumerate() {
        let path = format!("axis[{index}]");
        if NUMERICS.measures().any(|it| it.name == axis.name) {
            let message = format!("the table has a column \"{}\" of its own", axis.name);
            let problem = Problem::new(format!("{path}.name"), message);
            problems.push(problem.help("choose another `name`"));
        }
        if ["time.frame_interval", "time.duration"].contains(&axis.key.as_str()) {
            let message = format!("the study sets `{}`, so it cannot be an axis", axis.key);
            let problem = Problem::new(format!("{path}.key"), message);
            problems.push(problem.help("choose another key, such as `time.dt`"));
        }
    }
    let mut seen = Vec::new();
    for (index, integrator) in file.integrators.iter().enumerate() {
        if seen.contains(integrator) {
            let message = format!("duplicate integrator \"{}\"", integrator.name());
            let problem = Problem::new(format!("integrators[{index}]"), message);
            problems.push(problem.help("remove one"));
        }
        seen.push(*integrator);
    }
    if file.integrators.is_empty() {
        let problem = Problem::new("integrators", "there are no integrators");
        problems.push(problem.help("list at least one, or remove the key for all of them"));
    }
    if file.frames > MOST_FRAMES {
        let message = format!("{} frames are too many", file.frames);
        let problem = Problem::new("frames", message);
        problems.push(problem.help(format!("{MOST_FRAMES} are the most")));
    }
}
