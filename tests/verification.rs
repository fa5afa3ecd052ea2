//! Every case of the verification tables, with every integrator that claims it.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on should panic")]

use phase::scene::Integrator;
use phase::verify::{self, Case};
use std::fmt::Write;

fn report(case: &Case, integrator: Integrator) -> Option<String> {
    let mut lines = format!("{} ({integrator:?})", case.name);
    match verify::run(case, integrator) {
        Ok(outcome) if outcome.passed() => return None,
        Ok(outcome) => {
            for check in outcome.checks {
                let verdict = if check.passed() { "ok" } else { "FAILED" };
                write!(
                    lines,
                    "\n    {verdict} {}: measured {:.10e}, expected {:.10e}, error {:.2e} of {:.0e}",
                    check.quantity, check.measured, check.expected, check.error, check.limit
                )
                .unwrap();
            }
        }
        Err(error) => write!(lines, "\n    {error}").unwrap(),
    }
    Some(lines)
}

#[test]
fn every_case_meets_its_numbers() {
    let runs = verify::cases()
        .iter()
        .flat_map(|case| case.integrators.iter().map(move |&it| (case, it)));
    let failures: Vec<String> = runs
        .filter_map(|(case, integrator)| report(case, integrator))
        .collect();
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}
