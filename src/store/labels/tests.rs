use super::*;
use crate::classify::{Label, SILO, TANK};
use proptest::prelude::*;

fn in_file<T>(content: &str, read: impl FnOnce(&Path) -> T) -> T {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("labels.csv");
    std::fs::write(&path, content).unwrap();
    read(&path)
}

fn written(table: &LabelTable, write: fn(&LabelTable, &Path) -> Result<(), StoreError>) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("labels.csv");
    write(table, &path).unwrap();
    std::fs::read_to_string(&path).unwrap()
}

fn example() -> LabelTable {
    let row = |seed, label, settle_time| LabelRow {
        id: format!("0123456789abcde{seed}"),
        values: vec![0.1 + 0.2, 40.0],
        seed,
        verdict: Verdict::unmeasured(&TANK, label)
            .with("settle_time", settle_time)
            .and_then(|it| it.with("fluid_margin", Some(-0.9)))
            .and_then(|it| it.with("spout_count", Some(1e-300)))
            .unwrap(),
    };
    LabelTable {
        family: &TANK,
        axes: vec!["radius".to_owned(), "omega".to_owned()],
        variants: Vec::new(),
        rows: vec![
            row(1, Label::PINNED, Some(0.25)),
            row(2, Label::SMALL_SPOUT, None),
            row(3, Label::PINNED, Some(0.75)),
        ],
    }
}

#[test]
fn a_table_looks_as_documented() {
    let text = written(&example(), write_labels);
    let mut lines = text.lines();
    assert_eq!(
        lines.next().unwrap(),
        "id,radius,omega,seed,label,code,settle_time,settle_change,settle_drift,fluid_share,\
         fluid_margin,pinned_share,pinned_margin,spout_share,spout_margin,spout_peak,hole_radius,\
         paraboloid_rotation,paraboloid_residual,rotation,mobility,packing_height,spout_count"
    );
    assert_eq!(
        lines.next().unwrap(),
        "0123456789abcde1,0.30000000000000004,40.0,1,pinned,3,0.25,\
         ,,,-0.9,,,,,,,,,,,,1e-300"
    );
    assert!(lines.next().unwrap().contains(",2,small-spout,4,,,"));
}

#[test]
fn tables_of_runs_that_end_when_they_are_steady_say_which_did() {
    let mut table = example();
    table.rows[0].verdict.steady = Some(true);
    table.rows[2].verdict.steady = Some(false);
    let text = written(&table, write_labels);
    let mut lines = text.lines();
    let head = "id,radius,omega,seed,label,code,steady,settle_time,";
    assert!(lines.next().unwrap().starts_with(head));
    for start in [
        "1,pinned,3,true,0.25,",
        "2,small-spout,4,,,",
        "3,pinned,3,false,0.75,",
    ] {
        let line = lines.next().unwrap();
        assert!(line.contains(&format!(",40.0,{start}")), "{line}");
    }
    assert_eq!(in_file(&text, read_labels).unwrap(), table);
    let wrong = in_file(&text.replace(",true,", ",perhaps,"), read_labels).unwrap_err();
    assert!(
        wrong
            .to_string()
            .contains("column `steady`: `perhaps` is not true or false"),
        "{wrong}"
    );
    let points = table.points();
    assert!(points.iter().any(|it| table.is_unsteady(it)));
    assert!(!example().is_unsteady(&points[0]));
}

#[test]
fn points_put_the_seeds_together() {
    assert_eq!(
        written(&example(), write_points),
        "radius,omega,label,code,agreement,seeds\n\
         0.30000000000000004,40.0,pinned,3,0.6666666666666666,3\n"
    );
}

#[test]
fn a_malformed_table_is_refused_with_line_and_reason() {
    let good = written(&example(), write_labels);
    for (from, to, message) in [
        (
            ",2,small-spout,4,",
            ",2,small-spout,4",
            "labels.csv:3: 22 values, but the header line names 23 columns",
        ),
        (
            ",40.0,1,",
            ",forty,1,",
            "labels.csv:2: column `omega`: `forty` is not a number",
        ),
        (
            ",40.0,3,",
            ",40.0,-3,",
            "labels.csv:4: column `seed`: `-3` is not a whole number",
        ),
        (
            "small-spout",
            "spout",
            "labels.csv:3: `spout` is not a label of a tank",
        ),
        (
            "small-spout,4",
            "arching,6",
            "labels.csv:3: `arching` is not a label of a tank",
        ),
        (
            "small-spout,4",
            "small-spout,5",
            "labels.csv:3: label `small-spout` does not have code 5",
        ),
        (
            "0.25",
            "soon",
            "labels.csv:2: column `settle_time`: `soon` is not a number",
        ),
        (
            "-0.9",
            "x",
            "labels.csv:2: column `fluid_margin`: `x` is not a number",
        ),
        (
            "settle_change",
            "change",
            "labels.csv:1: this is not the header line of a table of labels",
        ),
        (
            "id,",
            "",
            "labels.csv:1: this is not the header line of a table of labels",
        ),
    ] {
        let bad = good.replacen(from, to, 1);
        assert_ne!(bad, good);
        let found = in_file(&bad, read_labels).unwrap_err().to_string();
        assert!(found.contains(message), "{found}\nis not\n{message}");
    }
    assert!(in_file("", read_labels).is_err());
}

