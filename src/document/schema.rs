//! Which keys a file may have and what each may hold.
//!
//! A description is data: one list per table, next to the structs that the file ends in. It
//! serves to refuse a file with all its problems at once, to name the numeric keys of a scene, and
//! to describe files to editors and readers ([`crate::reference`]).

use super::{Problem, any_of, number, one_of, quoted, suggest};
use serde_json::{Map, Value};

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

/// A tag and all its variants.
type Variants = (&'static str, &'static [Variant]);

/// The first whole number that is too large for TOML.
const LARGEST_WHOLE: f64 = (1_u64 << 63) as f64;

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

    fn contains(self, value: f64) -> bool {
        let high_enough = if self.low_allowed {
            value >= self.low
        } else {
            value > self.low
        };
        high_enough && value <= self.high
    }

    /// What to use in place of a number that is outside.
    fn advice(self, value: f64) -> String {
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

    /// Adds what is wrong with `value`, found at `path`.
    pub(crate) fn check(&self, value: &Value, path: &str, problems: &mut Vec<Problem>) {
        let misfit = || {
            let found = found(value);
            let message = format!("`{path}` must be {}, but is {found}", self.words());
            Problem::new(path, message)
        };
        match (self, value) {
            (Self::Either(kinds), _) => match kinds.iter().find(|kind| kind.fits_type_of(value)) {
                // Who writes another word may have meant any of the kinds.
                Some(Self::Choice(words)) if words.iter().all(|word| value != word) => {
                    problems.push(misfit());
                }
                Some(kind) => kind.check(value, path, problems),
                None => problems.push(misfit()),
            },
            (Self::Table(keys), Value::Object(table)) => {
                check_table(keys, None, table, path, problems);
            }
            (Self::Tagged(tag, variants), Value::Object(table)) => {
                check_tagged(tag, variants, table, path, problems);
            }
            (Self::List(kind), Value::Array(entries)) => {
                for (index, entry) in entries.iter().enumerate() {
                    kind.check_entry(entry, path, index, problems);
                }
            }
            (Self::Vector, Value::Array(entries)) if entries.len() == 3 => {
                for (index, entry) in entries.iter().enumerate() {
                    let path = format!("{path}[{index}]");
                    Self::Number(Range::ANY).check(entry, &path, problems);
                }
            }
            (Self::Vector, Value::Array(entries)) => {
                let message = format!(
                    "`{path}` must be a list of three numbers, but has {}",
                    entries.len()
                );
                problems.push(Problem::new(path, message));
            }
            (Self::Choice(words), Value::String(word)) => {
                if !words.contains(&word.as_str()) {
                    problems.push(match suggest(word, words.iter().copied()) {
                        Some(near) => misfit().help(format!("did you mean \"{near}\"?")),
                        None => misfit(),
                    });
                }
            }
            (Self::Number(range), Value::Number(number)) => {
                let number = number.as_f64().unwrap_or(f64::NAN);
                if number.abs() > Range::HUGE {
                    problems.push(misfit().help("no number may be beyond 1e30"));
                } else if !range.contains(number) {
                    problems.push(misfit().help(range.advice(number)));
                }
            }
            (Self::Whole(least), Value::Number(number)) => {
                if number.as_u64().is_none_or(|number| number < *least) {
                    problems.push(misfit().help(advice_on_whole(number, *least)));
                }
            }
            (Self::Number(_), Value::Null) => {
                problems.push(misfit().help("use a finite number"));
            }
            _ if self.fits_type_of(value) => {}
            _ => problems.push(misfit()),
        }
    }

    /// Checks one entry of a list of this kind that stands at `path`.
    pub(crate) fn check_entry(
        &self,
        entry: &Value,
        path: &str,
        index: usize,
        problems: &mut Vec<Problem>,
    ) {
        self.check(entry, &format!("{path}[{index}]"), problems);
    }
}

/// What to write in place of a number that is not whole, or less than that.
fn advice_on_whole(number: &serde_json::Number, least: u64) -> String {
    let value = number.as_f64().unwrap_or(f64::NAN);
    match libm::trunc(value) == value && value >= least as f64 {
        true if value < LARGEST_WHOLE => format!("write {value:.0}, without a point"),
        true => format!("the largest whole number of a file is {}", i64::MAX),
        false => format!("use {least} or more, without a fraction"),
    }
}

/// The keys of a table, as it would be written.
fn braces(keys: &[Key]) -> String {
    let names: Vec<&str> = keys.iter().map(|key| key.name).collect();
    format!("{{ {} }}", names.join(", "))
}

/// What was found in place of the value that should be there.
fn found(value: &Value) -> String {
    match value {
        Value::Null => "not a finite number".to_owned(),
        Value::Bool(flag) => flag.to_string(),
        Value::Number(value) => value.as_f64().map_or_else(|| value.to_string(), number),
        Value::String(text) => format!("\"{text}\""),
        Value::Array(entries) if entries.is_empty() => "an empty list".to_owned(),
        Value::Array(_) => "a list".to_owned(),
        Value::Object(_) => "a table".to_owned(),
    }
}

