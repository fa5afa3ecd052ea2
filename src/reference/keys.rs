//! The page of all keys.

use super::InputFile;
use crate::document::kind::{KeyTable, TableKey, ValueKind};
use serde_json::Value;

const INTRODUCTION: &str = "\
# Keys of scene, sweep and study files

This page is made by `phase generate reference keys`. Units are SI throughout, angles are in
radians, z points up, and the tank's axis is the z axis. A key whose default is *needed* must be
there; one without a default may be left out, which then means what its description says.
";

/// The page of all keys of all files, in Markdown: type, unit, default, description.
pub fn keys() -> String {
    let mut page = KeysPage(INTRODUCTION.to_owned());
    for file in InputFile::ALL {
        let heading = match file {
            InputFile::Scene => "Scene files",
            InputFile::Sweep => "Sweep files",
            InputFile::Stability => "Studies of stability",
            InputFile::Accuracy => "Studies of accuracy",
        };
        page.0 += &format!("\n## {heading}\n\n");
        page.tables("", &file.schema().kind);
    }
    page.0
}

/// The page so far.
struct KeysPage(String);

impl KeysPage {
    /// The tables of keys that a value at `path` may have.
    fn tables(&mut self, path: &str, kind: &ValueKind) {
        match kind {
            ValueKind::Table(table) => {
                if !path.is_empty() {
                    self.0 += &format!("\n### {}\n\n", heading(path));
                }
                self.table(path, None, table);
            }
            ValueKind::Tagged(tag, variants) => {
                for variant in variants {
                    let word = &variant.word;
                    self.0 += &format!("\n### {} with `{tag} = \"{word}\"`\n\n", heading(path));
                    self.table(path, Some((tag, word)), &variant.table);
                }
            }
            ValueKind::List(entry) => self.tables(&format!("{path}[]"), entry),
            // A scene within a sweep has a separate chapter.
            ValueKind::Either(_) if path == "scene" => {}
            ValueKind::Either(kinds) => kinds.iter().for_each(|kind| self.tables(path, kind)),
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

    fn table(&mut self, path: &str, tag: Option<(&str, &str)>, table: &KeyTable) {
        if let Some(text) = &table.description {
            self.0 += &format!("{}\n\n", text.replace('\n', "\n\n"));
        }
        self.0 += "| key | type | unit | default | description |\n|---|---|---|---|---|\n";
        if let Some((tag, word)) = tag {
            self.0 += &format!("| `{tag}` | \"{word}\" | | *needed* | |\n");
        }
        for key in &table.keys {
            let units: Vec<&str> = key.quantity.iter().flat_map(|it| it.units()).collect();
            let cells = [
                format!("`{}`", key.name),
                type_words(&key.kind),
                units.join(", "),
                default(key),
                key.description.clone().unwrap_or_default(),
            ];
            let cells = cells.map(|cell| match cell.as_str() {
                "" => " ".to_owned(),
                // A bar would end the cell.
                cell => format!(" {} ", cell.replace('|', "\\|").replace('\n', "<br>")),
            });
            self.0 += &format!("|{}|\n", cells.join("|"));
        }
        for key in &table.keys {
            self.tables(&key.path(path), &key.kind);
        }
    }
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

fn type_words(kind: &ValueKind) -> String {
    match kind {
        ValueKind::Table(_) | ValueKind::Tagged(..) => "a table".to_owned(),
        ValueKind::List(entry) if matches!(**entry, ValueKind::Table(_)) => {
            "a list of tables".to_owned()
        }
        ValueKind::Either(kinds) => {
            let kinds: Vec<String> = kinds.iter().map(type_words).collect();
            kinds.join(", or ")
        }
        kind => kind.words(),
    }
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
