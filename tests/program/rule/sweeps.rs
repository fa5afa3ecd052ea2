//! Sweeps whose runs are labelled and measured by rules of their own file.

use crate::support::{TinySweep, Workplace};

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

pub(super) fn text(rules: &str) -> String {
    format!(
        "{}{}",
        TinySweep::default().text(),
        rules.replace("\"009", "\"#009")
    )
}

/// The columns of a table by their names, row by row.
pub(crate) fn cells(place: &Workplace, table: &str, names: &[&str]) -> Vec<Vec<String>> {
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
    let found = |over: &str| -> (String, Option<f64>) {
        place.write("tiny.toml", &text(&label(over)));
        place
            .phase(&["sweep", "tiny.toml", "--no-plot", "--force"])
            .code(0);
        let names = ["label", "high_since"];
        let row = cells(&place, "results/tiny/labels.csv", &names).remove(0);
        (row[0].clone(), row[1].parse().ok())
    };
    // Frames are 0.01 s apart.
    for (over, label, since) in [
        ("{ any = 0.5 }", "high", Some(0.71)),
        ("{ any = 0.8 }", "other", None),
        ("{ from = 0.8, to = 1.3 }", "high", Some(0.8)),
    ] {
        let (found, at) = found(over);
        assert_eq!(found, label, "{over}");
        assert_eq!(at.is_some(), since.is_some(), "{over}");
        let near = |(one, other): (f64, f64)| (one - other).abs() < 1e-9;
        assert!(at.zip(since).is_none_or(near), "{over}: {at:?}");
    }
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
