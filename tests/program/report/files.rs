//! Where pages are written, and what is refused.

use super::sieved;
use crate::support::Workplace;

fn swept() -> Workplace {
    let place = Workplace::new();
    place.write("tiny.toml", &sieved().text());
    place
        .phase(&["sweep", "tiny.toml", "--no-plot"])
        .code(0)
        .says("phase report results/tiny");
    place
}

#[test]
fn a_page_may_be_made_again_and_no_other_file_is_lost() {
    let place = swept();
    place.phase(&["report", "results/tiny"]).code(0);
    let first = place.read("results/tiny/report.html");
    place.phase(&["report", "results/tiny"]).code(0);
    assert_eq!(place.read("results/tiny/report.html"), first);
    place.write("notes.html", "<!doctype html>\n<p>mine");
    place
        .phase(&["report", "results/tiny", "--out", "notes.html"])
        .code(2)
        .complains("this is not a page of `phase report`");
    assert_eq!(place.read("notes.html"), "<!doctype html>\n<p>mine");
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let place = swept();
    for (arguments, complaint) in [
        (&["absent"][..], "absent"),
        (&["results/tiny", "--point", "omega=5"], "omega"),
        (&["results/tiny", "--label", "a"], "--label is for records"),
        (
            &["results/tiny", "results/tiny"],
            "several paths must all be records",
        ),
        (&["tiny.toml"], "tiny.toml"),
        (
            &["tiny.toml", "--point", "omega=4"],
            "--point is for a results folder",
        ),
    ] {
        let all = [&["report"][..], arguments].concat();
        let answer = place.phase(&all);
        assert!(
            matches!(answer.code, Some(1 | 2)),
            "{arguments:?}: {answer:?}"
        );
        answer.complains(complaint);
    }
    assert!(!place.path("results/tiny/report.html").exists());
}

#[test]
fn a_table_of_another_sweep_is_refused() {
    let place = swept();
    let path = place.path("results/tiny/labels.csv");
    let table = std::fs::read_to_string(&path).unwrap();
    std::fs::write(&path, table.replacen("omega", "alpha", 1)).unwrap();
    let answer = place.phase(&["report", "results/tiny"]);
    assert!(matches!(answer.code, Some(1 | 2)), "{answer:?}");
    answer.complains("labels.csv");
    assert!(!place.path("results/tiny/report.html").exists());
}

#[test]
fn a_sweep_without_axes_has_records_only() {
    let place = Workplace::new();
    place.write("scene.toml", &crate::support::scene_file());
    place.write(
        "seeds.toml",
        "scene = \"scene.toml\"\n[seeds]\nlist = [1, 2]\n",
    );
    place.phase(&["sweep", "seeds.toml", "--no-plot"]).code(0);
    place
        .phase(&["report", "results/seeds"])
        .code(2)
        .complains("give its records");
}

#[test]
fn several_folders_have_a_page_each_and_a_lost_record_is_told() {
    let place = swept();
    place
        .phase(&["sweep", "tiny.toml", "--no-plot", "--out", "results/other"])
        .code(0);
    place
        .phase(&["report", "results", "--out", "page.html"])
        .code(2)
        .complains("each has a page of its own");
    let record = place.records("results/other").remove(0);
    std::fs::write(
        place.path(&format!("results/other/records/{record}")),
        "lost",
    )
    .unwrap();
    place.phase(&["report", "results"]).code(0);
    let page = super::read(&place, "results/other/report.html");
    let notes = page["sections"][0]["notes"].as_array().unwrap();
    assert!(
        notes
            .iter()
            .any(|it| it == "1 of 10 records could not be read."),
        "{notes:?}"
    );
    assert!(
        super::read(&place, "results/tiny/report.html")["sections"][0]
            .get("notes")
            .is_none()
    );
}
