//! Labels and measures of a run, by the rules of its family and by its sieves.

use super::names::{RunValues, SceneNames};
use super::{condition, number};
use crate::classify::{ClassifyError, Family, Label, Sieves};
use crate::record::RunRecord;
use crate::rule::{Condition, Evidence, ExpressionError, Number};
use crate::scene::{RuleWindow, Scene};
use std::ops::Range;

/// What a family says of a run that no guard ended: the label of the first rule that holds, or else
/// the label of the sieves; and the values of its measures, in their order.
pub(in crate::classify) fn judge(
    family: &Family,
    record: &RunRecord,
    sieves: &Sieves,
) -> Result<(Label, Vec<Option<f64>>), ClassifyError> {
    let names = SceneNames::new(&record.scene);
    let fail = |rule: &str, error: ExpressionError| ClassifyError::Rule {
        rule: rule.to_owned(),
        reason: error.message,
    };
    let labels = family.rules.iter().map(|rule| {
        let read = condition(rule.when, &names);
        read.map_err(|error| fail(rule.label.name, error))
    });
    let labels: Vec<Condition> = labels.collect::<Result<_, _>>()?;
    let measures = family.measured.iter().map(|rule| {
        let read = number(rule.measure.description, &names);
        read.map_err(|error| fail(rule.measure.name, error))
    });
    let measures: Vec<Number> = measures.collect::<Result<_, _>>()?;

    let (of_sieves, values_of_sieves) = match family.needs_sieves(&record.scene) {
        true => (Family::of(&record.scene).judge)(record, sieves)?,
        false => (Label::OTHER, Vec::new()),
    };
    let run = RunValues::new(record, &values_of_sieves);
    let (mut label, mut values) = (None, Vec::new());
    for (rule, condition) in family.rules.iter().zip(&labels) {
        check_columns(rule.label.name, condition.columns(), &run)?;
        let (found, since) = evidence(condition, rule.over.as_ref(), &run, record);
        if found.holds {
            label.get_or_insert(rule.label);
        }
        values.extend(numbers(&found));
        values.extend(rule.over.is_some().then_some(since));
    }
    if !family.has_rules_alone() {
        values.extend(&values_of_sieves);
    }
    for (rule, number) in family.measured.iter().zip(&measures) {
        check_columns(rule.measure.name, number.columns(), &run)?;
        let value = number.evaluate(&run, frames(rule.over.as_ref(), record));
        values.push(value.is_finite().then_some(value));
    }
    // Sieves may have measured what rules alone read.
    let otherwise = match family.has_rules_alone() {
        true => Label::OTHER,
        false => of_sieves,
    };
    Ok((label.unwrap_or(otherwise), values))
}

impl Family {
    /// Whether its runs are judged by sieves, or by rules that read what these measure.
    pub(in crate::classify) fn needs_sieves(&self, scene: &Scene) -> bool {
        let names = SceneNames::new(scene);
        let conditions = self.rules.iter();
        let conditions = conditions.filter_map(|rule| condition(rule.when, &names).ok());
        let numbers = self.measured.iter();
        let numbers = numbers.filter_map(|rule| number(rule.measure.description, &names).ok());
        let keys = conditions.flat_map(|it| it.keys().to_vec());
        let mut keys = keys.chain(numbers.flat_map(|it| it.keys().to_vec()));
        !self.has_rules_alone() || keys.any(|key| names.is_measure(&key))
    }
}

/// The evidence of a rule, and since when it holds (s). Of several windows it is the first in which
/// the rule holds, or else the one in which it comes nearest.
fn evidence(
    condition: &Condition,
    over: Option<&RuleWindow>,
    run: &RunValues<'_>,
    record: &RunRecord,
) -> (Evidence, Option<f64>) {
    let Some(over) = over.filter(|it| it.any.is_some()) else {
        let window = frames(over, record);
        let start = record.observations.time.get(window.start).copied();
        let found = condition.evaluate(run, window);
        let since = start.filter(|_| found.holds);
        return (found, since);
    };
    let mut nearest: Option<Evidence> = None;
    let windows = over.windows(record);
    let starts = windows.iter().map(|it| record.observations.time[it.start]);
    let starts: Vec<f64> = starts.collect();
    for (start, found) in starts
        .into_iter()
        .zip(condition.evaluate_each(run, windows))
    {
        if found.holds {
            return (found, Some(start));
        }
        // A margin that is not a number is farther than any.
        let margin = |it: &Evidence| {
            if it.margin.is_nan() {
                f64::MIN
            } else {
                it.margin
            }
        };
        if nearest
            .as_ref()
            .is_none_or(|it| margin(&found) > margin(it))
        {
            nearest = Some(found);
        }
    }
    // A run that is shorter than the window has none.
    (
        nearest.unwrap_or_else(|| condition.evaluate(run, 0..0)),
        None,
    )
}

/// Value and threshold of the comparison that decides, and the margin of the whole rule. What is
/// not a number is empty.
fn numbers(found: &Evidence) -> [Option<f64>; 3] {
    let decides = found
        .comparisons
        .iter()
        .find(|it| it.relative_margin.abs() == found.margin.abs())
        .or(found.comparisons.first());
    let [value, threshold] = decides.map_or([f64::NAN; 2], |it| [it.value, it.threshold]);
    // Zero has no sign in tables.
    [value, threshold, found.margin].map(|it| it.is_finite().then_some(it + 0.0))
}

fn frames(over: Option<&RuleWindow>, record: &RunRecord) -> Range<usize> {
    let whole = 0..record.observations.frames();
    over.map_or(whole, |it| it.frames(record))
}

/// Refuses a record without a column that a rule reads.
fn check_columns(rule: &str, columns: &[String], run: &RunValues<'_>) -> Result<(), ClassifyError> {
    match columns.iter().find(|it| !run.has(it)) {
        Some(column) => Err(ClassifyError::NoColumn {
            rule: rule.to_owned(),
            column: column.clone(),
        }),
        None => Ok(()),
    }
}
