//! Studies of accuracy: ladders of settings, their costs and errors, and the sentence.

use crate::support::Workplace;
use serde_json::Value;

/// Eight soft spheres in a small tank: a run takes a few milliseconds.
const SCENE: &str = r#"
[scene.spheres]
count = 8
radius = 0.004
density = 1000.0

[scene.contact]
law = "hertz"
young_modulus = 1e5
poisson_ratio = 0.3
dissipation_time = 1e-3

[scene.tank]
radius = 0.02
floor = 0.0

[scene.start]
kind = "random"
z_min = 0.01
z_max = 0.06
speed = 0.05

[scene.gravity]
acceleration = 9.8

[scene.time]
dt = 2e-4
duration = 0.04
frame_interval = 4e-3
"#;

const MOTION: &str = r#"
study = "accuracy"
times = [0.02, 0.04]

[[ladder]]
key = "time.dt"
values = [4e-4, 2e-4, 1e-4, 5e-5]

[reference]
set = { "time.dt" = 6.25e-6 }
"#;

fn evaluation(place: &Workplace, file: &str) -> Value {
    let printed = place
        .phase(&["study", file, "--no-plot", "--json"])
        .code(0)
        .stdout;
    let answer: Value = serde_json::from_str(&printed).unwrap();
    answer["finding"].clone()
}

#[test]
fn the_cheapest_setting_of_a_motion_is_the_largest_step_within_the_tolerance() {
    let place = Workplace::new();
    let study = format!("{MOTION}\n[tolerance]\nerror = ERROR\n{SCENE}");
    place.write("study.toml", &study.replace("ERROR", "1e-2"));
    let found = evaluation(&place, "study.toml");
    let outcomes = found["outcomes"].as_array().unwrap();
    let error = |outcome: &Value| outcome["errors"]["motion"]["times"][1].as_f64().unwrap();
    // As it is, the reference, then the ladder: errors fall with the step.
    let ladder: Vec<f64> = outcomes[2..].iter().map(error).collect();
    assert!(ladder.windows(2).all(|two| two[1] < two[0]), "{ladder:?}");
    let within = |outcome: &&Value| error(outcome) <= 1e-2;
    let best = outcomes[2..].iter().find(within).unwrap();
    let work = |outcome: &Value| outcome["cost"]["force_evaluations"].as_f64().unwrap();
    assert!(work(&outcomes[2]) < work(&outcomes[3]));
    // Which of those is cheapest by time depends on the machine; one of them it is.
    let cheapest = found["finding"]["cheapest"].as_str().unwrap();
    let mut chosen = outcomes.iter().filter(|it| it["name"] == cheapest);
    assert!(within(&chosen.next().unwrap()), "{cheapest}");
    assert!(error(best) > 0.0);
    let order = found["orders"][0]["order"].as_f64().unwrap();
    assert!(
        (0.7..1.4).contains(&order),
        "symplectic Euler is of first order, not {order}"
    );

    // Nothing is good enough for a tolerance below all errors.
    place.write("study.toml", &study.replace("ERROR", "1e-12"));
    let found = evaluation(&place, "study.toml");
    let cheapest = found["finding"]["cheapest"].as_str();
    assert_eq!(cheapest, Some("reference"), "{found:#}");
}

/// Symptom: the file of a study whose table `[scene]` has a word for its accuracy was refused: no
/// integrator. Cause: the scene was read without the keys that follow from that word.
#[test]
fn a_scene_in_the_file_may_have_a_word_for_its_accuracy() {
    let place = Workplace::new();
    let scene = SCENE.replace("dt = 2e-4\n", "");
    let study = MOTION
        .replace("key = \"time.dt\"", "key = \"guards.overlap\"")
        .replace("[4e-4, 2e-4, 1e-4, 5e-5]", "[2.0, 4.0]")
        .replace("\"time.dt\" = 6.25e-6", "accuracy = \"reference\"");
    let guards = "[scene.guards]\noverlap = 5.0\n";
    place.write(
        "study.toml",
        &format!("{study}[scene]\naccuracy = \"draft\"\n{scene}{guards}"),
    );
    place
        .phase(&["check", "study.toml", "--no-trial"])
        .code(0)
        .says("accuracy");
}

