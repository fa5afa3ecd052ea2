//! Other numbers of axes: strips, panels, rows and columns.

use super::bench::{
    OMEGA, RADIUS, axis, draw, has, linear, made_up, nine, sweep, table, texts, verdict,
};
use phase::classify::{Label, LabelTable};
use phase::grid::Axis;
use phase::scene::Scene;
use phase::sweep::Sweep;
use std::path::Path;

/// Symptom: the diagram of a refined sweep in three axes took 3.8 MB. Cause: every cell without a
/// run had a hatch of its own.
#[test]
fn cells_that_were_not_run_share_a_hatch() {
    let axes = vec![
        axis(RADIUS, &linear(0.002, 0.006, 41)),
        axis(OMEGA, &linear(0.0, 40.0, 41)),
        axis(("gravity.acceleration", "g"), &linear(1.0, 9.0, 9)),
    ];
    let sweep = sweep("Hardly run", axes, &[1]);
    let few = |values: &[f64]| values[0] == 0.002 && values[1] == 0.0;
    let table = table(&sweep, |values, _| {
        few(values).then(|| verdict(Label::FLUID))
    });
    let size = draw("hardly-run", "phase", &sweep, &table).len();
    assert!(size < 300_000, "{size} bytes");
}

#[test]
fn three_axes_make_panels_with_their_own_critical_rotation() {
    let axes = vec![
        axis(RADIUS, &linear(0.002, 0.006, 9)),
        axis(OMEGA, &linear(0.0, 40.0, 9)),
        axis(("gravity.acceleration", "g"), &[1.6, 3.7, 9.8, 24.8]),
    ];
    let sweep = sweep("Four planets", axes, &[1, 2]);
    let table = table(&sweep, |values, seed| {
        Some(made_up(
            values[0],
            values[1],
            0.1 * seed as f64 - 0.01 * values[2],
        ))
    });
    let svg = draw("three", "phase", &sweep, &table);
    for text in [
        "g = 1.6 m/s²",
        "g = 3.7 m/s²",
        "g = 9.8 m/s²",
        "g = 24.8 m/s²",
    ] {
        assert!(has(&svg, text), "{text}");
    }
    let mut curves: Vec<&str> = svg
        .lines()
        .filter(|line| line.contains("stroke-linejoin") && line.contains("stroke-width=\"20\""))
        .collect();
    assert_eq!(curves.len(), 4);
    curves.sort_unstable();
    curves.dedup();
    assert_eq!(curves.len(), 4);
    draw("three-settle-time", "settle-time", &sweep, &table);
}

#[test]
fn four_axes_make_rows_and_columns() {
    let axes = vec![
        axis(RADIUS, &linear(0.002, 0.006, 5)),
        axis(OMEGA, &linear(0.0, 40.0, 9)),
        axis(("spheres.density", "density"), &[1000.0, 2500.0, 7850.0]),
        axis(("drag.linear", "drag"), &[50.0, 100.0]),
    ];
    let sweep = sweep("Density and drag", axes, &[1]);
    let table = table(&sweep, |values, _| {
        Some(made_up(
            values[0],
            values[1],
            values[3] / 200.0 - values[2] / 2e4,
        ))
    });
    let svg = draw("four", "phase", &sweep, &table);
    for text in ["ρ = 2500 kg/m³", "M1 = 50 kg/(m² s)", "M1 = 100 kg/(m² s)"] {
        let found = texts(&svg).iter().filter(|found| *found == text).count();
        assert_eq!(found, 1, "{text}");
    }
    draw("four-hole", "hole-radius", &sweep, &table);
}

#[test]
fn settings_choose_the_axes() {
    let (mut sweep, table) = nine();
    sweep.plot.y = Some("radius".to_owned());
    let svg = draw("swapped", "phase", &sweep, &table);
    let rotated = |text: &str| {
        svg.lines().any(|line| {
            let label = line.starts_with("<text") && line.contains("rotate(270");
            label && texts(line).iter().any(|found| found == text)
        })
    };
    assert!(rotated("r / R") && !rotated("Ω (rad/s)"));
    assert!(has(&svg, "critical rotation Ωc"));
}

