//! Text dumps of LAMMPS (`dump atom` and `dump custom`), which LIGGGHTS writes too.

use super::FileLines;
use crate::replay::{StateTime, WrittenState};
use crate::store::StoreError;

/// How each part of a state begins.
pub(super) const ITEM: &str = "ITEM:";

/// A state whose first line is given.
pub(super) fn state<'a>(
    first: &'a str,
    lines: &mut FileLines<'a>,
) -> Result<WrittenState, StoreError> {
    let (mut moment, mut count, mut bounds) = (None, None, Vec::new());
    let mut is_oblique = false;
    let mut line = first;
    loop {
        let item = line.strip_prefix(ITEM).map(str::trim);
        let item = item.ok_or_else(|| lines.refuse("`ITEM:` is expected"))?;
        if let Some(columns) = item.strip_prefix("ATOMS") {
            let count = count.ok_or_else(|| lines.refuse("the number of atoms is missing"))?;
            let moment = moment.ok_or_else(|| lines.refuse("the time step is missing"))?;
            let bounds = (!is_oblique).then_some(&bounds[..]);
            return Ok(WrittenState {
                moment,
                are_numbered: true,
                spheres: spheres(columns, count, bounds, lines)?,
            });
        }
        if item == "TIMESTEP" {
            let step = lines.next_number("a number of steps")?;
            moment.get_or_insert(StateTime::Step(step));
        } else if item == "TIME" {
            moment = Some(StateTime::Time(lines.next_number("a time")?));
        } else if item == "NUMBER OF ATOMS" {
            count = Some(lines.next_number("a number of spheres")?);
        } else if let Some(kind) = item.strip_prefix("BOX BOUNDS") {
            is_oblique = kind.contains("xy") || kind.contains("abc");
            for _ in 0..3 {
                bounds.push(extent(lines)?);
            }
        } else {
            // Such as the units, which do not matter here.
            lines.next("what belongs to the item")?;
        }
        line = lines.next("`ITEM:`")?;
    }
}

/// The ends of the box along an axis.
fn extent(lines: &mut FileLines<'_>) -> Result<[f64; 2], StoreError> {
    let line = lines.next("the bounds of the box")?;
    let mut words = line.split_whitespace();
    let mut end = || lines.number(words.next().unwrap_or_default(), "a bound of the box");
    Ok([end()?, end()?])
}

/// The spheres; `bounds`: of the box, unless it is oblique.
fn spheres(
    columns: &str,
    count: usize,
    bounds: Option<&[[f64; 2]]>,
    lines: &mut FileLines<'_>,
) -> Result<Vec<(u64, [f64; 3])>, StoreError> {
    let names: Vec<&str> = columns.split_whitespace().collect();
    let find = |name: &str| names.iter().position(|it| *it == name);
    let number = find("id").ok_or_else(|| lines.refuse("the columns have no `id`"))?;
    let place = |end: &str| {
        Some([
            find(&format!("x{end}"))?,
            find(&format!("y{end}"))?,
            find(&format!("z{end}"))?,
        ])
    };
    // Where both stand there, `xu` goes on behind a periodic side, and `x` jumps to the other.
    let (place, scaled) = match (place("u").or_else(|| place("")), place("s"), bounds) {
        (Some(place), ..) => (place, None),
        (None, Some(_), None) => {
            return Err(lines.refuse(
                "the box is oblique, and `xs` are shares of its edges; dump `x y z` in their place",
            ));
        }
        (None, Some(place), Some(bounds)) if bounds.len() == 3 => (place, Some(bounds)),
        _ => return Err(lines.refuse("the columns have no `x`, `xu` or `xs`, with y and z")),
    };
    let mut spheres = Vec::new();
    for _ in 0..count {
        let line = lines.next("a sphere")?;
        let words: Vec<&str> = line.split_whitespace().collect();
        lines.check_columns(&words, names.len())?;
        let mut centre = lines.centre(&words, place)?;
        if let Some(bounds) = scaled {
            for (value, [low, high]) in centre.iter_mut().zip(bounds) {
                *value = low + *value * (high - low);
            }
        }
        spheres.push((lines.number(words[number], "a number of a sphere")?, centre));
    }
    Ok(spheres)
}
