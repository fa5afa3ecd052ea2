//! Every case of the verification tables, with the integrators that claim it.

use crate::support::Workplace;
use phase::scene::Integrator;
use phase::verify::{self, Case, CaseTolerance};
use rayon::prelude::*;
use std::collections::BTreeSet;
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
                    "\n    {verdict} {}: measured {:.10e}, expected {:.10e}, error {:.2e} of \
                     {:.0e}",
                    check.quantity, check.measured, check.expected, check.error, check.limit
                )
                .unwrap();
            }
        }
        Err(error) => write!(lines, "\n    {error}").unwrap(),
    }
    Some(lines)
}

/// Runs every case with that many of its integrators, and fails with the reports of what is off.
fn verify_all(integrators: usize) {
    let runs = verify::cases().iter().flat_map(|case| {
        let some = case.integrators.iter().take(integrators);
        some.map(move |&integrator| (case, integrator))
    });
    let runs: Vec<_> = runs.collect();
    let failures: Vec<String> = runs
        .into_par_iter()
        .filter_map(|(case, integrator)| report(case, integrator))
        .collect();
    assert!(failures.is_empty(), "\n{}", failures.join("\n"));
}

#[test]
fn every_case_meets_its_numbers() {
    verify_all(1);
}

#[test]
#[ignore = "takes a minute"]
fn every_case_meets_its_numbers_with_every_integrator() {
    verify_all(usize::MAX);
}

#[test]
fn the_table_is_sound() {
    let cases = verify::cases();
    let names: BTreeSet<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names.len(), cases.len(), "two cases share a name");
    for case in cases {
        let name = &case.name;
        assert!(!case.source.is_empty(), "{name} has no source");
        assert!(!case.expect.is_empty(), "{name} expects nothing");
        assert!(!case.integrators.is_empty(), "{name} is never run");
        assert!(case.tolerance.limit() <= 0.3, "{name} tolerates anything");
        // A fraction of zero would allow nothing.
        let relative = matches!(case.tolerance, CaseTolerance::Relative(_));
        let zero = case.expect.values().any(|&value| value == 0.0);
        assert!(!(relative && zero), "{name} needs an absolute tolerance");
    }
}

fn throw(expect: &str) -> Case {
    let row = format!(
        "[[case]]\n name = \"throw\"\n setup = {{ family = \"flight\", radius = 0.01, density = \
         1e3, velocity = [2.0, 0.0, 0.0], dt = 1e-3, duration = 1.0 }}\n expect = {{ {expect} }}\n \
         tolerance = {{ relative = 1e-3 }}\n source = \"closed form\""
    );
    verify::parse(&row).unwrap().remove(0)
}

#[test]
fn a_case_passes_within_its_tolerance_and_fails_beyond() {
    for (expect, passes) in [("x = 2.0019", true), ("x = 2.0021", false)] {
        let outcome = verify::run(&throw(expect), Integrator::VelocityVerlet).unwrap();
        assert_eq!(outcome.passed(), passes);
        assert_eq!(outcome.steps, 1000);
        let check = &outcome.checks[0];
        assert!((check.measured - 2.0).abs() < 1e-12);
        assert!((check.error - (1.0 - 2.0 / check.expected)).abs() < 1e-12);
    }
}

#[test]
fn an_unknown_quantity_is_named_with_the_known_ones() {
    let error = verify::run(&throw("height = 2.0"), Integrator::VelocityVerlet).unwrap_err();
    assert_eq!(
        error.to_string(),
        "this set-up has no quantity \"height\"; \
         it has speed, velocity_x, velocity_y, velocity_z, x, y, z"
    );
}

#[test]
fn an_unknown_parameter_is_refused() {
    let row = "[[case]]\nname = \"a\"\nexpect = {}\nsource = \"\"\n tolerance = { absolute = 1.0 \
               }\n setup = { family = \"cradle\", colour = 1 }";
    let error = verify::parse(row).unwrap_err().to_string();
    assert!(error.contains("case 1"), "{error}");
    assert!(error.contains("colour"), "{error}");
}

#[test]
fn the_program_prints_what_it_verified() {
    let place = Workplace::new();
    let answer = place
        .phase(&["verify", "--case", "parabola", "--out", "verified"])
        .code(0)
        .says("ok      flight: parabola of a thrown grain (velocity-verlet), 2000 steps")
        .says("3 runs: 3 passed, 0 failed");
    assert!(answer.stdout.contains("expected   -1.062000000e1"));
    let table = place.read("verified/verification.csv");
    assert!(
        table.starts_with("family,case,integrator,quantity,expected,measured,error,tolerance,")
    );
    assert_eq!(table.lines().count(), 13);
    let figure = place.read("verified/verification.svg");
    assert!(figure.contains("flight: parabola of a thrown grain"));
    assert!(place.path("verified/verification.png").exists());

    let json = place
        .phase(&["verify", "--family", "step-limit", "--json"])
        .code(0);
    let json: serde_json::Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(json["failed"], 0);
    assert_eq!(json["checks"][0]["family"], "step-limit");
    assert_eq!(json["checks"][0]["passed"], true);
}

#[test]
fn what_is_not_verified_is_refused() {
    let place = Workplace::new();
    place
        .phase(&["verify", "--family", "impacts"])
        .code(2)
        .complains("there is no family `impacts`; the families are impact, dashpot");
    place.phase(&["verify", "--case", "no such case"]).code(2);
    place
        .phase(&["verify", "--list", "--case", "parabola"])
        .code(0)
        .says("x + v t + a t^2 / 2");
    // Symptom: nothing was printed.
    let json = place
        .phase(&["verify", "--list", "--case", "parabola", "--json"])
        .code(0);
    let json: serde_json::Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(json["cases"][0]["family"], "flight");
    assert!(
        !json["cases"][0]["integrators"]
            .as_array()
            .unwrap()
            .is_empty()
    );
}

// Symptom: all cases ran, and then their table had no place.
#[test]
fn a_folder_that_cannot_be_made_is_found_before_any_case_runs() {
    let place = Workplace::new();
    place.write("file", "");
    let answer = place
        .phase(&["verify", "--case", "parabola", "--out", "file/verified"])
        .code(1)
        .complains("file/verified: Not a directory");
    assert_eq!(answer.stdout, "");
}
