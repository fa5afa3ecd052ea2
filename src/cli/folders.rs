//! Folders for what commands write.

use super::exit::Failure;
use phase::store;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Makes a folder and those above it, unless they are there.
pub(super) fn make(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| {
        Failure::failed(format_args!(
            "{}: {error}{}",
            folder.display(),
            store::advice(&error)
        ))
    })
}

/// Refuses to write over a file that does not begin with `signature`, as far as it goes: it is
/// something other than `kind`, which the command would write there.
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
        return Err(Failure::refused(format_args!(
            "{}: this is the name of a folder; give that of a file in it",
            path.display()
        )));
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
        "{}: this is not {kind}, and would be lost; choose another name for what is written",
        path.display()
    )))
}

/// Makes the folder of a file.
pub(super) fn make_for(file: &Path) -> Result<(), Failure> {
    make(file.parent().unwrap_or(Path::new("")))
}

/// Refuses a folder that holds frames which `count` new ones would not replace: what they are of
/// could not be told any more.
pub(super) fn refuse_other_frames(
    folder: &Path,
    count: usize,
    extension: &str,
) -> Result<(), Failure> {
    let beyond = folder.join(store::frame_name(count, extension));
    if beyond.exists() {
        return Err(Failure::refused(format_args!(
            "{}: this is a frame of another export, which had more of them; remove them, or choose \
             another folder",
            beyond.display()
        )));
    }
    Ok(())
}
