//! Ablations: each effect taken away, and whether the scene needs it.

use crate::support::{Workplace, end};
use serde_json::Value;

/// Eight spheres fall on a floor. The damping of their impacts decides how fast they are at the end;
/// a damping of spins that is next to nothing decides nothing.
const SCENE: &str = r#"
[spheres]
count = 8
radius = 0.004
density = 1000.0

[contact]
law = "hertz"
young_modulus = 1e5
poisson_ratio = 0.3
dissipation_time = 2e-3

[friction]
law = "mindlin"
coefficient = 0.2

[spin_damping]
coefficient = 1e-18

[tank]
radius = 0.02
floor = 0.0

[start]
kind = "random"
z_min = 0.01
z_max = 0.06

[gravity]
acceleration = 9.8

[time]
dt = 2e-4
duration = 0.4
frame_interval = 4e-2
"#;

#[test]
fn what_decides_is_found_and_what_does_not_is_called_not_needed() {
    let place = Workplace::new();
    place.write("scene.toml", SCENE);
    let arguments = [
        "study",
        "scene.toml",
        "--ablate",
        "--seeds",
        "60",
        "--tolerance",
        "0.1",
        "--no-pairs",
        "--json",
    ];
    let answer: Value = serde_json::from_str(&place.phase(&arguments).code(0).stdout).unwrap();
    let found = &answer["finding"];
    let verdict = |name: &str| {
        let all = found["ablated"].as_array().unwrap().iter();
        let mut own = all.filter(|it| it["name"] == name);
        own.next().unwrap_or_else(|| panic!("{name}: {answer:#}"))["verdict"].clone()
    };
    assert_eq!(verdict("restitution to elastic"), "needed");
    // The sieves of a tank need gravity.
    let skipped = found["skipped"].as_array().unwrap();
    assert!(
        skipped.iter().any(|it| it["name"] == "gravity off"),
        "{skipped:?}"
    );
    assert_eq!(verdict("spin damping off"), "not-needed");
    let sentence = found["finding"]["sentence"].as_str().unwrap();
    assert!(
        sentence.starts_with("This scene can do with: spin damping off"),
        "{sentence}"
    );
    for file in ["runs.csv", "ablation.csv", "ablation.json", "ablation.svg"] {
        let path = place.path(&format!("results/ablation/scene/{file}"));
        assert!(path.is_file(), "{}", path.display());
    }
    // All of it again costs nothing.
    let again: Value = serde_json::from_str(&place.phase(&arguments).code(0).stdout).unwrap();
    assert_eq!(again["run_now"], 0);
    assert_eq!(again["finding"]["ablated"], found["ablated"]);
}

/// Symptom: runs of pairs were made again by every command. Cause: the table was written for single
/// effects first, which dropped them.
#[test]
fn runs_of_pairs_and_of_other_seeds_are_kept() {
    let place = Workplace::new();
    // Fewer frames than a sieve needs: only order parameters decide.
    place.write("scene.toml", SCENE);
    let run = |seeds: &str| -> Value {
        let arguments = [
            "study",
            "scene.toml",
            "--ablate",
            "--seeds",
            seeds,
            "--no-plot",
            "--json",
        ];
        serde_json::from_str(&place.phase(&arguments).code(0).stdout).unwrap()
    };
    let first = run("6");
    assert!(first["runs"].as_u64().unwrap() > 0);
    // Symptom: "0 made now". Cause: only the runs of pairs were counted.
    assert_eq!(
        (&first["run_now"], &first["done_before"]),
        (&first["runs"], &0.into())
    );
    assert_eq!(run("6")["run_now"], 0);
    run("3");
    assert_eq!(run("6")["run_now"], 0);
}

