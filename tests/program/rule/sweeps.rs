//! Sweeps whose runs are labelled and measured by rules of their own file.

use crate::support::{TinySweep, Workplace, scene_file};

/// Two labels by their rules, and two measures.
const RULES: &str = r#"
[[label]]
name = "turning-fast"
when = "mean(rotation) > 0.5[rad/s]"
over = { last = 0.5 }
color = "009e73"

[[label]]
name = "turning"
when = "mean(rotation) > 1e-3 and not mean(rotation) > 0.5"
over = { last = 0.5 }

[[measure]]
name = "lift"
value = "max(height_mean) / spheres.radius"

[[measure]]
name = "spin_up"
value = "trend(rotation)"
over = { from = 0.0, to = 1.0 }
quantity = "spin-up"
"#;

fn text(rules: &str) -> String {
    format!(
        "{}{}",
        TinySweep::default().text(),
        rules.replace("\"009", "\"#009")
    )
}

/// The columns of a table by their names, row by row.
fn cells(place: &Workplace, table: &str, names: &[&str]) -> Vec<Vec<String>> {
    let text = place.read(table);
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let place = |name: &&str| header.iter().position(|it| it == name).unwrap();
    let places: Vec<usize> = names.iter().map(place).collect();
    let row = |line: Vec<&str>| places.iter().map(|&it| line[it].to_owned()).collect();
    lines.map(row).collect()
}

#[test]
fn runs_are_labelled_by_the_rules_of_their_file() {
    let place = Workplace::new();
    place.write("tiny.toml", &text(RULES));
    place
        .phase(&["sweep", "tiny.toml"])
        .code(0)
        .says("6 runs labelled");
    let table = "results/tiny/labels.csv";
    let names = [
        "label",
        "turning_fast_margin",
        "turning_margin",
        "lift",
        "spin_up",
    ];
    let rows = cells(&place, table, &names);
    assert_eq!(rows.len(), 6);
    for row in &rows {
        let numbers: Vec<f64> = row[1..].iter().map(|it| it.parse().unwrap()).collect();
        let expected = match (numbers[0] > 0.0, numbers[1] > 0.0) {
            (true, _) => "turning-fast",
            (false, true) => "turning",
            (false, false) => "other",
        };
        assert_eq!(row[0], expected, "{row:?}");
    }
    let labels: std::collections::BTreeSet<&String> = rows.iter().map(|row| &row[0]).collect();
    assert!(labels.len() > 1, "{rows:?}");

    // The maps of measures and margins are figures, and the phase diagram has the colours.
    place
        .phase(&[
            "plot",
            "results/tiny",
            "-f",
            "lift",
            "-f",
            "turning-fast-margin",
        ])
        .code(0)
        .says("lift.png")
        .says("turning-fast-margin.svg");
    assert!(place.read("results/tiny/lift.svg").contains("lift"));
    place
        .phase(&["plot", "results/tiny", "-f", "lifft"])
        .code(2)
        .complains("there is no figure `lifft`");

    // Records stay as they were without rules, and other thresholds make no run.
    place.write("plain.toml", &text(""));
    place
        .phase(&["sweep", "plain.toml", "--out", "plain"])
        .code(0);
    assert_eq!(place.digests("plain"), place.digests("results/tiny"));
    place.write(
        "moved.toml",
        &text(&RULES.replace("> 0.5[rad/s]", "> -1e9")),
    );
    place
        .phase(&["classify", "results/tiny", "--sweep", "moved.toml"])
        .code(0)
        .says("6 runs labelled");
    assert!(
        cells(&place, table, &["label"])
            .iter()
            .all(|row| row[0] == "turning-fast")
    );
    place
        .phase(&["status", "results/tiny"])
        .code(0)
        .says("6 done");
}

