//! What a folder holds already: runs and labels that a refined sweep goes on from.

use super::sweeps::{REFINE, bare, content, rows, tiny};
use crate::support::Workplace;
use serde_json::Value;

/// Symptom: in a fresh checkout `phase sweep` refused to make a published refined sweep again, as
/// labels would be lost. Cause: only the coarse grid counted as runs that it makes. And with fewer
/// runs than before sweep.json was replaced before that was refused.
#[test]
fn published_tables_are_made_again_without_their_records() {
    let place = Workplace::new();
    bare(&place, &tiny(2.0, REFINE), "results", &[]);
    let labels = place.read("results/labels.csv");
    std::fs::remove_dir_all(place.path("results/records")).unwrap();
    let smaller = REFINE.replace("budget = 14", "budget = 13");
    place.write("tiny.toml", &tiny(2.0, &smaller));
    let narrower = REFINE.replace("budget = 14", "width = 0.9\nbudget = 14");
    let sweep = place.read("results/sweep.json");
    let arguments = ["sweep", "tiny.toml", "--out", "results", "--no-plot"];
    for option in ["--keep-labels", "--quiet", "--force"] {
        let arguments = [&arguments[..], &[option]].concat();
        place.phase(&arguments).code(2).complains("would be lost");
    }
    place.write("tiny.toml", &tiny(2.0, &narrower));
    let keep = [&arguments[..], &["--keep-labels"]].concat();
    place.phase(&keep).code(2).complains("would be lost");
    assert_eq!(place.read("results/sweep.json"), sweep);
    assert_eq!(place.read("results/labels.csv"), labels);
    let said = bare(&place, &tiny(2.0, REFINE), "results", &[]);
    assert!(said.contains("14 jobs: 14 run now"), "{said}");
    assert_eq!(place.read("results/labels.csv"), labels);
}

#[test]
fn a_larger_budget_goes_on_with_the_same_runs() {
    let place = Workplace::new();
    bare(&place, &tiny(2.0, REFINE), "results", &[]);
    let larger = tiny(2.0, &REFINE.replace("14", "17"));
    let said = bare(&place, &larger, "results", &[]);
    assert!(said.contains("17 jobs: 3 run now"), "{said}");
    bare(&place, &larger, "whole", &[]);
    assert_eq!(content(&place, "results"), content(&place, "whole"));
}

#[test]
fn nothing_is_run_of_a_full_grid() {
    let place = Workplace::new();
    // Every point with both seeds.
    let full = bare(&place, &tiny(2.0, "[seeds]\ncount = 2"), "results", &[]);
    assert!(full.contains("54 jobs: 54 run now"), "{full}");
    let said = bare(&place, &tiny(2.0, REFINE), "results", &[]);
    assert!(said.contains("14 jobs: 0 run now"), "{said}");
    bare(&place, &tiny(2.0, REFINE), "alone", &[]);
    // All but progress.json, which says of a whole grid that it was there.
    let tables = |folder: &str| content(&place, folder)[..5].to_vec();
    assert_eq!(tables("results"), tables("alone"));
}

/// Symptom: of a folder with more runs than the budget, but not of the whole grid, those beside the
/// coarse grid were thrown away, and others were run. Cause: runs counted as data only if they were
/// fewer than the budget.
#[test]
fn nothing_is_run_of_a_part_of_the_grid_with_as_many_runs_as_the_budget() {
    let place = Workplace::new();
    let part = tiny(2.0, "").replace(
        "[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]",
        "[1.0, 3.0, 4.0, 5.0, 7.0]",
    );
    let first = bare(&place, &part, "results", &[]);
    assert!(first.contains("15 jobs: 15 run now"), "{first}");
    let said = bare(&place, &tiny(2.0, REFINE), "results", &[]);
    assert!(said.contains("15 jobs: 0 run now"), "{said}");
    assert!(said.contains("the budget of 14 runs is spent"), "{said}");
    let again = bare(&place, &tiny(2.0, REFINE), "results", &[]);
    assert!(again.contains("15 jobs: 0 run now"), "{again}");
}

/// Symptom: a finished grid of one seed was not enough for a refined sweep, which ran second seeds.
#[test]
fn nothing_is_run_of_a_full_grid_of_one_seed() {
    let place = Workplace::new();
    let full = bare(&place, &tiny(2.0, ""), "results", &[]);
    assert!(full.contains("27 jobs: 27 run now"), "{full}");
    for _ in 0..2 {
        let said = bare(&place, &tiny(2.0, REFINE), "results", &[]);
        assert!(said.contains("14 jobs: 0 run now"), "{said}");
    }
}

