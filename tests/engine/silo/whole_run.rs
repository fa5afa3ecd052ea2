//! Fill, rest, door, drain.

use super::{hopper, shipped};
use crate::support::Workplace;
use phase::dem::Simulation;
use phase::record::{Guard, MilestoneKind, Outcome, RunRecord};
use phase::run;
use phase::scene::{DemScene, Door, Scene};
use std::ops::ControlFlow;

fn record(scene: &Scene) -> RunRecord {
    run::run(scene, &mut |_| ControlFlow::Continue(())).unwrap()
}

fn time_of(record: &RunRecord, kind: MilestoneKind) -> f64 {
    let mut milestones = record.milestones.iter();
    let found = milestones.find(|milestone| milestone.kind == kind);
    found
        .unwrap_or_else(|| panic!("never {}", kind.name()))
        .time
}

/// When so many spheres had left (s).
fn time_left(record: &RunRecord, count: f32) -> f64 {
    let observations = &record.observations;
    let frame = observations
        .discharged
        .iter()
        .position(|left| *left >= count);
    observations.time[frame.unwrap()]
}

/// A number of the whole run: what is measured, the value to meet, and by how much the mean over
/// the seeds may miss it.
struct Expected {
    quantity: &'static str,
    value: f64,
    tolerance: f64,
    measure: fn(&RunRecord) -> f64,
}

/// One run of Remmers' silo by another program; its rate is said to lie in 28.5 to 30.5 over time
/// steps and release positions. Grains move chaotically, so one run is one draw. Over the seeds 1
/// to 8 ours spread by 1.0 s, 0.04 m, 0.9 s and 0.6 grains/s (one standard deviation). Tolerances
/// are 2.5 of these (for the rate 1.7): one run and the mean of four that differ by nothing but
/// chance are farther apart in 3 % (13 %) of all cases; one run and one run, at 1.26 times as much,
/// too. The seeds are fixed: the test gives the same answer every time.
const WHOLE_RUN: [Expected; 4] = [
    Expected {
        quantity: "time at rest (s)",
        value: 51.6,
        tolerance: 2.5,
        measure: |record| time_of(record, MilestoneKind::AtRest),
    },
    Expected {
        quantity: "top of the heap (m)",
        value: 2.906,
        tolerance: 0.1,
        measure: |record| {
            let rest = time_of(record, MilestoneKind::DoorOpened);
            let observations = &record.observations;
            let frame = observations
                .time
                .iter()
                .position(|time| *time >= rest - 1e-9);
            f64::from(observations.height_max[frame.unwrap()])
        },
    },
    Expected {
        quantity: "time from the door's opening to the last grain (s)",
        value: 35.8,
        tolerance: 2.2,
        measure: |record| {
            time_of(record, MilestoneKind::Emptied) - time_of(record, MilestoneKind::DoorOpened)
        },
    },
    Expected {
        quantity: "grains per second from 20 to 80 %",
        value: 29.5,
        tolerance: 1.0,
        measure: |record| 600.0 / (time_left(record, 800.0) - time_left(record, 200.0)),
    },
];

/// Asserts that runs of the shipped silo with these seeds, or as it is shipped, empty it and meet
/// the numbers, within so many times the tolerance of four.
#[track_caller]
fn assert_silo(seeds: &[Option<u64>], tolerances: f64) {
    let scene = shipped("silo.toml");
    let records: Vec<RunRecord> = std::thread::scope(|scope| {
        let start = |seed: &Option<u64>| {
            let mut scene = scene.clone();
            // Far below anything one could see, and enough for another course of everything.
            if let (Some(seed), phase::scene::Start::Feed { spread, .. }) = (seed, &mut scene.start)
            {
                scene.seed = *seed;
                *spread = 1e-6;
            }
            scope.spawn(move || record(&scene))
        };
        let threads: Vec<_> = seeds.iter().map(start).collect();
        let ended = threads.into_iter().map(|thread| thread.join().unwrap());
        ended.collect()
    });
    for record in &records {
        assert_eq!(record.outcome, Outcome::Completed, "no grain passes a wall");
        assert_eq!(record.observations.discharged.last(), Some(&1000.0));
    }
    for Expected {
        quantity,
        value,
        tolerance,
        measure,
    } in WHOLE_RUN
    {
        let mean = records.iter().map(measure).sum::<f64>() / records.len() as f64;
        assert!(
            (mean - value).abs() < tolerances * tolerance,
            "{quantity}: {mean}, not {value}"
        );
    }
}

