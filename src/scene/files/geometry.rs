//! The silo's own text file (Remmers, 2009): the numbers of wall and door spheres, then x, height
//! and radius of each.

use super::FileError;
use crate::document::quantities::LENGTHS;
use crate::document::text;
use crate::scene::{FixedSphere, FixedSpheres, LengthUnit};
use std::path::Path;

/// Largest number of fixed spheres in a file.
const MOST_SPHERES: u64 = 10_000_000;

/// Reads the fixed spheres of a silo, whose lengths are in `unit`. Blank lines and lines that
/// start with `#` are skipped.
///
/// # Errors
/// [`FileError::Read`], or [`FileError::Line`] with the line that is wrong.
pub(super) fn read_geometry(path: &Path, unit: LengthUnit) -> Result<FixedSpheres, FileError> {
    let content = text::read(path).map_err(|error| FileError::reading(path, error))?;
    let wrong = |line, reason: String| FileError::line(path, line, reason);
    let mut lines = text::lines(&content);
    let Some((first, header)) = lines.next() else {
        let reason = "the file is empty; its first line holds the numbers of wall and door \
                      spheres, such as `183 5`";
        return Err(wrong(1, reason.to_owned()));
    };
    let [walls, door] = counts(header).map_err(|reason| wrong(first, reason))?;
    // No memory is reserved for what the file announces.
    let mut spheres = Vec::new();
    let mut last = first;
    for (line, text) in lines {
        last = line;
        if spheres.len() as u64 == walls + door {
            let reason = format!(
                "line {first} announces {walls} + {door} spheres, but here is one more; correct \
                 the numbers or remove the line"
            );
            return Err(wrong(line, reason));
        }
        spheres.push(sphere(text, unit).map_err(|reason| wrong(line, reason))?);
    }
    if (spheres.len() as u64) < walls + door {
        let reason = format!(
            "the file ends after {} spheres, but line {first} announces {walls} + {door}; add the \
             missing lines or correct the numbers",
            spheres.len()
        );
        return Err(wrong(last, reason));
    }
    let door = spheres.split_off(walls as usize);
    Ok(FixedSpheres {
        walls: spheres,
        door,
    })
}

fn counts(header: &str) -> Result<[u64; 2], String> {
    let usage = "the first line holds two whole numbers, of wall and of door spheres";
    let fields: Vec<&str> = header.split_whitespace().collect();
    let [walls, door] = fields[..] else {
        return Err(format!("`{header}`: {usage}"));
    };
    let count = |field: &str| match field.parse::<u64>() {
        Ok(count) if count <= MOST_SPHERES => Ok(count),
        Ok(count) => Err(format!(
            "{count} spheres are too many; the maximum is {MOST_SPHERES}"
        )),
        Err(_) => Err(format!("`{field}` is not a whole number; {usage}")),
    };
    Ok([count(walls)?, count(door)?])
}

