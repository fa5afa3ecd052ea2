//! Variants of a scene as an axis of a sweep: jobs, tables, figures, points.

use crate::support::{TinySweep, Workplace, scene_file, texts};
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
        own.map(|job| (&job.id, job.scene()))
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

/// A sweep of variants with other tanks, radii and rotations, with its results.
fn swept_in_three_tanks() -> Workplace {
    let place = Workplace::new();
    let sweep = TinySweep {
        omegas: vec![4.0, 8.0],
        seeds: vec![1],
        duration: 0.2,
        more: "[[axis]]\nkey = \"spheres.radius\"\nvalues = [0.003, 0.004]\n\
               [[variant]]\nname = \"as it is\"\nset = { title = \"the same\" }\n\
               [[variant]]\nname = \"large\"\nset = { \"tank.radius\" = 0.06 }\n\
               scale = { radius = 2.0 }\n\
               [[variant]]\nname = \"wide\"\nset = { \"tank.radius\" = 0.06 }\n\
               [plot]\nx = \"radius\"\ny = \"omega\"\n"
            .to_owned(),
        ..TinySweep::default()
    };
    let sieves = "[sieves]\nsettle = { window = 0.05 }\nfluid = { window = 0.05 }\n\
                  pinned = { window = 0.05 }\nspout = { window = 0.05 }\n";
    place.write("tiny.toml", &(sweep.text() + sieves));
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    place
}

/// Symptom: radii stood over the tank of the scene, runs were named by radii that they did not
/// have, and the critical rotation was that of the scene. Cause: figures read tank and radius in
/// the scene from which variants start, without what these set and scale.
#[test]
fn figures_have_the_tank_and_the_radii_of_each_variant() {
    let place = swept_in_three_tanks();
    let large = "radius=0.004,omega=8,variant=large";
    // For each figure: options, texts that it has, and texts that it has not.
    let cases: [(&str, [&[&str]; 3]); 4] = [
        // Of "as it is" 0.1 and 0.13, of "large" the same, of "wide" half of it.
        ("phase", [&[], &["r / R", "0.05", "0.1"], &["r (m)"]]),
        (
            "critical-rotation",
            [
                &[],
                &["as it is", "large or wide", "n = 8, g = 9.8 m/s²"],
                &["R = 0.03 m", "R = 30 mm"],
            ],
        ),
        (
            "energies",
            [&["--point", large], &["r = 8 mm"], &["r = 4 mm"]],
        ),
        (
            "measures",
            [
                &[],
                &["r (m), before the factor of each variant"],
                &["r / R"],
            ],
        ),
    ];
    for (figure, [more, present, absent]) in cases {
        let arguments = [&["plot", "results/tiny", "--figure", figure], more].concat();
        place.phase(&arguments).code(0);
        let found = texts(&place.read(&format!("results/tiny/{figure}.svg")));
        let has = |part: &&&str| found.iter().any(|text| text.contains(**part));
        let missing: Vec<_> = present.iter().filter(|part| !has(part)).collect();
        let wrong: Vec<_> = absent.iter().filter(has).collect();
        assert!(
            missing.is_empty() && wrong.is_empty(),
            "{figure}: no {missing:?}, but {wrong:?} in {found:?}"
        );
    }
}

