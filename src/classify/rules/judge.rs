//! Labels and measures of a run, by the rules of its family.

use super::family::PreparedRules;
use super::names::RunValues;
use super::window::RuleWindow;
use crate::classify::{ClassifyError, Family, Label, Sieves};
use crate::record::RunRecord;
use crate::rule::Evidence;
use std::ops::Range;

/// What a family of rules says of a run.
type Judged = Result<(Label, Vec<Option<f64>>), ClassifyError>;

/// The label of the first rule that holds, with the evidence of all, and the measures.
pub(super) fn by_rules(record: &RunRecord, sieves: &Sieves) -> Judged {
    let Some(rules) = sieves.family(&record.scene).rules else {
        return Ok((Label::OTHER, Vec::new()));
    };
    check_columns(rules, record)?;
    let run = RunValues::new(record);
    let (mut label, mut values) = (None, Vec::new());
    for rule in &rules.labels {
        let frames = frames(rule.over.as_ref(), record);
        let found = rule.expression.evaluate(&run, frames);
        if found.holds {
            label.get_or_insert(rule.gives);
        }
        values.extend(numbers(&found));
    }
    values.extend(measures(rules, record));
    Ok((label.unwrap_or(Label::OTHER), values))
}

/// What the sieves say, and the measures of the file.
pub(super) fn with_measures(record: &RunRecord, sieves: &Sieves) -> Judged {
    let (label, mut values) = (Family::of(&record.scene).judge)(record, sieves)?;
    if let Some(rules) = sieves.family(&record.scene).rules {
        check_columns(rules, record)?;
        values.extend(measures(rules, record));
    }
    Ok((label, values))
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
    [value, threshold, found.margin].map(|it| it.is_finite().then_some(it))
}

fn measures(rules: &PreparedRules, record: &RunRecord) -> Vec<Option<f64>> {
    let run = RunValues::new(record);
    let values = rules.measures.iter().map(|rule| {
        let frames = frames(rule.over.as_ref(), record);
        let value = rule.expression.evaluate(&run, frames);
        value.is_finite().then_some(value)
    });
    values.collect()
}

fn frames(over: Option<&RuleWindow>, record: &RunRecord) -> Range<usize> {
    let whole = 0..record.observations.frames();
    over.map_or(whole, |it| it.frames(record))
}

/// Refuses a record without a column that a rule reads.
fn check_columns(rules: &PreparedRules, record: &RunRecord) -> Result<(), ClassifyError> {
    let of_labels = rules
        .labels
        .iter()
        .map(|it| (&it.name, it.expression.columns()));
    let of_measures = rules
        .measures
        .iter()
        .map(|it| (&it.name, it.expression.columns()));
    let run = RunValues::new(record);
    for (rule, columns) in of_labels.chain(of_measures) {
        if let Some(column) = columns.iter().find(|it| !run.has(it)) {
            return Err(ClassifyError::NoColumn {
                rule: rule.clone(),
                column: column.clone(),
            });
        }
    }
    Ok(())
}
