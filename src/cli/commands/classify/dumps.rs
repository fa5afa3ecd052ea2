//! Labels of a folder of dumps.

use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::folders;
use crate::cli::labels::{tell_of_labels, tell_of_problems};
use phase::classify::Sieves;
use phase::scene::Scene;
use phase::sweep::{DumpScene, Folder, FolderError, Labelled, Labelling, NamePattern, find_dumps};
use std::path::{Path, PathBuf};

/// Labels the dumps of a folder, whose names have this pattern, writes the tables there and prints
/// a summary.
pub(super) fn label(
    folder: &Path,
    scene: &Path,
    names: &str,
    sieves: &Sieves,
    workers: usize,
    console: &Console,
) -> Result<Labelled, Failure> {
    let scene = Scene::load_base(scene)?;
    sieves.check(&scene)?;
    let refuse = |problem| Failure::refused(format_args!("--names {names}: {problem}"));
    let pattern = NamePattern::parse(names).map_err(refuse)?;
    let dumps = dumps_in(folder, pattern.extension())?;
    let scene = DumpScene::new(&scene, pattern).map_err(refuse)?;
    let tables = ["labels.csv", "points.csv"];
    folders::refuse_foreign(folder, tables, "use a folder with the dumps alone")?;
    let labelling = Labelling::of_dumps(&dumps, &scene, sieves, workers)?;
    tell_of_problems(&labelling, console);
    if labelling.table.rows.is_empty() {
        let reason = "no dump could be labelled; its tables were left unchanged";
        return Err(Failure::failed(reason).at(folder));
    }
    let folder = Folder::new(folder);
    let labelled = labelling.replace(&folder)?;
    tell_of_labels(&labelled, &folder, console);
    Ok(labelled)
}

fn dumps_in(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, Failure> {
    let refuse = |reason: String| {
        Failure::refused(format_args!(
            "{reason}; make dumps with `phase export ... --to dump`"
        ))
        .at(folder)
    };
    if folder.join("sweep.json").exists() {
        return Err(refuse(
            "a results folder is labelled from its records; drop --scene".to_owned(),
        ));
    }
    match find_dumps(folder, extension) {
        Ok(dumps) if dumps.is_empty() => Err(refuse(format!("holds no .{extension} files"))),
        Ok(dumps) => Ok(dumps),
        Err(error) => Err(refuse(error.to_string())),
    }
}

/// Why a folder has no results; for a folder of dumps the message names the missing option.
pub(super) fn hint(folder: &Path, error: &FolderError) -> Failure {
    match find_dumps(folder, "npy") {
        Ok(dumps) if !dumps.is_empty() => Failure::refused(
            "holds dumps (.npy) but no sweep.json; give the scene of the dumps with --scene FILE",
        )
        .at(folder),
        _ => Failure::refused(error),
    }
}
