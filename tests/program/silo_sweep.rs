//! The quick sweep of the silo through the program: run, labelled, drawn, labelled again.

use crate::support::{TinySweep, Workplace};
use phase::classify::{Label, SILO};
use phase::store::read_labels;

const FOLDER: &str = "results/silo-quick";

/// A workplace with the sweep that is shipped, and its results.
fn swept() -> Workplace {
    let place = Workplace::new();
    let shipped = |name: &str| {
        let root = env!("CARGO_MANIFEST_DIR");
        std::fs::read_to_string(format!("{root}/sweeps/{name}")).unwrap()
    };
    std::fs::create_dir(place.path("scenes")).unwrap();
    for name in ["silo-quick.toml", "scenes/silo-hopper.toml"] {
        place.write(name, &shipped(name));
    }
    place.phase(&["sweep", "silo-quick.toml"]).code(0);
    place
}

#[test]
#[ignore = "takes forty seconds"]
fn the_quick_sweep_has_all_states_and_its_figures() {
    let place = swept();
    let table = read_labels(&place.path(&format!("{FOLDER}/labels.csv"))).unwrap();
    assert_eq!(table.family, &SILO);
    for label in [Label::ARCHING, Label::FLOWING, Label::EMPTIED] {
        assert!(
            table.rows.iter().any(|row| row.verdict.label == label),
            "{label:?}"
        );
    }
    for row in &table.rows {
        let value = |name: &str| row.verdict.value(name);
        let packing = value("packing_fraction").unwrap();
        assert!((0.80..0.92).contains(&packing), "{packing}");
        let rate = value("discharge_rate");
        // Between 20 and 80 % of the grains.
        let left = value("discharged_share").unwrap();
        assert_eq!(rate.is_some(), left >= 0.8, "{left}");
        // Grains of 1.6 g.
        let mass_rate = value("mass_rate").unwrap_or(0.0);
        assert!((mass_rate - 1.6e-3 * rate.unwrap_or(0.0)).abs() < 1e-3 * mass_rate.max(1e-9));
    }
    for figure in ["phase", "discharge-rate"] {
        assert!(
            place.path(&format!("{FOLDER}/{figure}.png")).exists(),
            "{figure}"
        );
    }
    assert!(!place.path(&format!("{FOLDER}/settle-time.png")).exists());

    let list = place.phase(&["plot", "--list", FOLDER]).code(0).stdout;
    assert!(list.contains("packing-fraction"), "{list}");
    // Too few openings let grains out for a fit.
    assert!(!list.contains("beverloo"), "{list}");
    assert!(
        !list.contains("hole-radius") && !list.contains("tracks"),
        "{list}"
    );
    place
        .phase(&["plot", FOLDER, "--figure", "settle-time"])
        .code(2)
        .complains("is not a figure of a silo");

    place
        .phase(&["classify", FOLDER])
        .code(0)
        .says("0 of 6 labels changed");
    let text = place.read("silo-quick.toml");
    place.write(
        "edited.toml",
        &format!("{text}\n[sieves.flowing]\nleast = 500\n"),
    );
    place
        .phase(&["classify", FOLDER, "--sweep", "edited.toml"])
        .code(0)
        .says("flowing -> unsettled");
    place.write(
        "wrong.toml",
        &format!("{text}\n[sieves.spout]\nleast = 5\n"),
    );
    place
        .phase(&["check", "wrong.toml"])
        .code(2)
        .complains("`sieves.spout` is not a sieve of a silo");
}

#[test]
fn a_tank_is_offered_no_figure_of_a_silo() {
    let place = Workplace::new();
    place.write("tiny.toml", &TinySweep::default().text());
    place.phase(&["sweep", "tiny.toml"]).code(0);
    let list = place
        .phase(&["plot", "--list", "results/tiny"])
        .code(0)
        .stdout;
    assert!(
        list.contains("hole-radius") && !list.contains("beverloo"),
        "{list}"
    );
    place
        .phase(&["plot", "results/tiny", "--figure", "packing-fraction"])
        .code(2)
        .complains("is not a figure of a tank");
}
