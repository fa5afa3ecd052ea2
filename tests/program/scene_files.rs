//! Scene and sweep files: the shipped ones and the good ones load, and each bad one gives exactly
//! the message that stands beside it. `BLESS=1` writes these messages anew; read the difference.

use phase::document::LoadError;
use phase::refine::{ModelKind, Settings};
use phase::scene::{self, Radii, Scene, Start};
use phase::study::{accuracy, stability};
use phase::sweep::{self, Sweep};
use proptest::prelude::*;
use std::path::{Path, PathBuf};

pub(crate) fn files(folder: &str) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "toml"))
        .collect();
    files.sort();
    files
}

/// Of which kind a file is: the beginning of its name says so.
pub(crate) fn kind(path: &Path) -> &'static str {
    let name = path.file_name().unwrap().to_str().unwrap();
    let kinds = ["sweep", "stability", "accuracy"].into_iter();
    let mut own = kinds.filter(|kind| name.starts_with(&format!("{kind}-")));
    own.next().unwrap_or("scene")
}

/// What is wrong with a file, if anything.
fn problems(path: &Path) -> Option<LoadError> {
    match kind(path) {
        "sweep" => sweep::load(path).err(),
        "stability" => stability::load(path).err(),
        "accuracy" => accuracy::load(path).err(),
        _ => Scene::load(path).err(),
    }
}

fn refusal(path: &Path) -> LoadError {
    problems(path).unwrap_or_else(|| panic!("{} is accepted", path.display()))
}

#[test]
fn every_bad_file_gives_its_message() {
    let files = files("tests/bad");
    assert!(files.len() > 60, "{} files", files.len());
    let mut different = Vec::new();
    for path in files {
        let message = format!("error: {}\n", refusal(&path));
        let expected = path.with_extension("txt");
        if std::env::var_os("BLESS").is_some() {
            std::fs::write(&expected, &message).unwrap();
        }
        let expected = std::fs::read_to_string(&expected).unwrap_or_default();
        if message != expected {
            different.push(format!("{message}instead of\n{expected}"));
        }
    }
    assert!(different.is_empty(), "{}", different.join("\n"));
}

#[test]
fn every_good_file_loads() {
    for path in files("tests/good") {
        if let Some(error) = problems(&path) {
            panic!("error: {error}");
        }
    }
}

fn load_sweep(path: impl AsRef<Path>) -> Sweep {
    sweep::load(path.as_ref()).unwrap_or_else(|error| panic!("error: {error}"))
}

fn load_scene(path: impl AsRef<Path>) -> Scene {
    scene::Scene::load(path.as_ref()).unwrap_or_else(|error| panic!("error: {error}"))
}

