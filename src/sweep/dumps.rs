//! Labels the runs of a folder of dumps, as the thesis's analysis did.

use super::{Labelling, work};
use crate::classify::{self, Family, LabelRow, LabelTable, Sieves};
use crate::document::Problem;
use crate::replay;
use crate::scene::{Radii, Scene};
use crate::store::{self, DumpName};
use std::collections::HashMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The dumps in a folder, by name: all its `.npy` files.
///
/// # Errors
/// If the folder cannot be listed.
pub fn find_dumps(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut dumps = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|extension| extension == "npy") {
            dumps.push(path);
        }
    }
    dumps.sort();
    Ok(dumps)
}

impl Labelling {
    /// Labels dumps of runs of a scene, with that many workers. Radius, density, Omega and seed are
    /// those that the name of a dump says; the scene says everything else. The table has the first
    /// three as its axes, and the name of the dump as its id.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn of_dumps(
        dumps: &[PathBuf],
        scene: &Scene,
        sieves: &Sieves,
        workers: usize,
    ) -> Result<Self, rayon::ThreadPoolBuildError> {
        let mut labelling = Self {
            table: LabelTable {
                family: Family::of(scene),
                axes: ["radius", "density", "omega"].map(str::to_owned).into(),
                variants: Vec::new(),
                rows: Vec::new(),
            },
            missing: 0,
            problems: Vec::new(),
            jobs: dumps.iter().map(|path| name_of(path)).collect(),
        };
        for row in work::map(workers, dumps, |path| label(path, scene, sieves))? {
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
    labelling.table.rows.retain(|row| {
        let run: Vec<u64> = row.values.iter().map(|value| value.to_bits()).collect();
        match seen.insert((run, row.seed), row.id.clone()) {
            None => true,
            Some(other) => {
                labelling.problems.push(format!(
                    "{}: says the same radius, density, Omega and seed as {other}; keep one of \
                     them",
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

fn label(path: &Path, scene: &Scene, sieves: &Sieves) -> Result<LabelRow, String> {
    let fail = |reason: String| format!("{}: {reason}", path.display());
    let (scene, name) = scene_of(path, scene).map_err(fail)?;
    let values = store::read_dump(path).map_err(|error| error.to_string())?;
    let record = replay::replay(&values, &scene).map_err(|error| fail(error.to_string()))?;
    let verdict = classify::classify(&record, sieves).map_err(|error| fail(error.to_string()))?;
    Ok(LabelRow {
        id: name_of(path),
        values: vec![name.radius, name.density, name.omega],
        seed: name.seed,
        verdict,
    })
}

/// The scene of a dump: what its name says, and the rest of `base`.
fn scene_of(path: &Path, base: &Scene) -> Result<(Scene, DumpName), String> {
    let mut scene = base.clone();
    let file = path.file_name().unwrap_or_default().to_string_lossy();
    let name = DumpName::parse(&file).ok_or_else(|| {
        "its name must say radius, density and Omega, as in dump_r00.003_p03750.0_f006.0.npy (and \
         a seed other than 1 as _s2 before the dot)"
            .to_owned()
    })?;
    if let Radii::One(radius) = &mut scene.spheres.radius {
        *radius = name.radius;
    }
    scene.spheres.density = name.density;
    scene.seed = name.seed;
    match &mut scene.dem.effects.swirl {
        Some(swirl) => swirl.omega = name.omega,
        None if name.omega == 0.0 => {}
        None => {
            return Err(format!(
                "its name says that the air rotates ({} rad/s), but the scene has no [swirl]",
                name.omega
            ));
        }
    }
    match scene.with_chosen_step() {
        Ok(scene) => Ok((scene, name)),
        Err(problems) => {
            let problems: Vec<String> = problems.iter().map(Problem::to_string).collect();
            Err(format!("with what its name says, {}", problems.join("; ")))
        }
    }
}
