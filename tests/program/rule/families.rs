//! How rules go with families of scenes: alone, before sieves, from a scene's own file.

use super::sweeps::{cells, text};
use crate::support::{Workplace, scene_file};

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
