//! Which keys a file may have and what each may hold, as read from its schema.

use super::number;
use super::quantity::KeyQuantity;
use serde_json::Value;

/// A key of a table.
pub(crate) struct TableKey {
    pub(crate) name: String,
    pub(crate) kind: ValueKind,
    /// Whether it is required.
    pub(crate) needed: bool,
    /// What it means, one paragraph per line.
    pub(crate) description: Option<String>,
    /// Its default value.
    pub(crate) default: Option<Value>,
    /// What it measures, if it holds numbers.
    pub(crate) quantity: Option<KeyQuantity>,
}

impl TableKey {
    /// Its path in a table at the path `table`.
    pub(crate) fn path(&self, table: &str) -> String {
        match table {
            "" => self.name.clone(),
            table => format!("{table}.{}", self.name),
        }
    }
}

/// The keys of a table, in the order of the struct.
pub(crate) struct KeyTable {
    pub(crate) description: Option<String>,
    pub(crate) keys: Vec<TableKey>,
}

/// A value of a tag, and the keys that go with it.
pub(crate) struct TagVariant {
    pub(crate) word: String,
    pub(crate) table: KeyTable,
}

/// What a value may be.
pub(crate) enum ValueKind {
    Text,
    Flag,
    Number(NumberRange),
    /// A whole number of at least this.
    Whole(u64),
    /// One of these words.
    Choice(Vec<String>),
    List(Box<ValueKind>),
    /// A list of three numbers.
    Vector,
    Table(KeyTable),
    /// A table whose key `0` selects one of the lists of further keys.
    Tagged(String, Vec<TagVariant>),
    /// Any of several kinds, distinguished by their TOML type.
    Either(Vec<ValueKind>),
    /// Anything: what it must be depends on other keys.
    Any,
    /// A table of any keys: what they may be depends on other keys.
    AnyTable,
}

/// Which numbers are allowed.
#[derive(Clone, Copy)]
pub(crate) struct NumberRange {
    pub(crate) low: f64,
    pub(crate) low_allowed: bool,
    pub(crate) high: f64,
}

impl NumberRange {
    /// Every number that could be intended.
    pub(crate) const ANY: Self = Self {
        low: -Self::HUGE,
        low_allowed: true,
        high: Self::HUGE,
    };

    /// A bound of this size is not mentioned in messages.
    pub(crate) const HUGE: f64 = 1e30;

    pub(super) fn contains(self, value: f64) -> bool {
        let high_enough = if self.low_allowed {
            value >= self.low
        } else {
            value > self.low
        };
        high_enough && value <= self.high
    }

    /// What to use instead of a number outside the range.
    pub(super) fn advice(self, value: f64) -> String {
        match (value > self.high, self.low_allowed) {
            (true, _) => format!("use {} or less", number(self.high)),
            (false, true) => format!("use {} or more", number(self.low)),
            (false, false) => format!("use a number above {}", number(self.low)),
        }
    }

    fn words(self) -> String {
        let low = if self.low_allowed {
            format!("of at least {}", number(self.low))
        } else {
            format!("above {}", number(self.low))
        };
        match (self.low > -Self::HUGE, self.high < Self::HUGE) {
            (false, false) => "a number".to_owned(),
            (true, false) => format!("a number {low}"),
            (false, true) => format!("a number of at most {}", number(self.high)),
            (true, true) => format!("a number {low} and at most {}", number(self.high)),
        }
    }
}

impl ValueKind {
    /// A description of a value of this kind, as a noun.
    pub(crate) fn words(&self) -> String {
        match self {
            Self::Text => "a text in quotes".to_owned(),
            Self::Flag => "true or false".to_owned(),
            Self::Number(range) => range.words(),
            Self::Whole(least) => format!("a whole number of at least {least}"),
            Self::Choice(words) => match words.as_slice() {
                [word] => format!("\"{word}\""),
                words => {
                    let words: Vec<String> =
                        words.iter().map(|word| format!("\"{word}\"")).collect();
                    format!("one of {}", words.join(", "))
                }
            },
            Self::List(entry) => match &**entry {
                Self::Table(table) => format!("a list of {}", table.braces()),
                Self::Number(_) | Self::Whole(_) => "a list of numbers".to_owned(),
                _ => format!("a list, each entry {}", entry.words()),
            },
            Self::Vector => "a list of three numbers".to_owned(),
            Self::Table(table) => format!("a table {}", table.braces()),
            Self::Tagged(tag, _) => format!("a table with the key `{tag}`"),
            Self::Either(kinds) => {
                let kinds: Vec<String> = kinds.iter().map(Self::words).collect();
                kinds.join(", or ")
            }
            Self::Any => "any value".to_owned(),
            Self::AnyTable => "a table".to_owned(),
        }
    }

    /// Calls `see` with every key and its path, `[]` for the entries of a list.
    pub(crate) fn visit<'a>(&'a self, path: &str, see: &mut dyn FnMut(&str, &'a TableKey)) {
        let mut visit_table = |table: &'a KeyTable| {
            for key in &table.keys {
                let path = key.path(path);
                see(&path, key);
                key.kind.visit(&path, see);
            }
        };
        match self {
            Self::Table(table) => visit_table(table),
            Self::Tagged(_, variants) => variants.iter().for_each(|it| visit_table(&it.table)),
            Self::List(entry) => entry.visit(&format!("{path}[]"), see),
            Self::Either(kinds) => kinds.iter().for_each(|kind| kind.visit(path, see)),
            _ => {}
        }
    }

    /// Whether the TOML type of `value` matches this kind.
    pub(crate) fn fits_type_of(&self, value: &Value) -> bool {
        match self {
            Self::Text | Self::Choice(_) => value.is_string(),
            Self::Flag => value.is_boolean(),
            Self::Number(_) => value.is_number(),
            Self::Whole(_) => value.is_u64() || value.is_i64(),
            Self::Vector => value.is_array(),
            Self::List(entry) => match value.as_array().map(Vec::as_slice) {
                Some([first, ..]) => entry.fits_type_of(first),
                Some([]) => true,
                None => false,
            },
            Self::Table(_) | Self::Tagged(..) | Self::AnyTable => value.is_object(),
            Self::Any => !value.is_null(),
            Self::Either(kinds) => kinds.iter().any(|kind| kind.fits_type_of(value)),
        }
    }
}

impl KeyTable {
    /// The keys, as the table would be written.
    fn braces(&self) -> String {
        let names: Vec<&str> = self.keys.iter().map(|key| key.name.as_str()).collect();
        format!("{{ {} }}", names.join(", "))
    }
}
