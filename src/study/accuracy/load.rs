//! From the file of a study of accuracy to the study.

use super::choices::{Choice, REFERENCE, choices};
use super::file::{ACCURACY, AccuracyFile, Changes};
use super::{AccuracyStudy, Subject, cases};
use crate::document::{Document, LoadError, Problem, number, one_of};
use crate::grid::{
    Variant, check_axes, check_jobs, check_number_of_axes, check_steps, expand_axes, expand_seeds,
    nothing_to_leave_out,
};
use crate::run;
use crate::scene::{Change, FileKind, Scene, Start, StartSphere, leaf, settings};
use crate::simulation::{BuildError, Snapshot};
use crate::study::StudyName;
use crate::study::comparison::{AS_IT_IS, Base, Comparison, Measurement, Setting};
use crate::sweep::StudyRuns;
use serde::Deserialize;
use std::path::Path;

/// Reads a study and the files that it names, relative to itself. All scenes have been checked.
///
/// # Errors
/// All that is wrong with the files, each with line, column and the fix.
pub fn load(path: &Path) -> Result<AccuracyStudy, LoadError> {
    of_document(&Document::read(path)?)
}

/// Like [`load`], with `text` for the content of the file `path`.
///
/// # Errors
/// Those of [`load`].
pub fn from_str(text: &str, path: &Path) -> Result<AccuracyStudy, LoadError> {
    of_document(&Document::parse(text.to_owned(), path)?)
}

pub(crate) fn of_document(document: &Document) -> Result<AccuracyStudy, LoadError> {
    FileKind::Study.expect(document)?;
    StudyName::Accuracy.expect(document)?;
    let mut tree = document.tree().clone();
    let mut problems = settings::complete_scene_of(&mut tree);
    ACCURACY.kind.check(&tree, "", &mut problems);
    document.accept(&problems)?;
    let file = AccuracyFile::deserialize(&tree)
        .map_err(|error| document.refuse(&[Problem::new("", format!("not a study: {error}"))]))?;
    let choices = choices(&file.ladder, &file.variant, file.combine)
        .map_err(|problems| document.refuse(&problems))?;
    let subject = match (&file.case, &file.scene) {
        (Some(case), None) => {
            check_case_keys(&file, document)?;
            let settings = cases::settings(case, &common(&file), &choices);
            Subject::Case(settings.map_err(|problems| document.refuse(&problems))?)
        }
        (None, Some(_)) => Subject::Scene(Box::new(comparison(&file, &choices, document)?)),
        (given, _) => {
            let message = match given {
                None => "the study has neither `scene` nor `case`",
                Some(_) => "`scene` and `case` exclude each other",
            };
            let help = "`scene` names a scene or sweep, `case` a case of `phase verify`";
            return Err(document.refuse(&[Problem::new("", message).help(help)]));
        }
    };
    check_step_time(&file, &subject, document)?;
    Ok(AccuracyStudy {
        title: file.title,
        tolerance: file.tolerance,
        subject,
        step_time: file.step_time,
    })
}

/// Times of steps are drawn against what the study varies in numbers.
fn check_step_time(
    file: &AccuracyFile,
    subject: &Subject,
    document: &Document,
) -> Result<(), LoadError> {
    let mut known = Vec::new();
    if let Subject::Scene(comparison) = subject {
        known.extend(comparison.axes().iter().map(|axis| axis.name.as_str()));
        let rungs = comparison.settings.iter().filter_map(|it| it.rung.as_ref());
        known.extend(rungs.map(|(key, _)| leaf(key)));
        known.dedup();
    }
    let names = file.step_time.iter().enumerate();
    let unknown = names.filter(|(_, name)| !known.contains(&name.as_str()));
    let problems = unknown.map(|(index, name)| {
        let message = format!("the study has no axis or ladder of numbers \"{name}\"");
        let help = match known.is_empty() {
            true => "remove it: the study has neither".to_owned(),
            false => format!("there is {}", one_of(known.iter().copied())),
        };
        Problem::new(format!("step_time[{index}]"), message).help(help)
    });
    document.accept(&problems.collect::<Vec<_>>())
}

