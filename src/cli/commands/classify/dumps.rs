//! Labels of a folder of dumps.

use super::{cannot_write, tell_of_labels, tell_of_problems};
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::folders;
use phase::classify::Sieves;
use phase::scene::Scene;
use phase::sweep::{Folder, FolderError, Labelled, Labelling, find_dumps};
use std::path::{Path, PathBuf};

/// Labels the dumps of a folder, writes the tables there and prints what they say.
pub(super) fn label(
    folder: &Path,
    scene: &Path,
    sieves: &Sieves,
    workers: usize,
    console: &Console,
) -> Result<Labelled, Failure> {
    let scene = Scene::load_base(scene).map_err(Failure::refused)?;
    sieves.check(&scene).map_err(Failure::refused)?;
    let dumps = dumps_in(folder)?;
    let tables = ["labels.csv", "points.csv"];
    folders::refuse_foreign(folder, tables, "use a folder with the dumps alone")?;
    let labelling =
        Labelling::of_dumps(&dumps, &scene, sieves, workers).map_err(Failure::failed)?;
    tell_of_problems(&labelling, console);
    let folder = Folder::new(folder);
    let labelled = labelling.replace(&folder).map_err(cannot_write)?;
    tell_of_labels(&labelled, &folder, console);
    Ok(labelled)
}

fn dumps_in(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let refuse = |reason: String| {
        Failure::refused(format_args!(
            "{}: {reason}; make dumps with `phase export ... --to dump`",
            folder.display()
        ))
    };
    if folder.join("sweep.json").exists() {
        return Err(refuse(
            "a results folder needs no --scene, its labels come from its records".to_owned(),
        ));
    }
    match find_dumps(folder) {
        Ok(dumps) if dumps.is_empty() => Err(refuse("holds no .npy files".to_owned())),
        Ok(dumps) => Ok(dumps),
        Err(error) => Err(refuse(error.to_string())),
    }
}

/// The failure to find results in a folder; one of dumps is told what it lacks.
pub(super) fn hint(folder: &Path, error: &FolderError) -> Failure {
    match find_dumps(folder) {
        Ok(dumps) if !dumps.is_empty() => Failure::refused(format_args!(
            "{}: holds dumps (.npy) but no sweep.json; say with --scene FILE of which scene they \
             are",
            folder.display()
        )),
        _ => Failure::refused(error),
    }
}
