//! `dt = "auto"` keeps every limit, and every run says how its step stands to them.

use crate::support::{TinySweep, Workplace, scene_file, silo_file};
use phase::dem::timestep::{least, limits};
use phase::document::LoadError;
use phase::run;
use phase::scene::{self, Scene};
use phase::store::content_digest;
use phase::sweep::{self, Folder, Job, Sweep};
use proptest::prelude::*;
use std::ops::ControlFlow;
use std::path::Path;

fn load(text: &str) -> Result<Scene, LoadError> {
    scene::Scene::from_toml(text, Path::new("scene.toml"))
}

fn load_sweep(text: &str) -> Sweep {
    sweep::from_str(text, Path::new("sweep.toml")).unwrap_or_else(|error| panic!("{error}"))
}

/// This file with another time step.
fn with_step(text: &str, step: &str) -> String {
    let is_step = |line: &&str| line.starts_with("dt = ");
    let old = text.lines().find(is_step).unwrap();
    text.replace(old, &format!("dt = {step}"))
}

/// Whether a time is a whole number of steps, but for rounding.
fn is_whole(time: f64, dt: f64) -> bool {
    let steps = time / dt;
    (steps - steps.round()).abs() < 1e-6 * steps.min(1e3)
}

#[test]
fn auto_and_its_number_are_the_same_run() {
    let auto = load(&with_step(&scene_file(), "\"auto\"")).unwrap();
    let number = load(&with_step(&scene_file(), &format!("{}", auto.time.dt))).unwrap();
    assert_eq!(auto, number);
    assert_eq!(auto.time.safety_factor, None);
    assert_eq!(auto.identity(), number.identity());
    let digest = |scene: &Scene| {
        let record = run::run(scene, &mut |_| ControlFlow::Continue(())).unwrap();
        content_digest(&record).unwrap()
    };
    assert_eq!(digest(&auto), digest(&number));
}

#[test]
fn the_default_is_a_fifth_of_the_least_limit() {
    let step = |step: &str| load(&with_step(&scene_file(), step)).unwrap();
    let auto = step("\"auto\"");
    assert_eq!(auto, step("\"auto\"\nsafety_factor = 0.2"));
    let largest = 0.2 * least(&auto).unwrap().seconds;
    let steps = (auto.time.frame_interval / largest).ceil();
    assert_eq!(auto.time.dt, auto.time.frame_interval / steps);
    assert!(step("\"auto\"\nsafety_factor = 0.02").time.dt < 0.11 * auto.time.dt);
}

#[test]
fn the_step_divides_the_interval_of_the_feed() {
    let text = with_step(&silo_file(), "\"auto\"");
    for (interval, parts) in [
        ("0.1", 1),
        ("0.06", 5),
        ("0.02", 5),
        ("0.07", 5),
        ("0.0625", 4),
    ] {
        let text = text.replace("\ninterval = 0.1", &format!("\ninterval = {interval}"));
        let scene = load(&text).unwrap_or_else(|error| panic!("{error}"));
        let (frame, dt) = (scene.time.frame_interval, scene.time.dt);
        assert!(is_whole(interval.parse().unwrap(), dt), "{interval}: {dt}");
        assert_eq!((frame / dt).round() as u64 % parts, 0);
        let longest = 0.2 * least(&scene).unwrap().seconds;
        assert!(dt <= longest);
        // No more steps than the limit and the parts ask for.
        assert!((frame / dt).round() < frame / longest + parts as f64 + 1.0);
    }
}

fn step_of(job: &Job) -> f64 {
    assert_eq!(job.scene().time.safety_factor, None);
    assert_eq!(job.id, job.scene().identity());
    job.scene().time.dt
}

/// A sweep whose scene has a step that is chosen, with these axes besides the rotation.
fn auto_sweep(axes: &[(&str, [f64; 2])]) -> Sweep {
    let more = axes
        .iter()
        .map(|(key, values)| format!("[[axis]]\nkey = \"{key}\"\nvalues = {values:?}\n"));
    let sweep = TinySweep {
        omegas: vec![4.0],
        seeds: vec![1],
        more: more.collect(),
        ..TinySweep::default()
    };
    load_sweep(&with_step(&sweep.text(), "\"auto\""))
}

