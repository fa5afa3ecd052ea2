//! A run that was interrupted goes on from its checkpoint with the bits of one that was not.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod scenes;
mod support;

use phase::dem::Simulation;
use phase::record::{MilestoneKind, Outcome, Program, RunRecord};
use phase::resume::{Checkpoints, Ending};
use phase::run::Run;
use phase::scene::{Friction, Integrator, Neighbours, Scene};
use phase::store::{content_digest, read_record};
use scenes::{frictions, state, tank};
use std::fs;
use std::io::{BufRead, BufReader};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::Child;
use std::time::Duration;
use support::{Answer, TinySweep, Workplace, damage, end, signal, silo_file, wait_until};

/// Runs a scene to its end without a break.
fn whole(scene: &Scene) -> RunRecord {
    phase::run::run(scene, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// Runs a scene to its end, and stops at every `step`-th frame: each part goes on from the file that
/// the part before left. Returns the record and the number of parts.
fn in_parts(scene: &Scene, step: u64) -> (RunRecord, usize) {
    let place = Workplace::new();
    let checkpoints = Checkpoints::beside(&place.path("run.h5"), Duration::from_secs(1000));
    for part in 1.. {
        let mut run = Run::new(scene).unwrap();
        assert_eq!(checkpoints.restore(&mut run).unwrap(), part > 1);
        let first = run.progress().frame;
        let mut control = |now: phase::run::Progress| match now.frame - first < step {
            true => ControlFlow::Continue(()),
            false => ControlFlow::Break(()),
        };
        match checkpoints.run(run, &mut control, &mut |error| panic!("{error}")) {
            Ending::Finished(record) => return (*record, part),
            Ending::Interrupted => {}
            other => panic!("{other:?}"),
        }
    }
    unreachable!("a run comes to its end")
}

/// Asserts that a run in parts has the bits of a whole one, at every frame, and returns that.
#[track_caller]
fn assert_same_bits(mut scene: Scene, step: u64) -> RunRecord {
    scene.output.trajectory = true;
    scene.output.snapshot_interval = 3.0 * scene.time.frame_interval;
    let expected = whole(&scene);
    let (found, parts) = in_parts(&scene, step);
    assert!(parts > 2, "{parts} parts");
    assert_eq!(found.trajectory.len(), expected.trajectory.len());
    for (frame, (one, other)) in expected
        .trajectory
        .iter()
        .zip(&found.trajectory)
        .enumerate()
    {
        let bits = |state: &phase::observe::Snapshot| -> Vec<u64> {
            let arrays = [&state.position, &state.velocity, &state.spin];
            arrays
                .into_iter()
                .flatten()
                .map(|it| it.to_bits())
                .collect()
        };
        assert!(
            bits(one) == bits(other),
            "frame {frame}, {:?}, {:?}",
            scene.friction,
            scene.time.integrator
        );
    }
    assert_eq!(found.outcome, expected.outcome);
    assert_eq!(found.milestones, expected.milestones);
    assert_eq!(
        content_digest(&found).unwrap(),
        content_digest(&expected).unwrap()
    );
    expected
}

/// The small silo with a friction law.
fn silo(friction: Option<Friction>, integrator: Integrator) -> Scene {
    let mut scene: Scene = toml::from_str(&silo_file()).unwrap();
    scene.friction = friction;
    scene.time.integrator = integrator;
    scene
}

#[test]
fn a_tank_with_every_effect_goes_on_with_the_same_bits() {
    for friction in frictions() {
        for integrator in Integrator::ALL {
            let mut scene = tank(friction.clone(), integrator);
            scene.output.ledger = integrator == Integrator::VelocityVerlet;
            assert_same_bits(scene, 37);
        }
    }
}

#[test]
fn a_silo_goes_on_with_the_same_bits_while_it_is_filled_and_drained() {
    let laws = [
        None,
        Some(Friction::Coulomb {
            coefficient: 0.3,
            regularisation: 1e-2,
        }),
        Some(Friction::CundallStrack {
            coefficient: 0.5,
            stiffness: 50.0,
            damping: 0.01,
        }),
    ];
    for friction in laws {
        for integrator in Integrator::ALL {
            // At every frame: between two grains, while they come to rest, at the door.
            let mut scene = silo(friction.clone(), integrator);
            scene.output.ledger = true;
            let record = assert_same_bits(scene, 1);
            let happened = |kind| record.milestones.iter().any(|it| it.kind == kind);
            assert!(happened(MilestoneKind::DoorOpened), "{friction:?}");
            assert_eq!(record.outcome, Outcome::Completed);
        }
    }
}

/// Walls are looked at every 10 ms: frames of 3 ms leave a grain on either side of a checkpoint.
#[test]
fn a_grain_that_passes_a_wall_is_seen_across_a_checkpoint() {
    let mut scene = silo(None, Integrator::VelocityVerlet);
    scene.time.frame_interval = 3e-3;
    scene.guards.overlap = 10.0;
    let Some(phase::scene::Contact::Linear { stiffness, .. }) = &mut scene.contact else {
        panic!("the silo's contact is linear");
    };
    *stiffness = 0.5;
    let record = assert_same_bits(scene, 1);
    let Outcome::Unstable(broken) = &record.outcome else {
        panic!("{:?}", record.outcome);
    };
    assert_eq!(broken.guard, phase::record::Guard::WallPassed);
}

#[test]
fn spheres_that_pass_through_each_other_go_on() {
    let mut scene = tank(None, Integrator::VelocityVerlet);
    (scene.contact, scene.updraught) = (None, None);
    scene.guards.vertical = Some(100.0);
    scene.guards.horizontal = Some(100.0);
    assert_same_bits(scene, 50);
}

#[test]
fn any_way_to_find_neighbours_goes_on() {
    let length = 0.01;
    for neighbours in [
        Neighbours::AllPairs,
        Neighbours::Cells { length },
        Neighbours::HashedCells { length },
    ] {
        let mut scene = tank(frictions()[3].clone(), Integrator::VelocityVerlet);
        scene.updraught = None;
        scene.neighbours = neighbours;
        assert_same_bits(scene, 50);
    }
}

/// What the springs of contacts remember is a part of the state: without it a pile goes another way.
#[test]
fn a_pile_needs_its_histories() {
    let mut scene = tank(
        Some(Friction::Mindlin { coefficient: 0.3 }),
        Integrator::SymplecticEuler,
    );
    (scene.updraught, scene.swirl) = (None, None);
    let mut simulation = Simulation::new(&scene).unwrap();
    simulation.advance(3000).unwrap();
    let saved = simulation.state();

    // All that symplectic Euler goes on from but for the histories.
    let mut bare = scene.clone();
    bare.start = state(&simulation).start(simulation.radius());
    let mut forgetful = Simulation::new(&bare).unwrap();
    let mut restored = Simulation::new(&scene).unwrap();
    restored.restore(saved).unwrap();
    for _ in 0..5 {
        simulation.advance(40).unwrap();
        restored.advance(40).unwrap();
        forgetful.advance(40).unwrap();
        assert!(state(&restored).bits() == state(&simulation).bits());
        assert!(state(&forgetful).bits() != state(&simulation).bits());
    }
}

/// A state of another scene is refused, and the run stays as it was.
#[test]
fn a_state_that_does_not_fit_is_refused() {
    let [plain, mindlin] =
        [0, 3].map(|law| tank(frictions()[law].clone(), Integrator::SymplecticEuler));
    let fresh = || Simulation::new(&mindlin).unwrap();
    let mut other_walls = mindlin.clone();
    other_walls.tank.as_mut().unwrap().floor = None;
    for saved in [
        Simulation::new(&silo(None, Integrator::SymplecticEuler))
            .unwrap()
            .state(),
        Simulation::new(&other_walls).unwrap().state(),
        Simulation::new(&plain).unwrap().state(),
    ] {
        let mut simulation = fresh();
        assert!(simulation.restore(saved).is_err());
        simulation.advance(100).unwrap();
        let mut undisturbed = fresh();
        undisturbed.advance(100).unwrap();
        assert!(state(&simulation).bits() == state(&undisturbed).bits());
    }
}

/// A disk that is full for a while must not end a run of hours; who stops it then is told.
#[test]
fn a_checkpoint_that_cannot_be_written_does_not_end_the_run() {
    let place = Workplace::new();
    let mut scene = tank(None, Integrator::SymplecticEuler);
    scene.time.duration = 0.02;
    let checkpoints = Checkpoints::beside(&place.path("no-folder/run.h5"), Duration::ZERO);
    let run = || Run::new(&scene).unwrap();
    let mut warnings = Vec::new();
    let mut warn = |error: phase::store::StoreError| warnings.push(error.to_string());
    let Ending::Finished(record) =
        checkpoints.run(run(), &mut |_| ControlFlow::Continue(()), &mut warn)
    else {
        panic!("it did not end");
    };
    assert_eq!(
        content_digest(&record).unwrap(),
        content_digest(&whole(&scene)).unwrap()
    );
    assert_eq!(warnings.len(), 19);
    assert!(
        warnings[0].contains("no-folder/run.checkpoint"),
        "{warnings:?}"
    );

    let ending = checkpoints.run(run(), &mut |_| ControlFlow::Break(()), &mut |_| {});
    assert!(matches!(ending, Ending::Lost(_)), "{ending:?}");
}

/// A scene that takes some seconds with a checkpoint at every frame.
fn slow_scene() -> String {
    support::scene_file().replace("duration = 2.0", "duration = 40.0")
}

fn digest(path: &Path) -> String {
    content_digest(&read_record(path).unwrap()).unwrap()
}

/// A place where a run of `scene.toml` was interrupted: its record is to be `run.h5`.
fn interrupted_by(name: &str) -> Workplace {
    let place = Workplace::new();
    place.write("scene.toml", &slow_scene());
    let arguments = [
        "run",
        "scene.toml",
        "--out",
        "run.h5",
        "--checkpoint-interval",
        "0",
    ];
    let mut child = place.start(&arguments);
    wait_until(|| place.path("run.checkpoint").exists());
    if name == "KILL" {
        child.kill().unwrap();
        child.wait().unwrap();
    } else {
        signal(&child, name);
        end(child)
            .code(130)
            .complains("interrupted at frame ")
            .complains("the same command with --resume goes on from there (run.checkpoint)");
    }
    assert!(!place.path("run.h5").exists());
    place
}

fn resume(place: &Workplace, more: &[&str]) -> Answer {
    let arguments = ["run", "scene.toml", "--out", "run.h5", "--resume"];
    place.phase(&[&arguments[..], more].concat())
}

#[test]
fn an_interrupted_run_goes_on_from_its_checkpoint() {
    for name in ["INT", "TERM", "KILL"] {
        let place = interrupted_by(name);
        let answer = resume(&place, &["--json"])
            .code(0)
            .complains("going on at ")
            .complains("from run.checkpoint");
        let answer: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
        assert!(answer["resumed_from"].as_f64().unwrap() > 0.0);
        assert!(!place.path("run.checkpoint").exists());
        place
            .phase(&["run", "scene.toml", "--out", "whole.h5"])
            .code(0);
        assert_eq!(
            digest(&place.path("run.h5")),
            digest(&place.path("whole.h5"))
        );
    }
}

#[test]
fn without_a_checkpoint_a_run_starts_from_the_beginning() {
    let place = Workplace::new();
    place.write("scene.toml", &support::scene_file());
    resume(&place, &[])
        .code(0)
        .complains("there is no checkpoint run.checkpoint; starting from the beginning");
    assert!(place.path("run.h5").exists());
    assert!(!place.path("run.checkpoint").exists());
}

/// Who forgets `--resume` and stops the run at once has lost nothing.
#[test]
fn a_run_from_the_beginning_replaces_a_checkpoint_only_with_one_of_its_own_time() {
    let place = interrupted_by("INT");
    let before = fs::read(place.path("run.checkpoint")).unwrap();
    let mut child = place.start(&["run", "scene.toml", "--out", "run.h5"]);
    let stderr = child.stderr.take().unwrap();
    let mut lines = BufReader::new(stderr).lines().map(Result::unwrap);
    let line = lines.find(|line| line.contains("run.checkpoint")).unwrap();
    assert!(line.contains("run.checkpoint is there"), "{line}");
    assert!(line.contains("--resume would go on"), "{line}");
    signal(&child, "INT");
    end(child).code(130);
    assert_eq!(fs::read(place.path("run.checkpoint")).unwrap(), before);

    // To the end: the checkpoint is of no use any more.
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(0);
    assert!(!place.path("run.checkpoint").exists());
}

/// Changes bytes and puts a checksum below that fits.
fn forge(path: &Path, change: impl FnOnce(&mut Vec<u8>)) {
    let mut bytes = fs::read(path).unwrap();
    bytes.truncate(bytes.len() - blake3::OUT_LEN);
    change(&mut bytes);
    let hash = blake3::hash(&bytes);
    bytes.extend_from_slice(hash.as_bytes());
    fs::write(path, bytes).unwrap();
}

fn replace(bytes: &mut [u8], text: &str, by: &str) {
    assert_eq!(text.len(), by.len());
    let mut windows = bytes.windows(text.len());
    let at = windows
        .position(|window| window == text.as_bytes())
        .unwrap();
    bytes[at..at + by.len()].copy_from_slice(by.as_bytes());
}

/// What is to be said of a checkpoint, and what was done to it.
type Spoil<'a> = (&'a str, &'a dyn Fn(&Path));

#[test]
fn nothing_goes_on_from_a_checkpoint_that_is_not_right() {
    let place = interrupted_by("INT");
    let path = place.path("run.checkpoint");
    let good = fs::read(&path).unwrap();
    let commit = Program::current().commit;
    let other_commit: String = commit
        .chars()
        .rev()
        .map(|it| if it == 'x' { 'y' } else { 'x' })
        .collect();
    let version = phase::store::CHECKPOINT_SIGNATURE.len();
    let spoils: [Spoil<'_>; 8] = [
        ("damaged or cut short: its checksum differs", &|path| {
            damage(path)
        }),
        ("damaged or cut short: its checksum differs", &|path| {
            fs::write(path, &good[..good.len() - 1]).unwrap();
        }),
        ("damaged or cut short: it ends too early", &|path| {
            fs::write(path, &good[..10]).unwrap();
        }),
        ("damaged or cut short: it ends too early", &|path| {
            fs::write(path, "").unwrap()
        }),
        (
            "damaged or cut short: its content has another form",
            &|path| {
                forge(path, |bytes| bytes.truncate(bytes.len() - 10));
            },
        ),
        ("this checkpoint has format 2", &|path| {
            forge(path, |bytes| bytes[version] = 2)
        }),
        ("was written by phase", &|path| {
            forge(path, |bytes| replace(bytes, &commit, &other_commit));
        }),
        ("they differ in seed", &|path| {
            forge(path, |bytes| replace(bytes, "\"seed\":1,", "\"seed\":2,"));
        }),
    ];
    for (message, spoil) in spoils {
        fs::write(&path, &good).unwrap();
        spoil(&path);
        let spoilt = fs::read(&path).unwrap();
        resume(&place, &[])
            .code(2)
            .complains("run.checkpoint: ")
            .complains(message)
            .complains("without --resume the run starts from the beginning");
        assert_eq!(fs::read(&path).unwrap(), spoilt);
        assert!(!place.path("run.h5").exists());
    }

    fs::write(&path, &good).unwrap();
    for (option, key) in [("--trajectory", "output.trajectory"), ("--seed=7", "seed")] {
        resume(&place, &[option])
            .code(2)
            .complains(&format!("they differ in {key}"));
    }
    assert_eq!(fs::read(&path).unwrap(), good);

    fs::write(&path, "something of somebody").unwrap();
    resume(&place, &[])
        .code(2)
        .complains("this is not a checkpoint");
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(2)
        .complains("this is not a checkpoint");
    assert_eq!(place.read("run.checkpoint"), "something of somebody");
}

#[test]
fn a_job_that_is_run_again_goes_on_too() {
    let place = Workplace::new();
    let sweep = TinySweep {
        omegas: vec![4.0],
        seeds: vec![1],
        duration: 40.0,
        ..TinySweep::default()
    };
    place.write("tiny.toml", &sweep.text());
    place
        .phase(&["sweep", "tiny.toml", "--out", "results", "--no-plot"])
        .code(0);
    let again = [
        "run",
        "--from",
        "results",
        "--point",
        "omega=4",
        "--trajectory",
    ];
    let more = ["--checkpoint-interval", "0"];
    let child = place.start(&[&again[..], &more[..]].concat());
    wait_until(|| {
        place
            .path("results/runs/omega-4_seed-1.checkpoint")
            .exists()
    });
    signal(&child, "INT");
    end(child).code(130);
    place
        .phase(&[&again[..], &["--resume"]].concat())
        .code(0)
        .complains("going on at ")
        .says("same bits as in the sweep");
}

/// A run under way with a checkpoint at every frame, and its first one.
fn under_way(place: &Workplace, out: &str) -> Child {
    place.write("scene.toml", &slow_scene());
    let arguments = ["run", "scene.toml", "--checkpoint-interval", "0", "--out"];
    let child = place.start(&[&arguments[..], &[out]].concat());
    wait_until(|| place.path(out).with_extension("checkpoint").exists());
    child
}

/// Symptom: two runs of one record at once wrote each other's checkpoint, and the later one's record
/// replaced the other's. Cause: no lock.
#[test]
fn two_runs_do_not_share_a_record() {
    let place = Workplace::new();
    let mut first = under_way(&place, "run.h5");
    let second = ["run", "scene.toml", "--out", "run.h5"];
    place.phase(&second).code(2).complains(
        "run.h5: another `phase run` is making this record; wait until it ends, or choose",
    );
    place
        .phase(&["run", "scene.toml", "--out", "else.h5"])
        .code(0);
    first.kill().unwrap();
    first.wait().unwrap();
    // The system gives the right of a killed run back.
    place.phase(&second).code(0);
    let names = fs::read_dir(place.path(".")).unwrap();
    let mut names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    assert!(names.all(|name| !name.ends_with(".lock")));
}

/// Symptom: a run whose record could not be written had come to its end for nothing, or so it said.
#[test]
fn a_record_that_cannot_be_written_leaves_the_checkpoint() {
    let place = Workplace::new();
    let run = under_way(&place, "run.h5");
    fs::create_dir(place.path("run.h5")).unwrap();
    end(run)
        .code(1)
        .complains("cannot write run.h5")
        .complains("stays: the same command with --resume goes on from there (run.checkpoint)");
    fs::remove_dir(place.path("run.h5")).unwrap();
    resume(&place, &[]).code(0).complains("going on at ");
    let expected = whole(&phase::scene::load(&place.path("scene.toml")).unwrap());
    let found = digest(&place.path("run.h5"));
    assert_eq!(found, content_digest(&expected).unwrap());
}

/// Symptom: a record was lost whose folder somebody had removed meanwhile.
#[test]
fn a_folder_that_was_removed_is_made_again_for_the_record() {
    let place = Workplace::new();
    let run = under_way(&place, "out/run.h5");
    fs::rename(place.path("out"), place.path("away")).unwrap();
    end(run).code(0);
    assert!(place.path("out/run.h5").exists());
}

/// Checkpoints of the jobs in `results`.
fn checkpoints(place: &Workplace) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(place.path("results/records")) else {
        return Vec::new();
    };
    let paths = entries.map(|entry| entry.unwrap().path());
    paths
        .filter(|path| path.extension().is_some_and(|it| it == "checkpoint"))
        .collect()
}

/// A place where a sweep was killed after its first job, in the middle of the second.
fn killed_sweep() -> Workplace {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::slow().text());
    let arguments = [
        "sweep",
        "tiny.toml",
        "--out",
        "results",
        "-j",
        "1",
        "--checkpoint-interval",
        "0",
    ];
    let mut killed = place.start(&arguments);
    // A record is there an instant before the checkpoint of its job goes.
    let under_way = || {
        checkpoints(&place)
            .iter()
            .any(|it| !it.with_extension("h5").exists())
    };
    wait_until(|| !place.records("results").is_empty() && under_way());
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert_eq!(checkpoints(&place).len(), 1);
    place
}

