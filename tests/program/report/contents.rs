//! What a page holds: everything that it needs, and nothing that its texts could set free.

use super::{document, read, sieved};
use crate::support::{TinySweep, Workplace, drainage_file, silo_file};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use phase::store::read_labels;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::path::Path;

/// A swept folder, and its page.
fn reported(sweep: &TinySweep) -> (Workplace, String) {
    let place = Workplace::new();
    place.write("tiny.toml", &sweep.text());
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    place.phase(&["report", "results/tiny"]).code(0);
    let page = place.read("results/tiny/report.html");
    (place, page)
}

/// The texts between a tag and its end.
fn inside<'a>(page: &'a str, tag: &str, end: &str) -> Vec<&'a str> {
    let parts = page.split(tag).skip(1);
    parts.map(|part| part.split_once(end).unwrap().0).collect()
}

#[test]
fn a_page_loads_nothing_and_runs_nothing_else() {
    let (_place, page) = reported(&sieved());
    let policy = inside(&page, "Content-Security-Policy\" content=\"", "\"")[0];
    assert!(policy.starts_with("default-src 'none';"), "{policy}");
    for (tag, end, directive) in [
        ("<script>", "</script>", "script-src"),
        ("<style>", "</style>", "style-src"),
    ] {
        let [text] = inside(&page, tag, end)[..] else {
            panic!("{tag} is not there once");
        };
        let digest = STANDARD.encode(Sha256::digest(text.as_bytes()));
        let allowed = format!("{directive} 'sha256-{digest}'");
        assert!(policy.contains(&allowed), "{policy}: {allowed}");
    }
    // Names of XML, and of parts of the page, are no addresses that are loaded.
    let code = page
        .replace("http://www.w3.org/2000/svg", "")
        .replace("url(#", "");
    for address in [
        "http:",
        "https:",
        "@import",
        "fetch(",
        "XMLHttpRequest",
        "src=\"",
        "url(",
    ] {
        let found = code
            .find(address)
            .map(|at| &code[at..(at + 60).min(code.len())]);
        assert_eq!(found, None, "{address}");
    }
}

#[test]
fn a_page_holds_the_labels_and_columns_of_its_folder() {
    let (place, page) = reported(&sieved());
    let section = &document(&page)["sections"][0];
    let table = read_labels(&place.path("results/tiny/labels.csv")).unwrap();
    let texts = |value: &Value, key: &str| -> Vec<String> {
        let list = value.as_array().unwrap().iter();
        list.map(|it| it[key].as_str().unwrap().to_owned())
            .collect()
    };
    let names = texts(&section["labels"], "name");
    let measures = section["measures"].as_array().unwrap();
    for (run, row) in table.rows.iter().enumerate() {
        let label = section["runs"]["label"][run].as_u64().unwrap() as usize;
        assert_eq!(names[label], row.verdict.label.name);
        assert_eq!(section["runs"]["id"][run], row.id);
        assert_eq!(section["runs"]["seed"][run], row.seed);
        for (axis, value) in row.values.iter().enumerate() {
            let at = section["runs"]["places"][axis][run].as_u64().unwrap() as usize;
            assert_eq!(section["axes"][axis]["values"][at], *value);
        }
        for measure in measures {
            let name = measure["name"].as_str().unwrap();
            // All digits, so that evidence decides as in the table.
            let value = row.verdict.value(name).filter(|it| it.is_finite());
            assert_eq!(measure["values"][run].as_f64(), value, "{name}");
        }
    }
    let columns = texts(&section["series"]["columns"], "name");
    assert!(columns.iter().any(|it| it == "height_mean"), "{columns:?}");
    assert_eq!(
        section["series"]["runs"].as_array().unwrap().len(),
        table.rows.len()
    );
    // One run of each label moves.
    let labels: std::collections::BTreeSet<&str> = table
        .rows
        .iter()
        .map(|row| row.verdict.label.name)
        .collect();
    assert_eq!(section["states"].as_array().unwrap().len(), labels.len());
    let command = section["command"].as_str().unwrap();
    assert!(
        command.starts_with("phase run --from results/tiny --point"),
        "{command}"
    );
}

#[test]
fn only_named_points_move_and_the_page_says_what_they_add() {
    let (place, _) = reported(&sieved());
    let named = [
        "report",
        "results/tiny",
        "--point",
        "omega=4,seed=2",
        "--out",
        "one.html",
    ];
    let said = place.phase(&named).code(0).stdout;
    let one = read(&place, "one.html");
    let states = one["sections"][0]["states"].as_array().unwrap();
    assert_eq!(states.len(), 1);
    let run = states[0]["run"].as_u64().unwrap() as usize;
    assert_eq!(one["sections"][0]["runs"]["seed"][run], 2);
    assert!(said.contains("of it animate 1 of them"), "{said}");
    place
        .phase(&[
            "report",
            "results/tiny",
            "--without-animations",
            "--out",
            "none.html",
        ])
        .code(0);
    assert!(
        read(&place, "none.html")["sections"][0]
            .get("states")
            .is_none()
    );
    let (one, none) = (place.read("one.html").len(), place.read("none.html").len());
    assert!(one > none, "{one} {none}");
}

