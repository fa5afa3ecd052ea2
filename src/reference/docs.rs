//! The documentation of structs, looked up key by key.

use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde_json::Value;

/// The documentation of a struct and of all it holds.
pub(super) struct Docs(Value);

impl Docs {
    /// What is written at `T` and its fields.
    pub(super) fn of<T: JsonSchema>() -> Self {
        let settings = SchemaSettings::draft07().with(|settings| settings.inline_subschemas = true);
        Self(settings.into_generator().into_root_schema_for::<T>().into())
    }

    /// That of the struct itself.
    pub(super) fn root(&self) -> Entry<'_> {
        Entry(&self.0)
    }
}

/// The documentation of one key, and of the keys below it.
#[derive(Clone, Copy)]
pub(super) struct Entry<'a>(&'a Value);

impl<'a> Entry<'a> {
    /// The text, one paragraph per line.
    pub(super) fn text(self) -> Option<String> {
        let text = self.0["description"].as_str()?;
        let paragraphs = text.split("\n\n").map(|text| text.replace('\n', " "));
        Some(paragraphs.collect::<Vec<_>>().join("\n"))
    }

    /// The value that holds if the key is left out.
    pub(super) fn default(self) -> Option<&'a Value> {
        let default = &self.0["default"];
        (!default.is_null()).then_some(default)
    }

    /// That of a key of this table.
    pub(super) fn key(self, name: &str) -> Self {
        let found = self
            .alternatives()
            .find(|entry| entry.0["properties"][name].is_object());
        found.map_or(Entry(&Value::Null), |entry| {
            Entry(&entry.0["properties"][name])
        })
    }

    /// That of this table if its key `tag` is `word`.
    pub(super) fn variant(self, tag: &str, word: &str) -> Self {
        let found = self
            .alternatives()
            .find(|entry| entry.0["properties"][tag]["const"] == word);
        found.unwrap_or(Entry(&Value::Null))
    }

    /// That of one of several words that a key may hold.
    pub(super) fn word(self, word: &str) -> Self {
        let found = self.alternatives().find(|entry| entry.0["const"] == word);
        found.unwrap_or(Entry(&Value::Null))
    }

    /// That of the entries of this list.
    pub(super) fn items(self) -> Self {
        let found = self
            .alternatives()
            .find(|entry| entry.0["items"].is_object());
        found.map_or(Entry(&Value::Null), |entry| Entry(&entry.0["items"]))
    }

    /// This, and everything that may stand in its place.
    fn alternatives(self) -> impl Iterator<Item = Self> {
        let mut all = vec![self];
        let mut next = 0;
        while let Some(entry) = all.get(next) {
            let branches = ["anyOf", "oneOf"].map(|key| entry.0[key].as_array());
            all.extend(branches.into_iter().flatten().flatten().map(Entry));
            next += 1;
        }
        all.into_iter()
    }
}