/// Symptom: "order 0.10" of a key without influence. Cause: an end of the range of orders passed for
/// an order.
#[test]
fn a_key_without_influence_has_no_order() {
    let place = Workplace::new();
    let ladder = "key = \"guards.overlap\"\nvalues = [2.0, 4.0, 8.0]";
    let study = MOTION.replace(
        "key = \"time.dt\"\nvalues = [4e-4, 2e-4, 1e-4, 5e-5]",
        ladder,
    );
    assert_ne!(study, MOTION);
    place.write(
        "study.toml",
        &format!("{study}{SCENE}[scene.guards]\noverlap = 5.0\n"),
    );
    let order = &evaluation(&place, "study.toml")["orders"][0];
    assert_eq!(order["key"], "guards.overlap");
    assert_eq!(
        (&order["order"], &order["bound"]),
        (&Value::Null, &Value::from(0.1))
    );
    place
        .phase(&["study", "study.toml"])
        .code(0)
        .says("in guards.overlap: none, no measurable influence");
    let figure = place.read("results/accuracy/study/work-precision.svg");
    let texts = crate::support::texts(&figure);
    assert!(
        texts
            .iter()
            .any(|it| it.ends_with("(no measurable influence)")),
        "{texts:?}"
    );
    assert!(!figure.contains("(order"), "{texts:?}");
}

#[test]
fn runs_that_are_there_are_not_made_again() {
    let place = Workplace::new();
    place.write("study.toml", &format!("{MOTION}{SCENE}"));
    let first = place
        .phase(&["study", "study.toml", "--json"])
        .code(0)
        .stdout;
    let again = place
        .phase(&["study", "study.toml", "--json"])
        .code(0)
        .stdout;
    let [first, again]: [Value; 2] = [first, again].map(|it| serde_json::from_str(&it).unwrap());
    // The step of the scene is on the ladder: one run serves both.
    assert_eq!((&first["runs"], &first["run_now"]), (&5.into(), &5.into()));
    assert_eq!(
        (&again["done_before"], &again["run_now"]),
        (&5.into(), &0.into())
    );
    let errors = |it: &Value| it["finding"]["outcomes"][2]["errors"].clone();
    assert_eq!(errors(&first), errors(&again));
    // Of runs without a row and a record others are made, to the same errors.
    std::fs::remove_dir_all(place.path("results/accuracy/study/records")).unwrap();
    let table = place.read("results/accuracy/study/runs.csv");
    let kept: Vec<&str> = table.lines().take(3).collect();
    place.write("results/accuracy/study/runs.csv", &(kept.join("\n") + "\n"));
    let rest = place
        .phase(&["study", "study.toml", "--json"])
        .code(0)
        .stdout;
    let rest: Value = serde_json::from_str(&rest).unwrap();
    assert_eq!(
        (&rest["done_before"], &rest["run_now"]),
        (&2.into(), &3.into())
    );
    assert_eq!(errors(&first), errors(&rest));
    // A table with other columns was written over, and its rows were lost.
    let foreign = "setting,comfort\nsoft,3\n";
    place.write("results/accuracy/study/runs.csv", foreign);
    let refused = place.phase(&["study", "study.toml"]).code(2).stderr;
    assert!(
        refused.contains("its columns are not those of this study"),
        "{refused}"
    );
    assert_eq!(place.read("results/accuracy/study/runs.csv"), foreign);
    let anew = ["study", "study.toml", "--force"];
    place.phase(&anew).code(0);
    for file in [
        "runs.csv",
        "accuracy.csv",
        "accuracy.json",
        "work-precision.svg",
    ] {
        assert!(
            place
                .path(&format!("results/accuracy/study/{file}"))
                .is_file(),
            "{file}"
        );
    }
}

#[test]
fn a_case_has_known_numbers() {
    let place = Workplace::new();
    place.write(
        "case.toml",
        r#"
        study = "accuracy"
        case = "soft damped pair, c = 1"
        combine = "all"
        ladder = [
            { key = "setup.steps_per_contact", values = [10, 100, 1000] },
            { key = "integrator", values = ["symplectic-euler", "synchronised-verlet"] },
        ]
        tolerance = { error = 1e-2 }
        "#,
    );
    let found = evaluation(&place, "case.toml");
    let orders = found["orders"].as_array().unwrap();
    assert_eq!(orders.len(), 2, "{orders:?}");
    let sentence = found["finding"]["sentence"].as_str().unwrap();
    assert!(
        sentence.starts_with("The cheapest setting with errors of at most 0.010"),
        "{sentence}"
    );
}

