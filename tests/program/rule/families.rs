//! How rules go with families of scenes: alone, before sieves, from a scene's own file.

use super::sweeps::{cells, text};
use crate::support::{Workplace, drainage_file, scene_file};

/// With `labels = "tank"` the sieves label the runs of which no rule holds.
#[test]
fn rules_come_before_the_sieves_of_a_named_family() {
    let place = Workplace::new();
    let rule = "[[label]]\nname = \"fast\"\nwhen = \"swirl.omega > 7\"\n";
    place.write("plain.toml", &text(""));
    place.write("both.toml", &format!("labels = \"tank\"\n{}", text(rule)));
    for name in ["plain", "both"] {
        place.phase(&["sweep", &format!("{name}.toml")]).code(0);
    }
    let [plain, both] = ["plain", "both"].map(|name| {
        let table = format!("results/{name}/labels.csv");
        cells(&place, &table, &["omega", "label", "settle_time"])
    });
    for (plain, both) in plain.iter().zip(&both) {
        let fast = plain[0].parse::<f64>().unwrap() > 7.0;
        let expected = if fast { "fast" } else { &plain[1] };
        assert_eq!(both[1], expected);
        assert_eq!(both[2], plain[2]);
    }
    assert!(both.iter().any(|row| row[1] == "fast"));
    // Figures of the sieves stay.
    place
        .phase(&[
            "plot",
            "results/both",
            "-f",
            "settle-time",
            "-f",
            "fast-margin",
        ])
        .code(0);
    for (family, message) in [
        ("silo", "the scene is a tank, and no silo"),
        ("vortex", "`vortex` is no family of scenes"),
    ] {
        place.write(
            "bad.toml",
            &format!("labels = \"{family}\"\n{}", text(rule)),
        );
        place
            .phase(&["sweep", "bad.toml"])
            .code(2)
            .complains(message)
            .complains("use `labels = \"tank\"`")
            .complains("--> bad.toml:1:10");
    }
}

/// The rules of a scene's own file label its runs, unless the sweep states its own.
#[test]
fn a_scene_may_bring_its_rules() {
    let place = Workplace::new();
    let rules = "[[label]]\nname = \"turning\"\nwhen = \"last(rotation) > 1e-3\"\n\
                 [[measure]]\nname = \"touching\"\nvalue = \"max(share_at_wall)\"\n";
    place.write("scene.toml", &(scene_file() + rules));
    let ran = place.phase(&["run", "scene.toml"]).code(0);
    ran.says("label          turning").says("touching");
    let json = place.phase(&["run", "scene.toml", "--json"]).code(0).stdout;
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["label"], "turning");
    assert!(json["measures"]["turning_margin"].as_f64().unwrap() > 0.0);

    let axis = "[[axis]]\nkey = \"swirl.omega\"\nvalues = [0.0, 4.0]\n";
    let sweep = format!("scene = \"scene.toml\"\n{axis}");
    place.write("own.toml", &sweep);
    place.phase(&["sweep", "own.toml"]).code(0).says("turning");
    let rows = cells(&place, "results/own/labels.csv", &["label", "touching"]);
    assert_eq!(rows.len(), 2);
    assert!(
        rows.iter()
            .all(|row| ["turning", "other"].contains(&&*row[0]))
    );
    assert!(rows.iter().all(|row| row[1].parse::<f64>().is_ok()));

    place.write("sieved.toml", &format!("labels = \"tank\"\n{sweep}"));
    place.phase(&["sweep", "sieved.toml"]).code(0);
    let rows = cells(
        &place,
        "results/sieved/labels.csv",
        &["label", "settle_time"],
    );
    assert!(rows.iter().all(|row| row[0] != "turning"));

    let bad = scene_file() + &rules.replace("1e-3", "1e-3[m]");
    place.write("scene.toml", &bad);
    for command in [["run", "scene.toml"], ["check", "own.toml"]] {
        place
            .phase(&command)
            .code(2)
            .complains("compares rad/s with m")
            .complains("--> scene.toml:");
    }
}