#[test]
fn shipped_sweeps_have_the_grids_they_promise() {
    let grids = [
        ("quick", 9, 9, 1),
        ("realistic", 9, 9, 1),
        ("theoretical", 41, 41, 1),
        ("theoretical-9x9", 9, 9, 3),
        ("theoretical-quadratic", 41, 41, 1),
        ("theoretical-quadratic-9x9", 9, 9, 3),
    ];
    for (name, radii, rotations, seeds) in grids {
        let sweep = load_sweep(format!("sweeps/{name}.toml"));
        let sizes: Vec<usize> = sweep.axes.iter().map(|axis| axis.values.len()).collect();
        assert_eq!(sizes, [radii, rotations], "{name}");
        assert_eq!(sweep.axes[0].key, "spheres.radius");
        assert_eq!(sweep.axes[0].values[0], 0.002);
        assert_eq!(sweep.axes[0].values[radii - 1], 0.006);
        assert_eq!(sweep.axes[1].key, "swirl.omega");
        assert_eq!(sweep.seeds.len(), seeds);
        assert_eq!(sweep.jobs().unwrap().len(), radii * rotations * seeds);
    }
    assert_eq!(
        load_sweep("sweeps/theoretical.toml").axes[0].values[17],
        0.0037
    );
    let sweep = load_sweep("sweeps/density-friction.toml");
    let names: Vec<&str> = sweep.axes.iter().map(|axis| axis.name.as_str()).collect();
    assert_eq!(names, ["radius", "omega", "density", "coefficient"]);
    assert_eq!(sweep.jobs().unwrap().len(), 180);
    let others = [
        ("realistic-steady", 9 * 9),
        ("theoretical-until-steady", 9 * 9),
        ("steel-softened", 9 * 9 * 3),
        ("silo", 10 * 6 * 3),
        ("silo-quick", 3 * 2),
        ("beverloo", 8 * 2 * 4),
        ("beverloo-orifice", 5 * 2),
        ("spot", 7 * 6 * 3),
        ("spot-parameters", 3 * 3 * 3),
        ("silo-fillings", 2 * 12),
        // Coarse grids.
        ("theoretical-refined", 6 * 6),
        ("theoretical-density", 6 * 6 * 3),
        ("realistic-refined", 6 * 6),
        ("spot-refined", 6 * 6),
        ("steel", 9 * 9),
    ];
    for (name, jobs) in others {
        let sweep = load_sweep(format!("sweeps/{name}.toml"));
        assert_eq!(sweep.jobs().unwrap().len(), jobs, "{name}");
    }
    for (name, points, budget) in [
        ("theoretical-refined", 41 * 41, 116),
        ("theoretical-density", 41 * 41 * 9, 400),
        ("realistic-refined", 41 * 41, 84),
        ("steel", 9 * 9, 187),
        ("spot-refined", 21 * 37, 72),
    ] {
        let sweep = load_sweep(format!("sweeps/{name}.toml"));
        assert_eq!(sweep.points(), points, "{name}");
        assert_eq!(sweep.refine.unwrap().budget, budget, "{name}");
    }
    for path in files("sweeps") {
        let name = path.file_stem().unwrap().to_str().unwrap();
        assert!(
            name == "density-friction"
                || others.iter().any(|other| other.0 == name)
                || grids.iter().any(|grid| grid.0 == name),
            "{name} is not in this test"
        );
    }
}

/// `phase check` refuses what this refuses; its trial runs would take seconds.
#[test]
fn every_job_of_the_sweeps_off_the_main_road_is_stable() {
    for name in ["steel", "density-friction"] {
        for job in load_sweep(format!("sweeps/{name}.toml")).jobs().unwrap() {
            let problems: Vec<String> = job
                .scene()
                .problems()
                .iter()
                .map(std::string::ToString::to_string)
                .collect();
            assert_eq!(problems, Vec::<String>::new(), "{name}: {:?}", job.values);
            let limit = phase::dem::timestep::largest_stable(&job.scene()).unwrap();
            assert!(
                job.scene().time.dt < 0.8 * limit.seconds,
                "{name}: {limit:?}"
            );
        }
    }
}

#[test]
fn the_two_fillings_are_dealt_exactly() {
    let sweep = load_sweep("sweeps/silo-fillings.toml");
    for job in sweep.jobs().unwrap() {
        let grains = phase::start::place(&job.scene()).unwrap();
        let small = grains.radius.iter().filter(|radius| **radius == 0.03);
        assert_eq!(small.count(), if job.values[0] == 0.0 { 0 } else { 500 });
        assert_eq!(grains.radius.len(), 1000);
        // A radius that does not occur sets no limit.
        assert_eq!(job.scene().radius_range().0 == 0.04, job.values[0] == 0.0);
    }
}

#[test]
fn steel_is_lifted_as_its_comment_says() {
    let scene = load_scene("sweeps/scenes/steel.toml");
    let (drag, air) = (
        scene.dem.effects.drag.as_ref().unwrap(),
        scene.dem.effects.updraught.as_ref().unwrap(),
    );
    assert_eq!(
        (air.strength, Some(air.origin)),
        (1.0, scene.tank.as_ref().unwrap().floor)
    );
    for (radius, expected) in [(0.002, 6.0), (0.004, 3.0), (0.006, 2.0)] {
        let lift = drag.coefficient(radius, air.speed) * air.speed;
        let volume = 4.0 / 3.0 * std::f64::consts::PI * radius * radius * radius;
        let weight = volume * scene.spheres.density * 9.8;
        assert!(
            (lift / weight - expected).abs() < 0.01,
            "{radius}: {}",
            lift / weight
        );
    }
}

