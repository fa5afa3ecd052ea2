//! What the runs of a study say: cost and error of every setting, and what follows.

use super::cases::{self, CaseRow, CaseSetting};
use super::finding::Finding;
use super::motion::MotionError;
use super::order::{Order, fitted_order};
use super::{AccuracyStudy, Subject, Tolerance};
use crate::classify::Label;
use crate::study::comparison::{
    Comparison, Cost, Majority, Measurement, RunRow, States, majorities,
};
use serde::Serialize;
use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

/// A setting, what it costs, and how wrong it is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Name, as in tables and sentences.
    pub name: String,
    /// Name of the line in the figure.
    pub method: String,
    /// The key along the line and its value.
    pub rung: Option<(String, f64)>,
    /// What was changed besides what the name says, and why.
    pub note: Option<String>,
    /// Runs that there are.
    pub runs: usize,
    /// How many of them a guard ended.
    pub unstable: usize,
    /// Runs that there are not.
    pub missing: usize,
    /// What a run costs on average.
    pub cost: Cost,
    /// How wrong it is.
    pub errors: Errors,
}

/// How wrong a setting is.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Errors {
    /// In labels and order parameters, over seeds.
    States(States),
    /// In the motion at given times.
    Motion(MotionError),
    /// In the known numbers of a case, each on the scale of its tolerance.
    Case(BTreeMap<String, f64>),
}

/// The order of a method.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(into = "OrderRow")]
pub struct MethodOrder {
    /// Name of the line.
    pub method: String,
    /// The key along it.
    pub key: String,
    /// With which power of the key's value errors grow, or fall.
    pub order: Order,
    /// Whether they fall with the key's value, as with a number of steps.
    pub falls: bool,
    /// Largest misfit of the logarithm of an error.
    pub misfit: f64,
}

/// The order of a method, as `--json` prints it.
#[derive(Serialize)]
struct OrderRow {
    method: String,
    key: String,
    /// Negative if errors fall; `None` if only a bound is known.
    order: Option<f64>,
    /// The bound, where it is all that is known.
    bound: Option<f64>,
    misfit: f64,
}

impl From<MethodOrder> for OrderRow {
    fn from(of: MethodOrder) -> Self {
        let sign = if of.falls { -1.0 } else { 1.0 };
        let (order, bound) = match of.order {
            Order::Power(power) => (Some(sign * power), None),
            Order::Below(bound) | Order::Above(bound) => (None, Some(sign * bound)),
        };
        Self {
            method: of.method,
            key: of.key,
            order,
            bound,
            misfit: of.misfit,
        }
    }
}

impl MethodOrder {
    /// Whether the errors follow a power of the key's value: none is off by more than a factor of
    /// about 1.6.
    pub fn is_clear(&self) -> bool {
        self.misfit <= 0.5
    }
}

/// What a study says.
#[derive(Clone, Debug, Serialize)]
pub struct Evaluation {
    /// The settings.
    pub outcomes: Vec<Outcome>,
    /// Place of the setting that others are compared with; none for a case.
    pub reference: Option<usize>,
    /// Times at which motions are compared (s).
    pub times: Vec<f64>,
    /// Place of the time whose errors count: the last before the motion is chaotic.
    pub counted_time: Option<usize>,
    /// Time (s) at which no setting is near the reference any more: the motion is chaotic.
    pub chaotic_from: Option<f64>,
    /// Orders of the methods with errors of a motion or a case.
    pub orders: Vec<MethodOrder>,
    /// What more seeds buy: how often their majority is wrong, in the reference.
    pub majorities: Vec<Majority>,
    /// How large an error is allowed.
    pub tolerance: Tolerance,
    /// The sentence.
    pub finding: Finding,
}

/// A motion is chaotic where even the nearest setting is farther from the reference than this.
const CHAOTIC: f64 = 0.1;

impl Outcome {
    /// The error that figures show: the chance that labels disagree, or the error of the motion at
    /// the time of that place, or the largest error of a case.
    pub fn error(&self, time: Option<usize>) -> Option<f64> {
        match &self.errors {
            Errors::States(states) => Some(states.disagreement.as_ref()?.chance.value),
            Errors::Motion(error) => *error.times.get(time?)?,
            Errors::Case(errors) if errors.is_empty() => None,
            Errors::Case(errors) => Some(errors.values().copied().fold(0.0, f64::max)),
        }
    }

    /// Whether the error is within a tolerance for certain: the upper end of its interval is.
    pub fn is_within(&self, tolerance: &Tolerance, time: Option<usize>) -> bool {
        if self.missing > 0 {
            return false;
        }
        match &self.errors {
            Errors::States(states) => states.are_within(tolerance.labels, tolerance.shift),
            Errors::Motion(_) | Errors::Case(_) => {
                let error = self.error(time);
                self.unstable == 0 && error.is_some_and(|error| error <= tolerance.error)
            }
        }
    }
}

impl AccuracyStudy {
    /// What the rows of a comparison's jobs say.
    pub fn evaluate(&self, comparison: &Comparison, rows: &[Option<RunRow>]) -> Evaluation {
        let places = 0..comparison.settings.len();
        let outcomes = places.map(|place| of_setting(comparison, place, rows));
        let outcomes = outcomes.collect();
        let (times, majorities) = match &comparison.measurement {
            Measurement::Motion(times) => (times.clone(), Vec::new()),
            _ => {
                let reference = comparison.sample(comparison.reference, rows);
                (Vec::new(), majorities(&reference))
            }
        };
        self.conclude(outcomes, Some(comparison.reference), times, majorities)
    }

