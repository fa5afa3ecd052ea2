//! The program runs any model through the two traits of `phase::simulation`: here a tiny one, of
//! weights on springs, which knows no forces between spheres, no lists and no guards but one.

use phase::cost::RunCost;
use phase::record::{Outcome, RunRecord};
use phase::resume::{Checkpoints, Ending};
use phase::run::Run;
use phase::scene::Scene;
use phase::simulation::{
    BuildError, Column, Frame, FrameView, Guard, Instability, Model, PartOfStep, Profile,
    Simulation, StateError,
};
use phase::store::{content_digest, read_record};
use phase::sweep::{Folder, LocalThreads, Plan, Pool};
use std::io::Write;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::{Duration, Instant};

const SCENE: &str = r#"
    spheres = { count = 3, radius = 0.004, density = 1000.0 }
    start = { kind = "list", spheres = [
        { position = [0, 0, 1] }, { position = [0.1, 0, 2] }, { position = [0.2, 0, 3] },
    ] }
    gravity = { acceleration = 9.8 }
    time = { dt = 1e-3, duration = 0.2, frame_interval = 1e-2 }
"#;

/// Weights that swing about height 0 with one angular frequency, by symplectic Euler.
struct Weights {
    height: Vec<f64>,
    speed: Vec<f64>,
    at_rest: Vec<f64>,
    radius: Vec<f64>,
    mass: Vec<f64>,
    dt: f64,
    steps_per_frame: u64,
    step: u64,
    /// Squared (rad2/s2): the scene's acceleration of free fall over a metre.
    stiffness: f64,
    profile: Option<Profile>,
}

/// Above this height (m) the only guard is broken.
const HIGHEST: f64 = 100.0;

struct WeightsModel;

impl Model for WeightsModel {
    fn work_unit(&self) -> &'static str {
        "weight-steps"
    }

    fn work_of(&self, scene: &Scene) -> u64 {
        scene.spheres.count as u64 * scene.time.steps_per_frame() * scene.time.frames()
    }

    fn parts_of(&self, _: &Scene) -> Vec<PartOfStep> {
        vec![PartOfStep {
            name: "springs",
            is_present: true,
            is_between_steps: false,
        }]
    }

    fn build(&self, scene: &Scene) -> Result<Box<dyn Simulation>, BuildError> {
        let start = toml::Value::try_from(&scene.start).map_err(BuildError::new)?;
        let heights = start["spheres"].as_array().unwrap().iter();
        let count = scene.spheres.count;
        Ok(Box::new(Weights {
            height: heights
                .map(|it| it["position"][2].as_float().unwrap())
                .collect(),
            speed: vec![0.0; count],
            at_rest: vec![0.0; count],
            radius: vec![0.004; count],
            mass: vec![1.0; count],
            dt: scene.time.dt,
            steps_per_frame: scene.time.steps_per_frame(),
            step: 0,
            stiffness: scene.dem.effects.gravity.as_ref().unwrap().acceleration,
            profile: None,
        }))
    }
}

impl Simulation for Weights {
    fn advance_frame(&mut self) -> Result<(), Instability> {
        for _ in 0..self.steps_per_frame {
            self.step += 1;
            for (height, speed) in self.height.iter_mut().zip(&mut self.speed) {
                *speed -= self.dt * self.stiffness * *height;
                *height += self.dt * *speed;
            }
            if let Some(sphere) = self.height.iter().position(|it| !(it.abs() <= HIGHEST)) {
                return Err(Instability {
                    guard: Guard::OutOfBounds,
                    step: self.step,
                    time: self.time(),
                    sphere,
                    detail: "too high".to_owned(),
                });
            }
        }
        Ok(())
    }

    fn time(&self) -> f64 {
        self.step as f64 * self.dt
    }

    fn work(&self) -> u64 {
        self.step * self.height.len() as u64
    }

    fn radius(&self) -> &[f64] {
        &self.radius
    }

    fn mass(&self) -> &[f64] {
        &self.mass
    }

    fn look(&mut self, look: &mut dyn FnMut(&dyn Frame)) {
        look(&FrameView {
            position: [&self.at_rest, &self.at_rest, &self.height],
            velocity: [&self.at_rest, &self.at_rest, &self.speed],
            spin: None,
            radius: &self.radius,
            mass: &self.mass,
            inertia: &[],
            elastic_energy: 0.0,
            ledger: None,
            number: None,
            flow: None,
        });
    }

    fn columns(&self) -> &[Column] {
        &[Column {
            name: "stretch",
            unit: "m",
            description: "Largest stretch of a spring",
        }]
    }

    fn values(&mut self) -> Vec<f64> {
        vec![
            self.height
                .iter()
                .fold(0.0, |most: f64, it| most.max(it.abs())),
        ]
    }

    fn save(&self, to: &mut dyn Write) -> std::io::Result<()> {
        to.write_all(&self.step.to_le_bytes())?;
        let mut numbers = self.height.iter().chain(&self.speed);
        numbers.try_for_each(|it| to.write_all(&it.to_le_bytes()))
    }

    fn restore(&mut self, state: &[u8]) -> Result<(), StateError> {
        let (words, rest) = state.as_chunks::<8>();
        let count = self.height.len();
        if words.len() != 1 + 2 * count || !rest.is_empty() {
            return Err(StateError("it is of other weights"));
        }
        self.step = u64::from_le_bytes(words[0]);
        let numbers: Vec<f64> = words[1..]
            .iter()
            .map(|it| f64::from_le_bytes(*it))
            .collect();
        (self.height, self.speed) = (numbers[..count].to_vec(), numbers[count..].to_vec());
        Ok(())
    }

    fn keep_profile(&mut self) {
        self.profile = Some(Profile::new(1, 0));
    }

