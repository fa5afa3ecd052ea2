//! From a struct to the allowed contents of a file: its JSON schema, and the keys that are read
//! from it.

use super::kind::{KeyTable, NumberRange, TableKey, TagVariant, ValueKind};
use super::quantity::KeyQuantity;
use schemars::generate::SchemaSettings;
use schemars::transform::transform_subschemas;
use schemars::{JsonSchema, Schema as JsonSchemaOf};
use serde_json::{Map, Value, json};

/// The allowed contents of a file or a part of one. They are declared at the fields of the struct
/// into which the file is read: type, description, default, unit, symbol and range.
pub(crate) struct Schema {
    /// The JSON schema, for editors.
    pub(crate) json: Value,
    /// The same for the program, which checks files with it.
    pub(crate) kind: ValueKind,
}

impl Schema {
    /// What a `T` may say.
    pub(crate) fn of<T: JsonSchema>() -> Self {
        // Draft 7 is what editors know best.
        let settings = SchemaSettings::draft07().with(|settings| settings.inline_subschemas = true);
        let mut schema = settings.into_generator().into_root_schema_for::<T>();
        tidy(&mut schema);
        let json = Value::from(schema);
        let kind = ValueKind::of(&json);
        Self { json, kind }
    }
}

/// Removes null, which TOML does not have, and keywords without meaning for readers; refuses
/// unknown keys.
fn tidy(schema: &mut JsonSchemaOf) {
    without_null(schema.ensure_object());
    transform_subschemas(&mut tidy, schema);
    let schema = schema.ensure_object();
    schema.remove("format");
    if let Some(text) = schema.get("description").and_then(Value::as_str) {
        let paragraphs = text.split("\n\n").map(|text| text.replace('\n', " "));
        let text = paragraphs.collect::<Vec<_>>().join("\n");
        schema.insert("description".to_owned(), json!(text));
    }
    // An absent table has the defaults of its keys.
    if matches!(schema.get("default"), Some(Value::Null | Value::Object(_))) {
        schema.remove("default");
    }
    if schema.contains_key("properties") {
        schema.insert("additionalProperties".to_owned(), json!(false));
    }
    with_words(schema);
}

/// Removes null from the alternatives; a single remaining one replaces the list.
fn without_null(schema: &mut Map<String, Value>) {
    if let Some(Value::Array(types)) = schema.get("type") {
        let other = types.iter().find(|name| *name != "null").cloned();
        schema.extend(other.map(|name| ("type".to_owned(), name)));
    }
    let Some(Value::Array(mut branches)) = schema.remove("anyOf") else {
        return;
    };
    branches.retain(|branch| branch["type"] != "null");
    if let [Value::Object(only)] = branches.as_mut_slice() {
        only.extend(std::mem::take(schema));
        *schema = std::mem::take(only);
    } else {
        schema.insert("anyOf".to_owned(), json!(branches));
    }
}

/// Merges words with separate descriptions into one list with one description.
fn with_words(schema: &mut Map<String, Value>) {
    let branches = schema.get("oneOf").and_then(Value::as_array);
    let Some(branches) = branches.filter(|all| all.iter().all(|it| it["const"].is_string())) else {
        return;
    };
    let words: Vec<Value> = branches.iter().map(|it| it["const"].clone()).collect();
    let mut text = schema
        .get("description")
        .and_then(Value::as_str)
        .unwrap_or("")
        .to_owned();
    for branch in branches {
        if let Some(meaning) = branch["description"].as_str() {
            text += &format!("\n{}: {meaning}", branch["const"]);
        }
    }
    schema.remove("oneOf");
    schema.insert("enum".to_owned(), json!(words));
    schema.insert("description".to_owned(), json!(text));
}

impl ValueKind {
    fn of(schema: &Value) -> Self {
        let list = |keyword: &str| schema[keyword].as_array();
        if let Some(words) = list("enum") {
            return Self::Choice(words.iter().filter_map(text).collect());
        }
        if let Some(kinds) = list("anyOf") {
            return Self::Either(kinds.iter().map(Self::of).collect());
        }
        if let Some(variants) = list("oneOf") {
            return Self::tagged(variants);
        }
        match schema["type"].as_str() {
            Some("string") => Self::Text,
            Some("boolean") => Self::Flag,
            Some("integer") => Self::Whole(schema["minimum"].as_u64().unwrap_or(0)),
            Some("number") => Self::Number(NumberRange::of(schema)),
            Some("array") if schema["minItems"] == 3 => Self::Vector,
            Some("array") => Self::List(Box::new(Self::of(&schema["items"]))),
            Some("object") if schema["properties"].is_null() => {
                match &schema["additionalProperties"] {
                    Value::Object(_) | Value::Bool(true) => Self::AnyTable,
                    _ => Self::Table(KeyTable::of(schema)),
                }
            }
            None if schema["properties"].is_null() => Self::Any,
            _ => Self::Table(KeyTable::of(schema)),
        }
    }

    fn tagged(variants: &[Value]) -> Self {
        let mut tag = String::new();
        let variants = variants.iter().map(|schema| {
            let mut table = KeyTable::of(schema);
            let mut word = String::new();
            table.keys.retain(|key| {
                let constant = schema["properties"][&key.name]["const"].as_str();
                if let Some(constant) = constant {
                    (tag, word) = (key.name.clone(), constant.to_owned());
                }
                constant.is_none()
            });
            TagVariant { word, table }
        });
        let variants = variants.collect();
        Self::Tagged(tag, variants)
    }
}

impl KeyTable {
    fn of(schema: &Value) -> Self {
        let needed = |name: &str| {
            let lists = [&schema["required"], &schema["then"]["required"]];
            let mut names = lists.into_iter().filter_map(Value::as_array).flatten();
            names.any(|needed| needed == name)
        };
        let keys = schema["properties"].as_object().into_iter().flatten();
        let keys = keys.map(|(name, schema)| TableKey {
            name: name.clone(),
            kind: ValueKind::of(schema),
            needed: needed(name),
            description: text(&schema["description"]),
            default: schema.get("default").cloned(),
            quantity: KeyQuantity::of(schema),
        });
        Self {
            description: text(&schema["description"]),
            keys: keys.collect(),
        }
    }
}

impl NumberRange {
    fn of(schema: &Value) -> Self {
        let [low, above, high] =
            ["minimum", "exclusiveMinimum", "maximum"].map(|keyword| schema[keyword].as_f64());
        Self {
            low: low.or(above).unwrap_or(-Self::HUGE),
            low_allowed: above.is_none(),
            high: high.unwrap_or(Self::HUGE),
        }
    }
}

fn text(value: &Value) -> Option<String> {
    value.as_str().map(str::to_owned)
}