/// Which pairs there are follows from the first runs, for each process alike.
#[test]
fn processes_share_an_ablation_with_pairs() {
    let place = Workplace::new();
    // Turning air makes friction matter, too.
    let air = "[drag]\nlaw = \"cross-section\"\nlinear = 30.0\n[swirl]\nomega = 20.0\n[tank]";
    place.write("scene.toml", &SCENE.replace("[tank]", air));
    let command = [
        "study",
        "scene.toml",
        "--ablate",
        "--seeds",
        "8",
        "--no-plot",
        "--json",
        "-j",
        "1",
    ];
    let children: Vec<_> = (0..2).map(|_| place.start(&command)).collect();
    let answers = children.into_iter().map(|child| {
        let answer = end(child);
        assert_eq!(answer.code, Some(0), "{}{}", answer.stdout, answer.stderr);
        serde_json::from_str(&answer.stdout).unwrap()
    });
    let answers: Vec<Value> = answers.collect();
    let [one, other] = &answers[..] else {
        panic!("{answers:?}")
    };
    assert_eq!(one["finding"], other["finding"]);
    let made = |answer: &Value| answer["run_now"].as_u64().unwrap();
    assert_eq!(made(one) + made(other), one["runs"].as_u64().unwrap());
    let names = one["finding"]["ablated"].as_array().unwrap().iter();
    let mut names = names.map(|it| it["name"].as_str().unwrap());
    assert!(names.any(|name| name.contains(" and ")), "{one:#}");
}

/// Symptom: pairs were never listed, and a line whose task ended the single effects was refused.
#[test]
fn pairs_are_handed_out_once_single_effects_are_there() {
    let place = Workplace::new();
    let air = "[drag]\nlaw = \"cross-section\"\nlinear = 30.0\n[swirl]\nomega = 20.0\n[tank]";
    place.write("scene.toml", &SCENE.replace("[tank]", air));
    let study = "study = \"ablation\"\nscene = \"scene.toml\"\nseeds.count = 8\n";
    place.write("study.toml", study);
    let mut answers = Vec::new();
    loop {
        let list = ["jobs", "study.toml", "--missing", "--chunk", "1h"];
        let lines = place.phase(&list).code(0).stdout;
        let Some(line) = lines.lines().next() else {
            break;
        };
        let answer = place.phase(&["study", "study.toml", "--no-plot", "--job", line]);
        answers.push(answer.code(0).stdout.clone());
    }
    assert_eq!(answers.len(), 2, "{answers:?}");
    assert!(answers[0].contains("pairs of effects follow"));
    let found = place.read("results/ablation/study/ablation.json");
    assert!(found.contains(" and "));
    place
        .phase(&["study", "study.toml", "--no-plot"])
        .code(0)
        .says(": 0 made now");
}

#[test]
fn a_scene_without_effects_and_a_single_seed_are_refused() {
    let place = Workplace::new();
    let bare = SCENE.split("[contact]").next().unwrap().to_owned()
        + "[start]\nkind = \"random\"\nz_min = 0.01\nz_max = 0.06\n\n[tank]\nradius = 0.02\n\n\
           [time]\ndt = 1e-3\nduration = 0.01\nframe_interval = 1e-3\n";
    place.write("bare.toml", &bare);
    place
        .phase(&["study", "bare.toml", "--ablate"])
        .code(2)
        .complains("the scene as it is cannot be compared");
    place.write("scene.toml", SCENE);
    place
        .phase(&["study", "scene.toml", "--ablate", "--seeds", "1"])
        .code(2)
        .complains("from 3");
    place
        .phase(&["study", "nowhere.toml", "--ablate"])
        .code(2)
        .complains("nowhere.toml");
}

