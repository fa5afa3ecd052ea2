//! Refined sweeps, studies and shards of programs.

use super::{MODEL, place_of, sweep_of};

/// `y` is `x` plus noise of the seed and of a step `h`, so that the border is at x = 2.
const NOISY: &str = "awk -v x=@{x} -v h=@{h} -v s=@{seed32} 'BEGIN { srand(s); \
                     printf \"t,y\\n0,%.17g\\n\", x + h + 0.2 * (rand() - 0.5) }' > out.csv";

fn noisy(values: &str) -> String {
    sweep_of(NOISY, values, "").replace("x = 1.0", "x = 1.0\nh = 0.0")
}

#[test]
fn a_refined_sweep_finds_the_border() {
    let place = place_of("", "[1.0]", "");
    let grid: Vec<String> = (0..41).map(|k| format!("{}", 0.1 * f64::from(k))).collect();
    let text = noisy(&format!("[{}]", grid.join(", ")));
    place.write(
        "model.toml",
        &format!("{text}\n[refine]\nbudget = 14\nround = 4\n"),
    );
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0);
    let borders = place.read("results/model/borders.csv");
    let mut reader = csv::Reader::from_reader(borders.as_bytes());
    let rows: Vec<std::collections::HashMap<String, String>> =
        reader.deserialize().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 1, "{borders}");
    let number = |key: &str| rows[0][key].parse::<f64>().unwrap();
    assert!(
        number("low_95") < 2.0 && 2.0 < number("high_95"),
        "{borders}"
    );
    assert!(number("high_95") - number("low_95") < 1.6, "{borders}");
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0)
        .says("14 done before");
}

#[test]
fn studies_of_accuracy_and_ablations_take_any_key_of_a_program() {
    let place = place_of("", "[1.0]", "");
    place.write("model.toml", &noisy("[0.5, 1.5, 2.5, 3.5]"));
    place.write(
        "accuracy.toml",
        "study = \"accuracy\"\nscene = \"model.toml\"\n[seeds]\ncount = 3\n\
         [[ladder]]\nkey = \"parameters.h\"\nvalues = [0.0, 1.0]\n",
    );
    let study = &["study", "accuracy.toml", "--out", "accuracy"];
    place.phase(study).code(2).complains("--allow-program");
    let mut study = study.to_vec();
    study.push("--allow-program");
    place.phase(&study).code(0);
    let table = place.read("accuracy/runs.csv");
    assert!(table.lines().count() > 8, "{table}");
    let text = format!(
        "{}\n[[variant]]\nname = \"as it is\"\nset = {{ \"parameters.h\" = 0.001 }}\n\
         [[variant]]\nname = \"coarse\"\nset = {{ \"parameters.h\" = 1.0 }}\n",
        noisy("[0.5, 1.5, 2.5, 3.5]")
    );
    place.write("variants.toml", &text);
    place
        .phase(&["sweep", "variants.toml", "--allow-program"])
        .code(0)
        .says("8 runs labelled");
}

/// Symptom: `[scene.program]` in the file of a study was refused, though `scene = "model.toml"` was
/// not. Cause: the scene was read without the keys that follow from others, such as the steps of a
/// program.
#[test]
fn a_study_may_hold_the_scene_of_its_program() {
    let place = place_of("", "[1.0]", "");
    let sweep = noisy("[1.0]");
    let scene = &sweep[..sweep.find("[[axis]]").unwrap()];
    place.write(
        "study.toml",
        &format!(
            "study = \"accuracy\"\n{scene}\n[seeds]\ncount = 3\n\
             [[ladder]]\nkey = \"parameters.h\"\nvalues = [0.5, 1.0]\n"
        ),
    );
    place
        .phase(&["check", "study.toml"])
        .code(0)
        .says("sh model.sh")
        .says("the program is not started here");
    place
        .phase(&["study", "study.toml", "--allow-program"])
        .code(0);
}

#[test]
fn shards_and_jobs_of_a_sweep_run_apart() {
    let place = place_of(MODEL, "[1.0, 2.0, 3.0]", "version = [\"echo\", \"1\"]");
    let sweep = |more: &[&str]| {
        let first = ["sweep", "model.toml", "--allow-program"];
        place.phase(&[&first[..], more].concat()).code(0)
    };
    sweep(&["--shard", "1/2"]);
    let left = place.phase(&["jobs", "model.toml", "--missing"]).code(0);
    let lines: Vec<&str> = left.stdout.lines().collect();
    assert!(!lines.is_empty() && lines.len() < 3, "{}", left.stdout);
    for line in lines {
        sweep(&["--job", line]);
    }
    sweep(&[]).says("3 done before");
}
