//! Folders that commands write to, and folders of results that they go through.

use super::console::Console;
use super::exit::{Exit, Failure};
use phase::store::{self, Holder};
use phase::study::StudyName;
use phase::sweep::{Folder, Sweep};
use serde::Serialize;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The remedy if a file of another program is in the way.
pub(super) const ANOTHER_FOLDER: &str = "choose another folder with --out";

/// The results folder of a sweep file: `results/NAME`.
pub(super) fn default_folder(file: &Path) -> PathBuf {
    Path::new("results").join(file.file_stem().unwrap_or("sweep".as_ref()))
}

/// The results folder of a study file: `results/STUDY/NAME`.
pub(super) fn default_folder_of_study(study: StudyName, file: &Path) -> PathBuf {
    let stem = file.file_stem().unwrap_or_default();
    Path::new("results").join(study.name()).join(stem)
}

/// The outcome of a results folder, as `--json` prints it.
#[derive(Serialize)]
#[serde(tag = "outcome", rename_all = "kebab-case")]
pub(super) enum Entry<T> {
    Done(T),
    Kept(Reason),
    Failed(Reason),
}

/// Why nothing was done with a folder.
#[derive(Serialize)]
pub(super) struct Reason {
    folder: String,
    reason: String,
}

/// Why nothing was done with a folder.
pub(super) enum Undone {
    /// It stays as it is, which is a failure only if the folder itself was named.
    Kept(Failure),
    Failed(Failure),
}

impl<E: Into<Failure>> From<E> for Undone {
    fn from(error: E) -> Self {
        Self::Failed(error.into())
    }
}

/// Says that it takes time to tell whether a process on another machine is at work in a folder.
pub(super) fn tell_of_waiting(folder: &Folder, holder: &Holder, console: &Console) {
    console.note(format_args!(
        "{}: watching for up to two minutes whether {holder} is still at work in this folder",
        folder.root().display()
    ));
}

/// Calls `act` for the results folders found at `dir`. If `dir` holds them, one that fails is named
/// and does not stop the others; if it is one itself, its failure fails the command.
pub(super) fn go_through<T>(
    dir: &Path,
    found: Vec<Folder>,
    console: &Console,
    mut act: impl FnMut(&Folder) -> Result<T, Undone>,
) -> Result<Vec<Entry<T>>, Failure> {
    let mut entries = Vec::new();
    for folder in found {
        let is_named_itself = folder.root() == dir;
        entries.push(match act(&folder) {
            Ok(done) => Entry::Done(done),
            Err(Undone::Kept(failure) | Undone::Failed(failure)) if is_named_itself => {
                return Err(failure);
            }
            Err(Undone::Kept(failure)) => {
                let reason = Reason::new(&folder, &failure);
                console.note(format_args!("kept: {}", reason.sentence()));
                Entry::Kept(reason)
            }
            Err(Undone::Failed(failure)) => {
                let reason = Reason::new(&folder, &failure);
                console.error(reason.sentence());
                Entry::Failed(reason)
            }
        });
    }
    Ok(entries)
}

impl<T> Entry<T> {
    /// How the command ends after these folders; `is_whole` says whether nothing failed in a
    /// folder.
    pub(super) fn exit(entries: &[Self], is_whole: impl Fn(&T) -> bool) -> Exit {
        let failed = |entry: &Self| match entry {
            Self::Done(done) => !is_whole(done),
            Self::Kept(_) => false,
            Self::Failed(_) => true,
        };
        match entries.iter().any(failed) {
            true => Exit::Failed,
            false => Exit::Done,
        }
    }
}

impl Reason {
    fn new(folder: &Folder, failure: &Failure) -> Self {
        Self {
            folder: folder.root().display().to_string(),
            reason: failure.message.clone(),
        }
    }

    /// The reason, which names the folder or a file of it first.
    fn sentence(&self) -> String {
        match self.reason.contains(&self.folder) {
            true => self.reason.clone(),
            false => format!("{}: {}", self.folder, self.reason),
        }
    }
}