#[test]
fn the_first_axis_varies_slowest_and_seeds_fastest() {
    let sweep = load_sweep("tests/good/sweep-of-file.toml");
    let names: Vec<&str> = sweep.axes.iter().map(|axis| axis.name.as_str()).collect();
    assert_eq!(names, ["radius", "rotation", "density", "alpha"]);
    assert_eq!(sweep.axes[3].values, [0.01, 0.1, 1.0]);
    let jobs = sweep.jobs().unwrap();
    assert_eq!(jobs.len(), 2 * 3 * 3 * 3 * 2);
    assert_eq!(
        (jobs[0].values.as_slice(), jobs[0].seed),
        (&[0.005, 0.0, 1000.0, 0.01][..], 3)
    );
    assert_eq!(
        (jobs[1].values.as_slice(), jobs[1].seed),
        (&[0.005, 0.0, 1000.0, 0.01][..], 4)
    );
    assert_eq!(jobs[2].values, [0.005, 0.0, 1000.0, 0.1]);
    assert_eq!(jobs[107].values, [0.003, 20.0, 3000.0, 1.0]);
    let scene = &jobs[2].scene();
    assert_eq!(scene.spheres.radius, Radii::One(0.005));
    assert_eq!(scene.spheres.density, 1000.0);
    assert_eq!(scene.dem.effects.updraught.as_ref().unwrap().alpha, 0.1);
    assert_eq!((scene.seed, jobs[3].scene().seed), (3, 4));
    let ids: std::collections::HashSet<&str> = jobs.iter().map(|job| job.id.as_str()).collect();
    assert_eq!(ids.len(), jobs.len());
    assert_eq!(jobs[5].id, jobs[5].scene().identity());
}

#[test]
fn a_sweep_without_axes_runs_its_seeds() {
    let jobs = load_sweep("tests/good/sweep-of-table.toml").jobs().unwrap();
    let seeds: Vec<u64> = jobs.iter().map(|job| job.seed).collect();
    assert_eq!(seeds, [5, 3, 11]);
}

#[test]
fn a_table_of_refining_says_how() {
    let sweep = load_sweep("tests/good/sweep-refined.toml");
    // Ascending, and cut into finer steps in the scale of each axis.
    let [omega, alpha] = [0, 1].map(|axis| &sweep.axes[axis].values);
    assert_eq!((omega.len(), alpha.len()), (13, 9));
    assert_eq!(omega[..3], [0.0, 2.5, 5.0]);
    assert_eq!((alpha[0], alpha[2], alpha[8]), (0.01, 0.0316227766017, 1.0));
    assert_eq!(sweep.seeds, [3, 4]);
    let expected = Settings {
        budget: 30,
        width: Some(0.05),
        start: vec![4, 3],
        round: 5,
        replicates: 2,
        first_seed: 3,
        exploring: 0.25,
        model: ModelKind::Regression,
    };
    assert_eq!(sweep.refine.as_ref(), Some(&expected));
    // The coarse grid.
    assert_eq!(sweep.jobs().unwrap().len(), 12);
}

/// A tenth of the points, but no less than half as many again as the coarse grid.
#[test]
fn a_budget_that_is_not_given_follows_the_grid() {
    for (count, budget) in [(11, 54), (41, 169)] {
        let text = format!(
            "scene = 'tank.toml'
            [[axis]]\nkey = 'omega'\nfrom = 0.0\nto = 40.0\ncount = {count}
            [[axis]]\nkey = 'spheres.radius'\nfrom = 0.003\nto = 0.005\ncount = {count}
            [refine]"
        );
        let sweep = sweep::from_str(&text, Path::new("tests/good/sweep.toml")).unwrap();
        assert_eq!(sweep.refine.unwrap().budget, budget);
    }
}

#[test]
fn whole_number_keys_can_be_varied() {
    let text = "scene = 'tank.toml'\n[[axis]]\nkey = 'count'\nvalues = [5, 10.0]";
    let sweep = sweep::from_str(text, Path::new("tests/good/sweep.toml")).unwrap();
    let jobs = sweep.jobs().unwrap();
    assert_eq!([0, 1].map(|job| jobs[job].scene().spheres.count), [5, 10]);
}

