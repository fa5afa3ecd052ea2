//! Runs that are measured together: records, and files of other programs.

use super::exit::Failure;
use phase::record::RunRecord;
use phase::replay::replay_states;
use phase::scene::Scene;
use phase::store;
use std::path::{Path, PathBuf};

/// Extensions of files of other programs.
const ENDS: [&str; 9] = [
    "dump",
    "lammpstrj",
    "xyz",
    "extxyz",
    "pvd",
    "series",
    "vtk",
    "vtp",
    "vtu",
];

/// Whether a file is of another program: a dump of LAMMPS, an extended XYZ file, files of VTK.
fn is_of_another_program(path: &Path) -> bool {
    let end = path.extension().unwrap_or_default().to_string_lossy();
    ENDS.contains(&end.to_ascii_lowercase().as_str())
}

/// Reads records and files of other programs. The latter take the given scene, or else the first
/// record's.
pub(super) fn read(paths: &[PathBuf], scene: Option<&Path>) -> Result<Vec<RunRecord>, Failure> {
    if let Some(unused) = scene
        && !paths.iter().any(|path| is_of_another_program(path))
    {
        return Err(Failure::refused(format_args!(
            "--scene {}: this option is for files of other programs ({}), and none is given; \
             records of phase hold their own scene",
            unused.display(),
            ENDS.map(|end| format!(".{end}")).join(", ")
        )));
    }
    let mut scene = match scene {
        Some(path) => Some(Scene::load(path)?),
        None => None,
    };
    let mut records: Vec<Option<RunRecord>> = Vec::new();
    for path in paths {
        if is_of_another_program(path) {
            records.push(None);
            continue;
        }
        let record = store::read_record(path)?;
        scene.get_or_insert_with(|| record.scene.clone());
        records.push(Some(record));
    }
    let all = paths.iter().zip(records);
    all.map(|(path, record)| match record {
        Some(record) => Ok(record),
        None => replayed(path, scene.as_ref()),
    })
    .collect()
}

/// Refuses labels, unless there is one for each of so many records; folders have none.
pub(super) fn check_labels(
    labels: &[String],
    records: usize,
    folders: bool,
) -> Result<(), Failure> {
    match labels {
        [] => Ok(()),
        _ if folders => Err(Failure::refused("--label is for records, not for folders")),
        _ if labels.len() == records => Ok(()),
        _ => Err(Failure::refused(format_args!(
            "--label must be given once for each of the {records} records, in their order"
        ))),
    }
}

/// The record of the states that a file of another program holds.
fn replayed(path: &Path, scene: Option<&Scene>) -> Result<RunRecord, Failure> {
    let scene = scene.ok_or_else(|| {
        Failure::refused(
            "a file of another program does not describe its box; add a record of phase to the \
             command, or give its scene with --scene",
        )
        .at(path)
    })?;
    let states = store::read_states(path)?;
    replay_states(&states, scene)
        .map_err(|error| Failure::refused(format_args!("{error}")).at(path))
}

/// Refuses the record of another program that kept no states of spheres.
pub(super) fn refuse_without_spheres(record: &RunRecord, path: &Path) -> Result<(), Failure> {
    match record.scene.is_external() && record.radius.is_empty() {
        false => Ok(()),
        true => Err(Failure::refused(
            "the record holds no spheres: its program left no states; add `program.states`",
        )
        .at(path)),
    }
}
