//! The files that another program is given.

use super::FileError;
use crate::document::Problem;
use crate::scene::{TemplateFile, TemplateText};
use std::fs;
use std::io;
use std::path::Path;

/// Most files.
const MOST_FILES: usize = 1000;

/// Largest file that is read (bytes); all together may be no larger, which is checked later.
const LARGEST: u64 = 1_000_000;

/// Reads the files at paths, relative to `folder`, in place of these.
pub(super) fn read_templates(
    files: &mut Vec<TemplateFile>,
    folder: &Path,
    problems: &mut Vec<Problem>,
) {
    let mut texts = Vec::new();
    for (place, file) in std::mem::take(files).into_iter().enumerate() {
        let path = match file {
            TemplateFile::Text(text) => {
                texts.push(text);
                continue;
            }
            TemplateFile::Path(path) => folder.join(path),
        };
        let read = match path.is_dir() {
            true => read_folder(&path, "", &mut texts),
            false => {
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                read_file(&path, &name, &mut texts)
            }
        };
        if let Err(problem) = read {
            problems.push(Problem {
                path: format!("program.files[{place}]"),
                ..problem
            });
        }
    }
    *files = texts.into_iter().map(TemplateFile::Text).collect();
}

/// Reads all files of a folder, by name; those that begin with a point are left out.
fn read_folder(folder: &Path, head: &str, texts: &mut Vec<TemplateText>) -> Result<(), Problem> {
    let refuse = |error| Problem::new("", FileError::reading(folder, error).to_string());
    let entries = fs::read_dir(folder).map_err(refuse)?;
    let entries: Result<Vec<_>, io::Error> = entries.collect();
    let mut entries = entries.map_err(refuse)?;
    entries.sort_by_key(fs::DirEntry::file_name);
    for entry in entries {
        let (path, name) = (entry.path(), entry.file_name());
        let Some(name) = name.to_str() else {
            let message = format!("{}: the name is no text in UTF-8", path.display());
            return Err(Problem::new("", message).help("rename the file"));
        };
        if name.starts_with('.') || name == "__pycache__" {
            continue;
        }
        match path.is_dir() {
            true => read_folder(&path, &format!("{head}{name}/"), texts)?,
            false => read_file(&path, &format!("{head}{name}"), texts)?,
        }
    }
    Ok(())
}

fn read_file(path: &Path, name: &str, texts: &mut Vec<TemplateText>) -> Result<(), Problem> {
    let large = "name large files of data by their full path in a command or template instead";
    let refuse = |error| Problem::new("", FileError::reading(path, error).to_string());
    let metadata = fs::metadata(path).map_err(refuse)?;
    if !metadata.is_file() {
        let message = format!("{} is no file", path.display());
        return Err(Problem::new("", message).help("name files of text, or folders of them"));
    }
    let size = metadata.len();
    if size > LARGEST {
        let message = format!("{} has {size} bytes", path.display());
        return Err(Problem::new("", message).help(large));
    }
    if texts.len() == MOST_FILES {
        let message = format!("more than {MOST_FILES} files");
        return Err(Problem::new("", message).help("name a smaller folder"));
    }
    let bytes = fs::read(path).map_err(refuse)?;
    let text = String::from_utf8(bytes).map_err(|_| {
        let message = format!("{} is no text in UTF-8", path.display());
        Problem::new("", message).help(large)
    })?;
    texts.push(TemplateText {
        name: name.to_owned(),
        text,
    });
    Ok(())
}
