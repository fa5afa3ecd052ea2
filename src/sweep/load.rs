//! From a sweep file to a sweep.

use super::refining::RefineEntry;
use super::{PlotSettings, Sweep};
use crate::classify::{ClassifyError, FAMILIES, Family, Rules, Sieves};
use crate::document::{Document, LoadError, Problem, Schema, differing_keys, one_of, suggest};
use crate::grid::{
    AxisEntry, PointScenes, SceneTree, SeedsEntry, VariantEntry, base_scene, check_axes,
    check_jobs, check_number_of_axes, check_points, check_steps, describe_point, expand_axes,
    expand_seeds, expand_variants, give_the_step_to_an_axis, or_path,
};
use crate::run::Reading;
use crate::scene::{FileKind, LabelRule, MeasureRule, Scene, settings};
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use std::collections::HashMap;
use std::path::Path;
use std::sync::LazyLock;

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
    /// The axes, four at most, or three beside variants. The first varies slowest. None: only
    /// variants and seeds vary.
    #[serde(default)]
    axis: Vec<AxisEntry>,
    /// Named changes of the scene. All together are one more axis, which varies fastest and whose
    /// name is `variant`: each point runs with each of them.
    #[serde(default)]
    variant: Vec<VariantEntry>,
    /// Seeds; each point of the grid runs once per seed. Absent: seed 1 alone.
    seeds: Option<SeedsEntry>,
    /// Runs only where labels need them, in place of the whole grid. Absent: the whole grid is run.
    refine: Option<RefineEntry>,
    /// The family of the scene, such as `tank`: its sieves label the runs of which no rule of this
    /// file holds, and rules of the scene's own file do not count. Absent: rules alone, if there
    /// are any.
    pub(super) labels: Option<String>,
    /// Thresholds of the sieves, which label the runs.
    #[serde(default)]
    pub(super) sieves: Sieves,
    /// Labels by rules of the file, in place of those of the sieves and of the scene's own file:
    /// the first whose condition holds is the run's.
    #[serde(default)]
    pub(super) label: Vec<LabelRule>,
    /// What is measured of each run besides, by rules of the file, in place of those of the scene's
    /// own file.
    #[serde(default)]
    pub(super) measure: Vec<MeasureRule>,
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
    give_the_step_to_an_axis(&mut scene, &axes);
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
        study: None,
        sieves: Sieves {
            rules: Rules {
                labels: file.label,
                measures: file.measure,
                sieves: file.labels.is_some(),
            },
            ..file.sieves
        },
        plot: file.plot,
    };
    problems.extend(problem_of_labels(file.labels.as_deref(), &sweep.scene));
    if file.axis.is_empty() && file.variant.is_empty() && file.seeds.is_none() {
        let help = "add [[axis]] with `key` and `values`; a single run needs no sweep";
        problems.push(Problem::new("", "the sweep varies nothing").help(help));
    }
    check_number_of_axes(&sweep.axes, &mut problems);
    check_axes(&sweep.axes, &mut problems);
    problems.extend(variants_with_rules(&sweep));
    let rules = rules_of(&mut sweep);
    check_sieves(&sweep, document.tree(), &mut problems);
    document.accept(&problems)?;
    for scene in sweep.scenes_mut() {
        rules.ask_for_columns(scene);
        rules.choose_columns(scene);
    }
    if let Some(refine) = &file.refine {
        refine.refine(&mut sweep, &mut problems);
        document.accept(&problems)?;
    }
    check_plot(&sweep, &mut problems);
    check_grid(&sweep, document, &mut problems);
    document.accept(&problems)?;
    Ok(sweep)
}

/// What is wrong with the family that the file names.
pub(super) fn problem_of_labels(named: Option<&str>, scene: &Scene) -> Option<Problem> {
    let (named, family) = (named?, Family::of(scene));
    if named == family.name {
        return None;
    }
    let message = match FAMILIES.iter().any(|it| it.name == named) {
        true => format!("the scene is a {}, and no {named}", family.name),
        false => format!("`{named}` is no family of scenes"),
    };
    let help = match family.sieves.is_empty() {
        true => "remove it: the scene has no sieves".to_owned(),
        false => format!("use `labels = \"{}\"`, or remove it", family.name),
    };
    Some(Problem::new("labels", message).help(help))
}

/// Rules label all runs alike.
fn variants_with_rules(sweep: &Sweep) -> Vec<Problem> {
    let variants = sweep
        .axes
        .iter()
        .flat_map(|axis| &axis.variants)
        .enumerate();
    let rules = Rules::of(&sweep.scene);
    let others = variants.filter(|(_, variant)| Rules::of(&variant.scene) != rules);
    let problems = others.map(|(place, variant)| {
        let message = format!("{} changes rules, which label all runs alike", variant.name);
        let help = "state `label` and `measure` in the sweep file, outside of variants";
        Problem::new(format!("variant[{place}]"), message).help(help)
    });
    problems.collect()
}