#[test]
fn the_shipped_silo_meets_its_numbers() {
    assert_silo(&[None], 1.26);
}

#[test]
#[ignore = "takes twenty seconds"]
fn four_runs_of_the_shipped_silo_meet_its_numbers() {
    assert_silo(&[None, Some(1), Some(2), Some(3)], 1.0);
}

#[test]
fn the_silo_as_printed_reports_the_first_grain_through_the_wall() {
    let record = record(&shipped("silo-as-printed.toml"));
    let Outcome::Unstable(instability) = &record.outcome else {
        panic!("{:?}", record.outcome);
    };
    assert_eq!(instability.guard, Guard::WallPassed);
    assert!(instability.time < 2.0, "{instability}");
    // Through the door, which is the first thing below the middle obstacle.
    let detail = &instability.detail;
    assert!(
        detail.contains("between the fixed ones at (-0.1000, 0.1000) m and (-0.0500, 0.1000) m"),
        "{instability}"
    );
}

/// Symptom: a panic, a division by zero. Cause: a feed of no spheres has no interval either.
#[test]
fn grains_may_be_there_from_the_start() {
    let feed = r#"kind = "feed", position = [0.0, 0.0, 1.4], velocity = [0.0, 0.0, -2.0], interval = 0.05, spread = 0.1"#;
    let list = r#"kind = "list", spheres = [
        { position = [0.0, 0.0, 0.5], radius = 0.04 }, { position = [0.1, 0.0, 0.6], radius = 0.04 }]"#;
    let scene = hopper(&[("count = 60", "count = 2"), (feed, list)]);
    let record = record(&scene);
    let kinds: Vec<_> = record.milestones.iter().map(|it| it.kind).collect();
    use MilestoneKind::{AtRest, DoorOpened, Emptied};
    assert_eq!(kinds, [AtRest, DoorOpened, Emptied]);
    let observations = &record.observations;
    assert!(
        observations
            .released
            .iter()
            .all(|released| *released == 2.0)
    );
    assert_eq!(observations.discharged.last(), Some(&2.0));
    assert!(record.work > 0);
}

#[test]
fn what_a_silo_does_not_do_is_said() {
    let place = Workplace::new();
    let run = |changes: &[(&str, &str)]| {
        let mut text = super::HOPPER.to_owned();
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        place.write("silo.toml", &text);
        place.phase(&["run", "silo.toml"]).code(0).stdout
    };
    assert!(!run(&[]).contains("NEVER"));
    // Far more grains than there is room for.
    let full = run(&[
        ("count = 60", "count = 400"),
        ("duration = 30.0", "duration = 25.0"),
    ]);
    assert!(
        full.contains("NOT FILLED: ") && full.contains("THE DOOR NEVER OPENED"),
        "{full}"
    );
    // All of them fall beside the silo.
    let beside = run(&[("position = [0.0, 0.0, 1.4]", "position = [0.7, 0.0, 1.4]")]);
    assert!(beside.contains("SPILLED: 60 spheres"), "{beside}");
    assert!(!beside.contains("emptied "), "{beside}");
    let restless = run(&[("kinetic_energy = 1e-4", "kinetic_energy = 1e-30")]);
    assert!(restless.contains("NEVER AT REST"), "{restless}");
}

#[test]
fn a_grain_that_bounces_off_a_corner_has_not_passed_it() {
    // Into the foot of the shipped silo's wall, with a wall that holds it.
    let mut scene = shipped("silo.toml");
    scene.spheres.count = 1;
    scene.start = phase::scene::Start::list(vec![phase::scene::StartSphere {
        velocity: [-1.45, 0.0, -0.6],
        ..phase::scene::StartSphere::at([-1.1, 0.0, 1.12])
    }]);
    let record = record(&scene);
    assert_eq!(record.outcome, Outcome::Completed);
}