/// A case has its own known numbers, and no seeds.
fn check_case_keys(file: &AccuracyFile, document: &Document) -> Result<(), LoadError> {
    let keys = [
        ("axis", file.axis.is_some()),
        ("seeds", file.seeds.is_some()),
        ("times", file.times.is_some()),
        ("reference", file.reference.is_some()),
    ];
    let given = keys.iter().filter(|(_, is_given)| *is_given);
    let problems: Vec<Problem> = given
        .map(|(key, _)| {
            let message = format!("`{key}` does not go with `case`");
            Problem::new(*key, message)
                .help("remove it: a case has known numbers")
                .at_key()
        })
        .collect();
    document.accept(&problems)
}

fn comparison(
    file: &AccuracyFile,
    choices: &[Choice],
    document: &Document,
) -> Result<Comparison, LoadError> {
    // As the file has it: a word for its accuracy is a key that settings may change.
    let entry = &document.tree()["scene"];
    let mut base = Base::of_entry(entry, document)?;
    let mut problems = Vec::new();
    if let Some(entries) = &file.axis {
        base.sweep.axes = expand_axes(entries, &base.sweep.scene, &mut problems);
        check_steps(&base.sweep.axes, &mut problems);
        check_number_of_axes(&base.sweep.axes, &mut problems);
        check_axes(&base.sweep.axes, &mut problems);
    }
    if file.seeds.is_some() {
        base.sweep.seeds = expand_seeds(file.seeds.as_ref(), &mut problems);
    }
    document.accept(&problems)?;
    let common = common(file);
    if !common.is_empty() {
        note_absent(&base, "base", &common, &mut problems);
        base = base.changed(&common).map_err(|found| {
            let found = found.into_iter().map(|it| at("base", None, it));
            document.refuse(&found.collect::<Vec<_>>())
        })?;
    }
    check_kind(file, &base, &mut problems);
    document.accept(&problems)?;
    let mut settings = settings(&base, file, choices, &mut problems);
    let runs = settings.len() * base.sweep.points() * base.sweep.seeds.len();
    if problems.is_empty() {
        check_jobs(runs, "use fewer settings, values or seeds", &mut problems);
    }
    document.accept(&problems)?;
    let reference = reference(file, &settings, choices).map_err(|it| document.refuse(&[it]))?;
    let measurement = match &file.times {
        None => Measurement::States(Box::new(base.sweep.sieves.clone())),
        Some(times) => {
            start_alike(&mut settings, &mut problems);
            for (_, variant) in &mut settings {
                keep_snapshots(variant, times, &mut problems);
            }
            document.accept(&problems)?;
            Measurement::Motion(times.clone())
        }
    };
    base.sweep.study = Some(match file.step_time.as_slice() {
        [] => StudyRuns::Compared,
        _ => StudyRuns::Timed,
    });
    let comparison = Comparison::new(&base.sweep, settings, reference, measurement);
    comparison.map_err(|error| document.refuse(&[Problem::new("", error.to_string())]))
}

