//! From parsed TOML to a plain tree of values and the places of its keys.

use super::SourcePlace;
use serde_json::{Number, Value};
use std::collections::BTreeMap;
use toml::Spanned;
use toml::de::{DeInteger, DeTable, DeValue};

/// The values of a table at `path`; notes the places of all its keys.
pub(super) fn of_table(
    table: &DeTable<'_>,
    path: &str,
    places: &mut BTreeMap<String, SourcePlace>,
) -> Value {
    let entries = table.iter().map(|(key, value)| {
        let name = key.get_ref().to_string();
        let path = if path.is_empty() {
            name.clone()
        } else {
            format!("{path}.{name}")
        };
        let place = SourcePlace {
            key: Some(key.span()),
            value: value.span(),
        };
        places.insert(path.clone(), place);
        (name, of_value(value, &path, places))
    });
    Value::Object(entries.collect())
}

fn of_value(
    value: &Spanned<DeValue<'_>>,
    path: &str,
    places: &mut BTreeMap<String, SourcePlace>,
) -> Value {
    match value.get_ref() {
        DeValue::String(text) => Value::String(text.to_string()),
        DeValue::Integer(integer) => of_integer(integer),
        DeValue::Float(float) => of_float(float.as_str()),
        DeValue::Boolean(flag) => Value::Bool(*flag),
        DeValue::Datetime(time) => Value::String(time.to_string()),
        DeValue::Table(table) => of_table(table, path, places),
        DeValue::Array(entries) => {
            let entries = entries.iter().enumerate().map(|(index, entry)| {
                let path = format!("{path}[{index}]");
                let place = SourcePlace {
                    key: None,
                    value: entry.span(),
                };
                places.insert(path.clone(), place);
                of_value(entry, &path, places)
            });
            Value::Array(entries.collect())
        }
    }
}

fn of_integer(integer: &DeInteger<'_>) -> Value {
    match i64::from_str_radix(integer.as_str(), integer.radix()) {
        Ok(value) => Value::from(value),
        // Beyond 64 bits: valid as a number, but refused as an integer.
        Err(_) => of_float(integer.as_str()),
    }
}

fn of_float(text: &str) -> Value {
    let value = text.parse().unwrap_or(f64::NAN);
    Number::from_f64(value).map_or(Value::Null, Value::Number)
}