/// Dashes show the critical rotation with friction, where friction can hold spheres: steel has it,
/// the thesis's rule does not.
#[test]
fn friction_that_holds_spheres_has_a_curve_of_its_own() {
    let (mut sweep, table) = nine();
    let without = draw("without-friction", "phase", &sweep, &table);
    assert!(!has(&without, "with friction, Ωμ"));
    sweep.scene = Scene::load(Path::new("sweeps/scenes/steel.toml")).unwrap();
    sweep.axes[1].values = linear(0.0, 600.0, 3);
    let table = self::table(&sweep, |values, seed| {
        Some(made_up(values[0], values[1] / 15.0, 0.05 * seed as f64))
    });
    let svg = draw("with-friction", "phase", &sweep, &table);
    assert!(has(&svg, "critical rotation Ωc") && has(&svg, "with friction, Ωμ"));
}

#[test]
fn one_axis_makes_a_strip() {
    let axes = vec![axis(OMEGA, &linear(0.0, 40.0, 21))];
    let sweep = sweep("Spheres of 4 mm", axes, &[1, 2, 3]);
    let table = table(&sweep, |values, seed| {
        Some(made_up(0.004, values[0], 0.05 * seed as f64))
    });
    let svg = draw("strip", "phase", &sweep, &table);
    assert!(has(&svg, "Ω (rad/s)") && has(&svg, "critical rotation Ωc"));
    draw("strip-settle-time", "settle-time", &sweep, &table);
    draw("strip-rotation", "rotation", &sweep, &table);
}

#[test]
fn logarithmic_axis_without_omega_has_no_curve() {
    let steps: Vec<f64> = (0..10)
        .map(|index| 1e-6 * libm::exp10(0.5 * f64::from(index)))
        .collect();
    let axes = vec![
        axis(("time.dt", "dt"), &steps),
        axis(("friction.coefficient", "friction"), &linear(0.0, 1.0, 6)),
    ];
    let sweep = sweep("Time step", axes, &[1]);
    let table = table(&sweep, |values, _| {
        let label = if values[0] > 1e-3 {
            Label::UNSTABLE
        } else {
            Label::SETTLED
        };
        Some(verdict(label))
    });
    let svg = draw("logarithmic", "phase", &sweep, &table);
    assert!(has(&svg, "10⁻⁵") && has(&svg, "Δt (s)") && has(&svg, "μ"));
    assert!(!has(&svg, "critical rotation Ωc"));
}

#[test]
fn many_panels_widen_the_figure() {
    let alpha = linear(0.1, 0.9, 9);
    let axes = vec![
        axis(RADIUS, &linear(0.002, 0.006, 5)),
        axis(OMEGA, &linear(0.0, 40.0, 5)),
        axis(("updraught.alpha", "alpha"), &alpha),
        axis(("contact.young_modulus", "young"), &[1e5, 5.657e5]),
    ];
    let sweep = sweep("Many panels", axes, &[1]);
    let table = table(&sweep, |values, _| {
        Some(made_up(values[0], values[1], values[2] - 0.5))
    });
    let svg = draw("many", "phase", &sweep, &table);
    assert!(has(&svg, "α = 0.9") && has(&svg, "Y = 5.657×10⁵ Pa"));
    let width = svg
        .split("width=\"")
        .nth(1)
        .and_then(|rest| rest.split('"').next());
    assert!(width.unwrap().parse::<f64>().unwrap() > 900.0);
}

/// A sweep of a made-up law that has been refined with runs at every third point.
fn refined(axes: Vec<Axis>) -> (Sweep, LabelTable) {
    let mut sweep = sweep("Refined", axes, &[1]);
    let mut table = table(&sweep, |values, _| {
        let third = values.get(2).map_or(0.0, |value| value / 2e4);
        Some(made_up(values[0], values[1], third))
    });
    sweep.refine_by_default().unwrap();
    let mut row = 0;
    table.rows.retain(|_| {
        row += 1;
        row % 3 == 1
    });
    (sweep, table)
}

