//! Every number that a message says to type is accepted when it is typed.
//!
//! Symptom: "use 0.999997 s or 1 s", and both were refused. Cause: numbers were rounded for the eye
//! where they had to satisfy a check. The tests read the numbers from whatever the messages say, so
//! that a new message is tested by being there.

use crate::scene_files::{files, kind};
use phase::document::{LoadError, LocatedProblem};
use phase::scene::Scene;
use phase::study::{accuracy, stability};
use phase::sweep;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::path::Path;
use toml::{Table, Value};

/// Rounds of typing after which a file should be accepted, or have problems of another kind.
const ROUNDS: usize = 12;

/// What a message says to type.
#[derive(Clone, Debug)]
struct Suggestion {
    /// The key, if the message names one; else the number stands at the caret.
    key: Option<String>,
    /// The number as it is typed.
    number: String,
}

fn problems(path: &Path, text: &str) -> Vec<LocatedProblem> {
    let error = match kind(path) {
        "sweep" => sweep::from_str(text, path).err(),
        "stability" => stability::from_str(text, path).err(),
        "accuracy" => accuracy::from_str(text, path).err(),
        _ => Scene::from_toml(text, path).err(),
    };
    match error {
        Some(LoadError::Invalid(findings)) => findings,
        Some(error) => panic!("{}: {error}", path.display()),
        None => Vec::new(),
    }
}

/// A message without its numbers: the problem whatever the values.
fn problem_of(finding: &LocatedProblem) -> String {
    let is_number = |word: &str| {
        let end = |character: char| ",;:.".contains(character);
        word.trim_end_matches(end).parse::<f64>().is_ok()
    };
    let words = finding.message.split_whitespace();
    let place = finding
        .spot
        .as_ref()
        .map(|spot| spot.text.split('=').next());
    format!(
        "{place:?} {:?}",
        words.filter(|word| !is_number(word)).collect::<Vec<_>>()
    )
}

/// All numbers that a message says to type.
fn suggestions(finding: &LocatedProblem) -> Vec<Suggestion> {
    let help = finding.help.as_deref().unwrap_or_default();
    let table = ["in [", "add ["].into_iter().find_map(|before| {
        let (_, rest) = help.split_once(before)?;
        rest.split(']').next()
    });
    let mut found = Vec::new();
    for code in help.split('`').skip(1).step_by(2) {
        let Some((key, number)) = code.split_once(" = ") else {
            continue;
        };
        let is_key = key
            .chars()
            .all(|it| it.is_ascii_lowercase() || "_.".contains(it));
        if is_key && number.parse::<f64>().is_ok() {
            let key = match table {
                Some(table) => format!("{table}.{key}"),
                None => key.to_owned(),
            };
            let (key, number) = (Some(key), number.to_owned());
            found.push(Suggestion { key, number });
        }
    }
    let prose: String = help.split('`').step_by(2).collect::<Vec<_>>().join(" _ ");
    let words: Vec<&str> = prose.split_whitespace().collect();
    let word = |at: Option<usize>| at.and_then(|at| words.get(at)).copied().unwrap_or_default();
    for (at, text) in words.iter().enumerate() {
        let number = text.trim_end_matches([',', ';', ':', '.']);
        let Ok(value) = number.parse::<f64>() else {
            continue;
        };
        let before = word(at.checked_sub(1));
        let after = [word(Some(at + 1)), word(Some(at + 2)), word(Some(at + 3))].join(" ");
        let leads = ["use", "write", "or", "least", "most", "as", "is", "beyond"];
        let number = match before {
            "above" => value.next_up().to_string(),
            "than" => value.next_down().to_string(),
            "between" => value.next_up().to_string(),
            "and" => value.next_down().to_string(),
            _ if leads.contains(&before) => number.to_owned(),
            _ if after.starts_with("are the most") => number.to_owned(),
            _ if after.starts_with("or more") || after.starts_with("or less") => number.to_owned(),
            _ => continue,
        };
        found.push(Suggestion { key: None, number });
    }
    found
}

/// The bytes of the text that the caret of a finding stands below, if they are a number.
fn number_at_caret(text: &str, finding: &LocatedProblem) -> Option<std::ops::Range<usize>> {
    let spot = finding.spot.as_ref()?;
    let line = text.lines().nth(spot.line - 1)?;
    let start = line.as_ptr() as usize - text.as_ptr() as usize;
    let byte = |column: usize| {
        let mut places = line.char_indices().map(|(byte, _)| byte);
        places.nth(column).unwrap_or(line.len())
    };
    let (from, to) = (byte(spot.column - 1), byte(spot.column - 1 + spot.width));
    line[from..to].parse::<f64>().ok()?;
    Some(start + from..start + to)
}