/// The rules of a sweep, which are those of its scene's file where its own does not say any. Its
/// scenes have none afterwards: other rules may label its runs later.
fn rules_of(sweep: &mut Sweep) -> Rules {
    let of_scene = Rules::of(&sweep.scene);
    for scene in sweep.scenes_mut() {
        scene.labels.clear();
        scene.measures.clear();
    }
    let rules = &mut sweep.sieves.rules;
    if rules.labels.is_empty() && !rules.sieves {
        rules.labels = of_scene.labels;
    }
    if rules.measures.is_empty() {
        rules.measures = of_scene.measures;
    }
    rules.clone()
}

/// Sieves must be those of the scene's family, and the spout sieve reads counts that the scene must
/// have asked for.
pub(super) fn check_sieves(sweep: &Sweep, tree: &Value, problems: &mut Vec<Problem>) {
    let variants = sweep.axes.iter().flat_map(|axis| &axis.variants);
    let variants: Vec<&Scene> = variants.map(|variant| &variant.scene).collect();
    problems.extend(sweep.sieves.rules.problems(&sweep.scene, &variants));
    for (place, rule) in sweep.sieves.rules.measures.iter().enumerate() {
        if sweep.axes.iter().any(|axis| axis.name == rule.name) {
            let message = format!("an axis has the name `{}` already", rule.name);
            let problem = Problem::new(format!("measure[{place}].name"), message);
            problems.push(problem.help("use another name: both are columns of one table"));
        }
    }
    check_uses(sweep, problems);
    let family = Family::of(&sweep.scene);
    let Rules { labels, sieves, .. } = &sweep.sieves.rules;
    if !labels.is_empty() && !sieves && tree.get("sieves").is_some() {
        let problem = Problem::new(
            "sieves",
            "the labels of this file are those of its [[label]]",
        );
        let help = match family.sieves.is_empty() {
            true => "remove [sieves], or [[label]]".to_owned(),
            false => format!(
                "remove [sieves], or [[label]]; or give `labels = \"{}\"`, and sieves label the \
                 runs of which no rule holds",
                family.name
            ),
        };
        problems.push(problem.help(help).at_key());
    }
    let given = tree["sieves"].as_object().into_iter().flatten();
    let own: Vec<&str> = family.sieves.iter().map(|sieve| sieve.name).collect();
    for (name, _) in given.filter(|(name, _)| !own.contains(&name.as_str())) {
        let message = format!("`sieves.{name}` is not a sieve of a {}", family.name);
        let help = match own.is_empty() {
            true => "remove it; there are none".to_owned(),
            false => format!("remove it; those are {}", one_of(own.iter().copied())),
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

/// An axis over what no program is given changes nothing.
fn check_uses(sweep: &Sweep, problems: &mut Vec<Problem>) {
    for (place, axis) in sweep.axes.iter().enumerate() {
        let Some(name) = axis.key.strip_prefix("parameters.") else {
            continue;
        };
        let programs = sweep
            .scenes()
            .into_iter()
            .filter_map(|it| it.program.as_ref());
        if !programs.into_iter().any(|program| program.is_given(name)) {
            let message = format!("no program is given `@{{{name}}}`: all its runs would be equal");
            let help = format!("write `@{{{name}}}` in a command or in one of `program.files`");
            let problem = Problem::new(format!("axis[{place}].key"), message);
            problems.push(problem.help(help));
        }
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
    let scenes = match PointScenes::new(&sweep.scene, &sweep.axes) {
        Ok(scenes) => scenes,
        Err(error) => return problems.extend(error.problems),
    };
    let has_variants = sweep.axes.iter().any(|axis| !axis.variants.is_empty());
    let mut points: HashMap<String, Vec<f64>> = HashMap::new();
    let mut same = None;
    let errors = sweep.grid().filter_map(|values| {
        let scene = match scenes.checked(&values) {
            Ok(scene) => scene,
            Err(error) => return Some(error),
        };
        if has_variants && let Some(earlier) = points.insert(scene.identity(), values.clone()) {
            same.get_or_insert((earlier, values));
        }
        None
    });
    check_points(errors, &sweep.axes, document.tree(), problems);
    if let Some((earlier, values)) = same {
        problems.push(same_scene(sweep, &earlier, &values));
    }
}

/// The problem of two points with one scene: their runs have one identity, one record and one row
/// in tables, so that only one of them could be kept as its variant says.
fn same_scene(sweep: &Sweep, earlier: &[f64], values: &[f64]) -> Problem {
    let scenes = [earlier, values].map(|it| sweep.scene_at(it));
    let kept = match &scenes {
        [Ok(earlier), Ok(later)] => differing_keys(&earlier.output, &later.output),
        _ => Vec::new(),
    };
    let [earlier, later] = [earlier, values].map(|it| describe_point(&sweep.axes, it));
    let variant = values.last().map_or(0, |place| *place as usize);
    let path = format!("variant[{variant}]");
    let message = format!("two points are the same scene: {earlier}; and {later}");
    if kept.is_empty() {
        let help = "change or remove one of the variants, or a value of an axis";
        return Problem::new(path, message).help(help);
    }
    let keys = kept.iter().map(|key| format!("`output.{key}`"));
    let keys: Vec<String> = keys.collect();
    Problem::new(
        path,
        format!("{message}; they differ only in {}", keys.join(", ")),
    )
    .help(
        "what a run keeps changes no motion, so that this is one run: set it in [output] of the \
         scene, and leave out one of the variants",
    )
}