#[test]
fn a_refined_map_shows_borders_bands_runs_and_the_critical_rotation() {
    let axes = vec![
        axis(RADIUS, &linear(0.002, 0.006, 13)),
        axis(OMEGA, &linear(0.0, 40.0, 13)),
    ];
    let (sweep, table) = refined(axes);
    let svg = draw("refined", "refined", &sweep, &table);
    for text in ["pinned", "in its 95 % band", "border", "run"] {
        assert!(has(&svg, text), "{text} in {:?}", texts(&svg));
    }
    assert!(
        texts(&svg)
            .iter()
            .any(|it| it.starts_with("critical rotation"))
    );
    // A black dot with a white rim for each point with a run and for the legend; those whose label
    // is not the most probable one there are a ring about their own colour.
    assert!(has(&svg, "run of another label"), "{:?}", texts(&svg));
    let circles = || svg.lines().filter(|line| line.starts_with("<circle"));
    let black = circles().filter(|line| line.contains("fill=\"#000000\""));
    let runs = table.points().len();
    assert_eq!(black.count(), runs + 2);
    assert!((2..8).contains(&(circles().count() - 2 * (runs + 2))));
}

/// Symptom: a refined map did not show which of its runs were not steady. Cause: only the phase
/// diagram did.
#[test]
fn a_refined_map_shows_runs_that_were_not_steady() {
    let axes = vec![
        axis(RADIUS, &linear(0.002, 0.006, 13)),
        axis(OMEGA, &linear(0.0, 40.0, 13)),
    ];
    let (sweep, mut table) = refined(axes);
    for row in &mut table.rows {
        row.verdict.steady = Some(row.values[0] < 0.004);
    }
    let svg = draw("refined-unsteady", "refined", &sweep, &table);
    assert!(has(&svg, "run that was not steady"), "{:?}", texts(&svg));
}

#[test]
fn a_third_axis_of_a_refined_map_has_four_panels() {
    let axes = vec![
        axis(RADIUS, &linear(0.002, 0.006, 7)),
        axis(OMEGA, &linear(0.0, 40.0, 7)),
        axis(("spheres.density", "density"), &linear(1000.0, 5000.0, 9)),
    ];
    let (sweep, table) = refined(axes);
    let svg = draw("refined-three", "refined", &sweep, &table);
    let heads = texts(&svg);
    let heads = heads.iter().filter(|text| text.starts_with("ρ = "));
    let heads: Vec<&String> = heads.collect();
    let expected = ["1000", "2500", "3500", "5000"];
    assert_eq!(heads.len(), 4, "{heads:?}");
    for (head, number) in heads.iter().zip(expected) {
        assert!(head.contains(number), "{head}");
    }
    draw("phase-of-refined-three", "phase", &sweep, &table);
}

/// The figure of a refined sweep over Omega alone.
fn refined_strip(file: &str, omegas: &[f64]) -> String {
    let (mut sweep, mut table) = refined(vec![axis(OMEGA, omegas), axis(RADIUS, &[0.003])]);
    sweep.axes.pop();
    table.axes.pop();
    table.rows.iter_mut().for_each(|row| row.values.truncate(1));
    draw(file, "refined", &sweep, &table)
}

#[test]
fn one_axis_of_a_refined_map_is_a_strip() {
    let svg = refined_strip("refined-strip", &linear(0.0, 40.0, 13));
    assert!(has(&svg, "run"));
}

/// Symptom: the first label of the horizontal axis was cut. Cause: without a vertical axis nothing
/// made room for its half left of the panel.
#[test]
fn the_first_tick_label_of_a_strip_is_in_the_figure() {
    let svg = refined_strip(
        "refined-strip-of-long-labels",
        &linear(1e6, 1_000_080.0, 81),
    );
    let label = svg.lines().find(|line| line.contains(">1000000</text>"));
    let place = label.and_then(|it| it.split('"').nth(1)).unwrap();
    // Half of seven digits, in tenths of pixels.
    let half = 3.5 * 0.63 * 120.0;
    assert!(place.parse::<f64>().unwrap() > half, "{label:?}");
}
