//! Which files this program has written, told by their content.

use super::export::VTK_SIGNATURE;
use serde_json::Value;
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// How much of a file is read to tell what it is (bytes), unless it must be read as a whole.
const BEGINNING: u64 = 1 << 16;

/// What the pictures of this program say of themselves: figures in SVG, states of spheres in SVG,
/// and PNG.
const STAMPS: [&[u8]; 3] = [
    b"\nSoftware: phase ",
    b"lengths in metres, up is up</desc>",
    b"Software\0phase ",
];

/// How the names of pictures end.
const PICTURES: [&str; 3] = [".svg", ".png", ".apng"];

/// Whether a name ends like that, in small or capital letters.
fn ends(name: &str, end: &str) -> bool {
    name.to_ascii_lowercase().ends_with(end)
}

/// What a file is, as far as this program writes such files.
enum OwnFile {
    /// A picture (SVG or PNG) with a stamp.
    Picture,
    /// A table (CSV) whose header line has these columns beside each other.
    Table(&'static str),
    /// A text whose beginning holds this.
    Text(&'static str),
    /// A JSON object with these keys.
    Object(&'static [&'static str]),
}

/// The kind of the files of that name; none for a name that this program does not give.
fn kind_of(name: &str) -> Option<OwnFile> {
    Some(match name {
        "sweep.json" => OwnFile::Object(&["scene", "axes", "seeds"]),
        "progress.json" => OwnFile::Object(&["basis", "chosen"]),
        "accuracy.json" => OwnFile::Object(&["outcomes", "finding"]),
        "ablation.json" => OwnFile::Object(&["ablated", "finding"]),
        "labels.csv" => OwnFile::Table("seed,label,code"),
        "points.csv" => OwnFile::Table("label,code,agreement,seeds"),
        "failed.csv" => OwnFile::Table("seed,reason"),
        "refined.csv" => OwnFile::Table("label,code,p_"),
        "borders.csv" => OwnFile::Table("along,below,above,low_68,high_68"),
        "runs.csv" | "accuracy.csv" => OwnFile::Table("setting,"),
        "ablation.csv" => OwnFile::Table("without,"),
        "stability.json" => OwnFile::Object(&["integrators"]),
        "verification.csv" => OwnFile::Table("family,case,integrator,quantity"),
        name if name.ends_with("-observations.csv") => OwnFile::Table("time,"),
        name if name.ends_with("-fixed.csv") => OwnFile::Table("kind,x,y,z,radius"),
        name if name.ends_with(".xyz") => {
            OwnFile::Text("Properties=species:S:1:pos:R:3:radius:R:1")
        }
        name if name.ends_with(".vtp") || name.ends_with(".pvd") => OwnFile::Text(VTK_SIGNATURE),
        name if name.ends_with(".1") => OwnFile::Text(".TH phase"),
        name if PICTURES.iter().any(|end| ends(name, end)) => OwnFile::Picture,
        _ => return None,
    })
}

/// Whether a file is as this program writes files of its name, such as `labels.csv` or `phase.svg`:
/// then it may be replaced. So may an empty one, and one that is not there.
pub fn is_own_file(path: &Path) -> bool {
    if !path.exists() {
        return true;
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Some(kind) = kind_of(&name) else {
        return false;
    };
    let most = match kind {
        OwnFile::Object(_) => u64::MAX,
        _ => BEGINNING,
    };
    read(path, most).is_ok_and(|bytes| bytes.is_empty() || kind.is_of(&bytes))
}

/// The first bytes of a file, so many at most.
fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

impl OwnFile {
    /// Whether a file that begins with these bytes is of this kind; an object is given as a whole.
    fn is_of(&self, bytes: &[u8]) -> bool {
        let holds = |bytes: &[u8], text: &[u8]| bytes.windows(text.len()).any(|it| it == text);
        match self {
            Self::Picture => STAMPS.iter().any(|stamp| holds(bytes, stamp)),
            Self::Text(text) => holds(bytes, text.as_bytes()),
            Self::Table(columns) => {
                let header = bytes.split(|byte| *byte == b'\n').next();
                holds(header.unwrap_or_default(), columns.as_bytes())
            }
            Self::Object(keys) => {
                let object: Result<Value, _> = serde_json::from_slice(bytes);
                object.is_ok_and(|object| keys.iter().all(|key| object.get(key).is_some()))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    /// The number of files in a folder and its subfolders that are recognised by their content.
    fn told(folder: &Path) -> usize {
        let mut count = 0;
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.ends_with("quick") {
                // Not shipped: the commands of the documentation write there.
                continue;
            }
            if path.is_dir() {
                count += told(&path);
            } else if kind_of(&path.file_name().unwrap().to_string_lossy()).is_some() {
                assert!(is_own_file(&path), "{}", path.display());
                count += 1;
            }
        }
        count
    }

    #[test]
    fn what_is_shipped_is_ours() {
        assert!(told(Path::new("results")) > 100);
    }

    #[test]
    fn files_of_others_are_not_ours() {
        let place = tempfile::tempdir().unwrap();
        for (name, text) in [
            ("sweep.json", "{\"learning_rate\": [1, 2]}"),
            ("sweep.json", "[1, 2]"),
            ("sweep.json", "not JSON"),
            ("labels.csv", "image,label\n1.png,cat\n"),
            ("labels.csv", "id,label\n1,cat\n"),
            ("points.csv", "x,y\n1,2\n"),
            ("refined.csv", "x,y\n1,2\n"),
            ("failed.csv", "id,reason\n"),
            (
                "phase.svg",
                "<svg xmlns=\"http://www.w3.org/2000/svg\"></svg>",
            ),
            ("phase.png", "\u{89}PNG"),
            ("run.xyz", "1\nsteel\nFe 0 0 0\n"),
            ("walls.vtp", "<?xml version=\"1.0\"?>\n<VTKFile>"),
            ("phase.1", ".TH moon 1\n"),
            ("notes.txt", "phase"),
        ] {
            let path = place.path().join(name);
            fs::write(&path, text).unwrap();
            assert!(!is_own_file(&path), "{name}: {text}");
        }
        let path = place.path().join("phase.svg");
        fs::write(&path, "").unwrap();
        assert!(is_own_file(&path));
        fs::remove_file(&path).unwrap();
        fs::create_dir(&path).unwrap();
        assert!(!is_own_file(&path));
        assert!(is_own_file(&place.path().join("absent.svg")));
    }
}