#[test]
fn a_row_of_too_few_values_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("labels.csv");
    let mut table = example();
    table.rows[1].values.pop();
    let message = write_labels(&table, &path).unwrap_err().to_string();
    assert!(message.contains("labels.csv"), "{message}");
    assert!(!path.exists());
}

fn silo() -> LabelTable {
    let row = |seed, label, rate| LabelRow {
        id: format!("0123456789abcde{seed}"),
        values: vec![0.24],
        seed,
        verdict: Verdict::unmeasured(&SILO, label)
            .with("arching_pause", Some(2.5))
            .and_then(|it| it.with("discharge_rate", rate))
            .unwrap(),
    };
    LabelTable {
        family: &SILO,
        axes: vec!["opening".to_owned()],
        variants: Vec::new(),
        rows: vec![
            row(1, Label::ARCHING, None),
            row(2, Label::EMPTIED, Some(29.7)),
        ],
    }
}

#[test]
fn a_table_of_a_silo_has_columns_of_its_own() {
    let text = written(&silo(), write_labels);
    let mut lines = text.lines();
    assert_eq!(
        lines.next().unwrap(),
        "id,opening,seed,label,code,emptied_value,emptied_threshold,emptied_margin,arching_pause,\
         arching_margin,over_opening,flowing_count,flowing_margin,rest_time,heap_height,\
         packing_fraction,coordination,discharge_rate,mass_rate,discharged_share,emptying_time"
    );
    assert_eq!(
        lines.next().unwrap(),
        "0123456789abcde1,0.24,1,arching,6,,,,2.5,,,,,,,,,,,,"
    );
    assert!(lines.next().unwrap().contains(",2,emptied,8,,,,2.5,"));
    let wrong = text.replace("arching,6", "settled,1");
    let found = in_file(&wrong, read_labels).unwrap_err().to_string();
    assert!(
        found.contains("labels.csv:2: `settled` is not a label of a silo"),
        "{found}"
    );
}

#[test]
fn a_row_of_another_family_is_not_written() {
    let mut mixed = silo();
    mixed.rows[1].verdict = example().rows[0].verdict.clone();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("labels.csv");
    let message = write_labels(&mixed, &path).unwrap_err().to_string();
    assert!(
        message.contains("a row of a tank in the table of a silo"),
        "{message}"
    );
}

fn any_row(family: &'static Family, axes: usize) -> impl Strategy<Value = LabelRow> {
    let finite = || prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO;
    (
        "[0-9a-f]{16}",
        prop::collection::vec(finite(), axes),
        any::<u64>(),
        prop::sample::select(family.labels()),
        prop::collection::vec(prop::option::of(finite()), family.measures().count()),
        any::<Option<bool>>(),
    )
        .prop_map(
            move |(id, values, seed, label, measured, steady)| LabelRow {
                id,
                values,
                seed,
                verdict: Verdict {
                    label,
                    family,
                    steady,
                    values: measured,
                },
            },
        )
}

fn any_table() -> impl Strategy<Value = LabelTable> {
    let axes = prop::collection::vec("[a-z_]{1,8}|a, \"quoted\" one|seed", 0..5);
    let family = prop::sample::select(&FAMILIES[..]);
    (axes, family).prop_flat_map(|(axes, family)| {
        let rows = prop::collection::vec(any_row(family, axes.len()), 0..6);
        rows.prop_map(move |rows| LabelTable {
            family,
            axes: axes.clone(),
            variants: Vec::new(),
            rows,
        })
    })
}

proptest! {
    // Every case makes two files durable, which takes a disk a while.
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn reads_back_the_same_bits(table in any_table()) {
        let text = written(&table, write_labels);
        let back = in_file(&text, read_labels).unwrap();
        prop_assert_eq!(&back, &table);
        prop_assert_eq!(written(&back, write_labels), text);
    }
}
