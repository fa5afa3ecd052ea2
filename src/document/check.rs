//! Refuses values that a description does not allow, with all their problems at once.

use super::kind::{NumberRange, TableKey, TagVariant, ValueKind};
use super::{Problem, any_of, number, one_of, quoted, suggest};
use serde_json::{Map, Value};

/// A tag and all its variants.
type Variants<'a> = (&'a str, &'a [TagVariant]);

/// The first whole number that is too large for TOML.
const LARGEST_WHOLE: f64 = (1_u64 << 63) as f64;

impl ValueKind {
    /// Adds what is wrong with `value`, found at `path`.
    pub(crate) fn check(&self, value: &Value, path: &str, problems: &mut Vec<Problem>) {
        let misfit = || {
            let found = found(value);
            let message = format!("`{path}` must be {}, but is {found}", self.words());
            Problem::new(path, message)
        };
        match (self, value) {
            (Self::Either(kinds), _) => match kinds.iter().find(|kind| kind.fits_type_of(value)) {
                // Another word may have been meant for any of the kinds.
                Some(Self::Choice(words)) if words.iter().all(|word| value != word) => {
                    problems.push(misfit());
                }
                Some(kind) => kind.check(value, path, problems),
                None => problems.push(misfit()),
            },
            (Self::Table(keys), Value::Object(table)) => {
                check_table(&keys.keys, None, table, path, problems);
            }
            (Self::Tagged(tag, variants), Value::Object(table)) => {
                check_tagged(tag, variants, table, path, problems);
            }
            (Self::List(kind), Value::Array(entries)) => {
                for (index, entry) in entries.iter().enumerate() {
                    kind.check(entry, &format!("{path}[{index}]"), problems);
                }
            }
            (Self::Vector, Value::Array(entries)) if entries.len() == 3 => {
                for (index, entry) in entries.iter().enumerate() {
                    let path = format!("{path}[{index}]");
                    Self::Number(NumberRange::ANY).check(entry, &path, problems);
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
                if !words.contains(word) {
                    problems.push(match suggest(word, words.iter().map(String::as_str)) {
                        Some(near) => misfit().help(format!("did you mean \"{near}\"?")),
                        None => misfit(),
                    });
                }
            }
            (Self::Number(range), Value::Number(number)) => {
                let number = number.as_f64().unwrap_or(f64::NAN);
                if !range.contains(number) {
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
            (Self::AnyTable | Self::Any, _) if self.fits_type_of(value) => {
                check_finite(value, path, problems);
            }
            _ if self.fits_type_of(value) => {}
            _ => problems.push(misfit()),
        }
    }
}

/// For a table with any keys. TOML has no null: it stands for a number that is not finite.
fn check_finite(value: &Value, path: &str, problems: &mut Vec<Problem>) {
    match value {
        Value::Null => {
            let message = format!("`{path}` is not a finite number");
            problems.push(Problem::new(path, message).help("use a finite number"));
        }
        Value::Object(table) => {
            for (key, value) in table {
                check_finite(value, &format!("{path}.{key}"), problems);
            }
        }
        Value::Array(entries) => {
            for (index, value) in entries.iter().enumerate() {
                check_finite(value, &format!("{path}[{index}]"), problems);
            }
        }
        _ => {}
    }
}

/// What to write instead of a number that is not whole, or less than `least`.
fn advice_on_whole(number: &serde_json::Number, least: u64) -> String {
    let value = number.as_f64().unwrap_or(f64::NAN);
    match libm::trunc(value) == value && value >= least as f64 {
        true if value < LARGEST_WHOLE => format!("write {value:.0}, without a point"),
        true => format!("the largest whole number of a file is {}", i64::MAX),
        false => format!("use {least} or more, without a fraction"),
    }
}

/// What was found instead of the expected value.
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

/// The name of the table at `path` in messages.
fn table_name(path: &str) -> String {
    match path {
        "" => "the file".to_owned(),
        path if path.ends_with(']') => quoted(path),
        path => format!("[{path}]"),
    }
}

fn check_table(
    keys: &[TableKey],
    variants: Option<Variants<'_>>,
    table: &Map<String, Value>,
    path: &str,
    problems: &mut Vec<Problem>,
) {
    let join = |name: &str| match path {
        "" => name.to_owned(),
        path => format!("{path}.{name}"),
    };
    for (name, value) in table {
        match keys.iter().find(|key| key.name == *name) {
            Some(key) => key.kind.check(value, &join(name), problems),
            None if variants.is_some_and(|(tag, _)| tag == name) => {}
            None => problems.push(unknown_key(keys, variants, name, path, join(name))),
        }
    }
    let misspelt = |key: &TableKey| {
        let mut unknown = table
            .keys()
            .filter(|name| !keys.iter().any(|key| key.name == **name));
        unknown.any(|name| suggest(name, [key.name.as_str()]).is_some())
    };
    for key in keys
        .iter()
        .filter(|key| key.needed && !table.contains_key(&key.name))
    {
        if !misspelt(key) {
            problems.push(missing_key(key, path, &join(&key.name)));
        }
    }
}

fn unknown_key(
    keys: &[TableKey],
    variants: Option<Variants<'_>>,
    name: &str,
    table: &str,
    path: String,
) -> Problem {
    let table_name = table_name(table);
    let elsewhere = variants.and_then(|(tag, variants)| {
        let has = |variant: &&TagVariant| variant.table.keys.iter().any(|key| key.name == name);
        variants
            .iter()
            .find(has)
            .map(|variant| (tag, &variant.word))
    });
    if let Some((tag, word)) = elsewhere {
        let message = format!("`{path}` belongs to `{tag} = \"{word}\"` only");
        let help = format!("remove it, or choose `{tag} = \"{word}\"`");
        return Problem::new(path, message).help(help).at_key();
    }
    let tag = variants.map(|(tag, _)| tag);
    let names = || {
        tag.into_iter()
            .chain(keys.iter().map(|key| key.name.as_str()))
    };
    let message = format!("{table_name} has no key `{name}`");
    let known = format!("{table_name} has the keys {}", one_of(names()));
    let help = match suggest(name, names()) {
        Some(near) => format!("did you mean `{near}`? {known}"),
        None => known,
    };
    Problem::new(path, message).help(help).at_key()
}

fn missing_key(key: &TableKey, table: &str, path: &str) -> Problem {
    let name = &key.name;
    match &key.kind {
        ValueKind::Table(_) | ValueKind::Tagged(..) => {
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
fn first_keys(kind: &ValueKind) -> String {
    match kind {
        ValueKind::Table(table) => {
            let needed = table.keys.iter().filter(|key| key.needed);
            one_of(needed.map(|key| &key.name))
        }
        ValueKind::Tagged(tag, variants) => {
            let words = variants.iter().map(|variant| &variant.word);
            one_of(words.map(|word| format!("{tag} = \"{word}\"")))
        }
        _ => String::new(),
    }
}

fn check_tagged(
    tag: &str,
    variants: &[TagVariant],
    table: &Map<String, Value>,
    path: &str,
    problems: &mut Vec<Problem>,
) {
    let words: Vec<&str> = variants.iter().map(|it| it.word.as_str()).collect();
    let listed = || any_of(words.iter().map(|word| format!("{tag} = \"{word}\"")));
    let Some(value) = table.get(tag) else {
        let message = format!("{} lacks the key `{tag}`", table_name(path));
        problems.push(Problem::new(path, message).help(format!("add {}", listed())));
        return;
    };
    match variants.iter().find(|variant| *value == *variant.word) {
        Some(variant) => {
            let keys = &variant.table.keys;
            check_table(keys, Some((tag, variants)), table, path, problems);
        }
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
