//! `phase verify`: runs the verification cases and compares them with their numbers.

use crate::cli::console::Console;
use crate::cli::exit::{Exit, Failure};
use crate::cli::figures;
use crate::cli::folders::ANOTHER_FOLDER;
use crate::cli::options::Workers;
use crate::cli::{folders, format};
use phase::plot::verification::CaseError;
use phase::plot::{self, StudyResult};
use phase::record::Program;
use phase::scene::Integrator;
use phase::store;
use phase::sweep::work;
use phase::verify::{self, Case, CaseOutcome, VerifyError};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Run the verification cases: set-ups whose outcome is known in closed form or from a reference.
///
/// Runs every case with every integrator that claims it, and prints the expected and the measured
/// value, the error over the tolerance and the cost. Fails if any case does.
#[derive(clap::Args)]
#[command(after_help = "\
Example: all impacts, as a table and a figure
  phase verify --family impact --out results/verification")]
pub(crate) struct Arguments {
    /// Only these families, such as `impact`; may be given several times.
    #[arg(short, long, value_name = "NAME", value_delimiter = ',')]
    family: Vec<String>,
    /// Only cases whose name contains this.
    #[arg(short, long, value_name = "TEXT")]
    case: Option<String>,
    /// List the cases with their sources; run nothing.
    #[arg(short, long)]
    list: bool,
    /// Folder for the table (CSV) and the figure (SVG, PNG) [default: print only].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    workers: Workers,
}

/// A quantity of a case with one integrator.
#[derive(Serialize)]
struct Row {
    family: &'static str,
    case: &'static str,
    integrator: &'static str,
    quantity: String,
    /// Expected and measured value (SI units).
    expected: f64,
    measured: f64,
    /// Error, relative or absolute as the case says, and how large it may be.
    error: f64,
    tolerance: f64,
    passed: bool,
    /// Steps and processor time (s) of the case.
    steps: u64,
    cpu_seconds: f64,
    source: &'static str,
}

pub(crate) fn main(arguments: &Arguments, console: &Console) -> Result<Exit, Failure> {
    let cases = chosen(arguments)?;
    if arguments.list {
        return list(&cases, console);
    }
    if let Some(folder) = &arguments.out {
        let figure = folders::files_of_figures(["verification"]);
        let names = figure.chain([PathBuf::from("verification.csv")]);
        folders::refuse_foreign(folder, names, ANOTHER_FOLDER)?;
        folders::make(folder)?;
    }
    let runs: Vec<(&Case, Integrator)> = cases
        .iter()
        .flat_map(|case| case.integrators.iter().map(move |&it| (*case, it)))
        .collect();
    let workers = arguments.workers.count();
    let outcomes = work::map(workers, &runs, |(case, integrator)| {
        verify::run(case, *integrator)
    });
    let outcomes = outcomes?;
    let (mut rows, mut errors, mut failed) = (Vec::new(), Vec::new(), 0);
    for ((case, integrator), outcome) in runs.iter().zip(&outcomes) {
        console.result(line(case, *integrator, outcome));
        match outcome {
            Ok(outcome) => {
                failed += usize::from(!outcome.passed());
                errors.push(error_of(case, *integrator, outcome));
                rows.extend(rows_of(case, *integrator, outcome));
            }
            Err(_) => failed += 1,
        }
    }
    console.result(format_args!(
        "{}: {} passed, {failed} failed",
        format::count(runs.len(), "run"),
        runs.len() - failed
    ));
    if let Some(folder) = &arguments.out {
        write(&rows, &errors, folder, console)?;
    }
    console.answer_with_files(&Answer {
        runs: runs.len(),
        failed,
        checks: rows,
    });
    Ok(if failed == 0 {
        Exit::Done
    } else {
        Exit::Failed
    })
}

/// The `--json` result.
#[derive(Serialize)]
struct Answer {
    runs: usize,
    failed: usize,
    checks: Vec<Row>,
}

/// The `--list --json` result.
#[derive(Serialize)]
struct List<'a> {
    cases: Vec<Listed<'a>>,
}

/// A case that was not run.
#[derive(Serialize)]
struct Listed<'a> {
    family: &'static str,
    case: &'a str,
    integrators: Vec<&'static str>,
    source: &'a str,
}

