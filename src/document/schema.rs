//! Which keys a file may have and what each may hold.
//!
//! A description is data: one list per table, next to the structs that the file ends in. It
//! serves to refuse a file with all its problems at once, to name the numeric keys of a scene, and
//! to describe files to editors and readers ([`crate::reference`]).

use super::number;
use serde_json::Value;

/// A key of a table.
pub(crate) struct Key {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) needed: bool,
}

/// A key that must be there.
pub(crate) const fn needed(name: &'static str, kind: Kind) -> Key {
    Key {
        name,
        kind,
        needed: true,
    }
}

/// A key that may be left out.
pub(crate) const fn optional(name: &'static str, kind: Kind) -> Key {
    Key {
        name,
        kind,
        needed: false,
    }
}

/// What a value may be.
pub(crate) enum Kind {
    Text,
    Flag,
    Number(Range),
    /// A whole number of at least this.
    Whole(u64),
    /// One of these words.
    Choice(&'static [&'static str]),
    List(&'static Kind),
    /// A list of three numbers.
    Vector,
    Table(&'static [Key]),
    /// A table whose key `0` says which of the lists of further keys holds.
    Tagged(&'static str, &'static [Variant]),
    /// Any of several kinds, told apart by their TOML type.
    Either(&'static [Kind]),
}

/// A value of a tag, and the keys that go with it.
pub(crate) type Variant = (&'static str, &'static [Key]);

/// Which numbers are allowed.
#[derive(Clone, Copy)]
pub(crate) struct Range {
    pub(crate) low: f64,
    pub(crate) low_allowed: bool,
    pub(crate) high: f64,
}

impl Range {
    /// Every number that could be meant.
    pub(crate) const ANY: Self = Self::between(-Self::HUGE, Self::HUGE);
    /// Above zero.
    pub(crate) const POSITIVE: Self = Self::above(0.0, Self::HUGE);
    /// Zero or more.
    pub(crate) const NOT_NEGATIVE: Self = Self::between(0.0, Self::HUGE);
    /// From zero to one.
    pub(crate) const FRACTION: Self = Self::between(0.0, 1.0);

    /// A number of this size is beyond anything that could be meant; no message speaks of it.
    pub(crate) const HUGE: f64 = 1e30;

    /// From `low` to `high`, both allowed.
    pub(crate) const fn between(low: f64, high: f64) -> Self {
        Self {
            low,
            low_allowed: true,
            high,
        }
    }

    /// Above `low`, and `high` at most.
    pub(crate) const fn above(low: f64, high: f64) -> Self {
        Self {
            low,
            low_allowed: false,
            high,
        }
    }

    pub(super) fn contains(self, value: f64) -> bool {
        let high_enough = if self.low_allowed {
            value >= self.low
        } else {
            value > self.low
        };
        high_enough && value <= self.high
    }

    /// What to use in place of a number that is outside.
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

impl Kind {
    /// What a value of this kind is, as a noun.
    pub(crate) fn words(&self) -> String {
        match self {
            Self::Text => "a text in quotes".to_owned(),
            Self::Flag => "true or false".to_owned(),
            Self::Number(range) => range.words(),
            Self::Whole(least) => format!("a whole number of at least {least}"),
            Self::Choice(words) => match words {
                [word] => format!("\"{word}\""),
                words => {
                    let words: Vec<String> =
                        words.iter().map(|word| format!("\"{word}\"")).collect();
                    format!("one of {}", words.join(", "))
                }
            },
            Self::List(entry) => match entry {
                Self::Table(keys) => format!("a list of {}", braces(keys)),
                Self::Number(_) | Self::Whole(_) => "a list of numbers".to_owned(),
                _ => format!("a list, each entry {}", entry.words()),
            },
            Self::Vector => "a list of three numbers".to_owned(),
            Self::Table(keys) => format!("a table {}", braces(keys)),
            Self::Tagged(tag, _) => format!("a table with the key `{tag}`"),
            Self::Either(kinds) => {
                let kinds: Vec<String> = kinds.iter().map(Self::words).collect();
                kinds.join(", or ")
            }
        }
    }

    /// Whether the TOML type of `value` is that of this kind.
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
            Self::Table(_) | Self::Tagged(..) => value.is_object(),
            Self::Either(kinds) => kinds.iter().any(|kind| kind.fits_type_of(value)),
        }
    }
}

/// The keys of a table, as it would be written.
fn braces(keys: &[Key]) -> String {
    let names: Vec<&str> = keys.iter().map(|key| key.name).collect();
    format!("{{ {} }}", names.join(", "))
}

/// For tests: names the tables in `value` whose described keys are not those that `T` has. What `T`
/// has, it tells when it refuses a key that nothing has.
#[cfg(test)]
pub(crate) fn differences<T: serde::de::DeserializeOwned>(
    kind: &Kind,
    value: &Value,
) -> Vec<String> {
    let mut tables = Vec::new();
    collect_tables(kind, value, String::new(), &mut tables);
    assert!(!tables.is_empty());
    let differs = |(pointer, described): &(String, Vec<&str>)| {
        let mut probe = value.clone();
        let table = probe.pointer_mut(pointer).and_then(Value::as_object_mut);
        table
            .unwrap()
            .insert("nothing has this".to_owned(), Value::Null);
        let message = serde_json::from_value::<T>(probe)
            .err()
            .unwrap()
            .to_string();
        let mut known: Vec<&str> = message.split('`').skip(3).step_by(2).collect();
        let mut described = described.clone();
        known.sort_unstable();
        described.sort_unstable();
        (known != described).then(|| format!("{pointer}: {described:?}, but {message}"))
    };
    tables.iter().filter_map(differs).collect()
}

/// The tables in `value`, as JSON pointers, each with its described keys but the tag.
#[cfg(test)]
fn collect_tables(
    kind: &Kind,
    value: &Value,
    pointer: String,
    tables: &mut Vec<(String, Vec<&'static str>)>,
) {
    let keys: &[Key] = match kind {
        Kind::Table(keys) => keys,
        Kind::Tagged(tag, variants) => {
            let variant = variants.iter().find(|(word, _)| value[tag] == **word);
            variant.unwrap().1
        }
        Kind::List(entry) => {
            for (index, value) in value.as_array().unwrap().iter().enumerate() {
                collect_tables(entry, value, format!("{pointer}/{index}"), tables);
            }
            return;
        }
        _ => return,
    };
    for key in keys {
        if let Some(value) = value.get(key.name) {
            collect_tables(&key.kind, value, format!("{pointer}/{}", key.name), tables);
        }
    }
    tables.push((pointer, keys.iter().map(|key| key.name).collect()));
}
