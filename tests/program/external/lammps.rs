//! Grains on an incline by LAMMPS and by the engine: two programs, one scene.

use super::has;
use crate::support::Workplace;

/// A shipped sweep over four points that lie deep in the three regions, with one seed.
fn coarse(name: &str) -> String {
    let text = std::fs::read_to_string(format!("sweeps/programs/{name}.toml")).unwrap();
    let text = text.replace("count = 9", "count = 2");
    text.replace("[seeds]\nfirst = 1\ncount = 3\n", "")
}

/// Symptom it guards against: an input of LAMMPS that is swept as it stands gives other labels than
/// the same scene here. At these points three seeds and their neighbours agree in both programs.
#[test]
fn an_input_of_lammps_has_the_labels_of_the_same_scene_here() {
    if !has("lmp", "-h") {
        return;
    }
    let place = Workplace::new();
    let input = std::fs::read_to_string("sweeps/programs/in.incline").unwrap();
    place.write("in.incline", &input);
    let mut rows = Vec::new();
    for name in ["incline-lammps", "incline"] {
        place.write(&format!("{name}.toml"), &coarse(name));
        place
            .phase(&["sweep", &format!("{name}.toml"), "--allow-program"])
            .code(0)
            .says("4 runs labelled");
        let labels = place.read(&format!("results/{name}/labels.csv"));
        let of_row = |row: &str| row.split(',').skip(1).take(4).collect::<Vec<_>>().join(",");
        rows.push(labels.lines().map(of_row).collect::<Vec<_>>());
    }
    assert_eq!(rows[0], rows[1]);
    assert_eq!(
        rows[0][1..],
        [
            "0.05,0.04,1,slide",
            "0.05,0.52,1,rest",
            "0.53,0.04,1,slide",
            "0.53,0.52,1,roll"
        ]
    );
    place
        .phase(&["compare", "results/incline", "results/incline-lammps"])
        .code(0)
        .says("4 of 4 runs with the same point and seed have equal labels");
}