/// Without labels of its own the file is labelled by the sieves, and all figures stay.
#[test]
fn measures_go_beside_the_sieves() {
    let place = Workplace::new();
    place.write("plain.toml", &text(""));
    let measures = RULES.split("[[measure]]").skip(1);
    let measures: String = measures.map(|it| format!("[[measure]]{it}")).collect();
    place.write("tiny.toml", &text(&measures));
    for name in ["plain", "tiny"] {
        place.phase(&["sweep", &format!("{name}.toml")]).code(0);
    }
    let [plain, own] = ["plain", "tiny"].map(|it| {
        cells(
            &place,
            &format!("results/{it}/labels.csv"),
            &["id", "label", "code"],
        )
    });
    assert_eq!(plain, own);
    let lifts = cells(&place, "results/tiny/labels.csv", &["lift"]);
    assert!(lifts.iter().all(|row| row[0].parse::<f64>().is_ok()));
    place
        .phase(&["plot", "results/tiny", "-f", "settle-time", "-f", "spin-up"])
        .code(0);
}

/// Folders with other thresholds are compared with a word, folders with other labels are not.
#[test]
fn folders_with_other_rules_are_told_apart() {
    let place = Workplace::new();
    let rules = |old: &str, new: &str| text(RULES).replacen(old, new, 1);
    for (name, text) in [
        ("one", text(RULES)),
        ("moved", rules("> 0.5[rad/s]", "> 0.7")),
        ("renamed", rules("\"turning-fast\"", "\"quick\"")),
    ] {
        place.write("tiny.toml", &text);
        place
            .phase(&["sweep", "tiny.toml", "--out", name, "--no-plot"])
            .code(0);
    }
    place
        .phase(&["compare", "one", "moved"])
        .code(0)
        .complains("the rules of their labels and measures differ");
    place
        .phase(&["compare", "one", "renamed"])
        .code(2)
        .complains("their files state different labels or measures");
}

/// Rounds follow the labels of rules.
#[test]
fn refined_sweeps_follow_rules() {
    let place = Workplace::new();
    let label = "[[label]]\nname = \"fast\"\nwhen = \"swirl.omega > 7\"\n";
    place.write("tiny.toml", &(crate::shards::refined() + label));
    place.phase(&["sweep", "tiny.toml"]).code(0).says("fast");
    let borders = cells(&place, "results/tiny/borders.csv", &["low_95", "high_95"]);
    assert_eq!(borders.len(), 1, "{borders:?}");
    let [low, high]: [f64; 2] = [0, 1].map(|it| borders[0][it].parse().unwrap());
    assert!(low < 7.5 && high > 6.5, "{low} {high}");
}

/// What is wrong with rules is said before any run, with its place.
#[test]
fn bad_rules_are_refused_with_their_place() {
    let place = Workplace::new();
    for (good, bad, message) in [
        (
            "mean(rotation) > 0.5[rad/s]",
            "mean(rotations) > 0.5",
            "write `rotation`",
        ),
        (
            "mean(rotation) > 0.5[rad/s]",
            "rotation > 0.5",
            "reduce it over time",
        ),
        (
            "mean(rotation) > 0.5[rad/s]",
            "mean(rotation)",
            "a number stands where a condition is needed",
        ),
        ("> 0.5[rad/s]", "> 0.5[m]", "compares rad/s with m"),
        (
            "\"turning-fast\"",
            "\"Fast\"",
            "use small letters, digits and `-`",
        ),
        (
            "\"turning-fast\"",
            "\"fluid\"",
            "`fluid` is a label of the program",
        ),
        (
            "\"turning-fast\"",
            "\"turning\"",
            "another label has the name `turning` already",
        ),
        ("\"lift\"", "\"seed\"", "has a column `seed` already"),
        (
            "\"lift\"",
            "\"turning_value\"",
            "has a column `turning_value` already",
        ),
        ("last = 0.5", "last = 99.0", "runs end after 2 s"),
        (
            "last = 0.5",
            "steady = true",
            "do not end when they are steady",
        ),
        (
            "last = 0.5",
            "last = 0.5, to = 1.0",
            "is not said in one way",
        ),
        ("to = 1.0", "to = 0.0", "must be a number above 0, but is 0"),
        ("#009e73", "green", "this is no colour"),
        (
            "[[measure]]",
            "[sieves.fluid]\n[[measure]]",
            "remove [sieves], or [[label]]",
        ),
        (
            "value = \"trend",
            "values = \"trend",
            "did you mean `value`?",
        ),
    ] {
        let rules = text(RULES);
        assert!(rules.contains(good), "{good}");
        place.write("tiny.toml", &rules.replacen(good, bad, 1));
        place
            .phase(&["sweep", "tiny.toml"])
            .code(2)
            .complains(message)
            .complains("--> tiny.toml:");
        assert!(!place.path("results").exists());
    }
}

