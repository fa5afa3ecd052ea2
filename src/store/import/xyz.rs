//! Extended XYZ: the number of spheres, a line with `Properties=` and `Time=`, a line per sphere.

use super::Lines;
use crate::replay::{Moment, WrittenState};
use crate::store::StoreError;

/// Columns of the places and of the numbers.
struct Columns {
    place: usize,
    number: Option<usize>,
}

/// A state whose first line is given.
pub(super) fn state(first: &str, lines: &mut Lines<'_>) -> Result<WrittenState, StoreError> {
    let count: usize = lines.number(first, "a number of spheres")?;
    let head = lines.next("the line with `Time=`")?;
    let time = key(head, "Time").or_else(|| key(head, "time"));
    let time = time.ok_or_else(|| lines.refuse("the line does not say `Time=`"))?;
    let moment = Moment::Time(lines.number(time, "a time")?);
    let columns = columns(head);
    let mut spheres = Vec::new();
    for index in 0..count {
        let line = lines.next("a sphere")?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let centre = lines.centre(&words, [0, 1, 2].map(|axis| columns.place + axis))?;
        let number = match columns.number.and_then(|column| words.get(column)) {
            Some(word) => lines.number(word, "a number of a sphere")?,
            None => index as u64,
        };
        spheres.push((number, centre));
    }
    Ok(WrittenState { moment, spheres })
}

/// The value of a key, with or without quotation marks.
fn key<'a>(head: &'a str, name: &str) -> Option<&'a str> {
    let mut parts = head.split_whitespace();
    let own = parts.find_map(|part| part.strip_prefix(name)?.strip_prefix('='));
    own.map(|value| value.trim_matches('"'))
}

/// By the list of properties: name, kind and number of columns of each. Without one, the places
/// stand behind the species.
fn columns(head: &str) -> Columns {
    let mut columns = Columns {
        place: 1,
        number: None,
    };
    let properties = key(head, "Properties").unwrap_or_default();
    let mut words = properties.split(':');
    let mut column = 0;
    while let (Some(name), Some(_kind), Some(width)) = (words.next(), words.next(), words.next()) {
        match name {
            "pos" => columns.place = column,
            "id" => columns.number = Some(column),
            _ => {}
        }
        column += width.parse().unwrap_or(1);
    }
    columns
}