#[test]
fn texts_of_files_stay_texts() {
    let hostile = "</script><img src=x onerror=alert(1)><!-- & \u{2028}";
    let text = TinySweep::default().text();
    let text = text.replace(
        "title = \"tiny\"",
        &format!("title = {}", toml::Value::from(hostile)),
    );
    let place = Workplace::new();
    place.write("tiny.toml", &text);
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    place.phase(&["report", "results/tiny"]).code(0);
    let page = place.read("results/tiny/report.html");
    assert_eq!(page.matches("</script>").count(), 2);
    assert!(!page.contains("<img"), "an element of the title");
    assert!(!page.contains("<!--"), "a comment of the title");
    assert_eq!(document(&page)["title"], hostile);
    assert_eq!(document(&page)["sections"][0]["title"], hostile);
}

#[test]
fn a_published_folder_has_a_page_without_runs() {
    let place = Workplace::new();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("results");
    let page = |name: &str| -> (Value, usize) {
        let folder = folder.join(name);
        let out = ["report", folder.to_str().unwrap(), "--out", "page.html"];
        place.phase(&out).code(0);
        (read(&place, "page.html"), place.read("page.html").len())
    };
    let (whole, bytes) = page("theoretical");
    let section = &whole["sections"][0];
    assert_eq!(section["runs"]["id"].as_array().unwrap().len(), 1681);
    assert!(section.get("series").is_none() && section.get("states").is_none());
    let note = section["notes"][0].as_str().unwrap();
    assert!(note.contains("without their records"), "{note}");
    assert!(bytes < 700_000, "{bytes}");
    let kinds = |section: &Value| -> Vec<String> {
        let curves = section["curves"].as_array().unwrap().iter();
        curves
            .map(|it| it["kind"].as_str().unwrap().to_owned())
            .collect()
    };
    assert_eq!(kinds(section), ["theory"]);

    // A refined sweep has borders and bands, and a label everywhere.
    let (refined, _) = page("theoretical-refined");
    let section = &refined["sections"][0];
    let kinds = kinds(section);
    for kind in ["border", "band", "theory"] {
        assert!(kinds.iter().any(|it| it == kind), "{kind}: {kinds:?}");
    }
    let sizes = section["axes"].as_array().unwrap().iter();
    let places: usize = sizes
        .map(|axis| axis["values"].as_array().unwrap().len())
        .product();
    assert_eq!(
        section["lattice"]["label"].as_array().unwrap().len(),
        places
    );
}

/// Each published study has a page.
#[test]
fn studies_have_pages() {
    let place = Workplace::new();
    let results = Path::new(env!("CARGO_MANIFEST_DIR")).join("results");
    for (folder, kind, list) in [
        ("accuracy/cradle", "accuracy", "settings"),
        ("accuracy/theoretical", "accuracy", "settings"),
        ("ablation/silo", "ablation", "effects"),
        ("stability/cradle", "sweep", "labels"),
    ] {
        let folder = results.join(folder);
        place
            .phase(&["report", folder.to_str().unwrap(), "--out", "page.html"])
            .code(0);
        let page = read(&place, "page.html");
        let section = &page["sections"][0];
        assert_eq!(section["kind"], kind, "{folder:?}");
        assert!(section[list].as_array().unwrap().len() > 1, "{folder:?}");
    }
    // Labels of a study of stability are those of its table.
    let page = read(&place, "page.html");
    let section = &page["sections"][0];
    let table = std::fs::read_to_string(results.join("stability/cradle/runs.csv")).unwrap();
    let runs = section["runs"]["label"].as_array().unwrap();
    assert_eq!(runs.len(), table.lines().count() - 1);
    let count = |name: &str| table.matches(&format!(",{name},")).count();
    for (place, label) in section["labels"].as_array().unwrap().iter().enumerate() {
        let name = label["name"].as_str().unwrap();
        let on_page = runs
            .iter()
            .filter(|it| it.as_u64() == Some(place as u64))
            .count();
        assert_eq!(on_page, count(name), "{name}");
    }
}

#[test]
fn records_stand_beside_each_other() {
    let place = Workplace::new();
    place.write("box.toml", &drainage_file());
    for (seed, out) in [("1", "a.h5"), ("2", "b.h5")] {
        place
            .phase(&["run", "box.toml", "--seed", seed, "--out", out])
            .code(0);
    }
    place
        .phase(&[
            "report", "a.h5", "b.h5", "--label", "one", "--label", "two's", "--out", "p.html",
        ])
        .code(0);
    let page = read(&place, "p.html");
    let section = &page["sections"][0];
    assert_eq!(section["kind"], "records");
    assert_eq!(section["records"][1]["name"], "two's");
    assert_eq!(section["records"][1]["changes"][0][0], "seed");
    assert_eq!(section["charts"].as_array().unwrap().len(), 3);
    assert!(!section["quantities"].as_array().unwrap().is_empty());
    assert_eq!(section["states"].as_array().unwrap().len(), 2);
    let again = page["commands"][0]["line"].as_str().unwrap();
    assert_eq!(
        again,
        "phase report a.h5 b.h5 --label one --label 'two'\\''s'"
    );

    place.write("silo.toml", &silo_file());
    place
        .phase(&["run", "silo.toml", "--out", "silo.h5"])
        .code(0);
    place.phase(&["report", "silo.h5"]).code(0);
    let page = read(&place, "silo.html");
    let walls = &page["sections"][0]["states"][0]["walls"];
    assert_eq!(walls["kind"], "segments");
    assert!(walls["segments"].as_array().unwrap().len() > 10);
}
