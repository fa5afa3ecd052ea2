//! `phase compare`: files of other programs, tables and folders, through the built program.

use crate::support::{Workplace, drainage_file};
use phase::record::RunRecord;
use phase::store::read_record;
use serde_json::Value;
use std::fmt::Write as _;

fn drained() -> (Workplace, RunRecord) {
    let place = Workplace::new();
    place.write("scene.toml", &drainage_file());
    place
        .phase(&["run", "scene.toml", "--out", "run.h5"])
        .code(0);
    let record = read_record(place.path("run.h5").as_ref()).unwrap();
    (place, record)
}

/// The states of a record as LAMMPS writes them, with numbers from 1; `time`: what stands for the
/// time (s) of a state.
fn lammps_dump(record: &RunRecord, time: impl Fn(f64) -> String) -> String {
    let mut text = String::new();
    for state in &record.snapshots {
        let rows = state.position.rows().into_iter().zip(1..);
        let rows: Vec<_> = rows.filter(|(row, _)| row[0].is_finite()).collect();
        write!(
            text,
            "{}ITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS ff ff ff\n\
             -9 9\n-9 9\n-9 99\nITEM: ATOMS id type x y z\n",
            time(state.time),
            rows.len()
        )
        .unwrap();
        for (row, number) in rows.iter().rev() {
            writeln!(text, "{number} 1 {:?} {:?} {:?}", row[0], row[1], row[2]).unwrap();
        }
    }
    text
}

fn with_time(time: f64) -> String {
    format!(
        "ITEM: TIMESTEP\n{}\nITEM: TIME\n{time}\n",
        5000.0 + 10.0 * time
    )
}

fn assert_equal(place: &Workplace, one: &str, other: &str) {
    let answer = place
        .phase(&["compare", one, other, "--times", "1,4", "--json"])
        .code(0);
    let answer: Value = serde_json::from_str(&answer.stdout).unwrap();
    let rows = answer["rows"].as_array().unwrap();
    let mut compared = 0;
    for row in rows.iter().filter(|it| it["quantity"] != "processor time") {
        let values = &row["values"];
        assert_eq!(values[0], values[1], "{row}");
        compared += usize::from(!values[0].is_null());
    }
    assert!(compared > 8, "{compared} numbers");
}

#[test]
fn what_other_programs_write_is_measured_alike() {
    let (place, record) = drained();
    place
        .phase(&["export", "run.h5", "--to", "xyz", "--out", "run.xyz"])
        .code(0);
    assert_equal(&place, "run.h5", "run.xyz");
    place
        .phase(&["export", "run.h5", "--to", "vtk", "--out", "run.pvd"])
        .code(0);
    assert_equal(&place, "run.h5", "run.pvd");
    let frame = "run/frame_00000.vtp";
    let timeless = place.phase(&["compare", "run.h5", frame]).code(2);
    assert!(timeless.stderr.contains(".pvd"), "{}", timeless.stderr);
    std::fs::remove_file(place.path(frame)).unwrap();
    let missing = place.phase(&["compare", "run.h5", "run.pvd"]).code(2);
    assert!(
        missing
            .stderr
            .contains("frame_00000.vtp, which run.pvd names"),
        "{}",
        missing.stderr
    );
    place.write("run.dump", &lammps_dump(&record, with_time));
    assert_equal(&place, "run.dump", "run.h5");
    // Alone it needs a scene.
    let alone = place.phase(&["compare", "run.dump"]).code(2);
    assert!(
        alone.stderr.contains("its scene with --scene"),
        "{}",
        alone.stderr
    );
    place
        .phase(&["compare", "run.dump", "--scene", "scene.toml"])
        .code(0);
    // Figures take them too.
    let plot = [
        "plot",
        "run.h5",
        "run.dump",
        "--figure",
        "radial-distribution",
        "--times",
    ];
    place.phase(&[&plot[..], &["1,4"]].concat()).code(0);
    place
        .phase(&["plot", "run.xyz", "--figure", "outflow"])
        .code(2)
        .complains("its scene with --scene");
    let plot = [
        "plot",
        "run.xyz",
        "--scene",
        "scene.toml",
        "--figure",
        "outflow",
    ];
    place.phase(&plot).code(0).says("run-outflow.png");
    // Times that do not grow.
    let twice = lammps_dump(&record, |_| with_time(1.0));
    place.write("still.dump", &twice);
    let refused = place.phase(&["compare", "run.h5", "still.dump"]).code(2);
    assert!(
        refused.stderr.contains("still.dump: state 2 is not later"),
        "{}",
        refused.stderr
    );
}

