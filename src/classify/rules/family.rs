//! The family of scenes that rules of a file make.

use super::names::SceneNames;
use super::of_family::{LabelOfRule, MeasureOfRule};
use super::{Rules, entry, number};
use crate::classify::measure::{evidence, measured};
use crate::classify::{Family, Label, Measure};
use crate::color::{self, DISTINCT};
use crate::rule::{ExpressionError, Unit};
use crate::scene::{LabelRule, MeasureRule, Scene};
use std::sync::{Mutex, PoisonError};

/// Columns of tables that are no measures.
pub(super) const RESERVED: [&str; 7] = [
    "id",
    "seed",
    "label",
    "code",
    "steady",
    "agreement",
    "seeds",
];

/// Codes of the labels that rules of a file give begin here.
const FIRST_CODE: i8 = 20;

impl Label {
    /// No rule of the file holds.
    pub const OTHER: Self = Self::new(13, "other", 0xe6_e2_f7);
}

/// The columns of a label's evidence.
pub(super) fn columns_of(rule: &LabelRule) -> impl Iterator<Item = String> {
    let name = rule.name.replace('-', "_");
    let since = rule.over.is_some().then_some("since");
    let parts = ["value", "threshold", "margin"].into_iter().chain(since);
    parts.map(move |what| format!("{name}_{what}"))
}

/// A family that rules have made, and of what.
struct KnownFamily {
    rules: Rules,
    base: &'static Family,
    family: &'static Family,
}

/// The family of the runs of a scene that is of the family `base` without these rules. Families
/// stay for as long as the program runs, since labels and measures are used everywhere: each set of
/// rules makes one.
pub(in crate::classify) fn family(
    rules: &Rules,
    base: &'static Family,
    scene: &Scene,
) -> Result<&'static Family, ExpressionError> {
    static KNOWN: Mutex<Vec<KnownFamily>> = Mutex::new(Vec::new());
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(it) = known
        .iter()
        .find(|it| it.base == base && it.rules == *rules)
    {
        return Ok(it.family);
    }
    let family: &'static Family = Box::leak(Box::new(make(rules, base, scene)?));
    known.push(KnownFamily {
        rules: rules.clone(),
        base,
        family,
    });
    Ok(family)
}

fn make(rules: &Rules, base: &'static Family, scene: &Scene) -> Result<Family, ExpressionError> {
    let names = SceneNames::new(scene);
    let measured: Vec<MeasureOfRule> = rules
        .measures
        .iter()
        .map(|rule| Ok(measure(rule, number(&rule.value, &names)?.unit())))
        .collect::<Result<_, ExpressionError>>()?;
    let labels = rules.labels.iter().enumerate();
    let own = labels.map(|(place, rule)| label(place, rule, base));
    let own: Vec<LabelOfRule> = own.collect();
    let family = Family {
        measured: measured.leak(),
        base: Some(base),
        ..*base
    };
    if rules.labels.is_empty() {
        return Ok(family);
    }
    if rules.sieves {
        let is_new = |it: &&LabelOfRule| own.iter().all(|own| own.label.code != it.label.code);
        let of_base: Vec<_> = base.rules.iter().filter(is_new).cloned().collect();
        return Ok(Family {
            rules: [own, of_base].concat().leak(),
            ..family
        });
    }
    Ok(Family {
        rules: own.leak(),
        sieves: &[],
        without_sieve: &[Label::UNSTABLE, Label::OTHER],
        order: &[],
        default_figures: &["phase"],
        ..family
    })
}

/// A rule of a file. One with the name of a rule of the family `base` takes its place.
fn label(place: usize, rule: &LabelRule, base: &'static Family) -> LabelOfRule {
    let replaced = base.rules.iter().find(|it| it.label.name == rule.name);
    let built_in = replaced.map_or_else(
        || Label {
            code: FIRST_CODE + place as i8,
            name: rule.name.clone().leak(),
            color: color::rgb(DISTINCT[place % DISTINCT.len()]),
        },
        |it| it.label,
    );
    let color = rule.color.as_deref().and_then(entry::color);
    LabelOfRule {
        label: Label {
            color: color.unwrap_or(built_in.color),
            ..built_in
        },
        when: rule.when.clone().leak(),
        over: rule.over.clone(),
        evidence: evidence_of(rule).leak(),
    }
}

/// What a rule leaves beside its label: of the comparison that decides the value, the threshold,
/// and how far they are apart over the larger of the two; and since when it holds, if it looks at a
/// part of the run.
fn evidence_of(rule: &LabelRule) -> Vec<Measure> {
    let about = |what: &str| -> &'static str { format!("{what} of \"{}\"", rule.name).leak() };
    let of_time = Measure {
        description: "beginning of the part of the run in which the rule holds",
        ..evidence(about("beginning"), "s")
    };
    let measures = [
        Measure {
            description: "what is compared in the rule",
            ..evidence(about("value"), "")
        },
        Measure {
            description: "what it is compared with in the rule",
            ..evidence(about("threshold"), "")
        },
        Measure {
            description: "distance from the border, over the larger side, in the rule",
            ..evidence(about("margin"), "").signed()
        },
        of_time,
    ];
    let named = columns_of(rule).zip(measures);
    let named = named.map(|(name, measure)| Measure {
        name: name.leak(),
        ..measure
    });
    named.collect()
}

fn measure(rule: &MeasureRule, unit: Unit) -> MeasureOfRule {
    let quantity = rule
        .quantity
        .clone()
        .unwrap_or_else(|| rule.name.replace('_', " "));
    MeasureOfRule {
        measure: Measure {
            name: rule.name.clone().leak(),
            description: rule.value.clone().leak(),
            ..measured(quantity.leak(), unit_text(unit))
        },
        over: rule.over.clone(),
    }
}

/// A unit as tables and figures write it.
fn unit_text(unit: Unit) -> &'static str {
    match unit.to_string() {
        one if one == "1" => "",
        unit => unit.leak(),
    }
}