/// The identity of the first job of a sweep, without making all the others of a grid.
fn first_job(mut sweep: Sweep) -> String {
    if sweep.refine.is_none() {
        for axis in &mut sweep.axes {
            axis.values.truncate(1);
        }
    }
    sweep.jobs().unwrap().swap_remove(0).id
}

#[test]
fn sweeps_survive_json_exactly() {
    for path in files("sweeps") {
        let sweep = load_sweep(&path);
        let text = serde_json::to_string_pretty(&sweep).unwrap();
        let back: Sweep = serde_json::from_str(&text).unwrap();
        assert_eq!(back, sweep);
        assert_eq!(first_job(back), first_job(sweep));
    }
}

#[test]
fn scenes_survive_json_and_toml_exactly() {
    let is_scene = |path: &&PathBuf| kind(path) == "scene";
    for path in files("tests/good").iter().filter(is_scene) {
        let scene = load_scene(path);
        let json = serde_json::to_string(&scene).unwrap();
        assert_eq!(serde_json::from_str::<Scene>(&json).unwrap(), scene);
        let text = toml::to_string(&scene).unwrap();
        let back =
            scene::Scene::from_toml(&text, path).unwrap_or_else(|error| panic!("error: {error}"));
        assert_eq!(back, scene);
        assert_eq!(back.identity(), scene.identity());
    }
}

#[test]
fn files_named_by_a_scene_become_part_of_it() {
    let scene = load_scene("tests/good/from-files.toml");
    assert_eq!(scene.spheres.radius, Radii::Each(vec![0.003, 0.004, 0.005]));
    let Start::List { spheres } = &scene.start else {
        panic!("{:?}", scene.start);
    };
    assert_eq!(spheres[1].position, [0.1, 0.0, 0.0]);
    assert_eq!(spheres[1].radius, Some(0.006));
    assert_eq!(scene.radius_range(), (0.003, 0.006));
}

#[test]
fn values_of_every_listed_sphere_are_checked() {
    let mut scene = load_scene("tests/good/from-files.toml");
    assert!(scene.problems().is_empty());
    let spheres = scene.start.list_mut().unwrap();
    spheres[1].radius = Some(-1.0);
    spheres[2].velocity[1] = f64::INFINITY;
    let problems: Vec<String> = scene
        .problems()
        .iter()
        .map(std::string::ToString::to_string)
        .collect();
    assert_eq!(problems.len(), 2, "{problems:?}");
    assert!(
        problems[0].contains("`start.spheres[1].radius`"),
        "{problems:?}"
    );
    assert!(
        problems[1].contains("`start.spheres[2].velocity[1]`"),
        "{problems:?}"
    );
}

#[test]
fn every_numeric_key_is_part_of_the_identity() {
    let scene = load_scene("tests/good/everything.toml");
    let keys = scene.numeric_keys();
    assert!(keys.len() > 30, "{keys:?}");
    for key in &keys {
        // Not all of them may be as large as 3, or as small as a quarter.
        let changed = [3.0, 0.25, 0.75].map(|value| scene.with_values([(key.as_str(), value)]));
        let changed = changed.into_iter().find_map(Result::ok).unwrap();
        assert_ne!(changed.identity(), scene.identity(), "{key}");
    }
    let reseeded = Scene {
        seed: 8,
        ..scene.clone()
    };
    assert_ne!(reseeded.identity(), scene.identity());
}

/// The tests of identity look at every effect only if the file has every effect.
#[test]
fn the_file_of_everything_has_every_effect() {
    let names: Vec<_> = load_scene("tests/good/everything.toml")
        .dem
        .effects
        .names()
        .collect();
    let all: Vec<_> = phase::scene::Effects::all_names().collect();
    assert_eq!(names, all);
}

#[test]
fn title_and_output_are_no_part_of_the_identity() {
    let scene = load_scene("tests/good/everything.toml");
    let mut changed = scene.clone();
    changed.title = None;
    changed.output = phase::scene::Output::default();
    assert_ne!(changed, scene);
    assert_eq!(changed.identity(), scene.identity());
}

/// Symptom: a folder of runs whose silbert spring kept its force was resumed with runs whose spring
/// keeps its displacement. Cause: the formula had changed and the keys had not.
#[test]
fn a_law_that_has_changed_makes_other_runs() {
    let before = "c42498a2ada1cbb2";
    assert_ne!(
        first_job(load_sweep("sweeps/beverloo-orifice.toml")),
        before
    );
}