/// Symptom: `phase check` named variants, but not what they change, and described the scene from
/// which they start as if it was run.
#[test]
fn check_says_what_each_variant_changes() {
    let place = Workplace::new();
    let more = "\n[[variant]]\nname = \"still\"\nwithout = [\"swirl\", \"drag\"]\n";
    let text = text() + more;
    place.write(
        "tiny.toml",
        &text.replace("key = \"swirl.omega\"", "key = \"spheres.radius\""),
    );
    let text = place
        .read("tiny.toml")
        .replace("[0.0, 4.0, 8.0]", "[0.003, 0.004]");
    place.write("tiny.toml", &text);
    place
        .phase(&["check", "tiny.toml", "--no-trial"])
        .code(0)
        .says("variant     3, no two of which share a run: heavy, as it was, still")
        .says("heavy: spheres.density = 4000.0")
        .says("as it was: the scene as it is")
        .says("still: without drag, without swirl")
        .says("gravity, swirl, contact (hertz), cylinder, floor (heavy, as it was)")
        .says("gravity, contact (hertz), cylinder, floor (still)");
    let check = place.phase(&["check", "tiny.toml", "--no-trial", "--json"]);
    let check: Value = serde_json::from_str(&check.code(0).stdout).unwrap();
    assert_eq!(
        check["variants"][0]["keys"],
        serde_json::json!(["spheres.density"])
    );
    assert_eq!(check["variants"][2]["name"], "still");
}

/// Symptom: dumps of variants were refused, because all had one name. Cause: the name of a dump
/// says radius, density, rotation and seed alone.
#[test]
fn dumps_of_variants_have_names_of_their_own() {
    let place = swept_in_three_tanks();
    let records = place.records("results/tiny");
    let paths = records
        .iter()
        .map(|name| format!("results/tiny/records/{name}"));
    let paths: Vec<String> = paths.collect();
    for (format, names) in [
        ("dump", 12),
        ("xyz", 12),
        ("csv", 24),
        ("npy", 12),
        ("vtk", 24),
    ] {
        let mut arguments = vec!["export", "--to", format, "--out", format];
        arguments.extend(paths.iter().map(String::as_str));
        place.phase(&arguments).code(0);
        let files = std::fs::read_dir(place.path(format)).unwrap().count();
        assert_eq!(files, names, "{format}");
    }
    // Two variants have radii of 3 and 4 mm, one of 6 and 8 mm, whose names need no more.
    let dumps = std::fs::read_dir(place.path("dump")).unwrap();
    let dumps = dumps.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let (short, long): (Vec<String>, Vec<String>) = dumps.partition(|name| !name.contains("_s1_"));
    assert_eq!((short.len(), long.len()), (4, 8), "{short:?} {long:?}");
    assert!(
        short.contains(&"dump_r00.008_p03750.0_f008.0.npy".to_owned()),
        "{short:?}"
    );
}

/// Symptom: a table in `set` kept keys that it did not name, unless it had another `law`, `kind` or
/// `search`, so that the same line did different things. Cause: tables were merged key by key.
#[test]
fn a_table_that_is_set_replaces_the_whole_table() {
    let place = Workplace::new();
    place.write("scene.toml", &scene_file());
    for (setting, is_there) in [
        ("tank.radius=0.04", true),
        ("tank = { radius = 0.04, floor = 0.0 }", true),
        ("tank={radius=0.04}", false),
        ("[tank]\nradius = 0.04", false),
    ] {
        let check = [
            "check",
            "scene.toml",
            "--no-trial",
            "--json",
            "--set",
            setting,
        ];
        let check: Value = serde_json::from_str(&place.phase(&check).code(0).stdout).unwrap();
        let effects = check["effects"].as_array().unwrap();
        assert!(
            effects.contains(&"cylinder".into()),
            "{setting}: {effects:?}"
        );
        assert_eq!(effects.contains(&"floor".into()), is_there, "{setting}");
        // The same in a variant.
        let set = setting.replace("tank.radius", "\"tank.radius\"");
        let Some(set) = Some(set).filter(|set| !set.starts_with('[')) else {
            continue;
        };
        let variant = format!("[[variant]]\nname = \"it\"\nset = {{ {set} }}\n");
        let text = TinySweep::default().text() + &variant;
        let sweep = sweep::from_str(&text, &place.path("sweep.toml")).unwrap();
        let tank = sweep.jobs().unwrap()[0].scene().tank.clone().unwrap();
        assert_eq!(
            (tank.radius, tank.floor.is_some()),
            (Some(0.04), is_there),
            "{set}"
        );
    }
}