/// What the scene must have for the errors that are asked for.
fn check_kind(file: &AccuracyFile, base: &Base, problems: &mut Vec<Problem>) {
    let Some(times) = &file.times else {
        if base.sweep.seeds.len() < 3 {
            let message = "labels and order parameters are told from noise by seeds, of which it \
                           takes three at least";
            let help = "add [seeds] with `count = 10`, or `times` for a motion that is not chaotic";
            problems.push(Problem::new("seeds", message).help(help));
        }
        if matches!(base.sweep.scene.start, Start::List { .. }) {
            let message = "every sphere of the scene has its place, so that seeds change nothing \
                           and tell no noise";
            let help = "give the scene a random start, or compare its motion at `times`";
            problems.push(Problem::new("scene", message).help(help));
        }
        return;
    };
    if times.is_empty() || !times.windows(2).all(|two| two[0] < two[1]) || times[0] <= 0.0 {
        let message = "`times` must rise from a time above 0";
        problems.push(Problem::new("times", message).help("list them in order, each once"));
    }
    if !base.sweep.axes.is_empty() || base.sweep.seeds.len() > 1 {
        let message = "`times` compares one motion with another, but there are axes or seeds";
        let help = "name a scene, or remove `times` to compare labels";
        problems.push(Problem::new("times", message).help(help).at_key());
    }
    if base.sweep.scene.has_flow() {
        let message = "`times` needs a scene in which no sphere comes or goes";
        let help = "remove `times` to compare labels and order parameters";
        problems.push(Problem::new("times", message).help(help).at_key());
    }
}

/// What all settings have in common.
fn common(file: &AccuracyFile) -> Change {
    file.base.as_ref().map(Changes::change).unwrap_or_default()
}

/// The scene as it is, the reference if the file describes one, and all choices.
fn settings(
    base: &Base,
    file: &AccuracyFile,
    choices: &[Choice],
    problems: &mut Vec<Problem>,
) -> Vec<(Setting, Variant)> {
    let mut settings = Vec::new();
    let reference = file.reference.as_ref().map(|changes| {
        let change = changes.change();
        ("reference".to_owned(), REFERENCE.to_owned(), change)
    });
    let as_it_is = (String::new(), AS_IT_IS.to_owned(), Change::default());
    for (path, name, change) in [as_it_is].into_iter().chain(reference) {
        note_absent(base, &path, &change, problems);
        match base.setting(name, change) {
            Ok(setting) => settings.push(setting),
            Err(found) => problems.extend(found.into_iter().map(|it| at(&path, None, it))),
        }
    }
    for choice in choices {
        note_absent(base, &choice.path, &choice.change, problems);
        match base.setting(choice.name.clone(), choice.change.clone()) {
            Ok((setting, variant)) => {
                let setting = Setting {
                    method: choice.method.clone(),
                    rung: choice.rung.clone(),
                    ..setting
                };
                settings.push((setting, variant));
            }
            Err(found) => {
                let found = found.into_iter();
                problems.extend(found.map(|it| at(&choice.path, Some(&choice.name), it)));
            }
        }
    }
    settings
}

/// Notes what a change leaves out although it is not there: a slip of the pen.
fn note_absent(base: &Base, path: &str, change: &Change, problems: &mut Vec<Problem>) {
    for absent in base.not_there(change) {
        problems.push(nothing_to_leave_out(path, absent));
    }
}

/// A problem of a setting at the place of the study that says it.
fn at(path: &str, name: Option<&str>, problem: Problem) -> Problem {
    let message = match name {
        Some(name) => format!("with {name}: {}", problem.message),
        None => problem.message,
    };
    Problem {
        path: path.to_owned(),
        message,
        ..problem
    }
}

/// The place of the reference among the settings.
fn reference(
    file: &AccuracyFile,
    settings: &[(Setting, Variant)],
    choices: &[Choice],
) -> Result<usize, Problem> {
    if file.reference.is_some() {
        return Ok(1);
    }
    if file.times.is_none() {
        return Ok(0);
    }
    let smallest = |key: &str| {
        let rungs = settings.iter().enumerate();
        let rungs = rungs.filter_map(|(place, (setting, _))| {
            let (own, value) = setting.rung.as_ref()?;
            (own == key).then_some((place, *value))
        });
        rungs.min_by(|(_, a), (_, b)| a.total_cmp(b))
    };
    let methods = |value: f64| {
        let finest = choices.iter().filter(|choice| {
            choice
                .rung
                .as_ref()
                .is_some_and(|(key, it)| key == "time.dt" && *it == value)
        });
        finest.count()
    };
    match smallest("time.dt") {
        Some((place, value)) if methods(value) == 1 => Ok(place),
        _ => {
            let message = "the study does not say what motions are compared with";
            let help = "add [reference] with `set`, such as `set = { \"time.dt\" = 1e-7, \
                        \"time.integrator\" = \"synchronised-verlet\" }`";
            Err(Problem::new("times", message).help(help))
        }
    }
}

