//! The page of all keys.

use super::File;
use super::docs::Entry;
use super::json_schema::description;
use crate::document::schema::{Key, Kind};
use crate::notation;
use serde_json::Value;

const INTRODUCTION: &str = "\
# Keys of scene, sweep and study files

This page is made by `phase reference keys`. Units are SI throughout, angles are in radians, z
points up, and the tank's axis is the z axis. A key whose default is *needed* must be there; one
without a default may be left out, which then means what its description says.
";

/// The page of all keys of all files, in Markdown: type, unit, default, description.
pub fn keys() -> String {
    let mut page = Page(INTRODUCTION.to_owned());
    for file in File::ALL {
        let heading = match file {
            File::Scene => "Scene files",
            File::Sweep => "Sweep files",
            File::Stability => "Studies of stability",
        };
        let docs = file.docs();
        page.0 += &format!("\n## {heading}\n\n");
        page.paragraph(docs.root());
        page.tables("", &file.keys(), docs.root());
    }
    page.0
}

/// The page so far.
struct Page(String);

impl Page {
    fn paragraph(&mut self, docs: Entry<'_>) {
        if let Some(text) = docs.text() {
            self.0 += &format!("{}\n\n", text.replace('\n', "\n\n"));
        }
    }

    /// The tables of keys that a value at `path` may have.
    fn tables(&mut self, path: &str, kind: &Kind, docs: Entry<'_>) {
        match kind {
            Kind::Table(keys) => {
                if !path.is_empty() {
                    self.0 += &format!("\n### {}\n\n", heading(path));
                    self.paragraph(docs);
                }
                self.table(path, None, keys, docs);
            }
            Kind::Tagged(tag, variants) => {
                for (word, keys) in *variants {
                    let docs = docs.variant(tag, word);
                    self.0 += &format!("\n### {} with `{tag} = \"{word}\"`\n\n", heading(path));
                    self.paragraph(docs);
                    self.table(path, Some((tag, word)), keys, docs);
                }
            }
            Kind::List(entry) => self.tables(&format!("{path}[]"), entry, docs.items()),
            // A scene within a sweep has its own chapter.
            Kind::Either(_) if path == "scene" => {}
            Kind::Either(kinds) => {
                for kind in *kinds {
                    self.tables(path, kind, docs);
                }
            }
            Kind::Text
            | Kind::Flag
            | Kind::Number(_)
            | Kind::Whole(_)
            | Kind::Choice(_)
            | Kind::Vector => {}
        }
    }

    fn table(&mut self, path: &str, tag: Option<(&str, &str)>, keys: &[Key], docs: Entry<'_>) {
        self.0 += "| key | type | unit | default | description |\n|---|---|---|---|---|\n";
        if let Some((tag, word)) = tag {
            self.0 += &format!("| `{tag}` | \"{word}\" | | *needed* | |\n");
        }
        let path_of = |key: &Key| match path {
            "" => key.name.to_owned(),
            path => format!("{path}.{}", key.name),
        };
        for key in keys {
            let docs = docs.key(key.name);
            let cells = [
                format!("`{}`", key.name),
                type_words(&key.kind),
                notation::unit(&path_of(key)).unwrap_or_default(),
                default(key, docs),
                description(&key.kind, docs).unwrap_or_default(),
            ];
            let cells = cells.map(|cell| match cell.as_str() {
                "" => " ".to_owned(),
                // A bar would end the cell.
                cell => format!(" {} ", cell.replace('|', "\\|").replace('\n', "<br>")),
            });
            self.0 += &format!("|{}|\n", cells.join("|"));
        }
        for key in keys {
            self.tables(&path_of(key), &key.kind, docs.key(key.name));
        }
    }
}

/// A table as a file would head it.
fn heading(path: &str) -> String {
    match path.strip_suffix("[]") {
        // The one list of tables that is long enough to be written so.
        Some("axis") => "`[[axis]]`".to_owned(),
        Some(list) => format!("Entries of `{list}`"),
        None => format!("`[{path}]`"),
    }
}

fn type_words(kind: &Kind) -> String {
    match kind {
        Kind::Table(_) | Kind::Tagged(..) => "a table".to_owned(),
        Kind::List(Kind::Table(_)) => "a list of tables".to_owned(),
        Kind::Either(kinds) => {
            let kinds: Vec<String> = kinds.iter().map(type_words).collect();
            kinds.join(", or ")
        }
        kind => kind.words(),
    }
}

fn default(key: &Key, docs: Entry<'_>) -> String {
    match docs.default() {
        _ if key.needed => "*needed*".to_owned(),
        None | Some(Value::Object(_)) => String::new(),
        Some(Value::Array(entries)) if entries.is_empty() => String::new(),
        Some(default) => format!("`{default}`"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::schema::Range;

    fn visit(
        path: &str,
        kind: &Kind,
        docs: Entry<'_>,
        see: &mut dyn FnMut(&str, &Kind, Entry<'_>),
    ) {
        let mut table = |keys: &[Key], docs: Entry<'_>| {
            for key in keys {
                let dot = if path.is_empty() { "" } else { "." };
                let path = format!("{path}{dot}{}", key.name);
                see(&path, &key.kind, docs.key(key.name));
                visit(&path, &key.kind, docs.key(key.name), see);
            }
        };
        match kind {
            Kind::Table(keys) => table(keys, docs),
            Kind::Tagged(tag, variants) => variants
                .iter()
                .for_each(|(word, keys)| table(keys, docs.variant(tag, word))),
            Kind::List(entry) => visit(&format!("{path}[]"), entry, docs.items(), see),
            Kind::Either(kinds) if path != "scene" => {
                kinds.iter().for_each(|kind| visit(path, kind, docs, see));
            }
            _ => {}
        }
    }

    fn is_number(kind: &Kind) -> bool {
        match kind {
            Kind::Number(_) | Kind::Vector => true,
            Kind::List(entry) => is_number(entry),
            Kind::Either(kinds) => kinds.iter().any(is_number),
            _ => false,
        }
    }

    #[test]
    fn every_key_has_a_description_and_every_number_a_unit() {
        assert!(is_number(&Kind::List(&Kind::Number(Range::ANY))));
        for file in File::ALL {
            let docs = file.docs();
            let mut seen = 0;
            visit("", &file.keys(), docs.root(), &mut |path, kind, docs| {
                seen += 1;
                assert!(docs.text().is_some(), "{path} has no description");
                let unit = notation::unit(path);
                assert!(unit.is_some() || !is_number(kind), "{path} has no unit");
            });
            assert!(seen > 10, "{seen}");
        }
    }
}