/// A column that runs of the scene cannot have is refused before any run.
#[test]
fn columns_that_the_scene_cannot_have_are_refused() {
    let place = Workplace::new();
    for (column, why) in [
        ("discharged", "spheres come and go only through"),
        ("residual", "only with `output.ledger = true`"),
    ] {
        let when = format!("last({column}) > 3");
        let label = format!("[[label]]\nname = \"leaving\"\nwhen = \"{when}\"\n");
        place.write("tiny.toml", &text(&label));
        place
            .phase(&["sweep", "tiny.toml"])
            .code(2)
            .complains(&format!("runs of this scene have no column `{column}`"))
            .complains("     ^")
            .complains(why);
    }
}

/// A record without a column that a rule reads is named, and the sweep with this rule makes those
/// runs again that lack it, but none twice.
#[test]
fn further_columns_are_asked_for_by_rules() {
    let place = Workplace::new();
    place.write("tiny.toml", &text(""));
    place.phase(&["sweep", "tiny.toml"]).code(0);
    let plain = place.digests("results/tiny");
    let rule = "[[measure]]\nname = \"touching\"\nvalue = \"max(share_at_wall)\"\n";
    place.write("touching.toml", &text(rule));
    place
        .phase(&["classify", "results/tiny", "--sweep", "touching.toml"])
        .code(1)
        .complains("the rule \"touching\" reads `share_at_wall`, which this record lacks");
    let sweep = ["sweep", "touching.toml", "--out", "results/tiny"];
    place.phase(&sweep).code(0).says("6 runs labelled");
    let touching = cells(&place, "results/tiny/labels.csv", &["touching"]);
    assert!(
        touching
            .iter()
            .all(|row| (0.0..=1.0).contains(&row[0].parse::<f64>().unwrap()))
    );
    let made = place.digests("results/tiny");
    assert_ne!(plain, made);

    // One record is made without the column again: only this one is run.
    let records = place.records("results/tiny");
    place
        .phase(&["sweep", "tiny.toml", "--out", "plain"])
        .code(0);
    let one = &records[0];
    std::fs::copy(
        place.path(&format!("plain/records/{one}")),
        place.path(&format!("results/tiny/records/{one}")),
    )
    .unwrap();
    place
        .phase(&sweep)
        .code(0)
        .complains("5 of 6 jobs are done already");
    assert_eq!(place.digests("results/tiny"), made);

    // A sweep that does not need the column any more takes the records as they are.
    let sweep = ["sweep", "tiny.toml", "--out", "results/tiny"];
    place
        .phase(&sweep)
        .code(0)
        .complains("6 of 6 jobs are done already");
    assert_eq!(place.digests("results/tiny"), made);
}

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