#[test]
fn a_killed_sweep_goes_on_in_the_middle_of_a_job() {
    let place = killed_sweep();
    // How far that job is, is told meanwhile.
    let status = place.phase(&["status", "results", "--json"]).code(0);
    let status: serde_json::Value = serde_json::from_str(&status.stdout).unwrap();
    let under_way = &status["folders"][0]["under_way"];
    let (step, steps) = (
        under_way[0]["step"].as_u64(),
        under_way[0]["steps"].as_u64(),
    );
    let (step, steps) = (step.unwrap(), steps.unwrap());
    assert!(0 < step && step < steps, "{step} of {steps}");
    place
        .phase(&["status", "results"])
        .code(0)
        .says("under way  omega = ")
        .says(&format!("checkpoint at step {step} of {steps}, "));
    let answer = place
        .phase(&[
            "sweep",
            "tiny.toml",
            "--out",
            "results",
            "--no-plot",
            "--json",
        ])
        .code(0);
    let answer: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
    assert_eq!(answer["resumed"], 1);
    assert!(checkpoints(&place).is_empty());
    place
        .phase(&["sweep", "tiny.toml", "--out", "whole", "--no-plot"])
        .code(0);
    assert_eq!(place.digests("results"), place.digests("whole"));
    assert_eq!(
        place.read("results/labels.csv"),
        place.read("whole/labels.csv")
    );
}

#[test]
fn a_sweep_starts_a_job_anew_whose_checkpoint_is_damaged() {
    let place = killed_sweep();
    let path = &checkpoints(&place)[0];
    damage(path);
    place
        .phase(&["sweep", "tiny.toml", "--out", "results", "--no-plot"])
        .code(0)
        .complains("starts from the beginning: ")
        .complains("this checkpoint is damaged");
    assert!(checkpoints(&place).is_empty());
    assert_eq!(place.records("results").len(), TinySweep::slow().jobs());
}

/// A process that is killed right after it stored a record leaves the checkpoint of a job that is done,
/// which nobody would ever read.
#[test]
fn checkpoints_of_jobs_that_are_done_are_removed() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    let sweep = ["sweep", "tiny.toml", "--out", "results", "--no-plot"];
    place.phase(&sweep).code(0);
    let record = place
        .path("results/records")
        .join(&place.records("results")[0]);
    fs::write(record.with_extension("checkpoint"), "").unwrap();
    place.phase(&sweep).code(0);
    assert!(checkpoints(&place).is_empty());
}
