//! Labels the runs of a folder of dumps, as the thesis's analysis did.

use super::{Labelling, NamePattern, work};
use crate::classify::{self, LabelRow, LabelTable, Sieves};
use crate::document::{Problem, number};
use crate::grid::{Axis, PointScenes, give_the_step_to_an_axis};
use crate::replay;
use crate::scene::{Scene, leaf};
use crate::store;
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The dumps in a folder, by name: all its files with that extension.
///
/// # Errors
/// If the folder cannot be listed.
pub fn find_dumps(folder: &Path, extension: &str) -> io::Result<Vec<PathBuf>> {
    let mut dumps = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|own| own == extension) {
            dumps.push(path);
        }
    }
    dumps.sort();
    Ok(dumps)
}

/// The mean radius of the spheres stands in names of the thesis even if a scene lists the radii.
const RADIUS: &str = "spheres.radius";

/// What is known of dumps: their scene, and a pattern of names that says in which keys they differ.
pub struct DumpScene {
    scene: Scene,
    pattern: NamePattern,
    /// The axes of the table, one for each key of the pattern.
    axes: Vec<Axis>,
    /// Whether the scene has the key of each axis as a number.
    is_set: Vec<bool>,
    points: PointScenes,
}

impl DumpScene {
    /// The scene of dumps. Its table has the axes of a sweep over the keys of the pattern.
    ///
    /// # Errors
    /// If a key of the pattern is not a numeric key of the scene, or stands in it twice.
    pub fn new(scene: &Scene, pattern: NamePattern) -> Result<Self, Problem> {
        let (mut axes, mut is_set) = (Vec::new(), Vec::new());
        for written in pattern.keys() {
            let key = match scene.resolve_key(written) {
                Ok(key) => Some(key),
                // Names of the thesis have all three keys, whatever the scene has.
                Err(_) if pattern.text() == NamePattern::OF_THESIS => None,
                Err(problem) => return Err(problem),
            };
            is_set.push(key.is_some());
            axes.push(named_axis(key.unwrap_or_else(|| written.clone()), &axes)?);
        }
        let mut scene = scene.clone();
        give_the_step_to_an_axis(&mut scene, &axes);
        let set: Vec<Axis> = chosen(&axes, &is_set).cloned().collect();
        let points = PointScenes::new(&scene, &set).map_err(|error| {
            let problem = error.problems.into_iter().next();
            problem.unwrap_or_else(|| Problem::new("", "it does not fit the scene"))
        })?;
        Ok(Self {
            scene,
            pattern,
            axes,
            is_set,
            points,
        })
    }

    fn label(&self, path: &Path, sieves: &Sieves) -> Result<LabelRow, String> {
        let fail = |reason: String| format!("{}: {reason}", path.display());
        let (scene, values) = self.of_dump(path).map_err(fail)?;
        let array = store::read_dump(path).map_err(|error| error.to_string())?;
        let record = replay::replay(&array, &scene).map_err(|error| fail(error.to_string()))?;
        let verdict = classify::classify(&record, sieves);
        Ok(LabelRow {
            id: name_of(path),
            values,
            seed: scene.seed,
            verdict: verdict.map_err(|error| fail(error.to_string()))?,
        })
    }

    /// The scene of one dump, with the values of its name.
    fn of_dump(&self, path: &Path) -> Result<(Scene, Vec<f64>), String> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let run = self.pattern.read(&name).ok_or_else(|| {
            format!(
                "its name does not fit `{}`; rename it, or give the pattern of the names with \
                 --names",
                self.pattern.text()
            )
        })?;
        for ((axis, value), is_set) in self.axes.iter().zip(&run.values).zip(&self.is_set) {
            if !is_set && *value != 0.0 && axis.key != RADIUS {
                let (key, value) = (&axis.key, number(*value));
                return Err(format!(
                    "its name says that `{key}` is {value}, but the scene has no such key; add it \
                     to the scene"
                ));
            }
        }
        let values: Vec<f64> = chosen(&run.values, &self.is_set).copied().collect();
        let scene = self.points.unchecked(&values);
        let mut scene = scene.map_err(|error| error.to_string())?;
        scene.seed = run.seed;
        match scene.with_chosen_step() {
            Ok(scene) => Ok((scene, run.values)),
            Err(problems) => Err(self.points.error(&values, problems).to_string()),
        }
    }
}

/// The axis of a key beside others. Of keys that end alike the later ones have their whole path.
fn named_axis(key: String, others: &[Axis]) -> Result<Axis, Problem> {
    if others.iter().any(|other| other.key == key) {
        let message = format!("two of its marks stand for `{key}`");
        return Err(Problem::new("", message).help("leave one of them out"));
    }
    let name = match others.iter().any(|other| other.name == leaf(&key)) {
        true => key.clone(),
        false => leaf(&key).to_owned(),
    };
    Ok(Axis::of_numbers(key, name, Vec::new()))
}

fn chosen<'a, T>(all: &'a [T], is_chosen: &'a [bool]) -> impl Iterator<Item = &'a T> {
    let pairs = all.iter().zip(is_chosen);
    pairs.filter_map(|(one, is_chosen)| is_chosen.then_some(one))
}

impl Labelling {
    /// Labels dumps of runs of a scene, with that many workers. A name says the values of the axes
    /// and the seed of its run; the scene says everything else. The table has the name of the dump
    /// as its id.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn of_dumps(
        dumps: &[PathBuf],
        scene: &DumpScene,
        sieves: &Sieves,
        workers: usize,
    ) -> Result<Self, rayon::ThreadPoolBuildError> {
        let mut labelling = Self {
            table: LabelTable {
                family: sieves.family(&scene.scene),
                axes: scene.axes.iter().map(|axis| axis.name.clone()).collect(),
                variants: Vec::new(),
                rows: Vec::new(),
            },
            missing: 0,
            problems: Vec::new(),
            jobs: dumps.iter().map(|path| name_of(path)).collect(),
        };
        for row in work::map(workers, dumps, |path| scene.label(path, sieves))? {
            match row {
                Ok(row) => labelling.table.rows.push(row),
                Err(problem) => labelling.problems.push(problem),
            }
        }
        refuse_repeated(&mut labelling);
        labelling.table.rows.sort_by(|a, b| {
            let order = |row: &LabelRow| row.values.clone();
            let values = order(a).partial_cmp(&order(b)).expect("finite numbers");
            values.then(a.seed.cmp(&b.seed)).then(a.id.cmp(&b.id))
        });
        Ok(labelling)
    }
}

/// Two dumps of the same point and seed are one run, and must not count twice.
fn refuse_repeated(labelling: &mut Labelling) {
    let mut seen = HashMap::new();
    let axes = labelling.table.axes.join(", ");
    labelling.table.rows.retain(|row| {
        let run: Vec<u64> = row.values.iter().map(|value| value.to_bits()).collect();
        match seen.insert((run, row.seed), row.id.clone()) {
            None => true,
            Some(other) => {
                labelling.problems.push(format!(
                    "{}: says the same {axes} and seed as {other}; keep one of them",
                    row.id
                ));
                false
            }
        }
    });
}

/// What a dump is called in tables.
fn name_of(path: &Path) -> String {
    path.file_stem()
        .unwrap_or_default()
        .to_string_lossy()
        .into()
}