#[test]
fn points_of_a_paper_are_shown_beside_a_record() {
    let (place, _) = drained();
    place.write("paper.csv", "time,left,half\n1,20,5\n2,70,8\n3.5,150,10\n");
    let plot = |figure: &str, more: &[&str]| {
        let arguments = ["plot", "run.h5", "--figure", figure, "--name", figure];
        place.phase(&[&arguments[..], &["--data", "paper.csv"], more].concat())
    };
    plot("outflow", &[]).code(0);
    let svg = place.read("outflow-outflow.svg");
    assert!(svg.contains(">paper<"), "no entry in the legend");
    let alone = ["plot", "run.h5", "--figure", "outflow", "--name", "alone"];
    place.phase(&alone).code(0);
    let marks = |name: &str| place.read(name).matches("<circle").count();
    assert!(marks("outflow-outflow.svg") >= marks("alone-outflow.svg") + 3);
    plot("packing-map", &[])
        .code(2)
        .complains("the figure `packing-map` shows no data beside runs");
    place.write("paper.csv", "1,20\n2,many\n");
    plot("outflow", &[])
        .code(2)
        .complains("paper.csv:2: `many` is not a finite number");
    place
        .phase(&["plot", ".", "--figure", "phase", "--data", "paper.csv"])
        .code(2)
        .complains("data can be added to figures of records");
}

/// Symptom: steps of a dump beside a record of spots were taken as frames of that, and the outflow
/// was 0.03 in place of 67.
#[test]
fn steps_are_no_times_of_spots() {
    let (place, record) = drained();
    let steps = |time: f64| format!("ITEM: TIMESTEP\n{}\n", 1e4 * time);
    place.write("run.dump", &lammps_dump(&record, steps));
    place
        .phase(&["compare", "run.h5", "run.dump"])
        .code(2)
        .complains("run.dump: it counts steps, but a scene of spots has no time step");
}

/// Symptom: what a run with a door had been exported to gave another outflow than its record, as
/// the time before the opening counted. In steps from 0 it did so too.
#[test]
fn a_door_opens_in_files_of_other_programs_too() {
    let place = Workplace::new();
    place.write("silo.toml", crate::fit::ELEMENTS);
    let faster = ["--set", "time.dt=4e-4", "--set", "time.duration=3"];
    let run = ["run", "silo.toml", "--out", "run.h5"];
    place.phase(&[&run[..], &faster].concat()).code(0);
    let record = read_record(place.path("run.h5").as_ref()).unwrap();
    let dt = record.scene.time.dt;
    let steps = |time: f64| format!("ITEM: TIMESTEP\n{}\n", (time / dt).round());
    place.write("steps.dump", &lammps_dump(&record, steps));
    place.write("times.dump", &lammps_dump(&record, with_time));
    // As of a program that begins with the opening: states since then, in steps of its own.
    let mut opened = record.clone();
    opened.snapshots.retain(|it| it.time >= 1.0 - 1e-9);
    let later = |time: f64| steps(time + 30.0);
    place.write("opened.dump", &lammps_dump(&opened, later));
    for file in ["steps.dump", "times.dump", "opened.dump"] {
        let compare = ["compare", "run.h5", file, "--times", "0,2", "--json"];
        let answer: Value = serde_json::from_str(&place.phase(&compare).code(0).stdout).unwrap();
        let rows = answer["rows"].as_array().unwrap();
        let row = |name: &str| rows.iter().find(|it| it["quantity"] == name).unwrap();
        let of = |name: &str| row(name)["values"].as_array().unwrap().clone();
        let start = of("packing fraction at the start");
        assert_eq!(start[0], start[1], "{file}");
        let [own, other] = [0, 1].map(|place| of("outflow")[place].as_f64().unwrap());
        assert!((own / other - 1.0).abs() < 1e-6, "{file}: {own} {other}");
    }
}

