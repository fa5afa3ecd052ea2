//! What the results folder of a sweep holds already.

use super::describe::line;
use crate::cli::console::Console;
use crate::cli::exit::Failure;
use crate::cli::{folders, programs};
use phase::document::shown;
use phase::scene::Scene;
use phase::sweep::{Folder, Sweep};
use std::path::Path;

/// Prints how many runs the default folder of the file keeps, and why others are made; nothing
/// where it has none.
pub(super) fn describe_results(
    sweep: &Sweep,
    file: &Path,
    console: &Console,
) -> Result<(), Failure> {
    let folder = Folder::new(folders::default_folder(file));
    let (Ok(stored), Ok(there)) = (folder.read_sweep(), folder.recorded()) else {
        return Ok(());
    };
    if stored.study.is_some() || there.is_empty() {
        return Ok(());
    }
    let mut sweep = sweep.clone();
    programs::take_versions(&mut sweep, &folder);
    let refining = folder.read_refining(&sweep).ok().flatten();
    let jobs = sweep.jobs_so_far(refining.as_ref())?;
    let kept = jobs.iter().filter(|job| there.contains(&job.id)).count();
    let mut text = format!(
        "{kept} of {} runs are done and kept in {}",
        jobs.len(),
        folder.root().display()
    );
    if kept > 0
        && let Some(version) = sweep.scenes().into_iter().find_map(version)
    {
        text += &format!(" while the version is \"{version}\"");
    }
    let keys = stored.keys_of_other_runs(&sweep);
    if kept < jobs.len() && !keys.is_empty() {
        text += &format!(
            "\n{:14}the others are made: what was run there differs in {}",
            "",
            keys.join(", ")
        );
    }
    console.result(line("results", text));
    Ok(())
}

/// The version of the program of a scene, as an earlier sweep found it.
fn version(scene: &Scene) -> Option<String> {
    scene.program.as_ref()?.found_version.as_deref().map(shown)
}
