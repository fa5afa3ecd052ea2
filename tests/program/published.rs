//! Published tables: every one is read, and written again has the same bytes; borders too.

use crate::support::Workplace;
use phase::classify::{DRAINAGE, Family, SILO, TANK};
use phase::store::{read_labels, write_labels, write_points};
use phase::sweep::Folder;
use std::fs;
use std::path::Path;

#[test]
fn published_tables_keep_their_bytes() {
    let place = tempfile::tempdir().unwrap();
    let mut families = Vec::new();
    for folder in Folder::find(Path::new("results")).unwrap() {
        if !folder.labels().exists() {
            continue;
        }
        let table = read_labels(&folder.labels()).unwrap();
        families.push(table.family);
        let sweep = folder.read_sweep().unwrap();
        assert_eq!(table.family, Family::of(&sweep.scene), "{folder:?}");
        let (labels, points) = (place.path().join("labels"), place.path().join("points"));
        write_labels(&table, &labels).unwrap();
        write_points(&table, &points).unwrap();
        for (written, published) in [(labels, folder.labels()), (points, folder.points())] {
            let same = fs::read(written).unwrap() == fs::read(&published).unwrap();
            assert!(same, "{}", published.display());
        }
    }
    for family in [&TANK, &SILO, &DRAINAGE] {
        assert!(families.contains(&family), "no table of a {}", family.name);
    }
}

/// The borders of steel are learnt from its labels, without any run.
#[test]
fn borders_of_steel_are_those_of_its_labels() {
    let place = Workplace::new();
    fs::create_dir(place.path("steel")).unwrap();
    for file in ["labels.csv", "sweep.json"] {
        let published = Path::new("results/steel").join(file);
        fs::copy(published, place.path("steel").join(file)).unwrap();
    }
    let sweep = concat!(env!("CARGO_MANIFEST_DIR"), "/sweeps/steel.toml");
    let options = ["--out", "steel", "--keep-labels", "--no-plot"];
    place
        .phase(&[&["sweep", sweep], &options[..]].concat())
        .code(0);
    let published = fs::read_to_string("results/steel/borders.csv").unwrap();
    assert_eq!(place.read("steel/borders.csv"), published);
}