/// Rules read what the sieves measure.
#[test]
fn rules_read_the_measures_of_the_sieves() {
    let place = Workplace::new();
    let rule = "[[label]]\nname = \"late\"\nwhen = \"settle_time > 0.01[s]\"\n\
                [[measure]]\nname = \"half\"\nvalue = \"settle_time / 2\"\n";
    place.write("plain.toml", &text(""));
    place.write("own.toml", &text(rule));
    for name in ["plain", "own"] {
        place.phase(&["sweep", &format!("{name}.toml")]).code(0);
    }
    let plain = cells(&place, "results/plain/labels.csv", &["settle_time"]);
    let own = cells(&place, "results/own/labels.csv", &["label", "half"]);
    for (plain, own) in plain.iter().zip(&own) {
        let settled: Option<f64> = plain[0].parse().ok();
        let half: Option<f64> = own[1].parse().ok();
        assert_eq!(half, settled.map(|it| it / 2.0));
        let late = settled.is_some_and(|it| it > 0.01);
        assert_eq!(own[0], if late { "late" } else { "other" });
    }
    // Symptom: runs of which no rule holds had the labels of the sieves. Cause: the sieves, which
    // measure what the rule reads, decided about the rest.
    place.write("own.toml", &text(&rule.replace("0.01[s]", "1e6[s]")));
    place.phase(&["sweep", "own.toml"]).code(0);
    let own = cells(&place, "results/own/labels.csv", &["label"]);
    assert!(own.iter().all(|row| row[0] == "other"), "{own:?}");
    place.write("bad.toml", &text(&rule.replace("0.01[s]", "0.01[m]")));
    place
        .phase(&["sweep", "bad.toml"])
        .code(2)
        .complains("compares s with m");
}

/// A sweep that gives thresholds of sieves which its scene's rules would leave unused is refused.
#[test]
fn thresholds_of_sieves_do_not_go_with_rules_alone() {
    let place = Workplace::new();
    let rules = "[[label]]\nname = \"turning\"\nwhen = \"last(rotation) > 1e-3\"\n";
    place.write("scene.toml", &(scene_file() + rules));
    let sweep = "scene = \"scene.toml\"\n[[axis]]\nkey = \"swirl.omega\"\nvalues = [0.0, 4.0]\n\
                 [sieves.fluid]\nshare = 0.8\n";
    place.write("sweep.toml", sweep);
    place
        .phase(&["sweep", "sweep.toml"])
        .code(2)
        .complains("or give `labels = \"tank\"`");
    place.write("sweep.toml", &format!("labels = \"tank\"\n{sweep}"));
    place.phase(&["sweep", "sweep.toml", "--no-plot"]).code(0);
}

/// Symptom: `phase compare` of two records whose scenes have rules showed dashes for all measures.
/// Cause: it asked the family that the rules made for the measures of the sieves.
#[test]
fn records_with_rules_are_compared_by_all_measures() {
    let place = Workplace::new();
    let rules = "[[label]]\nname = \"turning\"\nwhen = \"last(rotation) > 1e-3\"\n\
                 [[measure]]\nname = \"lift\"\nvalue = \"max(height_mean) / spheres.radius\"\n";
    place.write("scene.toml", &(scene_file() + rules));
    for seed in ["1", "2"] {
        let out = format!("{seed}.h5");
        place
            .phase(&["run", "scene.toml", "--seed", seed, "--out", &out])
            .code(0);
    }
    let answer = place.phase(&["compare", "1.h5", "2.h5", "--json"]).code(0);
    let json: serde_json::Value = serde_json::from_str(&answer.stdout).unwrap();
    let rows = json["rows"].as_array().unwrap();
    for name in ["packing height", "lift"] {
        let row = rows.iter().find(|row| row["quantity"] == name);
        let row = row.unwrap_or_else(|| panic!("{name}: {rows:?}"));
        assert!(row["values"][0].is_number(), "{row}");
    }
    place
        .phase(&["compare", "1.h5", "2.h5"])
        .code(0)
        .says("turning");
}

