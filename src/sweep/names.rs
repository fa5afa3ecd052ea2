//! Patterns of file names, which say where in a name the values of its run are, such as
//! `run-@{spheres.radius}[_s@{seed}].npy`. What is in brackets may be missing.

use crate::document::Problem;
use crate::scene::{Marks, TextPiece};

/// The mark of the seed.
const SEED: &str = "seed";

/// The mark of any text, such as the name of a run.
const NAME: &str = "name";

/// The seed of a name without one.
const FIRST_SEED: u64 = 1;

/// A pattern of file names.
#[derive(Clone, Debug, PartialEq)]
pub struct NamePattern {
    text: String,
    /// The marks of values, in order.
    keys: Vec<String>,
    /// The pattern with and without each part in brackets, those with the earlier parts first.
    forms: Vec<Vec<NamePart>>,
}

/// What a name says of its run.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedRun {
    /// The values of the keys, in the order of the pattern.
    pub values: Vec<f64>,
    /// The seed; 1 if the name has none.
    pub seed: u64,
}

/// A part of a pattern.
#[derive(Clone, Debug, PartialEq)]
enum NamePart {
    Text(String),
    Value,
    Seed,
    Name,
    /// What may be missing.
    Optional(Vec<NamePart>),
}

impl NamePattern {
    /// The names of the thesis's dumps, and of those that `phase export` writes.
    pub const OF_THESIS: &str =
        "dump_r@{spheres.radius}_p@{spheres.density}_f@{swirl.omega}[_s@{seed}[_@{name}]].npy";

    /// Reads a pattern.
    ///
    /// # Errors
    /// If it is not clear what of a name is which value, or if no file of arrays has such a name.
    pub fn parse(text: &str) -> Result<Self, Problem> {
        let (parts, keys) = parts_of(text)?;
        let forms = forms_of(&parts);
        for form in &forms {
            check_form(form)?;
        }
        let is_marked = |form: &Vec<NamePart>| {
            form.contains(&NamePart::Value) || form.contains(&NamePart::Seed)
        };
        if !forms.iter().any(is_marked) {
            let help = "write marks where the values are, such as `@{spheres.radius}`";
            return Err(Problem::new("", "it has no mark of a value").help(help));
        }
        Ok(Self {
            text: text.to_owned(),
            keys,
            forms,
        })
    }

    /// The pattern as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The keys whose values a name has, as they are written, in order.
    pub fn keys(&self) -> &[String] {
        &self.keys
    }

    /// The extension of the files: `npy` or `npz`.
    pub fn extension(&self) -> &str {
        self.text.rsplit_once('.').map_or("", |(_, it)| it)
    }

    /// What a name says, if it fits.
    pub fn read(&self, name: &str) -> Option<NamedRun> {
        self.forms.iter().find_map(|form| read(form, name))
    }
}

/// The parts of a pattern, and its keys.
fn parts_of(text: &str) -> Result<(Vec<NamePart>, Vec<String>), Problem> {
    let mut keys: Vec<String> = Vec::new();
    let mut seen = Vec::new();
    let mut parts = Vec::new();
    // What stands before each bracket that is open.
    let mut before = Vec::new();
    for piece in Marks::of(text) {
        match piece {
            TextPiece::Plain(plain) => {
                for piece in plain.split_inclusive(['[', ']']) {
                    push_text(&mut parts, piece.trim_end_matches(['[', ']']));
                    if piece.ends_with('[') {
                        before.push(std::mem::take(&mut parts));
                    } else if piece.ends_with(']') {
                        let outer = before.pop().ok_or_else(|| bracket("]", "[", "before"))?;
                        check_optional(&parts)?;
                        let optional = NamePart::Optional(std::mem::replace(&mut parts, outer));
                        parts.push(optional);
                    }
                }
            }
            TextPiece::Mark(name, _) => {
                if seen.contains(&name) {
                    let message = format!("it has `@{{{name}}}` twice");
                    return Err(Problem::new("", message).help("leave one of them out"));
                }
                seen.push(name);
                parts.push(match name {
                    SEED => NamePart::Seed,
                    NAME => NamePart::Name,
                    key => {
                        keys.push(key.to_owned());
                        NamePart::Value
                    }
                });
            }
            TextPiece::Open(place) => {
                let message = format!("the mark `{}` has no end", &text[place]);
                return Err(Problem::new("", message).help("write `}` behind its key"));
            }
        }
    }
    match before.is_empty() {
        true => Ok((parts, keys)),
        false => Err(bracket("[", "]", "behind")),
    }
}

fn bracket(found: &str, other: &str, place: &str) -> Problem {
    let message = format!("it has a `{found}` without a `{other}` {place} it");
    Problem::new("", message).help("write what may be missing between `[` and `]`")
}

/// A run must have all its values, so that only the seed and the name may be missing.
fn check_optional(parts: &[NamePart]) -> Result<(), Problem> {
    let is_mark = |part: &NamePart| matches!(part, NamePart::Seed | NamePart::Name);
    match parts.contains(&NamePart::Value) || !parts.iter().any(is_mark) {
        true => Err(Problem::new("", "only a seed or a name may be missing")
            .help("write `[_s@{seed}]` or `[_@{name}]`, and no brackets around other marks")),
        false => Ok(()),
    }
}