    /// Simulates the settings of a case and says what follows; none if it was stopped.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn run_cases(
        &self,
        workers: usize,
        stop: &AtomicBool,
    ) -> Result<Option<Evaluation>, rayon::ThreadPoolBuildError> {
        let Subject::Case(settings) = &self.subject else {
            return Ok(None);
        };
        let rows = cases::run(settings, workers, stop)?;
        let Some(rows) = rows.into_iter().collect::<Option<Vec<_>>>() else {
            return Ok(None);
        };
        let outcomes = settings.iter().zip(&rows).map(|(it, row)| of_case(it, row));
        Ok(Some(self.conclude(
            outcomes.collect(),
            None,
            Vec::new(),
            Vec::new(),
        )))
    }

    fn conclude(
        &self,
        outcomes: Vec<Outcome>,
        reference: Option<usize>,
        times: Vec<f64>,
        majorities: Vec<Majority>,
    ) -> Evaluation {
        let nearest = |time: usize| {
            let others = outcomes
                .iter()
                .enumerate()
                .filter(|(at, _)| Some(*at) != reference);
            let errors = others.filter_map(|(_, it)| it.error(Some(time)));
            errors.fold(f64::INFINITY, f64::min)
        };
        let chaotic = (0..times.len()).find(|time| {
            let nearest = nearest(*time);
            nearest.is_finite() && nearest > CHAOTIC
        });
        let counted_time = match chaotic {
            Some(first) => first.checked_sub(1),
            None => times.len().checked_sub(1),
        };
        let mut evaluation = Evaluation {
            orders: orders(&outcomes, reference, counted_time),
            outcomes,
            reference,
            chaotic_from: chaotic.map(|time| times[time]),
            times,
            counted_time,
            majorities,
            tolerance: self.tolerance,
            finding: Finding::default(),
        };
        evaluation.finding = Finding::of(&evaluation);
        evaluation
    }
}

fn of_setting(comparison: &Comparison, place: usize, rows: &[Option<RunRow>]) -> Outcome {
    let setting = &comparison.settings[place];
    let sample = comparison.sample(place, rows);
    let errors = match &comparison.measurement {
        Measurement::Motion(_) => {
            let reference = comparison.sample(comparison.reference, rows);
            let quantities = comparison.quantities();
            Errors::Motion(MotionError::of(&sample, &reference, &quantities))
        }
        _ => Errors::States(States::of(comparison, place, rows)),
    };
    let is_unstable = |run: &&RunRow| run.label == Label::UNSTABLE;
    Outcome {
        name: setting.name.clone(),
        method: setting.method.clone(),
        rung: setting.rung.clone(),
        note: setting.note.clone(),
        runs: sample.runs().count(),
        unstable: sample.runs().filter(is_unstable).count(),
        missing: sample.missing(),
        cost: sample.cost(),
        errors,
    }
}

fn of_case(setting: &CaseSetting, row: &CaseRow) -> Outcome {
    let checks = row.checks.as_ref().map(Vec::as_slice).unwrap_or_default();
    Outcome {
        name: setting.name.clone(),
        method: setting.method.clone(),
        rung: setting.rung.clone(),
        note: row.checks.as_ref().err().cloned(),
        runs: usize::from(row.checks.is_ok()),
        unstable: 0,
        missing: usize::from(row.checks.is_err()),
        cost: Cost {
            cpu_seconds: row.cpu_seconds,
            sphere_steps: row.steps as f64,
            force_evaluations: row.force_evaluations as f64,
        },
        errors: Errors::Case(
            checks
                .iter()
                .map(|check| (check.quantity.clone(), check.error))
                .collect(),
        ),
    }
}

/// The orders of methods that have at least two rungs, where errors are those of numbers.
fn orders(outcomes: &[Outcome], reference: Option<usize>, time: Option<usize>) -> Vec<MethodOrder> {
    let mut lines: BTreeMap<(&str, &str), Vec<(f64, f64)>> = BTreeMap::new();
    for (place, outcome) in outcomes.iter().enumerate() {
        let is_number = !matches!(outcome.errors, Errors::States(_));
        let (Some((key, value)), true) = (&outcome.rung, is_number) else {
            continue;
        };
        if let Some(error) = outcome.error(time).filter(|_| Some(place) != reference) {
            let line = lines.entry((&outcome.method, key)).or_default();
            line.push((*value, error));
        }
    }
    let finest = reference.and_then(|place| {
        let outcome = outcomes.get(place)?;
        Some((&outcome.method, outcome.rung.as_ref()?))
    });
    let order = |((method, key), mut points): ((&str, &str), Vec<(f64, f64)>)| {
        let reference = finest
            .filter(|(own, (own_key, _))| *own == method && own_key == key)
            .map(|(_, (_, value))| *value);
        points.sort_by(|one, other| one.0.total_cmp(&other.0));
        // Errors fall with a time step, and with the inverse of a number of steps.
        let falls = points.first()?.1 > points.last()?.1;
        let step = |value: f64| if falls { 1.0 / value } else { value };
        for point in &mut points {
            point.0 = step(point.0);
        }
        let (order, misfit) = fitted_order(&points, reference.map(step))?;
        Some(MethodOrder {
            method: method.to_owned(),
            key: key.to_owned(),
            order,
            falls,
            misfit,
        })
    };
    lines.into_iter().filter_map(order).collect()
}
