//! The page of all keys.

use super::InputFile;
use crate::document::kind::{KeyTable, NumberRange, TableKey, ValueKind};
use crate::document::number;
use serde_json::Value;
use std::collections::BTreeSet;

const INTRODUCTION: &str = "\
# Keys of scene, sweep and study files

This page is made by `phase generate reference keys`. Units are SI throughout, angles are in
radians, z points up, and the tank's axis is the z axis. A key whose default is *needed* is
required; without a default, the description says what leaving it out means. A table that several
kinds of files share appears once.
";

/// The page of all keys of all files, in Markdown: type, unit, default, description.
pub fn keys() -> String {
    let mut page = KeysPage {
        text: INTRODUCTION.to_owned(),
        sections: BTreeSet::new(),
    };
    for file in InputFile::ALL {
        let heading = match file {
            InputFile::Scene => "Scene files",
            InputFile::Sweep => "Sweep files",
            InputFile::Stability => "Studies of stability",
            InputFile::Accuracy => "Studies of accuracy",
        };
        page.text += &format!("\n## {heading}\n\n");
        page.tables("", None, &file.schema().kind);
    }
    page.text
}

/// The page so far.
struct KeysPage {
    text: String,
    /// The sections in it, each with its heading.
    sections: BTreeSet<String>,
}

impl KeysPage {
    /// The tables of keys that a value at `path` may have, whose key has this `description`.
    fn tables(&mut self, path: &str, description: Option<&str>, kind: &ValueKind) {
        match kind {
            ValueKind::Table(table) if path.is_empty() => {
                self.text += &(paragraphs(table) + &rows(table));
                self.tables_below(path, table);
            }
            ValueKind::Table(table) => {
                // The row of its key says the same.
                let text = match table.description.as_deref() == description {
                    true => String::new(),
                    false => paragraphs(table),
                };
                self.section(&heading(path), &(text + &rows(table)));
                self.tables_below(path, table);
            }
            ValueKind::Tagged(tag, variants) => {
                for variant in variants {
                    let (word, table) = (&variant.word, &variant.table);
                    let heading = format!("{} with `{tag} = \"{word}\"`", heading(path));
                    self.section(&heading, &(paragraphs(table) + &rows(table)));
                    self.tables_below(path, table);
                }
            }
            ValueKind::List(entry) => self.tables(&format!("{path}[]"), description, entry),
            // A scene within a sweep has a separate chapter.
            ValueKind::Either(_) if path == "scene" => {}
            ValueKind::Either(kinds) => {
                for kind in kinds {
                    self.tables(path, description, kind);
                }
            }
            ValueKind::Text
            | ValueKind::Flag
            | ValueKind::Number(_)
            | ValueKind::Whole(_)
            | ValueKind::Choice(_)
            | ValueKind::Vector
            | ValueKind::Any
            | ValueKind::AnyTable => {}
        }
    }

    /// The tables of the keys of `table`.
    fn tables_below(&mut self, path: &str, table: &KeyTable) {
        for key in &table.keys {
            self.tables(&key.path(path), key.description.as_deref(), &key.kind);
        }
    }

    /// A section, unless the page has it already.
    fn section(&mut self, heading: &str, content: &str) {
        let section = format!("\n### {heading}\n\n{content}");
        if !self.sections.contains(&section) {
            self.text += &section;
            self.sections.insert(section);
        }
    }
}

/// The description of a table.
fn paragraphs(table: &KeyTable) -> String {
    match &table.description {
        Some(text) => format!("{}\n\n", text.replace('\n', "\n\n")),
        None => String::new(),
    }
}

