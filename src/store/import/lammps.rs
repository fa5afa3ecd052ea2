//! Text dumps of LAMMPS (`dump atom` and `dump custom`), of which LIGGGHTS writes the same.

use super::Lines;
use crate::replay::{Moment, WrittenState};
use crate::store::StoreError;

/// How each part of a state begins.
pub(super) const ITEM: &str = "ITEM:";

/// A state whose first line is given.
pub(super) fn state<'a>(first: &'a str, lines: &mut Lines<'a>) -> Result<WrittenState, StoreError> {
    let (mut moment, mut count, mut bounds) = (None, None, Vec::new());
    let mut line = first;
    loop {
        let item = line.strip_prefix(ITEM).map(str::trim);
        let item = item.ok_or_else(|| lines.refuse("`ITEM:` is expected"))?;
        if let Some(columns) = item.strip_prefix("ATOMS") {
            let count = count.ok_or_else(|| lines.refuse("the number of atoms is missing"))?;
            let moment = moment.ok_or_else(|| lines.refuse("the time step is missing"))?;
            let spheres = spheres(columns, count, &bounds, lines)?;
            return Ok(WrittenState { moment, spheres });
        }
        if item == "TIMESTEP" {
            let step = lines.next_number("a number of steps")?;
            moment.get_or_insert(Moment::Step(step));
        } else if item == "TIME" {
            moment = Some(Moment::Time(lines.next_number("a time")?));
        } else if item == "NUMBER OF ATOMS" {
            count = Some(lines.next_number("a number of spheres")?);
        } else if item.starts_with("BOX BOUNDS") {
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
fn extent(lines: &mut Lines<'_>) -> Result<[f64; 2], StoreError> {
    let line = lines.next("the bounds of the box")?;
    let mut words = line.split_whitespace();
    let mut end = || lines.number(words.next().unwrap_or_default(), "a bound of the box");
    Ok([end()?, end()?])
}

fn spheres(
    columns: &str,
    count: usize,
    bounds: &[[f64; 2]],
    lines: &mut Lines<'_>,
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
    let (place, scaled) = match (place("").or_else(|| place("u")), place("s")) {
        (Some(place), _) => (place, false),
        (None, Some(place)) if bounds.len() == 3 => (place, true),
        _ => return Err(lines.refuse("the columns have no `x`, `xu` or `xs`, with y and z")),
    };
    let mut spheres = Vec::new();
    for _ in 0..count {
        let line = lines.next("a sphere")?;
        let words: Vec<&str> = line.split_whitespace().collect();
        let mut centre = lines.centre(&words, place)?;
        if scaled {
            for (value, [low, high]) in centre.iter_mut().zip(bounds) {
                *value = low + *value * (high - low);
            }
        }
        let word = words.get(number).copied().unwrap_or_default();
        spheres.push((lines.number(word, "a number of a sphere")?, centre));
    }
    Ok(spheres)
}
