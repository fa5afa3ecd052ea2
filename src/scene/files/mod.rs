//! The files that a scene names: radii, fixed spheres, spheres to start from.

mod geometry;
mod program;
mod radii;
mod start;

use super::{Geometry, LIST_KEY, Radii, Scene, Start};
use crate::document::{Problem, advice};
use geometry::read_geometry;
use program::read_templates;
use radii::read_radii;
use start::{line_of, read_start};
use std::io;
use std::path::{Path, PathBuf};

/// Why a file that a scene names cannot be read.
#[derive(Debug, thiserror::Error)]
enum FileError {
    /// The file cannot be opened or read.
    #[error("cannot read {}: {source}{}", path.display(), advice(source))]
    Read {
        /// The file.
        path: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// A line is wrong.
    #[error("{}:{line}: {reason}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: u64,
        /// What is wrong and what is expected.
        reason: String,
    },
}

/// The same problem for spheres read from a start file: a problem of a sphere then names its line.
pub(crate) fn in_start_file(path: &Path, problem: Problem) -> Problem {
    let index = problem.path.strip_prefix(LIST_KEY);
    let index = index.and_then(|it| it.strip_prefix('[')?.split(']').next()?.parse().ok());
    match index.and_then(|sphere| line_of(path, sphere)) {
        Some(line) => Problem {
            message: format!("{}:{line}: {}", path.display(), problem.message),
            path: "start.path".to_owned(),
            ..problem
        },
        None => problem,
    }
}

impl FileError {
    fn reading(path: &Path, source: io::Error) -> Self {
        Self::Read {
            path: path.to_owned(),
            source,
        }
    }

    fn line(path: &Path, line: u64, reason: impl ToString) -> Self {
        Self::Line {
            path: path.to_owned(),
            line,
            reason: reason.to_string(),
        }
    }
}

impl Scene {
    /// Whether some of its values are still in files.
    pub(crate) fn names_files(&self) -> bool {
        matches!(self.spheres.radius, Radii::File { .. })
            || matches!(self.dem.geometry, Some(Geometry::File { .. }))
            || matches!(self.start, Start::File { .. })
            || self
                .program
                .as_ref()
                .is_some_and(|it| it.texts().count() < it.files.len())
    }

    /// Replaces the names of files, relative to `folder`, by their contents.
    pub(crate) fn read_files(&mut self, folder: &Path, problems: &mut Vec<Problem>) {
        let mut refuse = |key: &str, error: FileError| {
            problems.push(Problem::new(key, error.to_string()));
        };
        if let Radii::File { file } = &self.spheres.radius {
            match read_radii(&folder.join(file)) {
                Ok(radii) => self.spheres.radius = Radii::Each(radii),
                Err(error) => refuse("spheres.radius.file", error),
            }
        }
        if let Some(Geometry::File { path, unit }) = &self.dem.geometry {
            match read_geometry(&folder.join(path), *unit) {
                Ok(spheres) => {
                    self.dem.geometry = Some(Geometry::List {
                        walls: spheres.walls,
                        door: spheres.door,
                    });
                }
                Err(error) => refuse("geometry.path", error),
            }
        }
        if let Some(program) = &mut self.program {
            read_templates(&mut program.files, folder, problems);
        }
        let mut refuse = |key: &str, error: FileError| {
            problems.push(Problem::new(key, error.to_string()));
        };
        if let Start::File { path } = &self.start {
            match read_start(&folder.join(path)) {
                Ok(spheres) => self.start = Start::list(spheres),
                Err(error) => refuse("start.path", error),
            }
        }
    }
}
