//! A file of spheres to start from: a CSV table with a header line.

use super::FileError;
use crate::document::text;
use crate::scene::StartSphere;
use std::path::Path;

/// The columns that a start file may have; the first three are required.
const COLUMNS: [&str; 10] = ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "radius"];
const NEEDED: usize = 3;
const RADIUS: usize = 9;

/// Reads the spheres of a CSV file: columns `x`, `y`, `z` (m) and optionally `vx`, `vy`,
/// `vz` (m/s), `wx`, `wy`, `wz` (rad/s) and `radius` (m), in any order, named by the header line.
///
/// A velocity or spin without a column is zero. An empty radius means the scene's radius. Blank
/// lines and lines that start with `#` are skipped.
///
/// # Errors
/// [`FileError::Read`], or [`FileError::Line`] with the line at fault.
pub(super) fn read_start(path: &Path) -> Result<Vec<StartSphere>, FileError> {
    let content = text::read(path).map_err(|error| FileError::reading(path, error))?;
    let mut lines = text::lines(&content);
    let Some((line, names)) = lines.next() else {
        let reason = "the file is empty; its first line names the columns, such as x,y,z";
        return Err(FileError::line(path, 1, reason));
    };
    let columns = header(names).map_err(|reason| FileError::line(path, line, reason))?;
    let spheres = lines
        .map(|(line, row)| {
            sphere(&columns, row).map_err(|reason| FileError::line(path, line, reason))
        })
        .collect::<Result<Vec<_>, _>>()?;
    if spheres.is_empty() {
        let reason = "no sphere follows the header line; give one sphere per line";
        return Err(FileError::line(path, line, reason));
    }
    Ok(spheres)
}

/// The line of a start file, from 1, that gives a sphere.
pub(super) fn line_of(path: &Path, sphere: usize) -> Option<u64> {
    let content = text::read(path).ok()?;
    // The header line comes first.
    text::lines(&content).nth(sphere + 1).map(|(line, _)| line)
}

fn fields(line: &str) -> impl Iterator<Item = &str> {
    line.split(',')
        .map(|field| field.trim().trim_matches('"').trim())
}

/// For each column of the file, its place in [`COLUMNS`].
fn header(line: &str) -> Result<Vec<usize>, String> {
    let mut columns = Vec::new();
    for name in fields(line) {
        let column = COLUMNS
            .iter()
            .position(|&known| known == name)
            .ok_or_else(|| {
                format!(
                    "`{name}` is not a column of a start file; the columns are {}",
                    COLUMNS.join(", ")
                )
            })?;
        if columns.contains(&column) {
            return Err(format!("column `{name}` appears twice"));
        }
        columns.push(column);
    }
    match (0..NEEDED).find(|column| !columns.contains(column)) {
        Some(missing) => Err(format!("column `{}` is missing", COLUMNS[missing])),
        None => Ok(columns),
    }
}

fn sphere(columns: &[usize], line: &str) -> Result<StartSphere, String> {
    let found = fields(line).count();
    if found != columns.len() {
        return Err(format!(
            "{found} values, but the header line names {} columns",
            columns.len()
        ));
    }
    let mut values = [0.0; RADIUS];
    let mut radius = None;
    for (&column, field) in columns.iter().zip(fields(line)) {
        let in_column = |reason| format!("column `{}`: {reason}", COLUMNS[column]);
        if column < RADIUS {
            values[column] = text::number(field).map_err(in_column)?;
        } else if !field.is_empty() {
            radius = Some(text::radius(field).map_err(in_column)?);
        }
    }
    let [x, y, z, vx, vy, vz, wx, wy, wz] = values;
    Ok(StartSphere {
        position: [x, y, z],
        velocity: [vx, vy, vz],
        spin: [wx, wy, wz],
        radius,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(content: &str) -> Result<Vec<StartSphere>, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("start.csv");
        std::fs::write(&path, content).unwrap();
        read_start(&path).map_err(|error| {
            let message = error.to_string();
            let at = message.find("start.csv").expect("names the file");
            message[at..].to_owned()
        })
    }

    #[test]
    fn positions_alone_are_enough() {
        let spheres = read("x,y,z\n0.01,-0.02,3e-2\n").unwrap();
        assert_eq!(spheres.len(), 1);
        assert_eq!(spheres[0].position, [0.01, -0.02, 0.03]);
        assert_eq!(spheres[0].velocity, [0.0; 3]);
        assert_eq!(spheres[0].spin, [0.0; 3]);
        assert_eq!(spheres[0].radius, None);
    }

    #[test]
    fn columns_come_in_any_order_and_spacing() {
        let spheres =
            read("# m\r\n\"radius\",\"wz\", z ,y,x,vy\r\n.004,7,3,2,1,5\r\n\r\n,0,0,0,0,0\r\n")
                .unwrap();
        assert_eq!(
            spheres[0],
            StartSphere {
                position: [1.0, 2.0, 3.0],
                velocity: [0.0, 5.0, 0.0],
                spin: [0.0, 0.0, 7.0],
                radius: Some(0.004),
            }
        );
        assert_eq!(spheres[1].radius, None);
    }

    #[test]
    fn names_the_line_and_the_reason() {
        for (content, message) in [
            (
                "\n",
                "start.csv:1: the file is empty; its first line names the columns, such as x,y,z",
            ),
            (
                "x,y,z\n",
                "start.csv:1: no sphere follows the header line; give one sphere per line",
            ),
            ("x,y\n0,0\n", "start.csv:1: column `z` is missing"),
            ("x,y,z,x\n", "start.csv:1: column `x` appears twice"),
            (
                "x,y,z,mass\n",
                "start.csv:1: `mass` is not a column of a start file; the columns are x, y, z, vx, \
                    vy, vz, wx, wy, wz, radius",
            ),
            (
                "x,y,z\n0,0,0\n\n0,high,0\n",
                "start.csv:4: column `y`: `high` is not a number",
            ),
            (
                "x,y,z\n0,0,NaN\n",
                "start.csv:2: column `z`: `NaN` is not a finite number",
            ),
            (
                "x,y,z\n0,,0\n",
                "start.csv:2: column `y`: a number is missing",
            ),
            (
                "x,y,z\n0,0,0\n0,0",
                "start.csv:3: 2 values, but the header line names 3 columns",
            ),
            (
                "x,y,z,radius\n0,0,0,-0.1\n",
                "start.csv:2: column `radius`: \
                 a radius must be above zero (in metres), but is `-0.1`",
            ),
        ] {
            assert_eq!(read(content).unwrap_err(), message);
        }
    }

    proptest! {
        #[test]
        fn every_bit_of_a_number_is_read(values in prop::collection::vec(-1e9..1e9f64, 9)) {
            let row: Vec<String> = values.iter().map(f64::to_string).collect();
            let spheres = read(&format!("x,y,z,vx,vy,vz,wx,wy,wz\n{}\n", row.join(","))).unwrap();
            let StartSphere { position, velocity, spin, .. } = &spheres[0];
            prop_assert_eq!([*position, *velocity, *spin].concat(), values);
        }

        #[test]
        fn no_text_panics(content in "[xyzvwradius0-9.,\\-\n#\"e ]{0,60}") {
            let _ = read(&content);
        }
    }
}
