//! Files of a kind, as the subcommands ask for them.

use super::exit::Failure;
use phase::scene::FileKind;
use phase::study::{AnyFile, AnyStudy};
use phase::sweep::Sweep;
use std::path::Path;

/// Reads a scene or a sweep, a scene as the sweep of just one; and which it is.
pub(super) fn load_scene_or_sweep(file: &Path) -> Result<(Sweep, FileKind), Failure> {
    match AnyFile::load(file)? {
        AnyFile::Scene(scene) => Ok((Sweep::of_scene(*scene), FileKind::Scene)),
        AnyFile::Sweep(sweep) => Ok((*sweep, FileKind::Sweep)),
        // The file is one of a sweep.
        AnyFile::Study(AnyStudy::Ablation(study)) => {
            Ok((study.comparison.sweep_of(0), FileKind::Sweep))
        }
        AnyFile::Study(_) => Err(Failure::refused(format_args!(
            "{}: this is a study, not a scene or sweep; `phase check {0}` estimates its cost",
            file.display()
        ))),
    }
}
