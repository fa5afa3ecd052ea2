//! From ladders and variants to settings.

use super::file::{Combine, Ladder};
use crate::document::{Problem, number};
use crate::grid::{VariantEntry, check_variants};
use crate::scene::{Change, leaf};
use crate::study::comparison::AS_IT_IS;
use serde_json::Value;

/// Name of the setting that others are compared with, where it is none of them.
pub(super) const REFERENCE: &str = "reference";

/// Names of settings that a study has besides its variants.
const TAKEN: [&str; 2] = [AS_IT_IS, REFERENCE];

/// Most settings of a study.
const MOST_CHOICES: usize = 500;

/// A setting of a study before it is put into the scene.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Choice {
    /// Where the file says it.
    pub(super) path: String,
    /// Name, such as `dt = 1e-4, velocity-verlet`.
    pub(super) name: String,
    /// Name of the line that it lies on.
    pub(super) method: String,
    /// Its place on the line, and the key of that.
    pub(super) rung: Option<(String, f64)>,
    /// What it changes.
    pub(super) change: Change,
}

/// All settings of ladders and variants.
///
/// # Errors
/// Ladders without values, with values twice, or too many of them.
pub(super) fn choices(
    ladders: &[Ladder],
    variants: &[VariantEntry],
    combine: Combine,
) -> Result<Vec<Choice>, Vec<Problem>> {
    let mut problems = Vec::new();
    check(ladders, variants, &mut problems);
    let steps: Vec<Vec<Choice>> = ladders
        .iter()
        .enumerate()
        .map(|(index, ladder)| steps(ladder, index))
        .collect();
    let named: Vec<Choice> = variants
        .iter()
        .enumerate()
        .map(|(index, variant)| Choice {
            path: format!("variant[{index}]"),
            name: variant.name.clone(),
            method: variant.name.clone(),
            rung: None,
            change: variant.change(),
        })
        .collect();
    let columns: Vec<Vec<Choice>> = steps
        .into_iter()
        .chain([named])
        .filter(|column| !column.is_empty())
        .collect();
    let count = match combine {
        Combine::Each => columns.iter().map(Vec::len).sum(),
        Combine::All => columns
            .iter()
            .fold(1, |all: usize, column| all.saturating_mul(column.len())),
    };
    if count > MOST_CHOICES {
        let message = format!("the study has {count} settings");
        let help = format!("{MOST_CHOICES} are the most; use fewer values");
        problems.push(Problem::new("ladder", message).help(help));
    }
    if !problems.is_empty() {
        return Err(problems);
    }
    Ok(match combine {
        Combine::Each => columns.into_iter().flatten().collect(),
        Combine::All => columns.into_iter().reduce(combined).unwrap_or_default(),
    })
}

/// The settings of one ladder.
fn steps(ladder: &Ladder, index: usize) -> Vec<Choice> {
    let values = ladder.values.iter().enumerate();
    let step = |(place, value): (usize, &Value)| {
        let name = leaf(&ladder.key);
        let (text, rung) = match (value, value.as_f64()) {
            (_, Some(it)) => (format!("{name} = {}", number(it)), Some(it)),
            (Value::String(word), _) => (word.clone(), None),
            (other, _) => (format!("{name} = {other}"), None),
        };
        Choice {
            path: format!("ladder[{index}].values[{place}]"),
            method: rung.map_or_else(|| text.clone(), |_| name.to_owned()),
            name: text,
            rung: rung.map(|value| (ladder.key.clone(), value)),
            change: Change::of_key(&ladder.key, value.clone()),
        }
    };
    values.map(step).collect()
}