#[test]
fn bad_studies_are_refused_with_line_and_fix() {
    let place = Workplace::new();
    for (text, message) in [
        ("study = \"accuracy\"\n", "the study varies nothing"),
        (
            "study = \"accuracy\"\n[[variant]]\nname = \"a\"\nset = { seed = 2 }\n",
            "neither `scene` nor `case`",
        ),
        (
            "study = \"accuracy\"\ncase = \"cradle of thee\"\n[[ladder]]\nkey = \"integrator\"\n\
             values = [\"velocity-verlet\"]\n",
            "did you mean \"cradle of three\"",
        ),
        (
            &format!(
                "study = \"accuracy\"\ntimes = [0.04]\n[[ladder]]\nkey = \"time.dtt\"\n\
                 values = [1.0]\n[reference]\n{SCENE}"
            ),
            "with dtt = 1",
        ),
        (
            &format!(
                "study = \"accuracy\"\ntimes = [0.041]\n[[ladder]]\nkey = \"time.dt\"\n\
                 values = [1e-4]\n{SCENE}"
            ),
            "whole multiples of `time.frame_interval`",
        ),
        (
            &format!(
                "study = \"accuracy\"\n[[ladder]]\nkey = \"time.dt\"\nvalues = [1e-4]\n{SCENE}"
            ),
            "told from noise by seeds",
        ),
    ] {
        place.write("bad.toml", text);
        for command in ["study", "check"] {
            let refused = place.phase(&[command, "bad.toml"]).code(2);
            refused.complains(message).complains("bad.toml");
        }
    }
}

/// "Spin" friction is an impulse mu per step.
#[test]
fn the_impulse_of_spin_friction_is_held_and_said() {
    let place = Workplace::new();
    let scene = SCENE.replace(
        "[scene.tank]",
        "[scene.friction]\nlaw = \"spin\"\ncoefficient = 0.02\n\n[scene.tank]",
    );
    let study = format!("{MOTION}{scene}");
    place.write("spin.toml", &study);
    let check = place.phase(&["check", "spin.toml", "--no-trial"]).code(0);
    check.says("mu/dt of \"spin\" friction is held: friction.coefficient = 0.04");
    // Symptom: friction that [base] gave was not held. Cause: the scene was looked at without it.
    let base = "[base]\nset = { friction = { law = \"spin\", coefficient = 0.02 } }\n";
    place.write("base.toml", &format!("{MOTION}{base}{SCENE}"));
    let check = place.phase(&["check", "base.toml", "--no-trial"]).code(0);
    check.says("mu/dt of \"spin\" friction is held: friction.coefficient = 0.04");
    place.write(
        "auto.toml",
        &study.replace("\ndt = 2e-4\n", "\ndt = \"auto\"\n"),
    );
    let refused = place.phase(&["check", "auto.toml", "--no-trial"]).code(2);
    refused.complains("another step is another friction");
}

/// No search changes the motion, so that runs of all of them have one identity.
#[test]
fn steps_of_each_search_are_timed_by_themselves() {
    let place = Workplace::new();
    let study = r#"
study = "accuracy"
step_time = ["count", "length"]
base.set = { neighbours = { search = "cells", length = 0.02 } }
seeds.count = 3

[[axis]]
key = "spheres.count"
values = [4, 8]

[[variant]]
name = "all pairs"
set = { neighbours = { search = "all-pairs" } }

[[ladder]]
key = "neighbours.length"
values = [0.01, 0.04]
"#;
    place.write("times.toml", &format!("{study}{SCENE}"));
    let checked = place.phase(&["check", "times.toml", "--json"]).code(0);
    place
        .phase(&["study", "times.toml"])
        .code(0)
        .says("24 runs: 24 made now");
    // The forecast took runs of one identity for one run.
    let checked: Value = serde_json::from_str(&checked.stdout).unwrap();
    let runs = place.read("results/accuracy/times/runs.csv");
    let mut runs = csv::Reader::from_reader(runs.as_bytes());
    let mut columns = runs.headers().unwrap().iter();
    let column = columns.position(|name| name == "sphere_steps").unwrap();
    let made: u64 = runs
        .records()
        .map(|row| row.unwrap()[column].parse::<u64>().unwrap())
        .sum();
    assert_eq!(checked["forecast"]["sphere_steps"], made);
    for (x, line) in [("count", "all pairs"), ("length", "count = 4")] {
        let figure = place.read(&format!("results/accuracy/times/step-time-{x}.svg"));
        let texts = crate::support::texts(&figure);
        assert!(texts.iter().any(|text| text.contains(line)), "{texts:?}");
    }
    place
        .phase(&["study", "times.toml", "--no-plot"])
        .code(0)
        .says("24 runs: 0 made now");
}