/// The path of the table in which a line stands, an entry of a list by its number.
fn table_of_line(text: &str, line: usize) -> String {
    let mut path = String::new();
    let mut seen: Vec<&str> = Vec::new();
    for line in text.lines().take(line) {
        let line = line.trim();
        if let Some(header) = line.strip_prefix("[[") {
            let name = header.split(']').next().unwrap();
            let index = seen.iter().filter(|it| **it == name).count();
            seen.push(name);
            path = format!("{name}.{index}");
        } else if let Some(header) = line.strip_prefix('[') {
            header.split(']').next().unwrap().clone_into(&mut path);
        }
    }
    path
}

/// Sets a key of a document, with the tables on the way to it.
fn set(table: &mut Table, path: &str, number: &str) -> Option<()> {
    let value = format!("x = {number}")
        .parse::<Table>()
        .unwrap()
        .remove("x")?;
    let mut parts: Vec<&str> = path.split('.').collect();
    let key = parts.pop()?;
    let mut place = table;
    let mut parts = parts.into_iter().peekable();
    while let Some(part) = parts.next() {
        let next = place
            .entry(part)
            .or_insert_with(|| Value::Table(Table::new()));
        place = match next {
            Value::Array(entries) => {
                let index: usize = parts.next()?.parse().ok()?;
                entries.get_mut(index)?.as_table_mut()?
            }
            other => other.as_table_mut()?,
        };
    }
    place.insert(key.to_owned(), value);
    Some(())
}

/// The text with a suggestion typed where its message points to; none if it says no such place.
fn typed(text: &str, finding: &LocatedProblem, suggestion: &Suggestion) -> Option<String> {
    let caret = number_at_caret(text, finding);
    if let (Some(range), None) = (&caret, &suggestion.key) {
        let mut text = text.to_owned();
        // "N are the most" of what follows from the number at the caret is no number to type there.
        let asks = text[range.clone()].parse::<f64>().ok()?;
        let help = finding.help.as_deref()?;
        let most = suggestion.number.parse::<f64>().ok()?;
        if help.contains("are the most") && asks <= most {
            return None;
        }
        text.replace_range(range.clone(), &suggestion.number);
        return Some(text);
    }
    let named = || {
        let mut code = finding.message.split('`').skip(1).step_by(2);
        code.find(|code| code.contains('.') && !code.contains(' '))
    };
    let mut table = text.parse::<Table>().ok()?;
    let line = finding.spot.as_ref().map_or(0, |spot| spot.line);
    let path = match &suggestion.key {
        Some(key) if key.contains('.') => key.clone(),
        Some(key) => match table_of_line(text, line) {
            path if path.is_empty() => named()
                .and_then(|path| path.rsplit_once('.'))
                .map_or_else(|| key.clone(), |(table, _)| format!("{table}.{key}")),
            path => format!("{path}.{key}"),
        },
        None => named()?.to_owned(),
    };
    set(&mut table, &path, &suggestion.number)?;
    Some(table.to_string())
}

/// Types every suggestion of every message about a file, and fails if the problem stays. Returns
/// how many there were.
fn type_all(path: &Path, text: &str) -> usize {
    let mut count = 0;
    for finding in problems(path, text) {
        for suggestion in suggestions(&finding) {
            let Some(typed) = typed(text, &finding, &suggestion) else {
                continue;
            };
            count += 1;
            let problem = problem_of(&finding);
            let stays = problems(path, &typed);
            let stays = stays.iter().find(|other| problem_of(other) == problem);
            if let Some(other) = stays {
                panic!("error: {finding}\n\nand with {suggestion:?}\n\nerror: {other}\n\n{typed}");
            }
        }
    }
    count
}

/// Follows the first suggestions until none is left. A problem may come back when another key was
/// changed, but not for ever.
fn follow(path: &Path, text: &str) {
    let mut text = text.to_owned();
    for _ in 0..ROUNDS {
        let next = problems(path, &text).into_iter().find_map(|finding| {
            let mut all = suggestions(&finding).into_iter();
            all.find_map(|suggestion| typed(&text, &finding, &suggestion))
        });
        let Some(typed) = next else { return };
        text = typed;
    }
    panic!("{}: still refused\n\n{text}", path.display());
}

#[test]
fn suggestions_of_the_messages_of_bad_files_are_accepted() {
    let mut count = 0;
    for path in files("tests/bad") {
        let Ok(text) = std::fs::read_to_string(&path) else {
            continue;
        };
        count += type_all(&path, &text);
        follow(&path, &text);
    }
    assert!(count > 50, "{count} suggestions");
}

/// `output.snapshot_interval` has a default, which frames of 6.24 µs do not divide.
#[test]
fn a_snapshot_interval_that_is_suggested_is_accepted() {
    let text = r#"
[spheres]
count=1
radius=0.005
density=2500.0
[start]
kind="list"
spheres=[{position=[0.0,0.0,0.0]}]
[gravity]
acceleration=9.81
[time]
dt=6.24e-6
duration=0.000624
frame_interval=6.24e-6
"#;
    let path = Path::new("tests/bad/scene.toml");
    let findings = problems(path, text);
    let help = findings[0].help.as_deref().unwrap();
    let expected = "use `snapshot_interval = 0.99999744` or `snapshot_interval = 1.00000368`";
    assert!(help.starts_with(expected), "{help}");
    assert_eq!(type_all(path, text), 2);
}