/// How a message calls the table at `path`.
fn table_name(path: &str) -> String {
    match path {
        "" => "the file".to_owned(),
        path if path.ends_with(']') => quoted(path),
        path => format!("[{path}]"),
    }
}

fn check_table(
    keys: &'static [Key],
    variants: Option<Variants>,
    table: &Map<String, Value>,
    path: &str,
    problems: &mut Vec<Problem>,
) {
    let join = |name: &str| match path {
        "" => name.to_owned(),
        path => format!("{path}.{name}"),
    };
    for (name, value) in table {
        match keys.iter().find(|key| key.name == name) {
            Some(key) => key.kind.check(value, &join(name), problems),
            None if variants.is_some_and(|(tag, _)| tag == name) => {}
            None => problems.push(unknown_key(keys, variants, name, path, join(name))),
        }
    }
    let misspelt = |key: &Key| {
        let mut unknown = table
            .keys()
            .filter(|name| !keys.iter().any(|key| key.name == **name));
        unknown.any(|name| suggest(name, [key.name]).is_some())
    };
    for key in keys
        .iter()
        .filter(|key| key.needed && !table.contains_key(key.name))
    {
        if !misspelt(key) {
            problems.push(missing_key(key, path, &join(key.name)));
        }
    }
}

fn unknown_key(
    keys: &'static [Key],
    variants: Option<Variants>,
    name: &str,
    table: &str,
    path: String,
) -> Problem {
    let table_name = table_name(table);
    let elsewhere = variants.and_then(|(tag, variants)| {
        let has = |(_, keys): &&Variant| keys.iter().any(|key| key.name == name);
        variants.iter().find(has).map(|(word, _)| (tag, word))
    });
    if let Some((tag, word)) = elsewhere {
        let message = format!("`{path}` belongs to `{tag} = \"{word}\"` only");
        let help = format!("remove it, or choose `{tag} = \"{word}\"`");
        return Problem::new(path, message).help(help).at_key();
    }
    let tag = variants.map(|(tag, _)| tag);
    let names = || tag.into_iter().chain(keys.iter().map(|key| key.name));
    let message = format!("{table_name} has no key `{name}`");
    let known = format!("{table_name} knows {}", one_of(names()));
    let help = match suggest(name, names()) {
        Some(near) => format!("did you mean `{near}`? {known}"),
        None => known,
    };
    Problem::new(path, message).help(help).at_key()
}

fn missing_key(key: &Key, table: &str, path: &str) -> Problem {
    let name = key.name;
    match &key.kind {
        Kind::Table(_) | Kind::Tagged(..) => {
            let message = format!("{} lacks the table [{path}]", table_name(table));
            Problem::new(table, message)
                .help(format!("add [{path}] with {}", first_keys(&key.kind)))
        }
        kind => {
            let message = format!("{} lacks the key `{name}`", table_name(table));
            Problem::new(table, message).help(format!("add `{name} = ...`, {}", kind.words()))
        }
    }
}

/// The keys that a table must have.
fn first_keys(kind: &Kind) -> String {
    match kind {
        Kind::Table(keys) => one_of(keys.iter().filter(|key| key.needed).map(|key| key.name)),
        Kind::Tagged(tag, variants) => {
            let words = variants
                .iter()
                .map(|(word, _)| format!("{tag} = \"{word}\""));
            one_of(words)
        }
        _ => String::new(),
    }
}

fn check_tagged(
    tag: &'static str,
    variants: &'static [Variant],
    table: &Map<String, Value>,
    path: &str,
    problems: &mut Vec<Problem>,
) {
    let words: Vec<&str> = variants.iter().map(|(word, _)| *word).collect();
    let listed = || any_of(words.iter().map(|word| format!("{tag} = \"{word}\"")));
    let Some(value) = table.get(tag) else {
        let message = format!("{} lacks the key `{tag}`", table_name(path));
        problems.push(Problem::new(path, message).help(format!("add {}", listed())));
        return;
    };
    match variants
        .iter()
        .find(|(word, _)| value.as_str() == Some(word))
    {
        Some((_, keys)) => check_table(keys, Some((tag, variants)), table, path, problems),
        None => {
            let near = value
                .as_str()
                .and_then(|word| suggest(word, words.iter().copied()));
            let message = format!("`{path}.{tag}` is {}", found(value));
            let known = format!("use {}", listed());
            let help = match near {
                Some(near) => format!("did you mean \"{near}\"? {known}"),
                None => known,
            };
            problems.push(Problem::new(format!("{path}.{tag}"), message).help(help));
        }
    }
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