#[test]
fn every_point_of_a_sweep_has_its_own_step() {
    let sweep = auto_sweep(&[("spheres.radius", [0.004, 0.002])]);
    let jobs = sweep.jobs().unwrap();
    let [large, small] = [&jobs[0], &jobs[1]].map(step_of);
    assert!(small < 0.7 * large, "{small} and {large}");
    for job in &jobs {
        assert!(step_of(job) <= 0.2 * least(&job.scene()).unwrap().seconds);
    }
}

#[test]
fn axes_vary_the_safety_factor_or_override_it() {
    let jobs = auto_sweep(&[("time.safety_factor", [0.2, 0.1])])
        .jobs()
        .unwrap();
    let [coarse, fine] = [&jobs[0], &jobs[1]].map(step_of);
    assert!((1.8..2.2).contains(&(coarse / fine)), "{coarse} and {fine}");
    let given = [1e-4, 5e-5];
    let jobs = auto_sweep(&[("time.dt", given)]).jobs().unwrap();
    assert_eq!([&jobs[0], &jobs[1]].map(step_of), given);
}

#[test]
fn a_results_folder_remembers_how_the_step_was_chosen() {
    let place = Workplace::new();
    let sweep = auto_sweep(&[("spheres.radius", [0.004, 0.002])]);
    let folder = Folder::new(place.path("results"));
    folder.create().unwrap();
    folder.write_sweep(&sweep).unwrap();
    let scenes = |sweep: &Sweep| -> Vec<Scene> {
        let jobs = sweep.jobs().unwrap();
        jobs.iter().map(Job::scene).collect()
    };
    assert_eq!(scenes(&folder.read_sweep().unwrap()), scenes(&sweep));
}

#[test]
fn a_run_says_how_its_step_stands_to_its_limit() {
    let place = Workplace::new();
    place.write("auto.toml", &with_step(&scene_file(), "\"auto\""));
    let answer = place.phase(&["run", "auto.toml", "--json"]).code(0);
    let told: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
    let scene = scene::Scene::load(&place.path("auto.toml")).unwrap();
    let decisive = limits(&scene)[0];
    assert_eq!(told["dt"], scene.time.dt);
    assert_eq!(told["limit"], decisive.name);
    assert_eq!(told["dt_over_limit"], scene.time.dt / decisive.seconds);
    let ratio = scene.time.dt / decisive.seconds;
    let answer = answer
        .complains(&format!(
            "time step {:e} s: {ratio:.3} of the ",
            scene.time.dt
        ))
        .complains("of the shortest contact (");
    assert!(!answer.stderr.contains("warning"), "{answer:?}");
}

#[test]
fn a_step_near_its_limit_is_warned_of() {
    let place = Workplace::new();
    let scene = load(&scene_file()).unwrap();
    let decisive = limits(&scene)[0].seconds;
    let steps = (scene.time.frame_interval / (0.8 * decisive)).ceil();
    let near = format!("{}", scene.time.frame_interval / steps);
    place.write("near.toml", &with_step(&scene_file(), &near));
    place
        .phase(&["check", "near.toml"])
        .code(0)
        .complains("warning: the time step is 0.")
        .complains("times the limit of")
        .complains("times the advised limit of")
        .complains("(twelve contacts): a sphere squeezed by many others may gain energy");
    let run = place.phase(&["run", "near.toml"]).code(0);
    let lines = run
        .stderr
        .lines()
        .filter(|line| line.contains("the time step is"));
    let [line] = lines.collect::<Vec<_>>()[..] else {
        panic!("{run:?}");
    };
    assert!(line.contains(" of the limit ("), "{line}");
    assert!(
        line.contains(" of the advised limit (twelve contacts)"),
        "{line}"
    );
    assert!(
        line.ends_with("; `phase check` says what follows"),
        "{line}"
    );
    for command in ["run", "check"] {
        let quiet = place.phase(&["--quiet", command, "near.toml"]).code(0);
        assert_eq!(quiet.stderr, "");
    }
    place.write(
        "sweep.toml",
        &with_step(&TinySweep::default().text(), &near),
    );
    place
        .phase(&["sweep", "sweep.toml"])
        .code(0)
        .complains(&format!(
            "time step {:e} s at omega = ",
            near.parse::<f64>().unwrap()
        ))
        .complains(", the nearest to its limit: 0.")
        .complains("the time step is coarse: 0.");
}