#[test]
fn check_warns_of_walls_that_do_not_hold() {
    let scenes = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/scenes/");
    let check = |name: &str| {
        let file = format!("{scenes}{name}");
        Workplace::new()
            .phase(&["check", &file, "--no-trial"])
            .code(0)
    };
    let answer = check("silo-as-printed.toml");
    assert!(
        answer
            .stdout
            .contains("WARNING: faster ones squeeze through"),
        "{}",
        answer.stdout
    );
    let answer = check("silo.toml");
    assert!(answer.stdout.contains("walls") && !answer.stdout.contains("WARNING"));
}

#[test]
fn a_run_counts_every_grain_in_and_out() {
    let record = record(&hopper(&[]));
    let kinds: Vec<_> = record.milestones.iter().map(|it| it.kind).collect();
    use MilestoneKind::{AtRest, DoorOpened, Emptied, Filled};
    assert_eq!(kinds, [Filled, AtRest, DoorOpened, Emptied]);
    assert!((time_of(&record, Filled) - 59.0 * 0.05).abs() < 1e-9);
    // At rest for half a second before the door opens.
    let wait = time_of(&record, DoorOpened) - time_of(&record, AtRest);
    assert!((wait - 0.5).abs() < 1e-9);
    let observations = &record.observations;
    let frames = observations.frames();
    for frame in 0..frames {
        let (time, released) = (observations.time[frame], observations.released[frame]);
        let due = ((time + 1e-9) / 0.05).floor() as f32 + 1.0;
        // The first comes in with the first step.
        assert!(
            frame == 0 || released == due.min(60.0),
            "{released} at {time} s"
        );
        let before = if frame == 0 {
            0.0
        } else {
            observations.discharged[frame - 1]
        };
        assert!(observations.discharged[frame] >= before);
        assert!(time >= time_of(&record, DoorOpened) || observations.discharged[frame] == 0.0);
    }
    assert_eq!(observations.discharged[frames - 1], 60.0);
    assert!(observations.time[frames - 1] < 30.0, "it ends by itself");
    // Counts of work are those of the grains that were in.
    let inside = observations
        .released
        .iter()
        .zip(&observations.discharged)
        .skip(1);
    let expected: f32 = inside
        .map(|(released, discharged)| released - discharged)
        .sum();
    // Frames do not say when within them a grain came or left.
    let ratio = record.work as f64 / (f64::from(expected) * 100.0);
    assert!((0.99..1.01).contains(&ratio), "{ratio}");
    // The rate is that of the last second, twenty frames.
    for (frame, rate) in observations.discharge_rate.iter().enumerate().skip(20) {
        let left = observations.discharged[frame] - observations.discharged[frame - 20];
        assert!((rate - left).abs() < 1e-3, "{rate} and {left}");
    }
}

#[test]
fn a_grain_at_the_top_of_its_bounce_is_not_at_rest() {
    // One grain that hardly loses energy bounces for many seconds and stands still at every top.
    let scene = hopper(&[
        ("count = 60", "count = 1"),
        (
            "[{ radius = 0.04, share = 1 }, { radius = 0.03, share = 1 }]",
            "0.04",
        ),
        (
            "damping = 0.05, drag = \"normal\"",
            "damping = 0.0005, drag = \"normal\"",
        ),
        ("opening = 0.3", "opening = 0.2"),
        ("kinetic_energy = 1e-4", "kinetic_energy = 1e-3"),
        ("velocity = [0.0, 0.0, -2.0]", "velocity = [0.0, 0.0, 0.0]"),
        ("spread = 0.1", "spread = 0.0"),
    ]);
    let record = record(&scene);
    let observations = &record.observations;
    let rest = time_of(&record, MilestoneKind::AtRest);
    let slow = observations.kinetic.iter().zip(&observations.time);
    let early = slow
        .filter(|(energy, time)| **energy < 1e-3 && **time > 0.2 && **time < rest - 1.0)
        .count();
    assert!(
        early > 0,
        "it was slow for an instant before it was at rest"
    );
    // After that it stays below.
    let after = observations.kinetic.iter().zip(&observations.time);
    let opened = time_of(&record, MilestoneKind::DoorOpened);
    for (energy, time) in after {
        assert!(
            *time < rest || *time > opened || *energy < 1e-3,
            "{energy} J at {time} s"
        );
    }
}

