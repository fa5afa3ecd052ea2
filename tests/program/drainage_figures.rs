//! Figures of made-up tables of a box that drains.

use crate::made_up::{self, axis, source};
use crate::support::texts;
use phase::classify::{DRAINAGE, Label, LabelTable, Verdict};
use phase::plot::{self, FittedLaw, Source, fitted_lines};
use phase::record::Program;
use phase::scene::Scene;
use phase::sweep::Sweep;
use serde_json::json;
use std::f64::consts::PI;

const PACKING: f64 = 0.6;
const DEPTH: f64 = 7.0;
const C: f64 = 0.58;
const K: f64 = 1.4;

fn scene(opening: &str) -> Scene {
    serde_json::from_value(json!({
        "spheres": { "count": 500, "radius": 0.5, "density": 1.9 },
        "contact": { "law": "silbert", "stiffness": 2e5, "damping": 50.0 },
        "tank": { "width": 20.0, "depth": DEPTH, "floor": 0.0, opening: 2.0 },
        "start": { "kind": "packing" },
        "gravity": { "acceleration": 1.0 },
        "time": { "dt": 1e-4, "duration": 10.0, "frame_interval": 0.1 },
    }))
    .unwrap()
}

/// A sweep over the opening, and the table of its made-up runs.
fn made_up(opening: &str, values: &[f64], rate: impl Fn(f64) -> f64) -> (Sweep, LabelTable) {
    let axes = vec![axis((&format!("tank.{opening}"), opening), values)];
    let sweep = made_up::sweep("A made-up box", scene(opening), axes, &[1]);
    let table = made_up::table(&DRAINAGE, &sweep, |values, _| {
        Verdict::unmeasured(&DRAINAGE, Label::DRAINING)
            .with("start_packing_fraction", Some(PACKING))
            .and_then(|it| it.with("outflow_rate", Some(rate(values[0]))))
    });
    (sweep, table)
}

fn with<T>(sweep: &Sweep, table: &LabelTable, action: impl Fn(&Source<'_>) -> T) -> T {
    action(&source(sweep, table, &Program::current()))
}

/// The only line that is fitted, and the text of the figure.
fn fitted((sweep, table): &(Sweep, LabelTable)) -> (FittedLaw, String) {
    with(sweep, table, |source| {
        let mut lines = fitted_lines(source).unwrap();
        let svg = plot::draw("beverloo", source).unwrap();
        let svg = String::from_utf8(svg.to_svg_bytes()).unwrap();
        (lines.pop().unwrap(), texts(&svg).join("\n"))
    })
}

#[test]
fn rates_through_round_holes_follow_beverloo() {
    let density = PACKING / (PI / 6.0);
    let rate = |radius: f64| C * density * libm::pow(2.0 * radius - K, 2.5);
    let (line, text) = fitted(&made_up("orifice_radius", &[2.0, 2.5, 3.0, 4.0], rate));
    assert!((line.bed.number_density / density - 1.0).abs() < 1e-12);
    assert!((line.fit.c.value - C).abs() < 1e-9 && (line.fit.k.value - K).abs() < 1e-9);
    // Units are those of the spheres.
    for word in ["⁵⁄²", "(grains/τ)", "(d)", "grains per volume", "1.15 /d³"] {
        assert!(text.contains(word), "no {word} in {text}");
    }
}

#[test]
fn rates_through_slits_have_the_exponent_of_two_dimensions() {
    let density = DEPTH * PACKING / (PI / 6.0);
    let rate = |width: f64| C * density * libm::pow(width - K, 1.5);
    let (line, text) = fitted(&made_up("slit_width", &[3.0, 4.0, 5.0, 6.0], rate));
    assert!((line.bed.number_density / density - 1.0).abs() < 1e-12);
    assert!((line.fit.c.value - C).abs() < 1e-9 && (line.fit.k.value - K).abs() < 1e-9);
    assert!(text.contains("³⁄²") && text.contains("grains per area"));
}

#[test]
fn the_law_needs_an_axis_of_the_opening() {
    let (mut sweep, table) = made_up("orifice_radius", &[2.0, 3.0], |radius| radius);
    sweep.axes[0].key = "friction.coefficient".to_owned();
    let refused = with(&sweep, &table, |source| {
        plot::draw("beverloo", source).err()
    });
    let message = refused.unwrap().to_string();
    let expected = "the figure `beverloo` needs a sweep over `tank.orifice_radius`";
    assert_eq!(message, expected);
}