/// Symptom: dumps of a scene with rules could not be labelled. Cause: the table was of the family
/// without rules.
#[test]
fn dumps_are_labelled_by_the_rules_of_their_scene() {
    let place = Workplace::new();
    let rules = "[[label]]\nname = \"high\"\nwhen = \"max(height_mean) > -1\"\n";
    place.write("scene.toml", &(scene_file() + rules));
    let run = ["run", "scene.toml", "--trajectory", "--out", "run.h5"];
    place.phase(&run).code(0);
    place
        .phase(&["export", "run.h5", "--to", "dump", "--out", "dumps"])
        .code(0);
    place
        .phase(&["classify", "dumps", "--scene", "scene.toml"])
        .code(0);
    let rows = cells(&place, "dumps/labels.csv", &["label"]);
    assert_eq!(rows, [["high"]]);
    // Names that do not fit leave the tables as they were.
    place
        .phase(&[
            "classify",
            "dumps",
            "--scene",
            "scene.toml",
            "--names",
            "x@{seed}.npy",
        ])
        .code(1)
        .complains("its tables were left unchanged");
    assert_eq!(cells(&place, "dumps/labels.csv", &["label"]), rows);
}

/// Symptom: a table of labels had two columns `stagnant_value`. Cause: the evidence of a rule that
/// stays was not looked at.
#[test]
fn evidence_has_names_of_its_own() {
    let place = Workplace::new();
    place.write("scene.toml", &drainage_file());
    let sweep = |name: &str| {
        format!(
            "scene = \"scene.toml\"\nlabels = \"drainage\"\n[[label]]\nname = \"{name}\"\n\
             when = \"left_share > 0.5\"\n[[axis]]\nkey = \"spot.diffusion_length\"\n\
             values = [2.0, 2.5]\n"
        )
    };
    for name in ["stagnant", "drained"] {
        place.write("sweep.toml", &sweep(name));
        place
            .phase(&["check", "sweep.toml", "--no-trial"])
            .code(2)
            .complains(&format!("has a column `{name}_value` already"));
    }
    place.write("sweep.toml", &sweep("emptied"));
    place.phase(&["check", "sweep.toml", "--no-trial"]).code(0);
}

/// Rules label all runs alike.
#[test]
fn variants_do_not_change_rules() {
    let place = Workplace::new();
    let rules = "[[label]]\nname = \"high\"\nwhen = \"max(height_mean) > -1\"\n";
    place.write("scene.toml", &(scene_file() + rules));
    let sweep = "scene = \"scene.toml\"\n[[variant]]\nname = \"as-it-is\"\n\
                 [[variant]]\nname = \"unlabelled\"\nwithout = [\"label\"]\n";
    place.write("sweep.toml", sweep);
    place
        .phase(&["check", "sweep.toml", "--no-trial"])
        .code(2)
        .complains("unlabelled changes rules, which label all runs alike");
}

/// Symptom: folders from before two sieves became rules were refused. Cause: `sweep.json` still has
/// their keys.
#[test]
fn folders_with_former_sieves_are_read() {
    let place = Workplace::new();
    place.write("tiny.toml", &text(""));
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    let json = place.read("results/tiny/sweep.json");
    let (before, after) = json.split_once("\"arching\"").unwrap();
    let old =
        |share: &str| format!("{before}\"emptied\": {{\"share\": {share}}}, \"arching\"{after}");
    place.write("results/tiny/sweep.json", &old("0.95"));
    place
        .phase(&["status", "results/tiny"])
        .code(0)
        .says("6 done");
    place.phase(&["classify", "results/tiny"]).code(0);
    // Another threshold needs a rule, which nobody can guess.
    place.write("results/tiny/sweep.json", &old("0.5"));
    place
        .phase(&["status", "results/tiny"])
        .code(1)
        .complains("unknown field `emptied`");
}