#[test]
fn a_grain_waits_until_its_place_is_free() {
    // Released without speed every 10 ms: a grain falls 0.5 mm in that time, and is 80 mm wide.
    let scene = hopper(&[
        ("velocity = [0.0, 0.0, -2.0]", "velocity = [0.0, 0.0, 0.0]"),
        (
            "interval = 0.05, spread = 0.1",
            "interval = 0.01, spread = 0.0",
        ),
    ]);
    let mut simulation = Simulation::new(&scene).unwrap();
    for _ in 0..100 {
        simulation.advance(100).unwrap();
        let particles = simulation.particles();
        let grains = particles.fixed..particles.len();
        for i in grains.clone() {
            for j in i + 1..grains.end {
                let apart = (particles.position[i] - particles.position[j]).norm();
                let overlap = particles.radius[i] + particles.radius[j] - apart;
                assert!(overlap < 0.02, "{overlap} m at {} s", simulation.time());
            }
        }
    }
    assert!(simulation.counts().unwrap().released > 5);
}

#[test]
fn the_door_opens_at_its_time() {
    let scene = hopper(&[("door = {}", "door = { opens = 2.5 }")]);
    let record = record(&scene);
    assert_eq!(time_of(&record, MilestoneKind::DoorOpened), 2.5);
    let closed = Scene {
        dem: DemScene {
            door: Some(Door { opens: Some(1e3) }),
            ..scene.dem
        },
        ..scene
    };
    let observations = &self::record(&closed).observations;
    assert_eq!(observations.discharged.last(), Some(&0.0));
}

#[test]
fn a_run_writes_its_record_its_table_and_says_what_happened() {
    let place = Workplace::new();
    place.write("silo.toml", super::HOPPER);
    let answer = place.phase(&["run", "silo.toml", "--json"]).code(0);
    let answer: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
    assert_eq!(answer["outcome"], "completed");
    let kinds: Vec<_> = answer["milestones"].as_array().unwrap().iter().collect();
    assert_eq!(kinds[3]["kind"], "emptied");
    let table = place.read("results/silo-observations.csv");
    let header = table.lines().next().unwrap();
    for column in [
        "time",
        "kinetic",
        "height_max",
        "released",
        "discharged",
        "discharge_rate",
    ] {
        assert!(
            header.split(',').any(|name| name == column),
            "{column} in {header}"
        );
    }
    // The same again, bit for bit.
    place
        .phase(&["run", "silo.toml", "--out", "again.h5"])
        .code(0);
    assert_eq!(place.read("again-observations.csv"), table);
    // A table that is something else is not replaced.
    place.write("notes-observations.csv", "my notes");
    place
        .phase(&["run", "silo.toml", "--out", "notes.h5"])
        .code(2)
        .complains("notes-observations.csv: this is not a table of observables");
}

#[test]
fn a_new_silo_fills_rests_and_drains() {
    let place = Workplace::new();
    place.phase(&["new", "silo", "mine"]).code(0);
    let answer = place.phase(&["run", "mine.toml"]).code(0);
    for event in ["filled", "at rest", "door opened", "emptied"] {
        assert!(
            answer.stdout.contains(event),
            "{event} in {}",
            answer.stdout
        );
    }
    let check = place
        .phase(&["check", "mine.toml", "--no-trial", "--verbose"])
        .code(0);
    assert!(!check.stdout.contains("WARNING"), "{}", check.stdout);
}

#[test]
fn friction_lets_grains_arch() {
    // With an opening of two grains; smooth ones run out.
    let narrow = ("opening = 0.3", "opening = 0.16");
    let rough = record(&hopper(&[
        narrow,
        ("coefficient = 0.2", "coefficient = 0.8"),
    ]));
    assert_eq!(rough.milestones.last().unwrap().kind, MilestoneKind::AtRest);
    let left = *rough.observations.discharged.last().unwrap();
    assert!(left < 60.0, "{left}");
    let smooth = record(&hopper(&[
        narrow,
        ("coefficient = 0.2", "coefficient = 0.0"),
    ]));
    assert_eq!(smooth.observations.discharged.last(), Some(&60.0));
}