/// A row for each key, except the one that selects this table.
fn rows(table: &KeyTable) -> String {
    if table.keys.is_empty() {
        return "No other keys.\n".to_owned();
    }
    let mut rows =
        "| key | type and unit | default | description |\n|---|---|---|---|\n".to_owned();
    for key in &table.keys {
        // The unit of a pure number is empty.
        let units = key.quantity.iter().flat_map(|it| it.units());
        let units: Vec<&str> = units.filter(|unit| !unit.is_empty()).collect();
        let cells = [
            format!("`{}`", key.name),
            match units.as_slice() {
                [] => type_words(&key.kind),
                units => format!("{} ({})", type_words(&key.kind), units.join(", ")),
            },
            default(key),
            description(key, &units),
        ];
        let cells = cells.map(|cell| match cell.as_str() {
            "" => " ".to_owned(),
            // A bar would end the cell.
            cell => format!(" {} ", cell.replace('|', "\\|").replace('\n', "<br>")),
        });
        rows += &format!("|{}|\n", cells.join("|"));
    }
    rows
}

/// The heading of a table, as in a file.
fn heading(path: &str) -> String {
    match path.strip_suffix("[]") {
        // The only list of tables that is long enough for this form.
        Some("axis") => "`[[axis]]`".to_owned(),
        Some(list) => format!("Entries of `{list}`"),
        None => format!("`[{path}]`"),
    }
}

/// What a value may be, in the fewest words.
fn type_words(kind: &ValueKind) -> String {
    match kind {
        ValueKind::Text => "text".to_owned(),
        ValueKind::Number(range) => format!("number{}", bounds(*range)),
        ValueKind::Whole(least) => format!("integer ≥ {least}"),
        ValueKind::Choice(words) => {
            let words: Vec<String> = words.iter().map(|word| format!("\"{word}\"")).collect();
            words.join(", ")
        }
        ValueKind::Table(_) | ValueKind::Tagged(..) | ValueKind::AnyTable => "table".to_owned(),
        ValueKind::List(entry) => match &**entry {
            ValueKind::Table(_) => "list of tables".to_owned(),
            ValueKind::Number(_) | ValueKind::Whole(_) => "list of numbers".to_owned(),
            entry => format!("list of {}", type_words(entry)),
        },
        ValueKind::Vector => "three numbers".to_owned(),
        ValueKind::Either(kinds) => {
            let kinds: Vec<String> = kinds.iter().map(type_words).collect();
            kinds.join(" or ")
        }
        kind @ (ValueKind::Flag | ValueKind::Any) => kind.words(),
    }
}

/// The bounds of a number, to follow the word.
fn bounds(range: NumberRange) -> String {
    let (low, high) = (number(range.low), number(range.high));
    let has_low = range.low > -NumberRange::HUGE;
    let has_high = range.high < NumberRange::HUGE;
    match (has_low, has_high, range.low_allowed) {
        (false, false, _) => String::new(),
        (false, true, _) => format!(" ≤ {high}"),
        (true, false, true) => format!(" ≥ {low}"),
        (true, false, false) => format!(" > {low}"),
        (true, true, true) => format!(", {low} to {high}"),
        (true, true, false) => format!(" > {low}, ≤ {high}"),
    }
}

/// The description of a key, without the units, which the table has already.
fn description(key: &TableKey, units: &[&str]) -> String {
    let text = key.description.clone().unwrap_or_default();
    units
        .iter()
        .fold(text, |text, unit| text.replace(&format!(" ({unit})"), ""))
}

fn default(key: &TableKey) -> String {
    match &key.default {
        _ if key.needed => "*needed*".to_owned(),
        None => String::new(),
        Some(Value::Array(entries)) if entries.is_empty() => String::new(),
        Some(default) => format!("`{default}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_number(kind: &ValueKind) -> bool {
        match kind {
            ValueKind::Number(_) | ValueKind::Vector => true,
            ValueKind::List(entry) => is_number(entry),
            ValueKind::Either(kinds) => kinds.iter().any(is_number),
            _ => false,
        }
    }

    #[test]
    fn every_key_has_a_description_and_every_number_a_unit() {
        for file in InputFile::ALL {
            let mut seen = 0;
            file.schema().kind.visit("", &mut |path, key| {
                seen += 1;
                assert!(key.description.is_some(), "{path} has no description");
                let has_unit = key.quantity.is_some();
                assert!(has_unit || !is_number(&key.kind), "{path} has no unit");
            });
            assert!(seen > 10, "{seen}");
        }
    }
}