/// Regularised friction at stiff contacts has a time step of its own, hundreds of times smaller: an
/// ablation of glass in water was to take 15 hours, nearly all of them for a law called simpler.
#[test]
fn what_takes_far_more_work_is_no_simplification() {
    let place = Workplace::new();
    let stiff = SCENE
        .replace("young_modulus = 1e5", "young_modulus = 1e8")
        .replace("dissipation_time = 2e-3", "dissipation_time = 1e-6")
        .replace("dt = 2e-4", "dt = \"auto\"")
        .replace("duration = 0.4", "duration = 0.04");
    place.write("scene.toml", &stiff);
    let arguments = ["study", "scene.toml", "--ablate", "--no-pairs", "--json"];
    let answer: Value = serde_json::from_str(&place.phase(&arguments).code(0).stdout).unwrap();
    let skipped = answer["finding"]["skipped"].as_array().unwrap();
    let coulomb = skipped
        .iter()
        .find(|it| it["name"] == "mindlin friction to coulomb")
        .unwrap_or_else(|| panic!("{skipped:?}"));
    let reason = coulomb["reason"].as_str().unwrap();
    assert!(
        reason.contains("times the work of the scene as it is"),
        "{reason}"
    );
}

#[test]
fn a_file_or_an_option_asks_for_an_ablation() {
    let place = Workplace::new();
    place.write("scene.toml", SCENE);
    place
        .phase(&["study", "scene.toml"])
        .code(2)
        .complains("this is a scene, not a study")
        .complains("with --ablate it is a study of the effects that it needs");
    let unknown = ["study", "scene.toml", "--ablate=spin,air"];
    place
        .phase(&unknown)
        .code(2)
        .complains("--ablate=air: no simplification has that word in its name")
        .complains("spin damping off");

    // Symptom: all effects were taken away.
    place
        .phase(&["study", "scene.toml", "--ablate="])
        .code(2)
        .complains("leave out `=` for all of them");
    // Symptom: the runs of the scene as it is were made, and then there was nothing to draw.
    place
        .phase(&["study", "scene.toml", "--ablate=gravity"])
        .code(2)
        .complains("scene.toml: nothing of the scene can be switched off; gravity off: ");
    assert!(!place.path("results").exists());

    let sweep = "study = \"ablation\"\nscene = \"scene.toml\"\nseeds.count = 3\n";
    place.write("sweep.toml", sweep);
    let whole = ["study", "sweep.toml", "--no-plot", "--no-pairs", "--json"];
    let of_file: Value = serde_json::from_str(&place.phase(&whole).code(0).stdout).unwrap();
    // Symptom: of an ablation only its sweep was checked.
    for check in [
        &["check", "sweep.toml", "--no-trial", "--json"][..],
        &[
            "check",
            "scene.toml",
            "--ablate",
            "--seeds",
            "3",
            "--no-trial",
            "--json",
        ],
    ] {
        let checked: Value = serde_json::from_str(&place.phase(check).code(0).stdout).unwrap();
        let seeds = checked["seeds"].as_array().unwrap().len() as u64;
        assert_eq!(
            (&checked["kind"], &checked["study"]),
            (&"study".into(), &"ablation".into())
        );
        let settings = checked["settings"].as_array().unwrap();
        let ablated = of_file["finding"]["ablated"].as_array().unwrap();
        let names = ablated.iter().map(|it| &it["name"]);
        assert!(settings[1..].iter().map(|it| &it["name"]).eq(names));
        assert_eq!(checked["skipped"][0], "gravity off");
        // Without --seeds at least five.
        assert_eq!(
            checked["jobs"].as_u64().unwrap() * 5,
            of_file["runs"].as_u64().unwrap() * seeds
        );
    }
    let one = [
        "study",
        "sweep.toml",
        "--ablate=spin damping",
        "--no-plot",
        "--json",
    ];
    let of_option: Value = serde_json::from_str(&place.phase(&one).code(0).stdout).unwrap();
    let ablated = of_option["finding"]["ablated"].as_array().unwrap();
    assert_eq!(
        (ablated.len(), &ablated[0]["name"]),
        (1, &"spin damping off".into())
    );
    // The runs of all effects include its runs.
    assert_eq!(of_option["run_now"], 0);
    assert!(of_file["runs"].as_u64() > of_option["runs"].as_u64());

    place.write(
        "study.toml",
        "study = \"stability\"\nscene = \"scene.toml\"\n",
    );
    place
        .phase(&["study", "study.toml", "--ablate"])
        .code(2)
        .complains("this is a study of its own, which has no ablation");
}