/// A rule may look for a window anywhere in the run, and tells where it begins.
#[test]
fn a_window_anywhere_tells_since_when() {
    let place = Workplace::new();
    let label = |over: &str| {
        format!(
            "[[label]]\nname = \"high\"\nwhen = \"min(time) > 0.705 and max(time) < 1.4\"\n\
             over = {over}\n"
        )
    };
    let numbers = |over: &str| -> Vec<String> {
        place.write("tiny.toml", &text(&label(over)));
        place
            .phase(&["sweep", "tiny.toml", "--no-plot", "--force"])
            .code(0);
        let names = ["label", "high_since"];
        cells(&place, "results/tiny/labels.csv", &names).remove(0)
    };
    // Frames are 0.01 s apart.
    assert_eq!(numbers("{ any = 0.5 }"), ["high", "0.71"]);
    assert_eq!(numbers("{ any = 0.8 }"), ["other", ""]);
    assert_eq!(numbers("{ from = 0.8, to = 1.3 }"), ["high", "0.8"]);
    let measure = "[[measure]]\nname = \"x\"\nvalue = \"pi * max(time)\"\nover = { any = 0.5 }\n";
    place.write("tiny.toml", &text(measure));
    place
        .phase(&["sweep", "tiny.toml"])
        .code(2)
        .complains("a measure is one number, and there are many windows");
    place.write("tiny.toml", &text(&measure.replace("any", "last")));
    place.phase(&["sweep", "tiny.toml", "--no-plot"]).code(0);
    let value: f64 = cells(&place, "results/tiny/labels.csv", &["x"])[0][0]
        .parse()
        .unwrap();
    assert!((value - 2.0 * std::f64::consts::PI).abs() < 1e-6, "{value}");
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

/// With `usual = "needed"` only what rules read is recorded; rules that read more make runs again.
#[test]
fn only_needed_columns_are_recorded() {
    let place = Workplace::new();
    let rule = "[[label]]\nname = \"high\"\nwhen = \"last(height_mean) > -0.1\"\n";
    let needed = "[scene.output]\nusual = \"needed\"\n";
    place.write("all.toml", &text(rule));
    place.write("few.toml", &(text(rule) + needed));
    for name in ["all", "few"] {
        place.phase(&["sweep", &format!("{name}.toml")]).code(0);
    }
    place
        .phase(&["check", "few.toml", "--no-trial"])
        .code(0)
        .says("of the usual ones only height_mean")
        .says("without the figures speeds, energies, state-energies");
    let table = |name: &str| {
        let table = format!("results/{name}/labels.csv");
        cells(&place, &table, &["id", "label", "high_value"])
    };
    assert_eq!(table("all"), table("few"));
    let columns = |name: &str| {
        let record = &place.records(&format!("results/{name}"))[0];
        let path = place.path(&format!("results/{name}/records/{record}"));
        let observations = phase::store::read_record(&path).unwrap().observations;
        let names = observations.scalars();
        let names: Vec<String> = names.iter().map(|it| it.name.to_owned()).collect();
        (
            names,
            observations.profile.ncols(),
            observations.rising.len(),
        )
    };
    assert_eq!(
        columns("few").0,
        ["height_mean", "height_max", "speed_mean"]
    );
    assert_eq!((columns("few").1, columns("few").2), (0, 0));
    assert!(columns("all").0.len() > 8);
    place
        .phase(&["plot", "results/few", "-f", "energies"])
        .code(1)
        .complains("shows `kinetic`, and the scene records only");
    place
        .phase(&["plot", "results/all", "-f", "energies"])
        .code(0);

    // Sieves read all, and say so; a rule that reads another column makes the runs again.
    place.write("sieves.toml", &text(""));
    place
        .phase(&["classify", "results/few", "--sweep", "sieves.toml"])
        .code(1)
        .complains("`output.usual`");
    place.write(
        "more.toml",
        &text(&rule.replace("height_mean", "hole_radius")),
    );
    place
        .phase(&["sweep", "more.toml", "--out", "results/few", "--no-plot"])
        .code(0)
        .says("6 runs labelled");
    assert!(columns("few").0.contains(&"hole_radius".to_owned()));
    // What has more than is needed stays.
    place
        .phase(&["sweep", "few.toml", "--no-plot"])
        .code(0)
        .complains("6 of 6 jobs are done already");
}