/// Symptom: spheres without numbers were taken for those of the same line before, though others had
/// left, and the spreading was wrong by a factor of ten thousand.
#[test]
fn spheres_that_cannot_be_told_apart_are_refused() {
    let place = Workplace::new();
    place.write("scene.toml", &crate::support::drainage_file());
    let compare = ["compare", "states.xyz", "--scene", "scene.toml"];
    let one = "1\nTime=0\nA 0 0 1\n";
    let numbered = "2\nProperties=species:S:1:pos:R:3:id:I:1 Time=1\nA 0 0 1 1\nA 0 0 3 2\n";
    for (states, reason) in [
        (
            format!("{one}2\nTime=1\nA 0 0 1\nA 0 0 3\n"),
            "state 2 and the state before differ in their number",
        ),
        (format!("{one}{numbered}"), "write an `id` for each sphere"),
        (
            one.to_owned() + "1\nTime=1\nA 50 0 1\n",
            "state 2: sphere 0 is outside the walls of the scene",
        ),
        (
            "2\nTime=0\nA 0 0 1e-3\nA 0 0 2e-3\n"
                .repeat(2)
                .replacen("=0", "=-1", 1),
            "state 1: with the scene's radius, its spheres are larger",
        ),
    ] {
        place.write("states.xyz", &states);
        place.phase(&compare).code(2).complains(reason);
    }
}

/// Symptom: the outflow of a record in units of its spheres was subtracted from one in SI units.
#[test]
fn numbers_in_two_units_are_not_compared() {
    let (place, _) = drained();
    let export = ["export", "run.h5", "--to", "xyz", "--out", "run.xyz"];
    place.phase(&export).code(0);
    place.write(
        "si.toml",
        &drainage_file().replace("radius = 0.5", "radius = 0.45"),
    );
    place
        .phase(&["compare", "run.h5", "run.xyz", "--scene", "si.toml"])
        .code(2)
        .complains("run.xyz: its scene is in units SI");
}

/// Symptom: a record that ended before the times that were asked for was measured over less, and
/// nothing said so.
#[test]
fn records_that_are_measured_over_other_times_are_named() {
    let (place, _) = drained();
    let shorter = [
        "run",
        "scene.toml",
        "--set",
        "time.duration=3",
        "--out",
        "short.h5",
    ];
    place.phase(&shorter).code(0);
    let compare = ["compare", "run.h5", "short.h5"];
    let asked = [&compare[..], &["--times", "1,4"]].concat();
    place
        .phase(&asked)
        .code(0)
        .complains("B is measured from 1 to 3 τ");
    place
        .phase(&compare)
        .code(0)
        .complains("B is measured from 0.6");
    let both = [&compare[..], &["--times", "1,3"]].concat();
    let answer = place.phase(&both).code(0);
    assert!(!answer.stderr.contains("measured"), "{}", answer.stderr);
    // A table holds what was measured.
    let table = [&both[..], &["--out", "both.csv"]].concat();
    place.phase(&table).code(0);
    place
        .phase(&["compare", "both.csv", "--times", "1,2"])
        .code(2)
        .complains("--times");
}

/// Symptom: the difference of a record to itself had an interval, as if its scatter were another's.
#[test]
fn a_record_differs_by_nothing_from_itself() {
    let (place, _) = drained();
    let compare = ["compare", "run.h5", "run.h5", "--times", "1,4", "--json"];
    let answer: Value = serde_json::from_str(&place.phase(&compare).code(0).stdout).unwrap();
    let mut compared = 0;
    for row in answer["rows"].as_array().unwrap() {
        if !row["difference"].is_null() {
            assert_eq!(row["difference"], 0.0, "{row}");
            assert_eq!(row["difference_half_width"], 0.0, "{row}");
            compared += 1;
        }
    }
    assert!(compared > 8, "{compared}");
}