fn chosen(arguments: &Arguments) -> Result<Vec<&'static Case>, Failure> {
    let mut families: Vec<&str> = verify::cases().iter().map(|it| it.setup.name()).collect();
    families.dedup();
    let is_known = |name: &&String| families.contains(&name.as_str());
    if let Some(name) = arguments.family.iter().find(|name| !is_known(name)) {
        return Err(Failure::refused(format_args!(
            "there is no family `{name}`; the families are {}",
            families.join(", ")
        )));
    }
    let is_chosen = |case: &&Case| {
        let family = arguments.family.is_empty()
            || arguments
                .family
                .iter()
                .any(|name| name == case.setup.name());
        let text = arguments.case.as_deref().unwrap_or_default();
        family && case.name.contains(text)
    };
    let cases: Vec<&Case> = verify::cases().iter().filter(is_chosen).collect();
    if cases.is_empty() {
        return Err(Failure::refused(
            "no case has such a name; `phase verify --list` lists all cases",
        ));
    }
    Ok(cases)
}

fn list(cases: &[&Case], console: &Console) -> Result<Exit, Failure> {
    for case in cases {
        console.result(format_args!(
            "{:<18} {}\n{:<18} {}",
            case.setup.name(),
            case.name,
            "",
            case.source
        ));
    }
    let listed = cases.iter().map(|case| Listed {
        family: case.setup.name(),
        case: &case.name,
        integrators: case.integrators.iter().map(|it| it.name()).collect(),
        source: &case.source,
    });
    console.answer(&List {
        cases: listed.collect(),
    });
    Ok(Exit::Done)
}

/// A case with an integrator in one line, and its quantities in further ones.
fn line(case: &Case, integrator: Integrator, outcome: &Result<CaseOutcome, VerifyError>) -> String {
    let head = format!("{}: {}", case.setup.name(), case.name);
    let with_integrator = format!("{head} ({})", integrator.name());
    let outcome = match outcome {
        Ok(outcome) => outcome,
        Err(error) => return format!("FAILED  {with_integrator}\n        {error}"),
    };
    let verdict = if outcome.passed() { "ok" } else { "FAILED" };
    // Spots and closed forms know no integrator.
    let what = match outcome.steps {
        0 => head,
        steps => format!("{with_integrator}, {steps} steps"),
    };
    let time = format::duration(outcome.cpu_seconds);
    let mut text = format!("{verdict:<7} {what}, {time}");
    for check in &outcome.checks {
        text += &format!(
            "\n        {:<22} expected {:>16.9e}, got {:>16.9e}, error {:.1e} of {:.0e}",
            check.quantity, check.expected, check.measured, check.error, check.limit
        );
    }
    text
}

fn error_of(case: &Case, integrator: Integrator, outcome: &CaseOutcome) -> CaseError {
    let ratios = outcome.checks.iter().map(|check| check.error / check.limit);
    CaseError {
        name: format!("{}: {}", case.setup.name(), case.name),
        integrator,
        ratio: ratios.fold(0.0, f64::max),
    }
}

fn rows_of(
    case: &'static Case,
    integrator: Integrator,
    outcome: &CaseOutcome,
) -> impl Iterator<Item = Row> {
    outcome.checks.iter().map(move |check| Row {
        family: case.setup.name(),
        case: &case.name,
        integrator: integrator.name(),
        quantity: check.quantity.clone(),
        expected: check.expected,
        measured: check.measured,
        error: check.error,
        tolerance: check.limit,
        passed: check.passed(),
        steps: outcome.steps,
        cpu_seconds: outcome.cpu_seconds,
        source: &case.source,
    })
}

fn write(
    rows: &[Row],
    errors: &[CaseError],
    folder: &Path,
    console: &Console,
) -> Result<(), Failure> {
    let place = |end: &str| folder.join(format!("verification.{end}"));
    store::write_rows(rows, &place("csv"))?;
    console.file(&place("csv"));
    let study = StudyResult::Verification(errors);
    let figure = plot::draw("verification", (study, &Program::current()))?;
    figures::write(&figure, place, console)
}
