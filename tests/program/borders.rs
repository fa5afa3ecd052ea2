//! More seeds at the borders of a diagram.

use crate::plot::bench::{self, axis};
use crate::support::{TinySweep, Workplace, wait_until};
use phase::classify::Label;
use phase::sweep::Sweep;

/// Settled at rest with one seed of two; pinned in all turning air.
fn tiny(at_borders: &str) -> TinySweep {
    TinySweep {
        omegas: vec![0.0, 4.0, 8.0, 12.0],
        seeds: vec![1, 2],
        more: at_borders.to_owned(),
        ..TinySweep::default()
    }
}

/// Sweeps into a folder, and gives Omega and seed of every row of its labels.
fn sweep(place: &Workplace, sweep: &TinySweep, results: &str, more: &[&str]) -> Vec<String> {
    place.write("tiny.toml", &sweep.text());
    let arguments = ["sweep", "tiny.toml", "--out", results, "--no-plot"];
    place.phase(&[&arguments[..], more].concat()).code(0);
    rows(place, results)
}

fn rows(place: &Workplace, results: &str) -> Vec<String> {
    let labels = place.read(&format!("{results}/labels.csv"));
    let cells = |line: &str| {
        line.split(',')
            .skip(1)
            .take(2)
            .collect::<Vec<_>>()
            .join(" ")
    };
    labels.lines().skip(1).map(cells).collect()
}

/// What `tiny("at_borders = 4")` runs, in order.
const ROWS: [&str; 12] = [
    "0.0 1", "0.0 2", "0.0 3", "0.0 4", "4.0 1", "4.0 2", "4.0 3", "4.0 4", "8.0 1", "8.0 2",
    "12.0 1", "12.0 2",
];

#[test]
fn points_at_borders_have_more_seeds() {
    let place = Workplace::new();
    assert_eq!(sweep(&place, &tiny("at_borders = 4"), "all", &[]), ROWS);
    let status = place.phase(&["status", "all"]).code(0);
    status.says("12 jobs, 12 done, 0 failed, 0 left");
    let points = place.read("all/points.csv");
    assert_eq!(points.lines().count(), 5, "{points}");
    let again = place.phase(&["sweep", "tiny.toml", "--out", "all", "--no-plot"]);
    again
        .code(0)
        .says("12 jobs: 0 run now")
        .says("12 done before")
        .says("0 of 12 labels changed");
    let forced = place.phase(&["sweep", "tiny.toml", "--out", "all", "--force", "--no-plot"]);
    forced.code(0).says("12 jobs: 12 run now");
    // Published tables are made again without their records, those at borders too.
    std::fs::remove_dir_all(place.path("all/records")).unwrap();
    assert_eq!(sweep(&place, &tiny("at_borders = 4"), "all", &[]), ROWS);
    place
        .phase(&["check", "tiny.toml", "--no-trial"])
        .code(0)
        .says("1, 2; 3 to 4 too at points beside another label");
}

#[test]
fn runs_at_borders_are_the_same_however_they_come_about() {
    let place = Workplace::new();
    sweep(&place, &tiny("at_borders = 4"), "all", &["-j", "2"]);
    assert_eq!(sweep(&place, &tiny(""), "later", &["-j", "1"]).len(), 8);
    place.write("tiny.toml", &tiny("at_borders = 4").text());
    let later = place.phase(&["sweep", "tiny.toml", "--out", "later", "--json"]);
    let later: serde_json::Value = serde_json::from_str(&later.code(0).stdout).unwrap();
    assert_eq!(
        [&later["jobs"], &later["run_now"], &later["done_before"]],
        [12, 4, 8]
    );
    assert_eq!(place.digests("all"), place.digests("later"));
    for file in ["labels.csv", "points.csv", "sweep.json"] {
        let [all, later] = ["all", "later"].map(|folder| place.read(&format!("{folder}/{file}")));
        assert_eq!(all, later, "{file}");
    }
}

#[test]
#[ignore = "takes twenty seconds"]
fn a_sweep_that_is_killed_at_borders_goes_on() {
    let place = Workplace::new();
    let slow = TinySweep {
        duration: 30.0,
        frame_interval: 0.1,
        ..tiny("at_borders = 4")
    };
    place.write("tiny.toml", &slow.text());
    let mut killed = place.start(&["sweep", "tiny.toml", "--out", "results", "-j", "1"]);
    wait_until(|| place.records("results").len() > slow.jobs());
    killed.kill().unwrap();
    killed.wait().unwrap();
    let rows = sweep(&place, &slow, "results", &[]);
    assert_eq!(sweep(&place, &slow, "again", &[]), rows);
    assert_eq!(place.digests("results"), place.digests("again"));
}