#[test]
fn check_says_that_the_step_was_chosen_and_from_what() {
    let place = Workplace::new();
    place.write("auto.toml", &with_step(&scene_file(), "\"auto\""));
    let scene = scene::Scene::load(&place.path("auto.toml")).unwrap();
    let chosen = format!(
        "{:e} s, chosen (\"auto\") from the least limit: {}",
        scene.time.dt,
        least(&scene).unwrap().name
    );
    let check = ["check", "auto.toml", "--no-trial"];
    place.phase(&check).code(0).says(&chosen);
    let answer = place.phase(&[&check[..], &["--json"]].concat()).code(0);
    let told: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
    assert_eq!(told["safety_factor"], 0.2);
    assert_eq!(told["dt"], scene.time.dt);
}

/// A tank whose step is chosen: its laws and everything that limits the step.
fn tanks() -> impl Strategy<Value = (String, f64)> {
    let contact = prop_oneof![
        (5.0..11.0_f64, 0.0..2e-3_f64).prop_map(|(modulus, time)| format!(
            "law = 'hertz', young_modulus = {:e}, poisson_ratio = 0.3, dissipation_time = {time:e}",
            libm::pow(10.0, modulus)
        )),
        (1.0..6.0_f64, 0.0..1.0_f64).prop_map(|(stiffness, damping)| format!(
            "law = 'linear', stiffness = {:e}, damping = {damping:e}",
            libm::pow(10.0, stiffness)
        )),
    ];
    let friction = (0.0..1.0_f64, 1e-5..1.0_f64).prop_map(|(mu, speed)| {
        format!("law = 'coulomb', coefficient = {mu}, regularisation = {speed}")
    });
    let drag = prop_oneof![
        Just(String::new()),
        (1e-4..10.0_f64).prop_map(|linear| format!(
            "drag = {{ law = 'constant', linear = {linear} }}\nswirl = {{ omega = 3.0 }}\n"
        )),
    ];
    let frames = prop::sample::select(vec!["1e-3", "0.01", "0.04", "3e-3"]);
    let other = (1e-3..6e-3_f64, 100.0..8000.0_f64, 0.01..=1.0_f64);
    (contact, friction, drag, frames, other).prop_map(
        |(contact, friction, drag, frame, (radius, density, safety_factor))| {
            let text = format!(
                "contact = {{ {contact} }}
                friction = {{ {friction} }}
                {drag}
                spheres = {{ count = 3, radius = {radius}, density = {density} }}
                tank = {{ radius = 0.06, floor = 0.0 }}
                start = {{ kind = 'random', z_min = 0.01, z_max = 0.3 }}
                gravity = {{ acceleration = 9.8 }}
                output = {{ snapshot_interval = 0.0 }}
                time.dt = 'auto'
                time.safety_factor = {safety_factor}
                time.duration = 0.12
                time.frame_interval = {frame}"
            );
            (text, safety_factor)
        },
    )
}

proptest! {
    #[test]
    fn auto_keeps_every_limit_and_divides_the_frames((text, safety_factor) in tanks()) {
        let scene = load(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let dt = scene.time.dt;
        prop_assert!(limits(&scene).len() >= 4);
        for limit in limits(&scene) {
            prop_assert!(dt <= safety_factor * limit.seconds, "{dt} for {limit:?}");
        }
        let steps = scene.time.frame_interval / dt;
        prop_assert!((steps - steps.round()).abs() < 1e-9 * steps);
        // One step less would be too long.
        let shortest = least(&scene).unwrap().seconds * safety_factor;
        prop_assert!(steps < 1.5 || scene.time.frame_interval / (steps.round() - 1.0) > shortest);
    }
}
