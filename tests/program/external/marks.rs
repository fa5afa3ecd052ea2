//! Marks stand for values, bit by bit, and nothing else is changed.

use super::{place_of, sweep_of};
use crate::support::Workplace;
use phase::sweep;

/// The text that a run was given under a name, for each job of a sweep.
fn texts(text: &str) -> Vec<(Vec<f64>, u64, String)> {
    let place = Workplace::new();
    place.write("sweep.toml", text);
    let sweep = sweep::load(&place.path("sweep.toml")).unwrap();
    let jobs = sweep.jobs().unwrap().into_iter();
    let filled = jobs.map(|job| {
        let program = job.scene().filled_program().unwrap();
        let text = program.files[0].text.trim().to_owned();
        (job.values.clone(), job.seed, text)
    });
    filled.collect()
}

#[test]
fn numbers_are_read_as_the_same_numbers() {
    let values = "[0.1, 1e-7, 3.0, 12345678.9, 1e22, -0.3333333333333333]";
    for (values, _, text) in texts(&sweep_of("@{x}", values, "")) {
        let read: f64 = text.parse().unwrap();
        assert_eq!(read.to_bits(), values[0].to_bits(), "{text}");
        // Python and LAMMPS tell whole numbers from others by this.
        assert!(text.contains(['.', 'e']), "{text}");
    }
}

#[test]
fn whole_numbers_stay_whole_and_texts_stay_as_they_are() {
    let script = "@{n} @{style} @{flag} @{ x } @@{x} ${x} {x} @x %(x)s $x \"@\"";
    let sweep = sweep_of(script, "[0.5]", "");
    let sweep = sweep.replace("x = 1.0", "x = 1.0\nn = 7\nstyle = \"a'b\"\nflag = true");
    let found = texts(&sweep).remove(0).2;
    assert_eq!(found, "7 a'b true 0.5 @{x} ${x} {x} @x %(x)s $x \"@\"");
    // An axis over a whole number keeps it whole where it is.
    let sweep = sweep.replace("\"parameters.x\"", "\"n\"");
    let over = |values: &str| sweep.replace("values = [0.5]", &format!("values = {values}"));
    let found = texts(&over("[-8, 0.5, 9.0]")).into_iter();
    let found: Vec<String> = found
        .map(|it| it.2.split(' ').next().unwrap().to_owned())
        .collect();
    assert_eq!(found, ["-8", "0.5", "9"]);
}

#[test]
fn seeds_are_those_of_the_run_and_small_ones_fit_into_32_bits() {
    let sweep = sweep_of("@{seed} @{seed32} @{x}", "[1.0, 2.0]", "");
    let found = texts(&format!(
        "{sweep}\n[seeds]\nlist = [1, 9223372036854775807]\n"
    ));
    let mut small = Vec::new();
    for (_, seed, text) in &found {
        let words: Vec<&str> = text.split(' ').collect();
        let (own, derived) = (words[0], words[1]);
        assert_eq!(own, seed.to_string());
        let derived: u64 = derived.parse().unwrap();
        assert!((1..=900_000_000).contains(&derived));
        small.push(derived);
    }
    small.sort_unstable();
    small.dedup();
    assert_eq!(small.len(), 4, "each run has its own");
}

#[test]
fn files_of_folders_keep_their_places_and_marks_stand_in_commands_too() {
    let place = place_of("", "[2.0]", "");
    std::fs::create_dir_all(place.path("parts/deep")).unwrap();
    place.write("parts/deep/y.txt", "@{x}\n");
    place.write("parts/.hidden", "@{nothing}");
    place.write(
        "run.sh",
        "printf \"t,y\\n0,$1\\n\" > \"$2.csv\"; cp deep/y.txt y.txt\n",
    );
    let text = place.read("model.toml");
    let start = text.find("files = ").unwrap();
    let end = text.find("units").unwrap();
    let text = format!(
        "{}files = [\"parts\", \"run.sh\"]\n{}",
        &text[..start],
        &text[end..]
    );
    let text = text
        .replace(
            "[\"sh\", \"model.sh\"]",
            "[\"sh\", \"run.sh\", \"@{x}\", \"out-@{seed}\"]",
        )
        .replace("out.csv", "out-@{seed}.csv");
    place.write("model.toml", &text);
    place
        .phase(&["check", "model.toml"])
        .code(0)
        .says("sh run.sh 2.0 out-1")
        .says("deep/y.txt, run.sh")
        .says("out-1.csv: y (m)");
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0)
        .says("near              1");
    let record = place.records("results/model").remove(0).replace(".h5", "");
    let copied = place.read(&format!("results/model/records/{record}.run/y.txt"));
    assert_eq!(copied, "2.0\n");
}
