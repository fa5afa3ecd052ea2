//! Extended XYZ: the number of spheres, a line with `Properties=` and `Time=`, a line per sphere.

use super::FileLines;
use crate::replay::{StateTime, WrittenState};
use crate::store::StoreError;

/// Where a row has what is read of it.
struct XyzColumns {
    place: usize,
    number: Option<usize>,
    /// How many words a row has, if the file says it.
    all: Option<usize>,
}

/// A state whose first line is given.
pub(super) fn state(first: &str, lines: &mut FileLines<'_>) -> Result<WrittenState, StoreError> {
    let count: usize = lines.number(first, "a number of spheres")?;
    let head = lines.next("the line with `Time=`")?;
    let time = key(head, "Time").or_else(|| key(head, "time"));
    let time = time.ok_or_else(|| lines.refuse("the line does not say `Time=`"))?;
    let moment = StateTime::Time(lines.number(time, "a time")?);
    let columns = columns(head).map_err(|reason| lines.refuse(&reason))?;
    let mut spheres = Vec::new();
    for index in 0..count {
        let line = lines.next("a sphere")?;
        let words: Vec<&str> = line.split_whitespace().collect();
        if let Some(all) = columns.all {
            lines.check_columns(&words, all)?;
        }
        let centre = lines.centre(&words, [0, 1, 2].map(|axis| columns.place + axis))?;
        let number = match columns.number {
            Some(column) => lines.number(words[column], "a number of a sphere")?,
            None => index as u64,
        };
        spheres.push((number, centre));
    }
    Ok(WrittenState {
        moment,
        are_numbered: columns.number.is_some(),
        spheres,
    })
}

/// The value of a key, with or without quotation marks.
fn key<'a>(head: &'a str, name: &str) -> Option<&'a str> {
    let mut parts = head.split_whitespace();
    let own = parts.find_map(|part| part.strip_prefix(name)?.strip_prefix('='));
    own.map(|value| value.trim_matches('"'))
}

/// By the list of properties: name, kind and number of columns of each. Without one, the places
/// stand behind the species.
fn columns(head: &str) -> Result<XyzColumns, String> {
    let Some(properties) = key(head, "Properties") else {
        return Ok(XyzColumns {
            place: 1,
            number: None,
            all: None,
        });
    };
    let words: Vec<&str> = properties.split(':').collect();
    let (mut place, mut number, mut column) = (None, None, 0);
    for property in words.chunks(3) {
        let width = property.get(2).and_then(|it| it.parse::<usize>().ok());
        let Some(width @ 1..) = width else {
            let property = property.join(":");
            return Err(format!(
                "`{property}` in `Properties` is no name, kind and number of columns, such as \
                 `pos:R:3`"
            ));
        };
        match (property[0], width) {
            ("pos", 3) => place = Some(column),
            ("pos", _) => return Err(format!("`pos` has {width} columns, but must have 3")),
            ("id", _) => number = Some(column),
            _ => {}
        }
        column += width;
    }
    Ok(XyzColumns {
        place: place.ok_or("`Properties` has no `pos:R:3`, the centres")?,
        number,
        all: Some(column),
    })
}