/// Two seeds differ by their spread. Of the 45 pairs of seeds 1 to 10 the intervals of differences
/// held 0 in 446 of 450 numbers; of the 20 here more than 2 miss it in a thousandth of all choices
/// of seeds, if numbers are independent.
#[test]
fn two_seeds_of_a_drainage_differ_by_their_spread() {
    let place = Workplace::new();
    let longer = drainage_file()
        .replace(
            "duration = 4.0, frame_interval = 0.5",
            "duration = 5.0, frame_interval = 0.25",
        )
        .replace("snapshot_interval = 1.0", "snapshot_interval = 0.5");
    let text = longer + "relaxation.method = \"global\"\n";
    place.write("scene.toml", &text);
    let (mut compared, mut missed, mut equal) = (0, 0, 0);
    for pair in [["1", "2"], ["3", "4"]] {
        for seed in pair {
            let record = format!("{seed}.h5");
            let run = ["run", "scene.toml", "--seed", seed, "--out", &record];
            place.phase(&run).code(0);
        }
        let [one, other] = pair.map(|seed| format!("{seed}.h5"));
        let compare = ["compare", &one, &other, "--times", "1,5", "--json"];
        let answer: Value = serde_json::from_str(&place.phase(&compare).code(0).stdout).unwrap();
        for row in answer["rows"].as_array().unwrap() {
            let numbers = [&row["difference"], &row["difference_half_width"]];
            if let [Some(difference), Some(half)] = numbers.map(Value::as_f64) {
                compared += 1;
                missed += u32::from(difference.abs() > half);
                equal += u32::from(difference == 0.0);
            }
        }
    }
    assert_eq!(compared, 20);
    assert!(missed <= 2 && equal <= 2, "{missed} missed, {equal} equal");
}

/// Symptom: two seeds of a tank, or two softnesses, could not be compared: only drainages were.
#[test]
fn runs_of_a_tank_are_compared_by_their_measures() {
    let place = Workplace::new();
    let scene = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/sweeps/scenes/theoretical.toml"
    );
    let small = ["--set", "spheres.count=20", "--set", "time.duration=2.5"];
    for seed in ["1", "2"] {
        let run = ["run", scene, "--seed", seed, "--out", &format!("{seed}.h5")];
        place.phase(&[&run[..], &small].concat()).code(0);
    }
    let told = place.phase(&["compare", "1.h5", "2.h5"]).code(0);
    told.says("B - A")
        .says("packing height")
        .says("hole radius");
    let named = [
        "compare", "1.h5", "2.h5", "--label", "one", "--label", "two",
    ];
    place.phase(&named).code(0).says("A  one").says("B  two");
    place
        .phase(&named[..5])
        .code(2)
        .complains("once for each of the 2");
    let answer = place.phase(&["compare", "1.h5", "1.h5", "--json"]).code(0);
    let answer: Value = serde_json::from_str(&answer.stdout).unwrap();
    for row in answer["rows"].as_array().unwrap() {
        let difference = &row["difference"];
        assert!(difference.is_null() || difference == 0.0, "{row}");
    }
    place
        .phase(&["compare", "1.h5", "2.h5", "--times", "1,2"])
        .code(2)
        .complains("--times is for drainages");
    let (drained, _) = drained();
    let other = drained.path("run.h5");
    place
        .phase(&["compare", "1.h5", other.to_str().unwrap()])
        .code(2)
        .complains("compare runs of one kind");
}

/// Symptom: of a scene in units of its spheres the text said 1/s, and figures beside it 1/τ. What
/// programs read stays in SI units, and so does the time that the run took.
#[test]
fn a_scene_in_units_of_its_spheres_is_told_in_those() {
    let (place, _) = drained();
    let compare = ["compare", "run.h5", "--times", "1,4"];
    place
        .phase(&compare)
        .code(0)
        .says("outflow (1/τ)")
        .says("processor time (s)");
    let answer = place.phase(&[&compare[..], &["--json"]].concat()).code(0);
    let answer: Value = serde_json::from_str(&answer.stdout).unwrap();
    let rows = answer["rows"].as_array().unwrap();
    let outflow = rows.iter().find(|row| row["quantity"] == "outflow");
    assert_eq!(outflow.unwrap()["unit"], "1/s");
}

