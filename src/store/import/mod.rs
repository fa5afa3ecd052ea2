//! States of spheres that other programs wrote: one file per format.

mod collection;
mod lammps;
mod vtk;
mod xyz;

use super::StoreError;
use crate::document::text;
use crate::replay::WrittenState;
use std::path::Path;

/// Reads the states of a text dump of LAMMPS (`ITEM: TIMESTEP`), of an extended XYZ file, or of the
/// files of VTK that a collection (`.pvd`) names.
///
/// # Errors
/// [`StoreError::Read`], with the line at fault.
pub fn read_states(path: &Path) -> Result<Vec<WrittenState>, StoreError> {
    let end = path.extension().unwrap_or_default().to_string_lossy();
    match &end.to_ascii_lowercase()[..] {
        "pvd" => collection::states(path),
        "series" | "vtk" | "vtp" | "vtu" => Err(StoreError::Read(format!(
            "{}: files of VTK do not say their time, and series of ParaView cannot be read; give \
             a collection (`.pvd`) that names the files of all times",
            path.display()
        ))),
        _ => text_states(path),
    }
}

/// The states of a dump of LAMMPS or of an extended XYZ file.
fn text_states(path: &Path) -> Result<Vec<WrittenState>, StoreError> {
    let content = text::read(path).map_err(|error| StoreError::reading(path, error))?;
    let mut lines = FileLines {
        path,
        lines: content.lines(),
        number: 0,
    };
    let is_dump = content.trim_start().starts_with(lammps::ITEM);
    let mut states = Vec::new();
    while let Some(first) = lines.next_filled() {
        states.push(match is_dump {
            true => lammps::state(first, &mut lines)?,
            false => xyz::state(first, &mut lines)?,
        });
    }
    match states.is_empty() {
        true => Err(lines.refuse("it holds no states")),
        false => Ok(states),
    }
}

/// The line, from 1, of a place in a text.
fn line_at(text: &str, place: usize) -> u64 {
    let before = text.bytes().take(place);
    before.filter(|it| *it == b'\n').count() as u64 + 1
}

/// The lines of a file, counted.
struct FileLines<'a> {
    path: &'a Path,
    lines: std::str::Lines<'a>,
    /// Of the latest line, from 1.
    number: u64,
}

