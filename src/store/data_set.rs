//! Points of a curve of another source (CSV), such as a figure in a paper.
//!
//! A row for each point: its place on the horizontal axis, its value, and, if the file has a third
//! column, the half width of its interval. A first row of words names the columns; lines that
//! begin with `#` say what they like.

use super::StoreError;
use crate::document::text;
use csv::StringRecord;
use std::path::Path;

/// A curve of another source, such as a figure in a paper, in the units of the figure's axes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DataSet {
    /// What the legend calls it.
    pub name: String,
    /// Its points.
    pub points: Vec<(f64, f64)>,
    /// Half widths of the intervals of all points; none if there are none.
    pub half_widths: Vec<f64>,
}

/// Reads the points of a curve, which is named by its file.
///
/// # Errors
/// [`StoreError::Read`], with the line at fault.
pub fn read_data_set(path: &Path) -> Result<DataSet, StoreError> {
    let content = text::read(path).map_err(|error| StoreError::reading(path, error))?;
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(content.as_bytes());
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let mut data = DataSet {
        name: name.into_owned(),
        ..DataSet::default()
    };
    for (index, row) in reader.records().enumerate() {
        let row = row.map_err(|error| {
            let line = error.position().map_or(1, csv::Position::line);
            StoreError::text(path, line, error)
        })?;
        let line = row.position().map_or(1, csv::Position::line);
        let refuse = |reason: String| StoreError::text(path, line, reason);
        if index == 0 && row.iter().all(|word| word.parse::<f64>().is_err()) {
            continue;
        }
        let numbers = numbers(&row).map_err(refuse)?;
        match numbers[..] {
            [x, y] => data.points.push((x, y)),
            [x, y, half_width] if half_width >= 0.0 => {
                data.points.push((x, y));
                data.half_widths.push(half_width);
            }
            [_, _, _] => return Err(refuse("a half width is not negative".to_owned())),
            _ => {
                return Err(refuse(format!(
                    "{} columns; give two or three: place, value, half width of its interval",
                    numbers.len()
                )));
            }
        }
    }
    match data.points.is_empty() {
        true => Err(StoreError::text(
            path,
            1,
            "it holds no points: a row of two numbers for each",
        )),
        false => Ok(data),
    }
}

fn numbers(row: &StringRecord) -> Result<Vec<f64>, String> {
    let number = |word: &str| match word.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(format!(
            "`{word}` is not a finite number, as `0.25`, with commas between numbers"
        )),
    };
    row.iter().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<DataSet, String> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("paper.csv");
        std::fs::write(&path, text).unwrap();
        read_data_set(&path).map_err(|error| {
            let folder = format!("{}/", folder.path().display());
            error.to_string().replace(&folder, "")
        })
    }

    #[test]
    fn points_are_read_with_and_without_names_and_intervals() {
        let plain = read("0,1\r\n 2 , 3e-1\r\n").unwrap();
        assert_eq!(plain.name, "paper");
        assert_eq!(plain.points, [(0.0, 1.0), (2.0, 0.3)]);
        assert!(plain.half_widths.is_empty());
        let named = read("# figure 8\nx,y,half\n1,2,0.5\n").unwrap();
        assert_eq!(
            (named.points, named.half_widths),
            (vec![(1.0, 2.0)], vec![0.5])
        );
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        for (text, expected) in [
            ("", "paper.csv:1: it holds no points"),
            ("x,y\n", "paper.csv:1: it holds no points"),
            ("x,y\n1,two\n", "paper.csv:2: `two` is not a finite number"),
            ("1,2\n3,nan\n", "paper.csv:2: `nan` is not a finite number"),
            ("1;2\n", "paper.csv:1: it holds no points"),
            ("1,2\n3;4\n", "paper.csv:2: "),
            ("1\n2\n", "paper.csv:1: 1 columns; give two or three"),
            ("1,2,3,4\n", "paper.csv:1: 4 columns; give two or three"),
            ("1,2,-1\n", "paper.csv:1: a half width is not negative"),
        ] {
            let error = read(text).unwrap_err();
            assert!(error.starts_with(expected), "{error}\n{expected}");
        }
    }
}
