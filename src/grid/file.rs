//! What files that describe a grid have in common, and what must be right in them.

use super::{Axis, AxisEntry, PointError, number_of_points};
use crate::document::{Document, LoadError, Problem};
use crate::run::{self, Reading};
use crate::scene::Scene;
use serde_json::{Value, json};

/// Largest number of axes.
const MOST_AXES: usize = 4;

/// Largest number of jobs: all are held in memory, with half a kilobyte each.
pub(crate) const MOST_JOBS: usize = 1_000_000;

/// For the key `scene`: the path of a file, or what the schema says.
pub(crate) fn or_path(schema: &mut schemars::Schema) {
    let description = schema.remove("description");
    let scene = std::mem::take(schema);
    schema.insert("anyOf".to_owned(), json!([{ "type": "string" }, scene]));
    schema.insert("description".to_owned(), json!(description));
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

/// Refuses more axes than a sweep may have; all variants together count as one.
pub(crate) fn check_number_of_axes(axes: &[Axis], problems: &mut Vec<Problem>) {
    if axes.len() <= MOST_AXES {
        return;
    }
    let numbers = axes.iter().filter(|axis| !axis.is_of_variants()).count();
    let (path, message) = match numbers {
        numbers if numbers == axes.len() => {
            let message = format!("{numbers} axes are too many");
            (format!("axis[{MOST_AXES}]"), message)
        }
        numbers => {
            let message = format!("{numbers} axes and the variants are too many");
            // Beside so many axes the variants alone are one too many.
            let path = match numbers > MOST_AXES {
                true => format!("axis[{MOST_AXES}]"),
                false => "variant[0]".to_owned(),
            };
            (path, message)
        }
    };
    let help =
        format!("{MOST_AXES} are the most; all variants together count as one, seeds as none");
    problems.push(Problem::new(path, message).help(help));
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

/// Where an axis has the step of every point, none is chosen for the scene.
pub(crate) fn give_the_step_to_an_axis(scene: &mut Scene, axes: &[Axis]) {
    if axes.iter().any(|axis| axis.key == "time.dt") {
        scene.time.safety_factor = None;
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
        more => format!(
            " (and at {more} more of the {} points)",
            number_of_points(axes)
        ),
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