/// Symptom: a sweep whose points need different steps asked for one correction after the other.
/// Cause: the step that its message advised was that of the first bad point.
#[test]
fn one_suggested_step_serves_all_points_of_a_sweep() {
    let text = r#"
[[axis]]
key = "young_modulus"
values = [1e6, 1e10, 1e12, 1e11]
[seeds]
list = [1]
[scene]
spheres = { count = 10, radius = 0.004, density = 2500.0 }
contact = { law = "hertz", young_modulus = 1e6, poisson_ratio = 0.3, dissipation_time = 1e-6 }
tank = { radius = 0.06, floor = 0.0 }
start = { kind = "random", z_min = 0.01, z_max = 0.1 }
gravity = { acceleration = 9.81 }
[scene.time]
dt = 1e-4
duration = 0.1
frame_interval = 1e-2
"#;
    let path = Path::new("tests/good/sweep-of-table.toml");
    let findings = problems(path, text);
    let [finding] = &findings[..] else {
        panic!("{findings:?}");
    };
    let message = "at young_modulus = 1e10 (and at 2 more of the 4 points): `time.dt` = 1e-4 s";
    assert!(finding.message.starts_with(message), "{finding}");
    let help = finding.help.as_deref().unwrap();
    assert!(
        help.ends_with("at most half the limit at young_modulus = 1e12"),
        "{help}"
    );
    let [step] = &suggestions(finding)[..] else {
        panic!("{finding}");
    };
    let typed = typed(text, finding, step).unwrap();
    assert_eq!(problems(path, &typed), []);
}

/// The paths of all numbers of a document.
fn numbers(value: &Value, path: &str, found: &mut Vec<String>) {
    let join = |key: &str| match path {
        "" => key.to_owned(),
        path => format!("{path}.{key}"),
    };
    match value {
        Value::Table(table) => {
            for (key, value) in table {
                numbers(value, &join(key), found);
            }
        }
        Value::Array(entries) => {
            for (index, value) in entries.iter().enumerate() {
                numbers(value, &join(&index.to_string()), found);
            }
        }
        Value::Integer(_) | Value::Float(_) => found.push(path.to_owned()),
        _ => {}
    }
}

fn at<'a>(value: &'a mut Value, path: &str) -> &'a mut Value {
    path.split('.').fold(value, |value, part| match value {
        Value::Array(entries) => &mut entries[part.parse::<usize>().unwrap()],
        other => &mut other[part],
    })
}

/// A change of one number of a scene: which, by how many powers of ten, and whether it is a time.
type Change = (prop::sample::Index, f64, bool);

/// The text of a scene after changes.
fn changed(path: &Path, changes: Vec<Change>) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    let mut document = Value::Table(text.parse().unwrap());
    let mut places = Vec::new();
    numbers(&document, "", &mut places);
    for (place, decades, is_time) in changes {
        // The times have most to do with each other.
        let times = ["time.dt", "time.duration", "time.frame_interval"].map(str::to_owned);
        let times: Vec<_> = times.into_iter().filter(|it| places.contains(it)).collect();
        let place = match is_time && !times.is_empty() {
            true => place.get(&times),
            false => place.get(&places),
        };
        let value = at(&mut document, place);
        let factor = libm::pow(10.0, decades);
        *value = match &*value {
            Value::Integer(number) => {
                let number = (*number as f64 * factor).clamp(-1e5, 1e5);
                Value::Integer(number as i64)
            }
            other => Value::Float(other.as_float().unwrap() * factor),
        };
    }
    document.as_table().unwrap().to_string()
}

/// Scenes with one or two numbers that are anything: all that a check of numbers can say.
#[test]
fn suggestions_for_random_scenes_are_accepted() {
    let scenes = [files("tests/good"), files("sweeps/scenes")].concat();
    let is_scene = |path: &std::path::PathBuf| kind(path) == "scene";
    let scenes: Vec<_> = scenes.into_iter().filter(is_scene).collect();
    let change = (any::<prop::sample::Index>(), -4.0..4.0_f64, any::<bool>());
    let changes = prop::collection::vec(change, 1..3);
    let mut runner = TestRunner::new(ProptestConfig::with_cases(120));
    let count = std::cell::Cell::new(0);
    let cases = (any::<prop::sample::Index>(), changes);
    let result = runner.run(&cases, |(file, changes)| {
        let path = file.get(&scenes);
        let text = changed(path, changes);
        count.set(count.get() + type_all(path, &text));
        follow(path, &text);
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
    assert!(count.get() > 60, "{} suggestions", count.get());
}