/// Every choice of one list with every choice of another. The numbers of the first ladder that has
/// some are the rungs; what else a choice says names the line.
fn combined(first: Vec<Choice>, second: Vec<Choice>) -> Vec<Choice> {
    let pair = |one: &Choice, other: &Choice| {
        let method = match (&one.rung, &other.rung) {
            (Some(_), None) if one.method == method_of_rung(one) => other.method.clone(),
            (None, Some(_)) if other.method == method_of_rung(other) => one.method.clone(),
            (Some(_), _) if one.method == method_of_rung(one) => other.name.clone(),
            (Some(_), _) => format!("{}, {}", one.method, other.name),
            _ => format!("{}, {}", one.method, other.method),
        };
        Choice {
            path: other.path.clone(),
            name: format!("{}, {}", one.name, other.name),
            method,
            rung: one.rung.clone().or_else(|| other.rung.clone()),
            change: one.change.then(&other.change),
        }
    };
    let pairs = first
        .iter()
        .flat_map(|one| second.iter().map(move |other| pair(one, other)));
    pairs.collect()
}

/// The name of a line that has no other than its key.
fn method_of_rung(choice: &Choice) -> String {
    choice
        .rung
        .as_ref()
        .map_or_else(String::new, |(key, _)| leaf(key).to_owned())
}

fn check(ladders: &[Ladder], variants: &[VariantEntry], problems: &mut Vec<Problem>) {
    if ladders.is_empty() && variants.is_empty() {
        let help = "add [[ladder]] with `key` and `values`, or [[variant]] with `name` and `set`";
        problems.push(Problem::new("", "the study varies nothing").help(help));
    }
    for (index, ladder) in ladders.iter().enumerate() {
        let path = format!("ladder[{index}]");
        if ladders[..index]
            .iter()
            .any(|earlier| earlier.key == ladder.key)
        {
            let message = format!("another ladder varies `{}` already", ladder.key);
            let problem = Problem::new(format!("{path}.key"), message);
            problems.push(problem.help("join the two lists of values"));
        }
        if ladder.key.is_empty() || ladder.key.split('.').any(str::is_empty) {
            let message = format!("\"{}\" is no path of a key", ladder.key);
            let problem = Problem::new(format!("{path}.key"), message);
            problems.push(problem.help("write it as `time.dt`"));
        }
        if ladder.values.is_empty() {
            let problem = Problem::new(format!("{path}.values"), "the ladder has no values");
            problems.push(problem.help("list at least one"));
        }
        for (place, value) in ladder.values.iter().enumerate() {
            let is_same = |earlier: &Value| match (earlier.as_f64(), value.as_f64()) {
                (Some(one), Some(other)) => one == other,
                _ => earlier == value,
            };
            if ladder.values[..place].iter().any(is_same) {
                let path = format!("{path}.values[{place}]");
                let problem = Problem::new(path, format!("duplicate value {value}"));
                problems.push(problem.help("remove one"));
            }
        }
    }
    check_variants(variants, &TAKEN, problems);
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn ladder(key: &str, values: Value) -> Ladder {
        serde_json::from_value(json!({ "key": key, "values": values })).unwrap()
    }

    #[test]
    fn ladders_are_climbed_one_by_one_or_together() {
        let ladders = [
            ladder("time.dt", json!([1e-3, 1e-4])),
            ladder(
                "time.integrator",
                json!(["velocity-verlet", "symplectic-euler"]),
            ),
        ];
        let names = |combine| {
            let choices = choices(&ladders, &[], combine).unwrap();
            let names = choices.into_iter().map(|it| (it.name, it.method));
            names.collect::<Vec<_>>()
        };
        let pair = |name: &str, method: &str| (name.to_owned(), method.to_owned());
        assert_eq!(
            names(Combine::Each),
            [
                pair("dt = 0.001", "dt"),
                pair("dt = 1e-4", "dt"),
                pair("velocity-verlet", "velocity-verlet"),
                pair("symplectic-euler", "symplectic-euler"),
            ]
        );
        assert_eq!(
            names(Combine::All),
            [
                pair("dt = 0.001, velocity-verlet", "velocity-verlet"),
                pair("dt = 0.001, symplectic-euler", "symplectic-euler"),
                pair("dt = 1e-4, velocity-verlet", "velocity-verlet"),
                pair("dt = 1e-4, symplectic-euler", "symplectic-euler"),
            ]
        );
    }
}
