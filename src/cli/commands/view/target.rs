//! The file that `phase view` writes.

use super::Arguments;
use crate::cli::exit::Failure;
use crate::cli::folders;
use std::path::{Path, PathBuf};

/// A kind of file.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// PNG, of one picture or animated (APNG).
    Png,
    Gif,
}

impl Kind {
    /// How such files begin.
    fn signature(self) -> &'static [u8] {
        match self {
            Self::Png => b"\x89PNG\r\n\x1a\n",
            Self::Gif => b"GIF8",
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Png => "a PNG picture",
            Self::Gif => "a GIF",
        }
    }
}

/// The file to write.
pub(super) struct Target {
    pub(super) path: PathBuf,
    pub(super) kind: Kind,
}

impl Target {
    /// The file on the command line, of the kind that its name indicates.
    pub(super) fn new(arguments: &Arguments) -> Result<Self, Failure> {
        let path = arguments.animate.as_ref().or(arguments.out.as_ref());
        if arguments.records.len() > 1 && path.is_none() {
            return Err(Failure::refused(
                "several records need --out for the name of the picture",
            ));
        }
        let path = path.cloned();
        let path = path.unwrap_or_else(|| arguments.records[0].with_extension("png"));
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let kind = match (extension.to_str(), &arguments.animate) {
            (Some("png"), _) | (Some("apng"), Some(_)) => Kind::Png,
            (Some("gif"), Some(_)) => Kind::Gif,
            (_, Some(_)) => {
                return Err(
                    Failure::refused("an animation must be a .png (APNG) or .gif file").at(path),
                );
            }
            (_, None) => {
                return Err(Failure::refused("a picture must be a .png file").at(path));
            }
        };
        Ok(Self { path, kind })
    }

    /// Refuses to replace anything but a picture of the same kind that this program wrote.
    pub(super) fn check(&self, records: &[PathBuf]) -> Result<(), Failure> {
        let refused = |why: &str| {
            let path = self.path.display();
            Err(Failure::refused(format_args!("{path}: {why}")))
        };
        let target = self.path.canonicalize().ok();
        let is_target = |record: &PathBuf| record.canonicalize().ok() == target;
        if target.is_some() && records.iter().any(is_target) {
            return refused("this is the record itself; choose another name for the picture");
        }
        if self.path.is_dir() {
            return refused("this is a folder; name a file in it");
        }
        folders::refuse_to_replace(&self.path, self.kind.name(), self.kind.signature())?;
        match self.kind {
            Kind::Png => {
                let remedy = "choose another name with --out";
                folders::refuse_foreign(Path::new(""), [&self.path], remedy)
            }
            // A GIF says nothing of what made it.
            Kind::Gif => Ok(()),
        }
    }
}