/// Symptom that this would show: with new thresholds the runs at the old borders lost their rows.
#[test]
fn new_thresholds_label_the_same_runs() {
    let place = Workplace::new();
    sweep(&place, &tiny("at_borders = 4"), "all", &[]);
    let edited = tiny("at_borders = 4\n[sieves.pinned]\nhole = 30.0");
    place.write("edited.toml", &edited.text());
    let answer = place.phase(&["classify", "all", "--sweep", "edited.toml"]);
    answer.code(0).says("12 runs labelled").says("pinned -> ");
    assert_eq!(rows(&place, "all"), ROWS);
}

#[test]
fn borders_need_labels_and_seeds_in_place_of_them_win() {
    let place = Workplace::new();
    place.write("tiny.toml", &tiny("at_borders = 4").text());
    let sweep = ["sweep", "tiny.toml", "--out", "results", "--no-plot"];
    place
        .phase(&[&sweep[..], &["--no-classify"]].concat())
        .code(2)
        .complains("seeds.at_borders needs labels; leave out --no-classify");
    place
        .phase(&[&sweep[..], &["--seed", "7"]].concat())
        .code(0)
        .says("4 jobs: 4 run now");
}

/// The points at borders of a grid of three axes whose points with `is_pinned` are pinned.
fn borders(is_pinned: impl Fn(&[f64]) -> bool) -> (Sweep, Vec<Vec<f64>>) {
    let keys = [bench::RADIUS, bench::OMEGA, ("spheres.density", "density")];
    let axes = keys.map(|key| axis(key, &[1.0, 2.0, 3.0, 4.0])).to_vec();
    let sweep = bench::sweep("grid", axes, &[1]);
    let table = bench::table(&sweep, |values, _| {
        let label = match is_pinned(values) {
            true => Label::PINNED,
            false => Label::SETTLED,
        };
        Some(bench::verdict(label))
    });
    let points = sweep.points_at_borders(&table);
    (sweep, points)
}

#[test]
fn a_border_point_has_a_neighbour_along_an_axis_with_another_label() {
    assert!(borders(|_| true).1.is_empty());
    let (_, points) = borders(|values| values == [2.0, 3.0, 1.0]);
    let mut expected = [
        [1.0, 3.0, 1.0],
        [2.0, 2.0, 1.0],
        [2.0, 3.0, 1.0],
        [2.0, 3.0, 2.0],
        [2.0, 4.0, 1.0],
        [3.0, 3.0, 1.0],
    ];
    expected.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(points, expected);
    // A plane: both layers beside it, whole.
    let (_, points) = borders(|values| values[1] > 2.5);
    assert_eq!(points.len(), 2 * 16);
    assert!(points.iter().all(|point| [2.0, 3.0].contains(&point[1])));
}

#[test]
fn seeds_of_border_points_and_points_without_label_do_not_move_borders() {
    let (mut sweep, points) = borders(|values| values[1] > 2.5);
    let label = |values: &[f64], seed| match (values[1] > 2.5, seed) {
        (false, 1) => Label::SETTLED,
        _ => Label::PINNED,
    };
    sweep.seeds = vec![1, 2, 3];
    let table = bench::table(&sweep, |values, seed| {
        Some(bench::verdict(label(values, seed)))
    });
    sweep.seeds = vec![1];
    assert_eq!(sweep.points_at_borders(&table), points);
    let table = bench::table(&sweep, |values, seed| {
        (values[1] != 3.0).then(|| bench::verdict(label(values, seed)))
    });
    assert!(sweep.points_at_borders(&table).is_empty());
}

#[test]
fn labels_count_without_their_records() {
    let place = Workplace::new();
    sweep(&place, &tiny("at_borders = 4"), "all", &[]);
    sweep(&place, &tiny(""), "kept", &[]);
    std::fs::remove_dir_all(place.path("kept/records")).unwrap();
    place.write("tiny.toml", &tiny("at_borders = 4").text());
    let arguments = ["sweep", "tiny.toml", "--out", "kept", "--no-plot"];
    let kept = place.phase(&[&arguments[..], &["--keep-labels", "--json"]].concat());
    let kept = kept.code(0);
    let answer: serde_json::Value = serde_json::from_str(&kept.stdout).unwrap();
    let numbers = ["jobs", "done_before", "run_now"].map(|name| &answer[name]);
    assert_eq!(numbers, [12, 8, 4]);
    // Symptom: progress began at 0 of 12 jobs, and the time left was that of all. Cause: only
    // records counted as done.
    kept.complains("8 of 8 jobs are done already");
    for file in ["labels.csv", "points.csv"] {
        let [all, kept] = ["all", "kept"].map(|folder| place.read(&format!("{folder}/{file}")));
        assert_eq!(all, kept, "{file}");
    }
    // Those of other thresholds are not kept.
    let other = format!("{}[sieves.settle]\ntolerance = 1e-9\n", tiny("").text());
    place.write("tiny.toml", &other);
    let refused = place.phase(&[&arguments[..], &["--keep-labels"]].concat());
    refused.code(2).complains("other thresholds");
}
