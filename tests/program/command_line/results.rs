//! What is done with the results of a sweep: `classify`, `plot`.

use super::bench::swept;
use crate::support::{TinySweep, Workplace};

#[test]
fn other_thresholds_change_labels_without_any_run() {
    let (place, answer) = swept(&TinySweep::default());
    answer.code(0);
    let records = place.digests("results/tiny");
    let labels = place.read("results/tiny/labels.csv");
    assert!(
        labels
            .lines()
            .skip(1)
            .all(|line| !line.contains(",unsettled,")),
        "{labels}"
    );
    place
        .phase(&["classify", "results/tiny"])
        .code(0)
        .says("0 of 6 labels changed");
    assert_eq!(place.read("results/tiny/labels.csv"), labels);

    let more = "[sieves.settle]\ntolerance = 1e-30".to_owned();
    place.write(
        "edited.toml",
        &TinySweep {
            more,
            ..TinySweep::default()
        }
        .text(),
    );
    place
        .phase(&["classify", "results/tiny", "--sweep", "edited.toml"])
        .code(0)
        .says("6 of 6 labels changed")
        .says("-> unsettled");
    let unsettled = place.read("results/tiny/labels.csv");
    assert_eq!(
        unsettled
            .lines()
            .filter(|line| line.contains(",unsettled,"))
            .count(),
        6
    );
    // The thresholds are kept, until the sweep is run with its own again.
    place
        .phase(&["classify", "results/tiny"])
        .code(0)
        .says("0 of 6 labels changed");
    place
        .phase(&["sweep", "tiny.toml"])
        .code(0)
        .says("6 jobs: 0 run")
        .says("6 of 6 labels changed");
    assert_eq!(place.read("results/tiny/labels.csv"), labels);
    assert_eq!(place.digests("results/tiny"), records);
}

#[test]
fn thresholds_of_other_runs_are_refused_by_name() {
    let (place, answer) = swept(&TinySweep {
        seeds: vec![1],
        ..TinySweep::default()
    });
    answer.code(0);
    let text = TinySweep {
        seeds: vec![1, 2],
        ..TinySweep::default()
    }
    .text();
    place.write(
        "edited.toml",
        &text.replace("density = 3750.0", "density = 3000.0"),
    );
    let labels = place.read("results/tiny/labels.csv");
    place
        .phase(&["classify", "results/tiny", "--sweep", "edited.toml"])
        .code(2)
        .complains("they differ in scene.spheres.density, seeds.");
    assert_eq!(place.read("results/tiny/labels.csv"), labels);
}

#[test]
fn a_folder_of_several_results_is_taken_as_all_of_them() {
    let place = Workplace::new();
    for name in ["a", "b"] {
        place.write(&format!("{name}.toml"), &TinySweep::default().text());
        place
            .phase(&["sweep", &format!("{name}.toml"), "--no-plot"])
            .code(0);
    }
    for (command, file) in [
        ("status", ": 6 jobs"),
        ("classify", "/labels.csv"),
        ("plot", "/phase.svg"),
    ] {
        let answer = place.phase(&[command, "results"]).code(0);
        for name in ["a", "b"] {
            let text = format!("results/{name}{file}");
            assert!(
                answer.stdout.contains(&text),
                "no {text} in {}",
                answer.stdout
            );
        }
    }
    place
        .phase(&["status", "absent"])
        .code(2)
        .complains("absent: there is no such file or folder");
    place
        .phase(&["status", "results/a/records"])
        .code(2)
        .complains("sweep.json");
}

#[test]
fn figures_are_drawn_by_name() {
    let (place, answer) = swept(&TinySweep::default());
    answer.code(0);
    // That of refined sweeps is none of this folder.
    let list = place.phase(&["plot", "--list", "results/tiny"]);
    let list = list.code(0).stdout;
    let names: Vec<_> = list
        .lines()
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(
        names.contains(&"phase") && names.contains(&"settle-time"),
        "{list}"
    );
    let other = names
        .iter()
        .find(|name| !["phase", "settle-time"].contains(name))
        .unwrap();
    let answer = place
        .phase(&["plot", "results/tiny", "--figure", other])
        .code(0);
    assert_eq!(
        answer.stdout,
        format!("results/tiny/{other}.svg\nresults/tiny/{other}.png\n")
    );
    place
        .phase(&["plot", "results/tiny", "--figure", "nonsense"])
        .code(2)
        .complains("`nonsense`");
}

#[test]
fn figures_of_single_runs_read_their_records() {
    let (place, answer) = swept(&TinySweep::default());
    answer.code(0);
    let plot = ["plot", "results/tiny", "--figure", "speeds", "--point"];
    let at = |point: &str| place.phase(&[&plot[..], &[point]].concat());
    at("omega=4,seed=2").code(0).says("results/tiny/speeds.png");
    at("omega=5").code(2).complains("`omega` is never 5");
    at("omega").code(2).complains("`name=value`");
    place
        .phase(&["plot", "results/tiny", "--point", "omega=4"])
        .code(2)
        .complains("--figure");
    std::fs::remove_dir_all(place.path("results/tiny/records")).unwrap();
    at("omega=4,seed=2")
        .code(1)
        .complains("the run at omega = 4, seed = 2: cannot read results/tiny/records/");
}