/// Symptom: with --keep-labels one damaged row let all labels be forgotten, and all runs be made
/// again. Cause: a table that could not be read counted as none.
#[test]
fn labels_that_cannot_be_read_are_not_forgotten() {
    let place = Workplace::new();
    bare(&place, &tiny(2.0, REFINE), "results", &[]);
    std::fs::remove_dir_all(place.path("results/records")).unwrap();
    let labels = place.read("results/labels.csv");
    let second = labels.lines().nth(1).unwrap();
    for (damaged, reason) in [
        (labels.replace(",pinned,", ",weird,"), "weird"),
        (
            format!("{labels}{second}\n"),
            "labels.csv:16: duplicate row of run",
        ),
    ] {
        place.write("results/labels.csv", &damaged);
        let keep = ["sweep", "tiny.toml", "--out", "results", "--keep-labels"];
        place
            .phase(&keep)
            .code(2)
            .complains(reason)
            .complains("repair the file");
        assert_eq!(place.read("results/labels.csv"), damaged);
    }
}

/// Symptom: with more runs than a whole grid has, refining still chose among its runs, and said
/// that every point had all its seeds. Cause: what an earlier, smaller budget had found was kept.
#[test]
fn a_budget_beyond_the_whole_grid_runs_more_seeds() {
    let place = Workplace::new();
    bare(&place, &tiny(2.0, ""), "results", &[]);
    bare(&place, &tiny(2.0, REFINE), "results", &[]);
    let more = tiny(2.0, &REFINE.replace("budget = 14", "budget = 30"));
    let said = bare(&place, &more, "results", &[]);
    assert!(said.contains("30 jobs: 3 run now"), "{said}");
    bare(&place, &tiny(2.0, ""), "other", &[]);
    bare(&place, &more, "other", &[]);
    assert_eq!(content(&place, "results"), content(&place, "other"));
}

/// Symptom: a refined sweep refused published labels with more seeds at some points. Cause: only
/// jobs of the same sweep counted. All count if they are no more than the budget.
#[test]
fn published_labels_with_more_seeds_at_some_points_count_without_records() {
    let place = Workplace::new();
    bare(&place, &tiny(2.0, "[seeds]\ncount = 1"), "results", &[]);
    let few = tiny(2.0, "[seeds]\nfirst = 2").replace(
        "[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]",
        "[3.0, 4.0]",
    );
    bare(&place, &few, "more", &[]);
    let more = place.read("more/labels.csv");
    let all = place.read("results/labels.csv") + more.split_once('\n').unwrap().1;
    place.write("results/labels.csv", &all);
    std::fs::remove_dir_all(place.path("results/records")).unwrap();
    let labels = rows(&place, "results/labels.csv");
    assert_eq!(labels.len(), 27 + 6);
    let budget = |runs: usize| REFINE.replace("budget = 14", &format!("budget = {runs}"));
    let keep = [
        "sweep",
        "tiny.toml",
        "--out",
        "results",
        "--keep-labels",
        "--no-plot",
    ];
    place.write("tiny.toml", &tiny(2.0, &budget(labels.len() - 1)));
    place.phase(&keep).code(2).complains("would be lost");
    let text = tiny(2.0, &budget(labels.len()));
    let said = bare(&place, &text, "results", &["--keep-labels"]);
    let count = labels.len();
    assert!(said.contains(&format!("{count} jobs: 0 run now")), "{said}");
    let sorted = |mut rows: Vec<Vec<String>>| {
        rows.sort();
        rows
    };
    assert_eq!(sorted(rows(&place, "results/labels.csv")), sorted(labels));
}

#[test]
fn runs_that_are_there_count_as_data() {
    let place = Workplace::new();
    let few = tiny(2.0, "").replace(
        "[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]",
        "[1.0, 5.0]",
    );
    let first = bare(&place, &few, "results", &[]);
    assert!(first.contains("6 jobs: 6 run now"), "{first}");
    let said = bare(&place, &tiny(2.0, REFINE), "results", &[]);
    assert!(said.contains("14 jobs: 8 run now"), "{said}");
    assert!(said.contains("6 done before"), "{said}");
    assert_eq!(place.records("results").len(), 14);
    // They stay given when the sweep goes on.
    let again = bare(&place, &tiny(2.0, REFINE), "results", &[]);
    assert!(again.contains("14 jobs: 0 run now"), "{again}");
}

/// What is done to a document.
type Edit = fn(&mut Value);

/// Symptom: `phase status` panicked on runs and borders that do not lie on the axes.
#[test]
fn progress_that_does_not_lie_on_the_axes_is_refused() {
    let place = Workplace::new();
    bare(&place, &tiny(2.0, REFINE), "results", &[]);
    let text = place.read("results/progress.json");
    let progress: Value = serde_json::from_str(&text).unwrap();
    let edits: [(&str, Edit); 3] = [
        ("along axis 7 of 2", |it| {
            it["widths"][0]["axis"] = 7.into();
        }),
        ("has 1 values, but there are 2 axes", |it| {
            it["chosen"][0]["values"].as_array_mut().unwrap().pop();
        }),
        ("unknown field `budget`", |it| it["budget"] = 7.into()),
    ];
    for (reason, edit) in edits {
        let mut broken = progress.clone();
        edit(&mut broken);
        place.write("results/progress.json", &broken.to_string());
        for command in ["status", "classify"] {
            let answer = place.phase(&[command, "results"]).code(1);
            answer.complains(reason).complains("progress.json");
        }
    }
}
