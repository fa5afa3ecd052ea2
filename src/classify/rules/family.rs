//! The family of scenes that rules make: labels, measures, and the rules as they are evaluated.

use super::names::SceneNames;
use super::{LabelRule, MeasureRule, RuleWindow, Rules, condition, entry, judge, number};
use crate::classify::measure::{evidence, measured};
use crate::classify::{Family, Label, Measure};
use crate::color::{self, DISTINCT};
use crate::rule::{Condition, ExpressionError, Number, Unit};
use crate::scene::Scene;
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

/// Codes of the labels that rules give begin here.
const FIRST_CODE: i8 = 20;

impl Label {
    /// No rule of the file holds.
    pub const OTHER: Self = Self::new(13, "other", 0xe6_e2_f7);
}

/// The rules of a family, ready to be evaluated.
pub(in crate::classify) struct PreparedRules {
    base: &'static Family,
    pub(super) labels: Vec<Prepared<Label, Condition>>,
    pub(super) measures: Vec<Prepared<(), Number>>,
}

impl PreparedRules {
    /// Whether they only add measures to those of a family.
    pub(in crate::classify) fn extends(&self, family: &Family) -> bool {
        self.labels.is_empty() && self.base == family
    }
}

/// A rule, and what it gives.
pub(super) struct Prepared<G, E> {
    pub(super) gives: G,
    pub(super) name: String,
    pub(super) expression: E,
    pub(super) over: Option<RuleWindow>,
}

/// The columns of a label's evidence.
pub(super) fn columns_of(rule: &LabelRule) -> [String; 3] {
    let name = rule.name.replace('-', "_");
    ["value", "threshold", "margin"].map(|what| format!("{name}_{what}"))
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
    let labels = rules.labels.iter().enumerate();
    let labels: Vec<Prepared<Label, Condition>> = labels
        .map(|(place, rule)| {
            Ok(Prepared {
                gives: label(place, rule),
                name: rule.name.clone(),
                expression: condition(&rule.when, &names)?,
                over: rule.over.clone(),
            })
        })
        .collect::<Result<_, ExpressionError>>()?;
    let measures: Vec<Prepared<(), Number>> = rules
        .measures
        .iter()
        .map(|rule| {
            Ok(Prepared {
                gives: (),
                name: rule.name.clone(),
                expression: number(&rule.value, &names)?,
                over: rule.over.clone(),
            })
        })
        .collect::<Result<_, ExpressionError>>()?;
    let units = measures.iter().map(|it| it.expression.unit());
    let mut order: Vec<Measure> = rules.labels.iter().flat_map(evidence_of).collect();
    order.extend(rules.measures.iter().zip(units).map(measure));
    let given = labels.iter().map(|it| it.gives);
    let all = [Label::UNSTABLE, Label::OTHER].into_iter().chain(given);
    let all: Vec<Label> = all.collect();
    let prepared = Box::leak(Box::new(PreparedRules {
        base,
        labels,
        measures,
    }));
    Ok(match rules.labels.is_empty() {
        // Sieves label the runs.
        true => Family {
            order: [base.order, &order].concat().leak(),
            judge: judge::with_measures,
            rules: Some(prepared),
            ..*base
        },
        false => Family {
            sieves: &[],
            without_sieve: all.leak(),
            order: order.leak(),
            default_figures: &["phase"],
            check: |_, _| Ok(()),
            judge: judge::by_rules,
            rules: Some(prepared),
            ..*base
        },
    })
}

fn label(place: usize, rule: &LabelRule) -> Label {
    let color = rule.color.as_deref().and_then(entry::color);
    Label {
        code: FIRST_CODE + place as i8,
        name: rule.name.clone().leak(),
        color: color.unwrap_or_else(|| color::rgb(DISTINCT[place % DISTINCT.len()])),
    }
}

/// What a rule leaves beside its label: of the comparison that decides the value, the threshold,
/// and how far they are apart over the larger of the two.
fn evidence_of(rule: &LabelRule) -> [Measure; 3] {
    let [value, threshold, margin] = columns_of(rule).map(|it| &*it.leak());
    let about = |what: &str| -> &'static str { format!("{what} of \"{}\"", rule.name).leak() };
    [
        Measure {
            name: value,
            description: about("what is compared in the rule"),
            ..evidence(about("value"), "")
        },
        Measure {
            name: threshold,
            description: about("what it is compared with in the rule"),
            ..evidence(about("threshold"), "")
        },
        Measure {
            name: margin,
            description: about("distance from the border, over the larger side, in the rule"),
            ..evidence(about("margin"), "").signed()
        },
    ]
}

fn measure((rule, unit): (&MeasureRule, Unit)) -> Measure {
    let quantity = rule
        .quantity
        .clone()
        .unwrap_or_else(|| rule.name.replace('_', " "));
    Measure {
        name: rule.name.clone().leak(),
        description: rule.value.clone().leak(),
        ..measured(quantity.leak(), unit_text(unit))
    }
}

/// A unit as tables and figures write it.
fn unit_text(unit: Unit) -> &'static str {
    match unit.to_string() {
        one if one == "1" => "",
        unit => unit.leak(),
    }
}