fn sphere(line: &str, unit: LengthUnit) -> Result<FixedSphere, String> {
    let [least, largest] = LENGTHS;
    let fields: Vec<&str> = line.split_whitespace().collect();
    let [x, height, radius] = fields[..] else {
        return Err(format!(
            "{} values, but a sphere has three: x, height and radius",
            fields.len()
        ));
    };
    let metres = |field| {
        let value = text::number(field)? / unit.per_metre();
        if value.abs() > largest {
            return Err(format!(
                "`{field}` is {value:e} m; the maximum is {largest:e} m"
            ));
        }
        Ok(value)
    };
    let position = [metres(x)?, 0.0, metres(height)?];
    match metres(radius)? {
        value if value >= least => Ok(FixedSphere {
            position,
            radius: value,
        }),
        value if value > 0.0 => Err(format!(
            "a radius of {value:e} m is too small; the minimum is {least:e} m"
        )),
        _ => Err(format!("a radius must be above zero, but is `{radius}`")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(content: &str, unit: LengthUnit) -> Result<FixedSpheres, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("silo.dat");
        std::fs::write(&path, content).unwrap();
        read_geometry(&path, unit).map_err(|error| {
            let message = error.to_string();
            let at = message.find("silo.dat").expect("names the file");
            message[at..].to_owned()
        })
    }

    #[test]
    fn the_printed_lines_are_centimetres() {
        let text = "2 1\n-1.300e+02 4.000e+02 3.000e+00\n-1.300e+02 3.950e+02 3.000e+00\n0 10 3\n";
        let silo = read(text, LengthUnit::Centimetre).unwrap();
        assert_eq!(silo.walls.len(), 2);
        assert_eq!(silo.walls[1].position, [-1.3, 0.0, 3.95]);
        assert_eq!(silo.walls[1].radius, 0.03);
        assert_eq!(silo.door.len(), 1);
        let metres = "2 1\n-1.3 4 .03\n-1.3 3.95 .03\n0 .1 .03\n";
        assert_eq!(read(metres, LengthUnit::Metre).unwrap(), silo);
    }

    #[test]
    fn names_the_line_and_the_reason() {
        for (content, message) in [
            (
                "",
                "silo.dat:1: the file is empty; its first line holds the numbers of wall and door \
                 spheres, such as `183 5`",
            ),
            (
                "three 5\n",
                "silo.dat:1: `three` is not a whole number; the first line holds two whole \
                 numbers, of wall and of door spheres",
            ),
            (
                "-1 5\n",
                "silo.dat:1: `-1` is not a whole number; the first line holds two whole numbers, \
                 of wall and of door spheres",
            ),
            (
                "1\n0 0 1\n",
                "silo.dat:1: `1`: the first line holds two whole numbers, of wall and of door \
                 spheres",
            ),
            (
                "99999999999 1\n",
                "silo.dat:1: 99999999999 spheres are too many; the maximum is 10000000",
            ),
            (
                "2 0\n0 0 1\n",
                "silo.dat:2: the file ends after 1 spheres, but line 1 announces 2 + 0; add the \
                 missing lines or correct the numbers",
            ),
            (
                "1 0\n0 0 1\n\n1 0 1\n",
                "silo.dat:4: line 1 announces 1 + 0 spheres, but here is one more; correct the \
                 numbers or remove the line",
            ),
            (
                "1 0\n0 0\n",
                "silo.dat:2: 2 values, but a sphere has three: x, height and radius",
            ),
            ("1 0\n0 NaN 1\n", "silo.dat:2: `NaN` is not a finite number"),
            ("1 0\n0 high 1\n", "silo.dat:2: `high` is not a number"),
            (
                "1 0\n0 0 -3\n",
                "silo.dat:2: a radius must be above zero, but is `-3`",
            ),
        ] {
            let error = read(content, LengthUnit::Centimetre).unwrap_err();
            assert_eq!(error, message);
        }
    }

    proptest! {
        #[test]
        fn every_sphere_is_read(
            values in prop::collection::vec((-9.0..9.0f64, 0.0..9.0f64, 1e-3..1.0f64), 1..20),
            door in 0usize..4,
        ) {
            let door = door.min(values.len());
            let walls = values.len() - door;
            let rows: Vec<String> = values.iter().map(|(x, z, r)| format!("{x} {z} {r}")).collect();
            let text = format!("{walls} {door}\n{}\n", rows.join("\n"));
            let silo = read(&text, LengthUnit::Metre).unwrap();
            prop_assert_eq!((silo.walls.len(), silo.door.len()), (walls, door));
            for (sphere, (x, z, radius)) in silo.walls.iter().chain(&silo.door).zip(values) {
                prop_assert_eq!(sphere.position, [x, 0.0, z]);
                prop_assert_eq!(sphere.radius, radius);
            }
        }

        #[test]
        fn no_text_panics(content in "[0-9.,\\-\n#e nai]{0,60}") {
            let _ = read(&content, LengthUnit::Metre);
        }
    }
}