#[test]
fn two_and_a_half_thousand_grains_and_more() {
    // Small grains by the thousand, fed in fast: nothing is limited to the document's 2500.
    let scene = hopper(&[
        ("velocity = [0.0, 0.0, -2.0]", "velocity = [0.0, 0.0, -4.0]"),
        ("count = 60", "count = 3000"),
        (
            "[{ radius = 0.04, share = 1 }, { radius = 0.03, share = 1 }]",
            "0.008",
        ),
        (
            "opening = 0.3, spacing = 0.05, radius = 0.03",
            "opening = 0.3, spacing = 0.02, radius = 0.015",
        ),
        (
            "interval = 0.05, spread = 0.1",
            "interval = 8e-4, spread = 0.3",
        ),
        ("dt = 5e-4, duration = 30.0", "dt = 2e-4, duration = 3.4"),
        (
            "stiffness = 100.0, damping = 0.05",
            "stiffness = 100.0, damping = 0.01",
        ),
        (
            "stiffness = 70.0, damping = 0.02",
            "stiffness = 70.0, damping = 0.004",
        ),
    ]);
    let record = record(&scene);
    assert_eq!(record.outcome, Outcome::Completed);
    assert_eq!(record.observations.released.last(), Some(&3000.0));
}

/// Symptom: a silo ended "at rest" while nine grains moved at .11 m/s and three a second still
/// left. Cause: the limit was compared with the energy of all grains together, in which a few that
/// flow are lost.
#[test]
fn rest_holds_for_every_sphere_and_for_spins() {
    let ends_at_rest = |last: &str| {
        let spheres: String = (0..9)
            .map(|k| format!("{{ position = [{}, 0.0, 0.01] }},", 0.03 * f64::from(k)))
            .collect();
        let text = format!(
            r#"
            spheres = {{ count = 10, radius = 0.01, density = 2400.0 }}
            contact = {{ law = "hertz", young_modulus = 1e6, poisson_ratio = 0.3, dissipation_time = 1e-3 }}
            friction = {{ law = "coulomb", coefficient = 0.0, regularisation = 1e-3 }}
            tank = {{ floor = 0.0 }}
            gravity = {{ acceleration = 9.8 }}
            rest = {{ kinetic_energy = 1e-4, hold = 0.3 }}
            start = {{ kind = "list", spheres = [{spheres} {{ position = [0.0, 0.1, 0.01], {last} }}] }}
            time = {{ dt = 1e-4, duration = 2.0, frame_interval = 1e-2 }}
            "#
        );
        let scene = Scene::from_toml(&text, std::path::Path::new("rest.toml"));
        let record = record(&scene.unwrap_or_else(|error| panic!("{error}")));
        record
            .milestones
            .iter()
            .any(|it| it.kind == MilestoneKind::AtRest)
    };
    assert!(ends_at_rest("velocity = [0.0, 0.0, 0.0]"));
    // Slides with 5e-5 J, less than all may have together.
    assert!(!ends_at_rest("velocity = [0.0, 0.1, 0.0]"));
    // Turns in its place with 2e-5 J.
    assert!(!ends_at_rest("spin = [0.0, 0.0, 10.0]"));
}

/// Symptom: `check` said that the walls hold up to 8.976 m/s, and the run ended by the overlap
/// guard. Cause: a disc that comes straight at a fixed one overlaps it too deep before it could
/// pass between two.
#[test]
fn check_warns_of_walls_that_break_the_overlap_guard() {
    let place = Workplace::new();
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/scenes");
    let text = std::fs::read_to_string(format!("{folder}/silo.toml")).unwrap();
    let check = |density: &str| {
        let changed = text
            .replace("density = 1.0 ", &format!("density = {density} "))
            .replace("silo1.dat", &format!("{folder}/silo1.dat"));
        place.write("silo.toml", &changed);
        place
            .phase(&["check", "--no-trial", "silo.toml"])
            .code(0)
            .stdout
    };
    assert!(!check("1.0").contains("WARNING: faster ones"));
    for density in ["2.8", "3.0", "3.14159265"] {
        let text = check(density);
        assert!(
            text.contains("may break the overlap guard"),
            "{density}: {text}"
        );
    }
}
