//! Figures of made-up tables of a silo: what they show, what they refuse.
//!
//! Every figure drawn here is left in `target/tmp` to look at.

use crate::made_up::{self, axis, source};
use crate::support::texts;
use phase::beverloo::{GrainBed, Opening};
use phase::classify::{FAMILIES, Label, LabelTable, SILO, Verdict};
use phase::plot::{self, PlotError, fitted_lines};
use phase::record::Program;
use phase::refusal::Refusal;
use phase::scene::Scene;
use phase::sweep::Sweep;
use serde_json::json;
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

const OPENINGS: [f64; 6] = [0.24, 0.32, 0.40, 0.48, 0.56, 0.64];
const FRICTIONS: [f64; 2] = [0.0, 0.5];
const SEEDS: [u64; 3] = [1, 2, 3];
const PACKING: f64 = 0.8;

/// C and k at a friction.
fn constants(friction: f64) -> [f64; 2] {
    [1.2 - 0.4 * friction, 1.0 + friction]
}

fn bed() -> GrainBed {
    GrainBed {
        gravity: 9.81,
        number_density: PACKING / (PI * 0.04 * 0.04),
        diameter: 0.08,
        opening: Opening::Flat,
    }
}

fn scene() -> Scene {
    serde_json::from_value(json!({
        "spheres": { "count": 500, "radius": 0.04, "density": 1.0, "shape": "disc" },
        "contact": { "law": "linear", "stiffness": 1000.0, "damping": 0.1 },
        "friction": { "law": "coulomb", "coefficient": 0.3, "regularisation": 0.05 },
        "geometry": { "kind": "hopper", "half_width": 0.83, "top": 3.5, "foot": 0.8, "slope": 0.6,
            "opening": 0.24, "spacing": 0.05, "radius": 0.03 },
        "start": { "kind": "feed", "position": [0.0, 0.0, 3.4], "interval": 0.02 },
        "gravity": { "acceleration": 9.81 },
        "rest": { "kinetic_energy": 1e-5 },
        "door": {},
        "outlet": { "height": -0.5 },
        "time": { "dt": 1e-4, "duration": 30.0, "frame_interval": 0.05 },
    }))
    .unwrap()
}

/// A sweep over opening and friction, and the table of its made-up runs: they follow the law of
/// Beverloo but for half a grain per second, and narrow openings are blocked if there is friction.
fn made_up() -> (Sweep, LabelTable) {
    made_up_of(&SEEDS)
}

fn made_up_of(seeds: &[u64]) -> (Sweep, LabelTable) {
    let axes = vec![
        axis(("geometry.opening", "opening"), &OPENINGS),
        axis(("friction.coefficient", "friction"), &FRICTIONS),
    ];
    let sweep = made_up::sweep("A made-up silo", scene(), axes, seeds);
    let table = made_up::table(&SILO, &sweep, |values, seed| {
        Some(verdict(values[0], values[1], seed))
    });
    (sweep, table)
}

fn verdict(opening: f64, friction: f64, seed: u64) -> Verdict {
    let blocked = opening < 0.3 && friction > 0.0;
    let jitter = 0.5 * (seed as f64 - 2.0);
    let rate = bed().discharge_rate(opening, constants(friction)) + jitter;
    let label = if blocked {
        Label::ARCHING
    } else if opening < 0.35 {
        Label::FLOWING
    } else {
        Label::EMPTIED
    };
    let values = [
        ("packing_fraction", Some(PACKING)),
        ("discharge_rate", (!blocked).then_some(rate)),
        ("discharged_share", Some(if blocked { 0.01 } else { 1.0 })),
    ];
    let verdict = Verdict::unmeasured(&SILO, label);
    values.into_iter().fold(verdict, |verdict, (name, value)| {
        verdict.with(name, value).unwrap()
    })
}

fn drawn(figure: &str, sweep: &Sweep, table: &LabelTable) -> Result<String, PlotError> {
    let program = Program::current();
    let svg = plot::draw(figure, &source(sweep, table, &program))?;
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("silo-{figure}.png"));
    fs::write(file, svg.to_png_bytes().unwrap()).unwrap();
    Ok(String::from_utf8(svg.to_svg_bytes()).unwrap())
}

/// The texts of a figure, line by line.
fn text(svg: &str) -> String {
    texts(svg).join("\n")
}

#[test]
fn the_phase_diagram_of_a_silo_is_over_grains_and_has_no_critical_rotation() {
    let (sweep, table) = made_up();
    let shown = text(&drawn("phase", &sweep, &table).unwrap());
    for word in [
        "D / d",
        "μ",
        "arching",
        "flowing",
        "emptied",
        "A made-up silo",
    ] {
        assert!(shown.contains(word), "no {word} in {shown}");
    }
    for word in ["Ω", "settled", "unsettled"] {
        assert!(!shown.contains(word), "{word} in {shown}");
    }
    // 0.24 m over 0.08 m.
    assert!(shown.contains('3') && !shown.contains("0.24"));
}

#[test]
fn an_opening_is_shown_in_metres_where_the_grains_are_swept() {
    let (mut sweep, mut table) = made_up();
    sweep.axes[1].key = "spheres.radius".to_owned();
    table.rows.retain(|row| row.seed == 1);
    let shown = text(&drawn("discharge-rate", &sweep, &table).unwrap());
    assert!(
        shown.contains("D (m)") && !shown.contains("D / d"),
        "{shown}"
    );
}

