//! Labels and measures that a file states itself, as rules over the columns of a run.
//!
//! A file with labels of its own is labelled by these alone, unless it says that the sieves label
//! the other runs; measures are added to those of the sieves. Both make a [`Family`] of their own.
//! Some labels that the program brings are rules, too.

mod entry;
mod family;
mod judge;
mod names;
mod of_family;
mod stored;
mod window;

pub(super) use family::family;
pub(super) use judge::judge;
pub(super) use of_family::{LabelOfRule, MARGIN, MeasureOfRule, rule};
pub use stored::StoredRule;

use super::{FAMILIES, Family, Label, Sieves};
use crate::document::Problem;
use crate::observe::Observations;
use crate::rule::{Condition, Expression, ExpressionError, Number};
use crate::scene::{FurtherColumn, LabelRule, MeasureRule, Scene, UsualChoice, UsualColumns};
use names::SceneNames;
use serde::{Deserialize, Serialize};

/// The rules of a file, which label and measure its runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Rules {
    /// The labels: the first whose condition holds is the run's.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<LabelRule>,
    /// What is measured besides.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub measures: Vec<MeasureRule>,
    /// Whether the sieves of the scene label the runs of which no rule holds.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub sieves: bool,
}

/// Most labels, and most measures.
const MOST: usize = 40;

