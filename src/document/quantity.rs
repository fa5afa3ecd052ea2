//! What a numeric key measures, and which numbers it may hold: declared once, at the field.
//!
//! ```ignore
//! /// Acceleration g (m/s2).
//! #[schemars(transform = quantity("g", "m/s²", "acceleration of gravity").at_least(0.0))]
//! pub acceleration: f64,
//! ```

use schemars::Schema;
use schemars::transform::Transform;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};

/// Keyword of a schema that holds a [`KeyQuantity`].
const KEYWORD: &str = "quantity";

/// What a numeric key measures.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub(crate) struct KeyQuantity {
    /// Symbol; `_` makes a subscript of the next character or of a group in braces. Empty: none.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub(crate) symbol: String,
    /// SI unit; empty for a pure number.
    pub(crate) unit: String,
    /// Plain name, without the unit.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub(crate) name: String,
    /// Other units, depending on other keys of its table.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    other_units: Vec<OtherUnit>,
}

/// The unit of a quantity if the key `key` of the same table is `word`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct OtherUnit {
    key: String,
    word: String,
    unit: String,
}

impl KeyQuantity {
    /// The quantity of a key with this schema, if its field declares one.
    pub(super) fn of(schema: &Value) -> Option<Self> {
        Self::deserialize(schema.get(KEYWORD)?).ok()
    }

    /// The unit in a table with these values.
    pub(crate) fn unit_in(&self, table: &Value) -> &str {
        let holds = |other: &&OtherUnit| table[&other.key] == *other.word;
        let other = self.other_units.iter().find(holds);
        other.map_or(&self.unit, |other| &other.unit)
    }

    /// The units that it may have, the usual one first.
    pub(crate) fn units(&self) -> impl Iterator<Item = &str> {
        let others = self.other_units.iter().map(|other| other.unit.as_str());
        std::iter::once(self.unit.as_str()).chain(others)
    }
}

/// The attribute of a numeric field: its quantity and its range.
pub(crate) struct Attribute {
    quantity: KeyQuantity,
    range: Map<String, Value>,
    word: Option<&'static str>,
}

/// A quantity that figures name by its symbol.
pub(crate) fn quantity(symbol: &str, unit: &str, name: &str) -> Attribute {
    Attribute {
        quantity: KeyQuantity {
            symbol: symbol.to_owned(),
            unit: unit.to_owned(),
            name: name.to_owned(),
            other_units: Vec::new(),
        },
        range: Map::new(),
        word: None,
    }
}

/// A quantity without a symbol; the unit is empty for a pure number.
pub(crate) fn unit(unit: &str) -> Attribute {
    quantity("", unit, "")
}

impl Attribute {
    /// Numbers from `low` on.
    pub(crate) fn at_least(self, low: impl Into<Value>) -> Self {
        self.limited("minimum", low.into())
    }

    /// Numbers larger than `low`.
    pub(crate) fn above(self, low: f64) -> Self {
        self.limited("exclusiveMinimum", low.into())
    }

    /// Numbers up to `high`.
    pub(crate) fn at_most(self, high: f64) -> Self {
        self.limited("maximum", high.into())
    }

    fn limited(mut self, keyword: &str, limit: Value) -> Self {
        self.range.insert(keyword.to_owned(), limit);
        self
    }

    /// Another unit if the key `key` of the same table is `word`.
    pub(crate) fn unit_where(mut self, key: &str, word: &str, unit: &str) -> Self {
        self.quantity.other_units.push(OtherUnit {
            key: key.to_owned(),
            word: word.to_owned(),
            unit: unit.to_owned(),
        });
        self
    }

    /// A file may have `word` instead of a number.
    pub(crate) fn or(mut self, word: &'static str) -> Self {
        self.word = Some(word);
        self
    }
}

impl Transform for Attribute {
    fn transform(&mut self, schema: &mut Schema) {
        let schema = schema.ensure_object();
        // The range of a list applies to its entries.
        let range = self.range.clone();
        match schema.get_mut("items").and_then(Value::as_object_mut) {
            Some(entries) => entries.extend(range),
            None => schema.extend(range),
        }
        if let Some(word) = self.word {
            let description = schema.remove("description");
            let number = Value::Object(std::mem::take(schema));
            schema.insert("anyOf".to_owned(), json!([number, { "enum": [word] }]));
            schema.extend(description.map(|text| ("description".to_owned(), text)));
        }
        schema.insert(KEYWORD.to_owned(), json!(self.quantity));
    }
}