#[test]
fn a_table_takes_the_place_of_its_records() {
    let (place, _) = drained();
    let arguments = ["compare", "run.h5", "--times", "1,4", "--out", "run.csv"];
    place.phase(&arguments).code(0);
    assert_equal(&place, "run.h5", "run.csv");
    place.phase(&["compare", "run.csv", "run.csv"]).code(0);
    place.write("other.csv", "a,b\n1,2\n");
    let refused = place.phase(&["compare", "run.h5", "other.csv"]).code(2);
    assert!(
        refused.stderr.contains("other.csv:1: not a table"),
        "{}",
        refused.stderr
    );
    place.write(
        "word.csv",
        "quantity,unit,record,value,half_width\noutflow,1/s,paper,many,\n",
    );
    let refused = place.phase(&["compare", "word.csv"]).code(2);
    assert!(
        refused.stderr.contains("word.csv:2: `many`"),
        "{}",
        refused.stderr
    );
}

/// Symptom: of two records of one name the second was lost, in tables written and read.
#[test]
fn a_table_has_one_number_for_each_name() {
    let (place, _) = drained();
    let alike = [
        "compare", "run.h5", "run.h5", "--label", "a", "--label", "a",
    ];
    place.phase(&alike).code(0);
    place
        .phase(&[&alike[..], &["--out", "alike.csv"]].concat())
        .code(2)
        .complains("two records are called `a`");
    let head = "quantity,unit,record,value,half_width\noutflow,1/s,a,4,1\n";
    for (row, reason) in [
        (
            "outflow,1/s,a,5,1",
            "again.csv:3: duplicate `outflow` of `a`",
        ),
        (
            "outflow,1/s,b,4,-1",
            "again.csv:3: a half width cannot be negative",
        ),
        (
            "outflow,1/s,b,1e400,1",
            "again.csv:3: `1e400` is not a finite number",
        ),
    ] {
        place.write("again.csv", &format!("{head}{row}\n"));
        let table = ["compare", "again.csv"];
        place.phase(&table).code(2).complains(reason);
    }
}

/// Symptom: the record was said to be a folder without labels.
#[test]
fn records_and_folders_do_not_mix() {
    let (place, _) = drained();
    let folder = std::path::absolute("results/theoretical-9x9").unwrap();
    place
        .phase(&["compare", "run.h5", folder.to_str().unwrap()])
        .code(2)
        .complains("run.h5: not a folder");
}

/// Symptom: a panic, or more memory than there is.
#[test]
fn states_without_spheres_or_far_off_are_refused() {
    let place = Workplace::new();
    place.write("scene.toml", &crate::support::drainage_file());
    let compare = ["compare", "states.xyz", "--scene", "scene.toml"];
    let state = |time: u32, spheres: &str, count: usize| {
        format!("{count}\nProperties=species:S:1:pos:R:3 Time={time}\n{spheres}")
    };
    for (spheres, count, reason) in [
        ("", 0, "no state has a sphere"),
        ("A 0.0 0.0 1e9\n", 1, "state 1: sphere"),
    ] {
        let both = state(0, spheres, count) + &state(1, spheres, count);
        place.write("states.xyz", &both);
        place.phase(&compare).code(2).complains(reason);
    }
}

#[test]
fn folders_of_sweeps_are_compared() {
    let place = Workplace::new();
    let folder = |name: &str| std::path::absolute(format!("results/{name}")).unwrap();
    let compare = |one: &str, other: &str| {
        let paths = [folder(one), folder(other)].map(|it| it.to_str().unwrap().to_owned());
        place.phase(&["compare", &paths[0], &paths[1]])
    };
    let same = compare("theoretical-9x9", "theoretical-9x9").code(0);
    assert!(
        same.stdout
            .contains("243 of 243 runs with the same point and seed"),
        "{}",
        same.stdout
    );
    let other = compare("theoretical-9x9", "theoretical-quadratic-9x9").code(0);
    assert!(
        other
            .stdout
            .contains("runs with the same point and seed have equal labels: ")
    );
    assert!(other.stdout.contains("rotation"), "{}", other.stdout);
    let refused = compare("theoretical-9x9", "silo").code(2);
    assert!(
        refused.stderr.contains("cannot be compared"),
        "{}",
        refused.stderr
    );
    let one = folder("silo");
    let one = place.phase(&["compare", one.to_str().unwrap()]).code(2);
    assert!(
        one.stderr.contains("exactly two results folders"),
        "{}",
        one.stderr
    );
}