impl Rules {
    /// The rules of a scene's own file.
    pub fn of(scene: &Scene) -> Self {
        Self {
            labels: scene.labels.clone(),
            measures: scene.measures.clone(),
            sieves: false,
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.labels.is_empty() && self.measures.is_empty()
    }

    /// All that is wrong with them for a scene, by the keys of a sweep file. Its variants, if there
    /// are any, are what is run: they must have the columns that rules read.
    pub(crate) fn problems(&self, scene: &Scene, variants: &[&Scene]) -> Vec<Problem> {
        let runs = match variants {
            [] => &[scene],
            variants => variants,
        };
        let mut problems = Vec::new();
        for (key, number) in [
            ("label", self.labels.len()),
            ("measure", self.measures.len()),
        ] {
            if number > MOST {
                let message = format!("{number} are too many");
                let help = format!("state at most {MOST}");
                problems.push(Problem::new(format!("{key}[{MOST}]"), message).help(help));
                return problems;
            }
        }
        for (place, rule) in self.labels.iter().enumerate() {
            let path = format!("label[{place}]");
            problems.extend(self.problem_of_label(place, &path, scene));
            problems.extend(rule.over.as_ref().and_then(|it| {
                let path = format!("{path}.over");
                it.check(&path, scene).err()
            }));
            if rule
                .color
                .as_ref()
                .is_some_and(|it| entry::color(it).is_none())
            {
                let problem = Problem::new(format!("{path}.color"), "this is no colour");
                problems.push(problem.help("write it as `\"#b03a2e\"`: red, green and blue"));
            }
            let check = |run: &&Scene| condition(&rule.when, &SceneNames::strict(run)).map(drop);
            let checked = runs.iter().try_for_each(check);
            problems.extend(checked.err().map(|it| pointed(&format!("{path}.when"), it)));
        }
        for (place, rule) in self.measures.iter().enumerate() {
            let path = format!("measure[{place}]");
            problems.extend(self.problem_of_measure(place, &path, scene));
            problems.extend(rule.over.as_ref().and_then(|it| {
                let path = format!("{path}.over");
                it.check(&path, scene)
                    .and_then(|()| it.check_is_one(&path))
                    .err()
            }));
            let check = |run: &&Scene| number(&rule.value, &SceneNames::strict(run)).map(drop);
            let checked = runs.iter().try_for_each(check);
            let path = format!("{path}.value");
            problems.extend(checked.err().map(|it| pointed(&path, it)));
        }
        problems
    }

    /// Asks for the columns that they read, so that these need no other entry.
    pub(crate) fn ask_for_columns(&self, scene: &mut Scene) {
        let read = self.columns(scene);
        let further = read.iter().filter_map(|name| FurtherColumn::of_name(name));
        let further: Vec<FurtherColumn> = further.filter(|it| !it.is_usual_in(scene)).collect();
        for column in further {
            scene.output.ask_for(column);
        }
        if let UsualColumns::Named(names) = &mut scene.output.usual {
            let usual = read.into_iter().filter(|name| Observations::is_usual(name));
            names.extend(usual);
            names.sort_unstable();
            names.dedup();
        }
    }

    /// Decides which usual columns are needed, of a scene that has no other rules.
    pub(crate) fn choose_columns(&self, scene: &mut Scene) {
        if scene.output.usual != UsualColumns::Word(UsualChoice::Needed) {
            return;
        }
        let sieves = Sieves {
            rules: self.clone(),
            ..Sieves::default()
        };
        let family = sieves.family(scene);
        if family.needs_sieves(scene) && !Family::of(scene).sieves.is_empty() {
            return;
        }
        let of_steady = ["kinetic", "rotational", "rotation"].map(str::to_owned);
        let of_steady = scene.steady.is_some().then_some(of_steady);
        let names = of_steady.into_iter().flatten().collect();
        scene.output.usual = UsualColumns::Named(names);
        self.ask_for_columns(scene);
    }

    /// The columns that they read.
    fn columns(&self, scene: &Scene) -> Vec<String> {
        let names = SceneNames::new(scene);
        let conditions = self.labels.iter().map(|rule| &rule.when);
        let conditions = conditions.filter_map(|it| condition(it, &names).ok());
        let numbers = self.measures.iter().map(|rule| &rule.value);
        let numbers = numbers.filter_map(|it| number(it, &names).ok());
        let read = conditions.flat_map(|it| it.columns().to_vec());
        read.chain(numbers.flat_map(|it| it.columns().to_vec()))
            .collect()
    }

    /// What is wrong with the name of a label.
    fn problem_of_label(&self, place: usize, path: &str, scene: &Scene) -> Option<Problem> {
        let (name, path) = (&self.labels[place].name, format!("{path}.name"));
        if let Err(problem) = entry::check_name(&path, name, '-') {
            return Some(problem);
        }
        let of_rules = Family::of(scene).rules;
        let replaces = self.sieves && of_rules.iter().any(|it| it.label.name == name);
        let is_built_in = FAMILIES.iter().any(|it| it.label(name).is_some());
        if !replaces && (is_built_in || name == Label::OTHER.name) {
            let message = format!("`{name}` is a label of the program");
            return Some(Problem::new(path, message).help("use another name"));
        }
        if self.labels[..place].iter().any(|it| it.name == *name) {
            let message = format!("another label has the name `{name}` already");
            return Some(Problem::new(path, message).help("join the conditions with `or`"));
        }
        let is_replaced =
            |it: &&LabelOfRule| self.labels.iter().any(|own| own.name == it.label.name);
        let kept = of_rules.iter().filter(|it| self.sieves && !is_replaced(it));
        let of_base = kept.flat_map(|it| it.evidence);
        let of_sieves = Family::of(scene)
            .measures_of_sieves()
            .filter(|_| self.sieves);
        let mut taken = of_base.chain(of_sieves).map(|measure| measure.name);
        let mut columns = family::columns_of(&self.labels[place]);
        let column = columns.find(|column| taken.any(|it| it == column))?;
        let message = format!("the table of labels has a column `{column}` already");
        Some(Problem::new(path, message).help("use another name"))
    }

    /// What is wrong with the name of a measure.
    fn problem_of_measure(&self, place: usize, path: &str, scene: &Scene) -> Option<Problem> {
        let (name, path) = (&self.measures[place].name, format!("{path}.name"));
        if let Err(problem) = entry::check_name(&path, name, '_') {
            return Some(problem);
        }
        let built_in = Family::of(scene).measures().map(|it| it.name.to_owned());
        let of_labels = self.labels.iter().flat_map(family::columns_of);
        let mut taken = built_in
            .chain(of_labels)
            .chain(family::RESERVED.map(str::to_owned));
        let is_twice = self.measures[..place].iter().any(|it| it.name == *name);
        (is_twice || taken.any(|it| it == *name)).then(|| {
            let message = format!("the table of labels has a column `{name}` already");
            Problem::new(path, message).help("use another name")
        })
    }
}

/// An expression as a condition on runs that have these names.
fn condition(text: &str, names: &SceneNames<'_>) -> Result<Condition, ExpressionError> {
    Expression::parse(text)?.condition(names)
}

/// An expression as a number of runs that have these names.
fn number(text: &str, names: &SceneNames<'_>) -> Result<Number, ExpressionError> {
    Expression::parse(text)?.number(names)
}

/// The problem of an expression in a file.
fn pointed(path: &str, error: ExpressionError) -> Problem {
    Problem::new(path, error.message)
        .help(error.help)
        .part(error.span)
}
