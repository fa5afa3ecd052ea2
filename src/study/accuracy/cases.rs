//! Settings of a verification case, whose numbers are known.

use super::choices::Choice;
use crate::document::{Problem, suggest};
use crate::scene::{Change, Integrator};
use crate::study::comparison::AS_IT_IS;
use crate::sweep::work;
use crate::verify::{self, Case, Check};
use serde::Deserialize;
use serde_json::Value;
use std::sync::atomic::{AtomicBool, Ordering};

/// A setting of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseSetting {
    /// Name, as in tables and sentences.
    pub name: String,
    /// Name of the line in the figure.
    pub method: String,
    /// The key along the line and its value.
    pub rung: Option<(String, f64)>,
    /// The case with the change.
    pub case: Case,
    /// The integrator.
    pub integrator: Integrator,
}

/// What became of a setting of a case.
#[derive(Clone, Debug, PartialEq)]
pub struct CaseRow {
    /// The numbers and their errors; or why there are none.
    pub checks: Result<Vec<Check>, String>,
    /// Steps.
    pub steps: u64,
    /// Evaluations of the force on a sphere, those of sub-steps too.
    pub force_evaluations: u64,
    /// Processor time (s).
    pub cpu_seconds: f64,
}

impl CaseRow {
    /// The largest error of its numbers.
    pub fn error(&self) -> Option<f64> {
        let checks = self.checks.as_ref().ok()?;
        Some(checks.iter().map(|check| check.error).fold(0.0, f64::max))
    }
}

/// The key that chooses the integrator.
const INTEGRATOR: &str = "integrator";

/// The case as it is, and with all choices.
pub(super) fn settings(
    name: &str,
    common: &Change,
    choices: &[Choice],
) -> Result<Vec<CaseSetting>, Vec<Problem>> {
    let Some(row) = verify::row(name) else {
        let names = verify::cases().iter().map(|case| case.name.as_str());
        let help = match suggest(name, names) {
            Some(near) => format!("did you mean \"{near}\"? `phase verify --list` names all"),
            None => "`phase verify --list` names all".to_owned(),
        };
        let message = format!("there is no verification case \"{name}\"");
        return Err(vec![Problem::new("case", message).help(help)]);
    };
    let mut problems = Vec::new();
    let as_it_is = Choice {
        path: "base".to_owned(),
        name: AS_IT_IS.to_owned(),
        method: AS_IT_IS.to_owned(),
        rung: None,
        change: Change::default(),
    };
    let all = std::iter::once(&as_it_is).chain(choices);
    let settings = all.filter_map(|choice| {
        let setting = setting(&row, common, choice);
        setting.map_err(|problem| problems.push(problem)).ok()
    });
    let settings: Vec<_> = settings.collect();
    match problems.is_empty() {
        true => Ok(settings),
        false => Err(problems),
    }
}

fn setting(row: &Value, common: &Change, choice: &Choice) -> Result<CaseSetting, Problem> {
    let refuse = |message: String| {
        let help = "a case has the keys of its table in src/verify, such as `setup.dt`, and \
                    `integrator`";
        Problem::new(choice.path.clone(), message).help(help)
    };
    if let Some(scale) = choice.change.scale.first() {
        return Err(refuse(format!("a case has no axis \"{}\"", scale.0)));
    }
    let all = common.then(&choice.change);
    let mut change = all.clone();
    change.set.retain(|(key, _)| key != INTEGRATOR);
    if let Some((key, _)) = change
        .set
        .iter()
        .find(|(key, _)| !key.starts_with("setup."))
    {
        return Err(refuse(format!("`{key}` is no key of the set-up of a case")));
    }
    let mut tree = row.clone();
    change
        .apply(&mut tree)
        .map_err(|path| refuse(format!("`{path}` is not in a table")))?;
    let case = Case::deserialize(tree)
        .map_err(|error| refuse(format!("with {}: {error}", choice.name)))?;
    let integrator = match all.value(INTEGRATOR) {
        None => case.integrators.first().copied().unwrap_or_default(),
        Some(word) => {
            Integrator::deserialize(word).map_err(|_| refuse(format!("{word} is no integrator")))?
        }
    };
    Ok(CaseSetting {
        name: choice.name.clone(),
        method: choice.method.clone(),
        rung: choice.rung.clone(),
        case,
        integrator,
    })
}

/// Simulates the settings with that many workers; none of one that was not begun before the stop.
///
/// # Errors
/// If the system gives no threads.
pub(super) fn run(
    settings: &[CaseSetting],
    workers: usize,
    stop: &AtomicBool,
) -> Result<Vec<Option<CaseRow>>, rayon::ThreadPoolBuildError> {
    work::map(workers, settings, |setting| {
        let row = (!stop.load(Ordering::Relaxed)).then(|| row_of(setting, stop));
        row.filter(|_| !stop.load(Ordering::Relaxed))
    })
}

fn row_of(setting: &CaseSetting, stop: &AtomicBool) -> CaseRow {
    match verify::run_until(&setting.case, setting.integrator, stop) {
        Ok(outcome) => CaseRow {
            checks: Ok(outcome.checks),
            steps: outcome.steps,
            force_evaluations: outcome.moves,
            cpu_seconds: outcome.cpu_seconds,
        },
        Err(error) => CaseRow {
            checks: Err(error.to_string()),
            steps: 0,
            force_evaluations: 0,
            cpu_seconds: 0.0,
        },
    }
}
