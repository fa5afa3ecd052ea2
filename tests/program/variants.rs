//! Variants of a scene as an axis of a sweep: jobs, tables, figures, points.

use crate::support::{TinySweep, Workplace, texts};
use phase::store::read_labels;
use phase::sweep::{self, parse_point};
use serde_json::Value;

/// The tiny sweep with two variants: one is the scene as it is.
fn swept() -> Workplace {
    let place = Workplace::new();
    place.write("tiny.toml", &text());
    place
}

fn text() -> String {
    TinySweep::default().text()
        + "\n[[variant]]\nname = \"heavy\"\nset = { \"spheres.density\" = 4000.0 }\n\
           [[variant]]\nname = \"as it was\"\nset = { \"spheres.density\" = 3750.0 }\n"
}

#[test]
fn variants_are_an_axis_that_varies_fastest() {
    let place = swept();
    let with = sweep::load(&place.path("tiny.toml")).unwrap();
    let plain = sweep::from_str(&TinySweep::default().text(), &place.path("plain.toml")).unwrap();
    let (jobs, plain_jobs) = (with.jobs().unwrap(), plain.jobs().unwrap());
    assert_eq!(jobs.len(), 2 * plain_jobs.len());
    let of_variant = |place: f64| {
        let own = jobs
            .iter()
            .filter(move |job| job.values.last() == Some(&place));
        own.map(|job| (&job.id, &job.scene))
    };
    // The scene says the same, so that the runs are the same.
    let ids = plain_jobs.iter().map(|job| &job.id);
    assert_eq!(plain.scene.spheres.density, 3750.0);
    assert!(ids.eq(of_variant(1.0).map(|(id, _)| id)));
    assert!(of_variant(0.0).all(|(_, scene)| scene.spheres.density == 4000.0));

    let point = parse_point("variant=heavy").unwrap();
    let chosen = with.select(&point).unwrap().jobs().unwrap();
    assert!(
        chosen
            .iter()
            .map(|job| &job.id)
            .eq(of_variant(0.0).map(|(id, _)| id))
    );
    let message = |text: &str| {
        let point = parse_point(text).unwrap();
        with.select(&point).unwrap_err().to_string()
    };
    assert_eq!(
        message("variant=light"),
        "`variant` is never light; it takes heavy, as it was"
    );
    let none = plain.select(&point).unwrap_err().to_string();
    assert!(
        none.starts_with("the sweep has no axis `variant`"),
        "{none}"
    );
}

#[test]
fn tables_figures_and_answers_name_variants() {
    let place = swept();
    place.phase(&["sweep", "tiny.toml"]).code(0);
    let folder = "results/tiny";
    for table in ["labels.csv", "points.csv"] {
        let text = place.read(&format!("{folder}/{table}"));
        assert!(text.lines().next().unwrap().contains(",variant,"), "{text}");
        assert!(
            text.contains(",heavy,") && text.contains(",as it was,"),
            "{text}"
        );
    }
    let labels = read_labels(&place.path(&format!("{folder}/labels.csv"))).unwrap();
    assert_eq!(labels.variants, ["heavy", "as it was"]);
    let turned = labels.clone().with_variants(vec!["as it was".to_owned()]);
    assert_eq!(turned.variants, ["as it was", "heavy"]);
    assert_eq!(turned.rows[0].values.last(), Some(&1.0));
    assert_eq!(turned.with_variants(labels.variants.clone()), labels);

    let figure = texts(&place.read(&format!("{folder}/phase.svg")));
    for name in ["heavy", "as it was"] {
        assert!(
            figure.iter().any(|text| text == name),
            "no {name} in {figure:?}"
        );
    }
    // A second sweep reads the tables, with variants in their places.
    place.phase(&["sweep", "tiny.toml"]).code(0);
    place
        .phase(&["classify", folder])
        .code(0)
        .says("0 of 12 labels changed");
    place.phase(&["compare", folder, folder]).code(0);
    let check = place
        .phase(&["check", "tiny.toml", "--no-trial", "--json"])
        .code(0);
    let check: Value = serde_json::from_str(&check.stdout).unwrap();
    let axes = check["axes"].as_array().unwrap();
    let values = serde_json::json!(["heavy", "as it was"]);
    assert_eq!(axes.last().unwrap()["values"], values);
    let again = [
        "run",
        "--from",
        folder,
        "--point",
        "omega=4,variant=as it was",
    ];
    place.phase(&again).code(0).says("variant-as it was");
}

#[test]
fn variants_are_not_refined() {
    swept()
        .phase(&["sweep", "tiny.toml", "--refine"])
        .code(2)
        .complains("a sweep with variants is not refined");
}