/// Adds a text to parts, of which no two are texts behind each other.
fn push_text(parts: &mut Vec<NamePart>, text: &str) {
    match parts.last_mut() {
        Some(NamePart::Text(last)) => last.push_str(text),
        _ if text.is_empty() => {}
        _ => parts.push(NamePart::Text(text.to_owned())),
    }
}

/// All forms of names: with and without each optional part.
fn forms_of(parts: &[NamePart]) -> Vec<Vec<NamePart>> {
    let mut forms = vec![Vec::new()];
    for part in parts {
        let endings = match part {
            NamePart::Optional(inner) => forms_of(inner).into_iter().chain([Vec::new()]).collect(),
            part => vec![vec![part.clone()]],
        };
        let with = |form: &Vec<NamePart>| -> Vec<Vec<NamePart>> {
            endings.iter().map(|ending| joined(form, ending)).collect()
        };
        forms = forms.iter().flat_map(with).collect();
    }
    forms
}

fn joined(form: &[NamePart], ending: &[NamePart]) -> Vec<NamePart> {
    let mut joined = form.to_vec();
    for part in ending {
        match part {
            NamePart::Text(text) => push_text(&mut joined, text),
            part => joined.push(part.clone()),
        }
    }
    joined
}

/// Checks that only one reading of a name is possible, and that it is one of an array.
fn check_form(form: &[NamePart]) -> Result<(), Problem> {
    for pair in form.windows(2) {
        match pair {
            [NamePart::Text(_), _] => {}
            [NamePart::Name, NamePart::Text(_)] => {}
            [_, NamePart::Text(text)] if goes_on_a_number(text) => {
                let message = format!("the text `{text}` behind a mark could belong to its number");
                let help = "begin it with another sign, such as `_`";
                return Err(Problem::new("", message).help(help));
            }
            [_, NamePart::Text(_)] => {}
            _ => {
                let help = "write a text between them, such as `_`";
                return Err(Problem::new("", "two marks have no text between them").help(help));
            }
        }
    }
    let behind_name = form
        .iter()
        .skip_while(|part| **part != NamePart::Name)
        .skip(1);
    if behind_name
        .filter(|part| !matches!(part, NamePart::Text(_)))
        .count()
        > 0
    {
        let message = "a mark stands behind `@{name}`, which is any text";
        return Err(Problem::new("", message).help("make `@{name}` the last mark"));
    }
    match form.last() {
        Some(NamePart::Text(text)) if text.ends_with(".npy") || text.ends_with(".npz") => Ok(()),
        _ => {
            let message = "it does not end in `.npy` or `.npz`";
            Err(Problem::new("", message).help("write the whole name of a file of an array"))
        }
    }
}

/// Whether a number that stands before a text could go on with it.
fn goes_on_a_number(text: &str) -> bool {
    let mut signs = text.chars();
    match signs.next() {
        Some('.') => !signs.next().is_some_and(|sign| sign.is_ascii_alphabetic()),
        Some(first) => first.is_ascii_digit() || "eE".contains(first),
        None => false,
    }
}

/// What a name says that has this form.
fn read(form: &[NamePart], name: &str) -> Option<NamedRun> {
    let mut rest = name;
    let mut run = NamedRun {
        values: Vec::new(),
        seed: FIRST_SEED,
    };
    for (place, part) in form.iter().enumerate() {
        match part {
            NamePart::Text(text) => rest = rest.strip_prefix(text.as_str())?,
            NamePart::Value => {
                let number;
                (number, rest) = rest.split_at(length_of_number(rest));
                let value = number.parse().ok().filter(|value: &f64| value.is_finite());
                run.values.push(value?);
            }
            NamePart::Seed => {
                let digits = rest.bytes().take_while(u8::is_ascii_digit).count();
                let number;
                (number, rest) = rest.split_at(digits);
                run.seed = number.parse().ok()?;
            }
            NamePart::Name => {
                let end = match form.get(place + 1) {
                    Some(NamePart::Text(text)) => text.as_str(),
                    _ => "",
                };
                let length = rest.strip_suffix(end).filter(|it| !it.is_empty())?.len();
                rest = &rest[length..];
            }
            // Forms have none.
            NamePart::Optional(_) => {}
        }
    }
    rest.is_empty().then_some(run)
}

/// How many bytes at the start of a text are a number, such as `-06.5e-3`.
fn length_of_number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let sign = |at: usize| usize::from(matches!(bytes.get(at), Some(b'+' | b'-')));
    let digits = |at: usize| {
        let rest = bytes.get(at..).unwrap_or_default();
        rest.iter().take_while(|byte| byte.is_ascii_digit()).count()
    };
    let mut end = sign(0);
    end += digits(end);
    if bytes.get(end) == Some(&b'.') && digits(end + 1) > 0 {
        end += 1 + digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let start = end + 1 + sign(end + 1);
        if digits(start) > 0 {
            end = start + digits(start);
        }
    }
    end
}
