//! The columns that runs record: further ones because rules read them, profiles, or only those that
//! are needed.

use super::sweeps::{cells, text};
use crate::support::{Workplace, scene_file};

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
    // Symptom: `check` and `cost` of a scene file took all columns. Cause: only runs chose them.
    place.write(
        "scene.toml",
        &(scene_file() + rule + "[output]\nusual = \"needed\"\n"),
    );
    place
        .phase(&["check", "scene.toml", "--no-trial"])
        .code(0)
        .says("of the usual ones only height_mean");
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
    assert_eq!(columns("few").0, ["height_mean", "height_max"]);
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

/// Bins of profiles are columns that rules read.
#[test]
fn profiles_are_columns_of_their_bins() {
    let place = Workplace::new();
    let profile = "[[scene.output.profiles]]\nof = \"count\"\nover = \"height\"\n\
                   from = -1.0\nto = 1.0\nbins = 2\n";
    let rule = "[[measure]]\nname = \"all\"\n\
                value = \"last(count_height_1) + last(count_height_2)\"\n";
    place.write("plain.toml", &text(""));
    place.write("tiny.toml", &(text(rule) + profile));
    for name in ["plain", "tiny"] {
        place.phase(&["sweep", &format!("{name}.toml")]).code(0);
    }
    let all = cells(&place, "results/tiny/labels.csv", &["id", "label", "all"]);
    let plain = cells(&place, "results/plain/labels.csv", &["id", "label"]);
    for (plain, all) in plain.iter().zip(&all) {
        assert_eq!(plain[..], all[..2]);
        // Every sphere is in one of the bins.
        assert_eq!(all[2], "8.0");
    }
    for (good, bad, message) in [
        (
            "bins = 2",
            "bins = 0",
            "must be a whole number of at least 1",
        ),
        ("bins = 2", "bins = 1000000000", "bins are too many"),
        ("to = 1.0", "to = -2.0", "does not end above the beginning"),
        (
            "\"height\"",
            "\"radius\"",
            "a distance from the axis is not below 0",
        ),
        ("\"count\"", "\"speed\"", "velocity_x"),
        ("count_height_2", "count_height_3", "write `count_height_"),
    ] {
        let file = (text(rule) + profile).replace(good, bad);
        place.write("bad.toml", &file);
        place
            .phase(&["check", "bad.toml"])
            .code(2)
            .complains(message);
    }
}

/// Forces on walls are columns by the names of walls. A sweep that asks for them, or renames a wall,
/// makes its runs again, and no others.
#[test]
fn forces_on_walls_are_columns_that_rules_read() {
    let place = Workplace::new();
    let wall = "[[scene.wall]]\nname = \"lid\"\ndisc = { centre = [0, 0, 0.2], radius = 0.02 }\n\
                [scene.output]\nwalls = true\n";
    let rule = "[[measure]]\nname = \"weight\"\nvalue = \"mean(floor_force_z) / 1[N]\"\n\
                [[measure]]\nname = \"lid_weight\"\nvalue = \"max(lid_force_z)\"\n";
    let asking = text(rule) + wall;
    place.write("plain.toml", &(text("") + &wall.replace("true", "false")));
    place.write("tiny.toml", &asking);
    for name in ["plain", "tiny"] {
        place
            .phase(&["sweep", &format!("{name}.toml"), "--out", "results/tiny"])
            .code(0);
    }
    let rows = cells(&place, "results/tiny/labels.csv", &["weight", "lid_weight"]);
    for row in &rows {
        // Eight spheres, of which some fall from time to time.
        let weight: f64 = row[0].parse().unwrap();
        assert!((weight / -0.0789 - 1.0).abs() < 0.1, "{weight}");
        assert_eq!(row[1], "0.0");
    }
    let renamed = asking
        .replace("\"lid\"", "\"cover\"")
        .replace("lid_force_z", "cover_force_z");
    place.write("tiny.toml", &renamed);
    let sweep = ["sweep", "tiny.toml", "--out", "results/tiny"];
    place.phase(&sweep).code(0).says("6 runs labelled");
    place
        .phase(&sweep)
        .code(0)
        .complains("6 of 6 jobs are done already");

    for (good, bad, message) in [
        (
            "walls = true",
            "walls = false",
            "only with `output.walls = true`",
        ),
        ("lid_force_z", "roof_force_z", "neither a column"),
        (
            "floor_force_z) / 1[N]",
            "floor_force_z) + 1[m]",
            "adds m to N",
        ),
    ] {
        assert!(asking.contains(good));
        place.write("bad.toml", &asking.replace(good, bad));
        place
            .phase(&["check", "bad.toml"])
            .code(2)
            .complains(message);
    }
}
