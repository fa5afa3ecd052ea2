//! What a program measured becomes a record like any other.

use super::{MODEL, place_of};
use phase::store::read_record;

#[test]
fn columns_units_and_labels_are_those_of_the_file() {
    let place = place_of(MODEL, "[1.0, 2.5]", "");
    let text = place.read("model.toml");
    let text =
        format!("{text}\n[[measure]]\nname = \"speed\"\nvalue = \"trend(y) / parameters.x\"\n");
    place.write("model.toml", &text);
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0)
        .says("far               1")
        .says("near              1");
    let labels = place.read("results/model/labels.csv");
    // y / x grows by 1 in 1.5 s.
    assert!(
        labels
            .lines()
            .skip(1)
            .all(|line| line.contains(",0.66666666666666")),
        "{labels}"
    );
    let record = place.records("results/model").remove(0);
    let path = place.path(&format!("results/model/records/{record}"));
    let record = read_record(&path).unwrap();
    assert_eq!(record.observations.time, [0.0, 1.5]);
    let columns = record.observations.scalars();
    assert_eq!(columns.len(), 1);
    let column = columns[0];
    assert_eq!(
        (column.name, column.unit, column.description),
        ("y", "m", "Place")
    );
    assert_eq!(column.values[0], 0.0);
    assert!(record.radius.is_empty() && record.observations.kinetic.is_empty());
    // The axis has the unit of the file, and no critical rotation is drawn.
    let svg = place.read("results/model/phase.svg");
    assert!(svg.contains("</tspan> (m)<"), "{svg}");
}

#[test]
fn equal_runs_have_equal_records_on_any_number_of_workers() {
    let digests = |jobs: &str| {
        let place = place_of(MODEL, "[1.0, 2.0, 3.0]", "");
        let arguments = ["sweep", "model.toml", "--allow-program", "-j", jobs];
        place.phase(&arguments).code(0);
        place.digests("results/model")
    };
    assert_eq!(digests("1"), digests("3"));
}

#[test]
fn several_tables_go_together_by_time() {
    let script =
        "printf 't,y\\n0,1\\n1,2\\n2,3\\n' > out.csv; printf '# t z\\n0 5\\n2 @{x}\\n' > z.txt";
    let place = place_of(script, "[7.0]", "");
    let more = "[[scene.program.read]]\nfile = \"z.txt\"\nformat = \"text\"\ntime = \"t\"\n\
                columns = [\"z\"]\n\n[scene.parameters]";
    let text = place.read("model.toml").replace("[scene.parameters]", more);
    place.write("model.toml", &text);
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0);
    let record = place.records("results/model").remove(0);
    let record = read_record(&place.path(&format!("results/model/records/{record}"))).unwrap();
    let columns = record.observations.scalars();
    assert_eq!(record.observations.time, [0.0, 2.0]);
    assert_eq!(columns[0].values, [1.0, 3.0]);
    assert_eq!(columns[1].values, [5.0, 7.0]);
}

#[test]
fn states_of_spheres_become_snapshots() {
    let script = format!(
        "{MODEL}\nfor t in 0 1.5; do printf \"2\\nProperties=species:S:1:pos:R:3:id:I:1 \
         Time=$t\\nX 0 0 0 4\\nX 0 $t @{{x}} 2\\n\"; done > states.xyz"
    );
    let more = "states = { file = \"states.xyz\", radius = \"0.25\" }";
    let place = place_of(&script, "[3.0]", more);
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0);
    let name = place.records("results/model").remove(0);
    let path = format!("results/model/records/{name}");
    let record = read_record(&place.path(&path)).unwrap();
    assert_eq!(record.radius, [0.25, 0.25]);
    assert_eq!(record.snapshots.len(), 2);
    let last = &record.snapshots[1];
    assert_eq!(last.time, 1.5);
    // By number: 2, then 4.
    assert_eq!(last.position.row(0).to_vec(), [0.0, 1.5, 3.0]);
    assert_eq!(last.position.row(1).to_vec(), [0.0, 0.0, 0.0]);
    place
        .phase(&["view", &path, "--out", "picture.png"])
        .code(0);
}

/// All that reads a table of results works without spheres, and what cannot be is refused.
///
/// Symptom: `export` wrote empty pictures, and panicked for a dump.
#[test]
fn commands_on_records_of_programs_work_or_refuse() {
    const NO_SPHERES: &str = "the record holds no spheres: its program left no states";
    let place = place_of(MODEL, "[1.0, 3.0]", "");
    place
        .phase(&["sweep", "model.toml", "--allow-program"])
        .code(0);
    let name = place.records("results/model").remove(0);
    let record = format!("results/model/records/{name}");
    let again = "run --from results/model --point x=3 --out again.h5";
    for (line, code, expected) in [
        ("status results/model", 0, "2 jobs, 2 done"),
        ("classify results/model", 0, "0 of 2 labels changed"),
        ("plot results/model -f phase", 0, "phase.svg"),
        ("plot results/model -f near-margin", 0, "near-margin.svg"),
        ("plot results/model --list", 0, "near-margin"),
        ("compare results/model results/model", 0, "100.0 %"),
        ("check model.toml", 0, "2 of 2 runs are done and kept"),
        ("export RECORD --to csv --out out", 0, "-observations.csv"),
        ("export RECORD --to svg --out out", 2, NO_SPHERES),
        ("export RECORD --to page --out out", 2, NO_SPHERES),
        ("export RECORD --to npy --out out", 2, NO_SPHERES),
        ("export RECORD --to xyz --out out", 2, NO_SPHERES),
        ("export RECORD --to vtk --out out", 2, NO_SPHERES),
        ("export RECORD --to dump --out out", 2, NO_SPHERES),
        ("view RECORD --out picture.png", 2, NO_SPHERES),
        ("plot RECORD", 1, "the record holds no trajectory"),
        ("fit RECORD", 2, "a fit needs a box with an opening"),
        ("cost model.toml", 2, "the scene starts another program"),
        (again, 2, "--allow-program"),
    ] {
        let line = line.replace("RECORD", &record);
        let answer = place.phase(&line.split(' ').collect::<Vec<_>>()).code(code);
        let said = format!("{}{}", answer.stdout, answer.stderr);
        assert!(said.contains(expected), "{line}: no `{expected}` in {said}");
    }
    let allowed = format!("{again} --allow-program");
    place.phase(&allowed.split(' ').collect::<Vec<_>>()).code(0);
    assert!(place.path("again.h5").exists());
}