/// Makes all settings start with the spheres of the scene as it is. Random places follow from all
/// keys of a scene, so that each setting would have its own.
fn start_alike(settings: &mut [(Setting, Variant)], problems: &mut Vec<Problem>) {
    let Some((_, Variant { scene, .. })) = settings.first() else {
        return;
    };
    if !matches!(scene.start, Start::Random { .. }) {
        return;
    }
    let (spheres, start) = (
        scene.spheres.clone(),
        match placed(scene) {
            Ok(spheres) => Start::list(spheres),
            Err(error) => return problems.push(Problem::new("scene", error.to_string())),
        },
    );
    for (_, variant) in settings {
        let own = &mut variant.scene;
        if own.spheres.count != spheres.count || own.spheres.radius != spheres.radius {
            let message = format!(
                "with {}: a motion of other spheres cannot be compared with that of the scene",
                variant.name
            );
            let help = "leave `spheres` as it is, or remove `times` to compare labels";
            problems.push(Problem::new("times", message).help(help));
        }
        own.start = start.clone();
    }
}

/// The spheres of a scene at its start.
fn placed(scene: &Scene) -> Result<Vec<StartSphere>, BuildError> {
    let mut simulation = run::model_of(scene).build(scene)?;
    let radius = simulation.radius().to_vec();
    let mut start = Snapshot::default();
    simulation.look(&mut |frame| start = Snapshot::take(0.0, frame));
    let vector = |rows: &ndarray::Array2<f64>, sphere: usize| match rows.nrows() > sphere {
        true => [0, 1, 2].map(|axis| rows[[sphere, axis]]),
        false => [0.0; 3],
    };
    let sphere = |(sphere, radius): (usize, &f64)| StartSphere {
        position: vector(&start.position, sphere),
        velocity: vector(&start.velocity, sphere),
        spin: vector(&start.spin, sphere),
        radius: Some(*radius),
    };
    Ok(radius.iter().enumerate().map(sphere).collect())
}

/// Makes the runs of a setting keep all spheres at these times, and end with the last.
fn keep_snapshots(variant: &mut Variant, times: &[f64], problems: &mut Vec<Problem>) {
    let time = &mut variant.scene.time;
    let frames = times.iter().map(|at| at / time.frame_interval);
    let whole = frames
        .clone()
        .all(|it| it >= 0.5 && (it - it.round()).abs() < 1e-6);
    if !whole || times.iter().any(|at| *at > time.duration * (1.0 + 1e-9)) {
        let message = format!(
            "with {}: the times must be whole multiples of `time.frame_interval` = {} s, up to \
             `time.duration` = {} s",
            variant.name,
            number(time.frame_interval),
            number(time.duration)
        );
        let help = "choose other times, or another `frame_interval` in the scene";
        problems.push(Problem::new("times", message).help(help));
        return;
    }
    let frames: Vec<u64> = frames.map(|it| it.round() as u64).collect();
    let common = frames
        .iter()
        .fold(0, |one, &other| greatest_common_divisor(one, other));
    variant.scene.output.snapshot_interval = common as f64 * time.frame_interval;
    time.duration = frames
        .iter()
        .max()
        .map_or(0.0, |&last| last as f64 * time.frame_interval);
}

fn greatest_common_divisor(mut one: u64, mut other: u64) -> u64 {
    while other != 0 {
        (one, other) = (other, one % other);
    }
    one
}