/// Refuses to replace files of other programs that have these names in a folder. `remedy` says what
/// the user may do instead of moving them away.
pub(super) fn refuse_foreign(
    folder: &Path,
    names: impl IntoIterator<Item = impl AsRef<Path>>,
    remedy: &str,
) -> Result<(), Failure> {
    let paths = names.into_iter().map(|name| folder.join(name));
    let foreign = paths.filter(|path| !store::is_own_file(path));
    let foreign: Vec<String> = foreign.map(|path| path.display().to_string()).collect();
    let (this, it) = match foreign.len() {
        0 => return Ok(()),
        1 => ("this file", "it"),
        _ => ("these files", "them"),
    };
    Err(Failure::refused(format_args!(
        "{}: phase did not write {this} and would overwrite {it}; {remedy}, or move {it} away",
        foreign.join(", ")
    )))
}

/// The files of figures of these names: each is an SVG and a PNG.
pub(super) fn files_of_figures(
    names: impl IntoIterator<Item = impl AsRef<Path>>,
) -> impl Iterator<Item = PathBuf> {
    let files = |name: &Path| ["svg", "png"].map(|end| name.with_added_extension(end));
    names.into_iter().flat_map(move |name| files(name.as_ref()))
}

/// Makes a folder and its parents, unless they exist.
pub(super) fn make(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| {
        Failure::failed(format_args!("{error}{}", store::advice(&error))).at(folder)
    })
}

/// Refuses to replace a file that does not begin with `signature` (or its beginning): it is not of
/// the `kind` that the command would write.
pub(super) fn refuse_to_replace(path: &Path, kind: &str, signature: &[u8]) -> Result<(), Failure> {
    refuse_to_replace_any(path, kind, &[signature])
}

/// The same of a file that may begin with any of several signatures.
pub(super) fn refuse_to_replace_any(
    path: &Path,
    kind: &str,
    signatures: &[&[u8]],
) -> Result<(), Failure> {
    let written = path.as_os_str().as_encoded_bytes();
    if written.ends_with(b"/") || written.ends_with(b"/.") {
        return Err(
            Failure::refused("this is the name of a folder; give the name of a file").at(path),
        );
    }
    let Ok(file) = File::open(path) else {
        return Ok(());
    };
    let is_file = file.metadata().is_ok_and(|data| data.is_file());
    let mut start = Vec::new();
    let longest = signatures.iter().map(|it| it.len()).max().unwrap_or(0);
    let read = file.take(longest as u64).read_to_end(&mut start);
    let begins = |signature: &&[u8]| {
        let length = start.len().min(signature.len());
        signature.starts_with(&start[..length])
    };
    if is_file && read.is_ok() && signatures.iter().any(begins) {
        return Ok(());
    }
    Err(Failure::refused(format_args!(
        "this is not {kind}, and would be overwritten; choose another name for the output"
    ))
    .at(path))
}

/// Makes the folder of a file.
pub(super) fn make_for(file: &Path) -> Result<(), Failure> {
    make(file.parent().unwrap_or(Path::new("")))
}

/// Refuses a folder that holds frames of another program, or more frames than the `count` new ones
/// would replace: two exports would be mixed.
pub(super) fn refuse_other_frames(
    folder: &Path,
    count: usize,
    extension: &str,
) -> Result<(), Failure> {
    let names = (0..count).map(|frame| store::frame_name(frame, extension));
    refuse_foreign(folder, names, "choose another folder")?;
    let beyond = folder.join(store::frame_name(count, extension));
    if beyond.exists() {
        return Err(Failure::refused(
            "this frame is left over from a longer export; remove its frames, or choose another \
             folder",
        )
        .at(beyond));
    }
    Ok(())
}

/// Refuses the folder that the name of a sweep or study file gives if another file of that name has
/// other runs there.
pub(super) fn refuse_another_file(
    folder: &Folder,
    sweep: &Sweep,
    file: &Path,
) -> Result<(), Failure> {
    let (Some(source), Ok(stored)) = (folder.source(), folder.read_sweep()) else {
        return Ok(());
    };
    let is_same = file.canonicalize().is_ok_and(|it| it == source);
    let is_namesake = !is_same && file.file_name() == source.file_name();
    if !is_namesake || stored.keys_of_other_runs(sweep).is_empty() {
        return Ok(());
    }
    let what = match sweep.study {
        Some(_) => "study",
        None => "sweep",
    };
    Err(Failure::refused(format_args!(
        "this folder holds the results of {}, another {what} of the same name; choose another \
         folder with --out",
        source.display()
    ))
    .at(folder.root()))
}
