//! From a table of keys to a JSON schema.

use super::docs::Entry;
use crate::document::schema::{Key, Kind, Range};
use serde_json::{Map, Value, json};

/// The schema of a value of this kind, with its description and default.
pub(super) fn of(kind: &Kind, docs: Entry<'_>) -> Value {
    let mut schema = shape(kind, docs);
    if let Some(text) = description(kind, docs) {
        schema["description"] = json!(text);
    }
    // A table that is left out has the defaults of its keys.
    if let Some(default) = docs.default().filter(|default| !default.is_object()) {
        schema["default"] = default.clone();
    }
    schema
}

/// The text of a key, and of each word that it may hold.
pub(super) fn description(kind: &Kind, docs: Entry<'_>) -> Option<String> {
    let mut text = docs.text()?;
    if let Kind::Choice(words) = kind {
        for word in *words {
            if let Some(meaning) = docs.word(word).text() {
                text += &format!("\n\"{word}\": {meaning}");
            }
        }
    }
    Some(text)
}

fn shape(kind: &Kind, docs: Entry<'_>) -> Value {
    match kind {
        Kind::Text => json!({ "type": "string" }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Number(range) => of_number(*range),
        Kind::Whole(least) => json!({ "type": "integer", "minimum": least }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::List(entry) => json!({ "type": "array", "items": of(entry, docs.items()) }),
        Kind::Vector => json!({
            "type": "array",
            "items": { "type": "number" },
            "minItems": 3,
            "maxItems": 3,
        }),
        Kind::Table(keys) => of_table(keys, None, docs),
        Kind::Tagged(tag, variants) => {
            let variant = |(word, keys): &(&str, &'static [Key])| {
                let docs = docs.variant(tag, word);
                let mut table = of_table(keys, Some((tag, word)), docs);
                table["description"] = json!(docs.text());
                table
            };
            let mut tables: Vec<Value> = variants.iter().map(variant).collect();
            if tables.len() == 1 {
                tables.remove(0)
            } else {
                json!({ "oneOf": tables })
            }
        }
        Kind::Either(kinds) => {
            let kinds: Vec<Value> = kinds.iter().map(|kind| shape(kind, docs)).collect();
            json!({ "anyOf": kinds })
        }
    }
}

fn of_number(range: Range) -> Value {
    let mut schema = json!({ "type": "number" });
    if range.low > -Range::HUGE {
        let low = if range.low_allowed {
            "minimum"
        } else {
            "exclusiveMinimum"
        };
        schema[low] = json!(range.low);
    }
    if range.high < Range::HUGE {
        schema["maximum"] = json!(range.high);
    }
    schema
}

fn of_table(keys: &[Key], tag: Option<(&str, &str)>, docs: Entry<'_>) -> Value {
    let mut properties = Map::new();
    let mut required = Vec::new();
    if let Some((tag, word)) = tag {
        properties.insert(tag.to_owned(), json!({ "enum": [word] }));
        required.push(tag);
    }
    for key in keys {
        properties.insert(key.name.to_owned(), of(&key.kind, docs.key(key.name)));
        if key.needed {
            required.push(key.name);
        }
    }
    let mut schema = json!({
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    });
    if !required.is_empty() {
        schema["required"] = json!(required);
    }
    schema
}