    fn profile(&self) -> Option<&Profile> {
        self.profile.as_ref()
    }
}

fn scene() -> Scene {
    Scene::from_toml(SCENE, Path::new("weights.toml")).unwrap()
}

fn begin(scene: &Scene) -> Result<Run, BuildError> {
    Ok(Run::with_simulation(scene, WeightsModel.build(scene)?))
}

fn whole(scene: &Scene) -> RunRecord {
    let mut run = begin(scene).unwrap();
    while !run.ended() {
        run.advance_frame();
    }
    run.finish()
}

#[test]
fn a_run_observes_and_records_it() {
    let record = whole(&scene());
    assert_eq!(record.outcome, Outcome::Completed);
    assert_eq!(record.observations.frames(), 21);
    assert_eq!(record.work, 3 * 200);
    // cos(sqrt(9.8) t) of 3 m at .2 s, with the error of the first order of the steps.
    // What the scene does not call for is not observed, and what the model declares is.
    let names: Vec<_> = record
        .observations
        .scalars()
        .iter()
        .map(|it| it.name)
        .collect();
    let of_spheres = [
        "kinetic",
        "rotational",
        "gravitational",
        "height_mean",
        "height_max",
    ];
    assert_eq!(
        names,
        [&of_spheres[..], &["speed_mean", "stretch"]].concat()
    );
    let top = f64::from(record.observations.height_max[20]);
    assert!(
        (top - 3.0 * libm::cos(9.8_f64.sqrt() * 0.2)).abs() < 0.02,
        "{top}"
    );
}

#[test]
fn its_checkpoints_keep_all_bits() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("weights.h5");
    let checkpoints = Checkpoints::beside(&path, Duration::from_secs(1000));
    for part in 0.. {
        let mut run = begin(&scene()).unwrap();
        assert_eq!(checkpoints.restore(&mut run).unwrap(), part > 0);
        let stop = run.progress().frame + 7;
        let mut control = |now: phase::run::Progress| match now.frame < stop {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        };
        match checkpoints.run(run, &mut control, &mut |error| panic!("{error}")) {
            Ending::Interrupted => {}
            Ending::Finished(record) => {
                assert_eq!(part, 2);
                let digest = |record| content_digest(record).unwrap();
                assert_eq!(digest(&record), digest(&whole(&scene())));
                return;
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn its_guard_ends_a_run() {
    let mut scene = scene();
    // Symplectic Euler is unstable from w dt = 2 on.
    scene.dem.effects.gravity.as_mut().unwrap().acceleration = 4.1e6;
    let record = whole(&scene);
    let Outcome::Unstable(broken) = &record.outcome else {
        panic!("{:?}", record.outcome);
    };
    assert_eq!((broken.guard, broken.sphere), (Guard::OutOfBounds, 2));
    assert_eq!(begin(&scene).unwrap().work(), 0);
}

#[test]
fn a_pool_runs_it_with_the_bits_of_single_runs() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("weights.toml"), SCENE).unwrap();
    let text = r#"
        scene = "weights.toml"
        axis = [{ key = "acceleration", values = [1.0, 2.0, 9.8] }]
    "#;
    let sweep = phase::sweep::from_str(text, &place.path().join("sweep.toml")).unwrap();
    let folder = Folder::new(place.path());
    folder.create().unwrap();
    let threads = LocalThreads::new(2).beginning(&|job| begin(&job.scene()));
    let pool = Pool::new(&folder, &sweep, &threads);
    let plan = Plan::new(&folder, sweep.jobs().unwrap(), 2).unwrap();
    let report = pool.run(&plan).unwrap();
    assert_eq!((report.finished, report.work), (3, 3 * 600));
    for (job, _) in &plan.jobs {
        let stored = read_record(&folder.record(&job.id)).unwrap();
        let digest = |record| content_digest(record).unwrap();
        assert_eq!(digest(&stored), digest(&whole(&job.scene())));
    }
}

#[test]
fn its_cost_is_told_by_its_own_parts() {
    let mut scene = scene();
    // A frame of ten steps takes less than one reading of the clock, whose spread then decided
    // whether springs took any time at all.
    scene.time.dt = 1e-6;
    let cost = RunCost::measure_model(&WeightsModel, &scene, Duration::from_mins(1)).unwrap();
    let names: Vec<_> = cost.parts.iter().map(|part| part.name).collect();
    assert_eq!(names, ["springs", "observers", "record", "start"]);
    assert!(cost.whole && cost.seconds("springs") > 0.0);
}

/// The same, with a start that takes half a second of processor time.
struct SlowStart;

impl Model for SlowStart {
    fn work_unit(&self) -> &'static str {
        WeightsModel.work_unit()
    }

    fn work_of(&self, scene: &Scene) -> u64 {
        WeightsModel.work_of(scene)
    }

    fn parts_of(&self, scene: &Scene) -> Vec<PartOfStep> {
        WeightsModel.parts_of(scene)
    }

    fn build(&self, scene: &Scene) -> Result<Box<dyn Simulation>, BuildError> {
        let mut last = WeightsModel.build(scene)?;
        let clock = Instant::now();
        while clock.elapsed() < Duration::from_millis(500) {
            last = WeightsModel.build(scene)?;
        }
        Ok(last)
    }
}

/// Symptom: `phase check` forecast four hours for a minute of spots, where their packing had to be
/// made first. Cause: the start was part of the time in which frames are tried, and of what they
/// take.
#[test]
fn a_long_start_is_no_part_of_what_frames_cost() {
    let cost = RunCost::measure_model(&SlowStart, &scene(), Duration::from_millis(200)).unwrap();
    assert!(cost.frames > 1, "{} frames", cost.frames);
    assert!(cost.elapsed < 0.5, "{} s", cost.elapsed);
}