#[test]
fn the_law_of_beverloo_is_fitted_and_its_constants_are_shown() {
    let (sweep, table) = made_up();
    let program = Program::current();
    let lines = fitted_lines(&source(&sweep, &table, &program)).unwrap();
    assert_eq!(lines.len(), 2);
    for (line, friction) in lines.iter().zip(FRICTIONS) {
        assert_eq!(line.name, format!("μ = {friction}"));
        assert!((line.bed.number_density / bed().number_density - 1.0).abs() < 1e-12);
        for (found, expected) in [line.fit.c, line.fit.k].iter().zip(constants(friction)) {
            let off = (found.value - expected).abs();
            assert!(off <= found.half_width, "{found:?} is not {expected}");
            assert!(found.half_width < 0.1 * expected, "{found:?}");
        }
    }
    assert_eq!((lines[0].without_rate, lines[1].without_rate), (0, 3));
    let shown = text(&drawn("beverloo", &sweep, &table).unwrap());
    for word in [
        "μ = 0: C = 1.2",
        "μ = 0.5: C = 1.0",
        "k = 1.",
        "±",
        "3 runs",
        "Beverloo",
    ] {
        assert!(shown.contains(word), "no {word} in {shown}");
    }
}

#[test]
fn what_cannot_be_fitted_says_why() {
    let (sweep, table) = made_up();
    let mut without = sweep.clone();
    without.axes[0].key = "geometry.slope".to_owned();
    let error = drawn("beverloo", &without, &table).unwrap_err();
    assert!(error.is_refusal() && error.to_string().contains("`geometry.opening`"));
    let mut blocked = table.clone();
    for row in &mut blocked.rows {
        row.verdict = verdict(0.24, 0.5, row.seed);
    }
    let error = drawn("beverloo", &sweep, &blocked).unwrap_err().to_string();
    assert!(error.contains("three discharges or more"), "{error}");
}

#[test]
fn measures_are_drawn_if_a_run_has_them() {
    let (sweep, table) = made_up();
    let shown = text(&drawn("measures", &sweep, &table).unwrap());
    for word in [
        "packing fraction at rest",
        "discharge rate (grains/s)",
        "3 seeds",
        "μ = 0.5",
    ] {
        assert!(shown.contains(word), "no {word} in {shown}");
    }
    for word in ["discharge rate (kg/s)", "hole", "margin"] {
        assert!(!shown.contains(word), "{word} in {shown}");
    }
}

/// How many bars of a figure are higher than nothing. Axes are black.
fn upright(svg: &str) -> usize {
    let colored = svg.lines().filter(|line| !line.contains("#000000"));
    let ends = colored.filter_map(|line| {
        let (_, path) = line.split_once("d=\"M")?;
        let (from, to) = path.split_once('"')?.0.split_once('L')?;
        Some((from.split_once(' ')?, to.split_once(' ')?))
    });
    ends.filter(|(from, to)| from.0 == to.0 && from.1 != to.1)
        .count()
}

/// Symptom: bars from 0 to 1 at every share, and "means over 1 seeds". Cause: the interval of one run
/// is infinite, and was cut to what shares can be.
#[test]
fn one_run_has_no_interval() {
    let figure = |seeds: &[u64]| {
        let (sweep, table) = made_up_of(seeds);
        drawn("measures", &sweep, &table).unwrap()
    };
    let (one, three) = (figure(&SEEDS[..1]), figure(&SEEDS));
    assert_eq!(
        [upright(&one), upright(&three)].map(|bars| bars > 0),
        [false, true]
    );
    let shown = text(&one);
    assert!(
        shown.contains("one run each") && !shown.contains("1 seeds"),
        "{shown}"
    );
}

#[test]
fn figures_of_the_other_family_are_refused() {
    let (sweep, table) = made_up();
    for figure in plot::figures().iter().filter(|it| it.is_of_sweep()) {
        let found = drawn(figure.name, &sweep, &table).map_err(|error| error.to_string());
        let refused = found.is_err_and(|error| error.contains("is not a figure of a silo"));
        assert_eq!(refused, !figure.applies_to(&SILO), "{}", figure.name);
    }
    for family in FAMILIES {
        for name in family.default_figures {
            let figures = plot::figures();
            let figure = figures.iter().find(|figure| figure.name == *name).unwrap();
            assert!(figure.applies_to(family), "{name}");
        }
    }
}

/// Symptom: with gravity as the second axis C was too small by the root of its ratio. Cause:
/// gravity and grains were those of the base scene for every line.
#[test]
fn the_law_is_fitted_with_the_gravity_of_each_line() {
    const GRAVITIES: [f64; 2] = [9.81, 2.4525];
    let (mut sweep, mut table) = made_up();
    sweep.axes[1] = axis(("gravity.acceleration", "gravity"), &GRAVITIES);
    table.axes[1] = "gravity".to_owned();
    for row in &mut table.rows {
        let gravity = if row.values[1] > 0.0 {
            GRAVITIES[1]
        } else {
            GRAVITIES[0]
        };
        row.values[1] = gravity;
        let verdict = verdict(row.values[0], 0.0, row.seed);
        let rate = verdict.value("discharge_rate").unwrap();
        let rate = rate * (gravity / GRAVITIES[0]).sqrt();
        row.verdict = verdict.with("discharge_rate", Some(rate)).unwrap();
    }
    let lines = fitted_lines(&source(&sweep, &table, &Program::current())).unwrap();
    assert_eq!(lines.len(), 2);
    for line in lines {
        let [c, k] = constants(0.0);
        assert!(
            (line.fit.c.value - c).abs() < 0.05,
            "{}: {:?}",
            line.name,
            line.fit
        );
        assert!(
            (line.fit.k.value - k).abs() < 0.1,
            "{}: {:?}",
            line.name,
            line.fit
        );
    }
}