#[test]
fn points_are_chosen_by_name_and_value() {
    let sweep = load_sweep("tests/good/sweep-of-file.toml");
    let point =
        sweep::parse_point("radius=0.003, rotation=10,density=1e3,updraught.alpha=.1").unwrap();
    let jobs = sweep.select(&point).unwrap().jobs().unwrap();
    assert_eq!(jobs.len(), 2);
    assert_eq!(jobs[0].values, [0.003, 10.0, 1000.0, 0.1]);
    let one_seed = sweep::parse_point(
        "seed=SEED"
            .replace("SEED", &jobs[1].seed.to_string())
            .as_str(),
    );
    let seeds = sweep.select(&one_seed.unwrap()).unwrap().seeds;
    assert_eq!(seeds, [jobs[1].seed]);
    let refusals = [
        (
            "radius",
            "`radius` is not of the form `name=value`, such as `radius=0.003,omega=6`",
        ),
        (
            "radius=0.004",
            "`radius` is never 0.004; it takes 0.005, 0.003",
        ),
        (
            "omega=3",
            "the sweep has no axis `omega`; it has radius, rotation, density, alpha",
        ),
    ];
    for (text, message) in refusals {
        let refused = sweep::parse_point(text).and_then(|point| sweep.select(&point));
        assert_eq!(refused.unwrap_err().to_string(), message);
    }
}

/// The tank of the shipped scenes with so many spheres of one radius.
fn tank(count: usize, radius: f64, tank: f64, height: f64) -> Result<Scene, LoadError> {
    let text = format!(
        "spheres = {{ count = {count}, radius = {radius}, density = 1e3 }}
        tank = {{ radius = {tank} }}
        start = {{ kind = 'random', z_min = 0, z_max = {height} }}
        time = {{ dt = 1e-3, duration = 1, frame_interval = 1e-2 }}"
    );
    scene::Scene::from_toml(&text, Path::new("tank.toml"))
}

#[test]
fn a_random_start_that_is_accepted_can_be_placed() {
    // Small and large spheres, flat and high, from loose to as dense as it goes.
    for (radius, height) in [
        (0.003, 0.05),
        (0.006, 0.0),
        (0.02, 0.5),
        (0.03, 0.5),
        (0.05, 1.0),
    ] {
        let volume = 4.0 / 3.0 * radius * radius * radius;
        let space = 0.06 * 0.06 * (height + 2.0 * radius);
        for filled in [0.08, 0.14, 0.20, 0.29, 0.31] {
            let count = (filled * space / volume) as usize;
            match tank(count, radius, 0.06, height) {
                Ok(scene) => assert!(phase::start::place(&scene).is_ok()),
                Err(error) => {
                    let message = error.to_string();
                    assert!(message.contains("spheres do not fit"), "{message}");
                    assert!(filled > 0.14, "{radius} m fill {filled}");
                }
            }
            assert!(filled < 0.30 || tank(count + 1, radius, 0.06, height).is_err());
        }
    }
}

proptest! {
    /// Whatever is done to a good file, it is loaded or refused.
    #[test]
    fn no_text_panics(
        file in prop::sample::select(vec![
            "everything.toml",
            "steel.toml",
            "sweep-of-file.toml",
            "accuracy-motion.toml",
        ]),
        from in 0_usize..1500,
        length in 0_usize..30,
        new in "[a-z0-9 .=\\[\\]{}\"',\n-]{0,8}|[1-9]e[0-9]{1,3}|-1|0|nan|inf|true|\u{e9}",
    ) {
        let path = Path::new("tests/good").join(file);
        let mut text = std::fs::read_to_string(&path).unwrap();
        let from = from.min(text.len());
        text.replace_range(from..(from + length).min(text.len()), &new);
        let refused = match kind(&path) {
            "sweep" => sweep::from_str(&text, &path).err(),
            "accuracy" => accuracy::from_str(&text, &path).err(),
            _ => Scene::from_toml(&text, &path).err(),
        };
        if let Some(error) = refused {
            prop_assert!(!error.to_string().is_empty());
        }
    }
}