impl<'a> FileLines<'a> {
    fn next(&mut self, wanted: &str) -> Result<&'a str, StoreError> {
        self.number += 1;
        let line = self.lines.next();
        line.ok_or_else(|| self.refuse(&format!("the file ends here, where {wanted} should stand")))
    }

    /// The next line that is not blank.
    fn next_filled(&mut self) -> Option<&'a str> {
        loop {
            self.number += 1;
            let line = self.lines.next()?;
            if !line.trim().is_empty() {
                return Some(line);
            }
        }
    }

    /// The number on the next line.
    fn next_number<V: std::str::FromStr>(&mut self, what: &str) -> Result<V, StoreError> {
        let line = self.next(what)?;
        self.number(line, what)
    }

    fn number<V: std::str::FromStr>(&self, word: &str, what: &str) -> Result<V, StoreError> {
        let number = word.trim().parse();
        number.map_err(|_| self.refuse(&format!("`{}` is not {what}", word.trim())))
    }

    /// Refuses a row that has not so many words.
    fn check_columns(&self, words: &[&str], expected: usize) -> Result<(), StoreError> {
        match words.len() {
            found if found == expected => Ok(()),
            found => Err(self.refuse(&format!(
                "the row has {found} columns, but the head names {expected}"
            ))),
        }
    }

    /// The centre in these columns of a line of words.
    fn centre(&self, words: &[&str], columns: [usize; 3]) -> Result<[f64; 3], StoreError> {
        let mut centre = [0.0_f64; 3];
        for (value, column) in centre.iter_mut().zip(columns) {
            let word = words.get(column).copied();
            let word = word.ok_or_else(|| self.refuse("a coordinate is missing"))?;
            *value = self.number(word, "a coordinate")?;
            if !value.is_finite() {
                return Err(self.refuse("a coordinate is not finite"));
            }
        }
        Ok(centre)
    }

    fn refuse(&self, reason: &str) -> StoreError {
        StoreError::text(self.path, self.number, reason)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::replay::StateTime;

    fn read(text: &str) -> Result<Vec<WrittenState>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("states");
        std::fs::write(&path, text).unwrap();
        read_states(&path).map_err(|error| error.to_string())
    }

    const DUMP: &str = "ITEM: TIMESTEP\n200\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ff ff ff\n\
                        -1 1\n-2 2\n0 10\nITEM: ATOMS id type x y z vx\n7 1 0.5 -1 2 0\n\
                        3 1 -0.5 1 4 0\n";

    #[test]
    fn dumps_and_xyz_files_give_the_same_states() {
        let dump = read(&DUMP.repeat(2)).unwrap();
        assert_eq!(dump.len(), 2);
        assert_eq!(dump[0].moment, StateTime::Step(200));
        assert_eq!(
            dump[0].spheres,
            [(7, [0.5, -1.0, 2.0]), (3, [-0.5, 1.0, 4.0])]
        );
        let scaled = DUMP
            .replace("x y z", "xs ys zs")
            .replace("0.5 -1 2", "0.75 0.25 0.2");
        assert_eq!(read(&scaled).unwrap()[0].spheres[0].1, [0.5, -1.0, 2.0]);
        let timed = DUMP.replace("ITEM: NUMBER", "ITEM: TIME\n0.25\nITEM: NUMBER");
        assert_eq!(read(&timed).unwrap()[0].moment, StateTime::Time(0.25));
        let xyz = "2\nProperties=species:S:1:pos:R:3:velo:R:3:id:I:1 Time=0.25\n\
                   X 0.5 -1 2 0 0 0 7\nX -0.5 1 4 0 0 0 3\n";
        let xyz = read(xyz).unwrap();
        assert_eq!(xyz[0].moment, StateTime::Time(0.25));
        assert_eq!(xyz[0].spheres, dump[0].spheres);
        assert!(xyz[0].are_numbered && dump[0].are_numbered);
        // Without numbers the lines count.
        let plain = read("1\nTime=1e0 anything\nAr 1 2 3\n\n").unwrap();
        assert_eq!(plain[0].spheres, [(0, [1.0, 2.0, 3.0])]);
        assert!(!plain[0].are_numbered);
        // Where a sphere has left a periodic box, it goes on outside.
        let unwrapped = DUMP
            .replace("x y z vx", "x y z xu yu zu")
            .replace("0.5 -1 2 0", "0.5 -1 2 2.5 -1 2")
            .replace("-0.5 1 4 0", "-0.5 1 4 -0.5 1 4");
        assert_eq!(read(&unwrapped).unwrap()[0].spheres[0].1, [2.5, -1.0, 2.0]);
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, expected) in [
            ("", "states:1: it holds no states"),
            ("many\n", "states:1: `many` is not a number of spheres"),
            (
                "1\nTime=0\n",
                "states:3: the file ends here, where a sphere should stand",
            ),
            (
                "1\nno time\nX 1 2 3\n",
                "states:2: the line does not say `Time=`",
            ),
            ("1\nTime=0\nX 1 2\n", "states:3: a coordinate is missing"),
            (
                "1\nProperties=species:S:1:pos:R:3:id:I:1 Time=0\nX 1 2 3\n",
                "states:3: the row has 4 columns, but the head names 5",
            ),
            (
                "1\nProperties=species:S:1:velo:R:3 Time=0\nX 1 2 3\n",
                "states:2: `Properties` has no `pos:R:3`",
            ),
            (
                "1\nProperties=species:S:1:pos:R:2:radius:R:1 Time=0\nX 1 2 3\n",
                "states:2: `pos` has 2 columns, but must have 3",
            ),
            (
                "1\nProperties=species:S:1:pos:R:x Time=0\nX 1 2 3\n",
                "states:2: `pos:R:x` in `Properties` is no name",
            ),
            (
                &DUMP.replace("3 1 -0.5 1 4 0", "3 1 -0.5 1 4"),
                "states:11: the row has 5 columns, but the head names 6",
            ),
            (
                &DUMP
                    .replace("BOUNDS ff", "BOUNDS xy xz yz ff")
                    .replace("x y z vx", "xs ys zs vx"),
                "states:9: the box is oblique",
            ),
            (
                "1\nTime=0\nX 1 2 nan\n",
                "states:3: a coordinate is not finite",
            ),
            (
                &DUMP.replace("id type x", "type y"),
                "states:9: the columns have no `id`",
            ),
            (
                &DUMP.replace("x y z", "a b c"),
                "states:9: the columns have no `x`, `xu` or `xs`",
            ),
            (
                &DUMP.replace("ITEM: NUMBER OF ATOMS\n2", "ITEM: NUMBER OF ATOMS\n-2"),
                "states:4: `-2` is not a number of spheres",
            ),
            (
                &DUMP.replace("3 1 -0.5", "3 1 half"),
                "states:11: `half` is not a coordinate",
            ),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.contains(expected), "{error}\n{expected}");
        }
    }
}
