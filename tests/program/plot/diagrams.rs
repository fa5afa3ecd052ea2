//! Phase diagrams, maps and measures over two axes.

use super::bench::{
    OMEGA, RADIUS, axis, count, draw, has, linear, made_up, nine, set, sweep, table, texts, verdict,
};
use phase::classify::{Label, TANK};

#[test]
fn the_nine_by_nine_phase_diagram() {
    let (sweep, table) = nine();
    let svg = draw("nine", "phase", &sweep, &table);
    // 81 cells, five keys of labels and one of disagreement, and the background.
    let cells = svg.lines().filter(|line| line.starts_with("<rect")).count();
    assert_eq!(cells, 81 + 5 + 1 + 1);
    for text in [
        "Theoretical tank, linear drag",
        "r / R",
        "Ω (rad/s)",
        "settled",
        "fluid",
        "pinned",
        "small spout",
        "large spout",
        "67 % of seeds agree",
        "critical rotation Ωc",
        "0.04",
        "24",
    ] {
        assert!(has(&svg, text), "{text} not in {:?}", texts(&svg));
    }
    for text in ["unstable", "unsettled", "not run", "no majority"] {
        assert!(!has(&svg, text), "{text}");
    }
}

#[test]
fn cells_in_which_seeds_disagree_are_paler_and_have_a_dot() {
    let (sweep, mut table) = nine();
    let disagreeing = table.points().iter().filter(|p| p.agreement < 1.0).count();
    let pure = ["#2a8a5c", "#58a6e0", "#e2bd6c"];
    let svg = draw("dots", "phase", &sweep, &table);
    // A disc and its rim in each of those cells, and in the legend.
    assert_eq!(circles(&svg), 2 * (disagreeing + 1));
    // Equal agreement has equal discs, however high the cells are.
    let radii = svg
        .split("<circle ")
        .skip(1)
        .map(|circle| circle.split(" r=").nth(1));
    let radii: std::collections::BTreeSet<_> = radii
        .map(|rest| rest.unwrap().split('"').nth(1).unwrap())
        .collect();
    assert_eq!(radii.len(), 1, "{radii:?}");
    let colors = pure.map(|color| count(&svg, color));
    table.rows.retain(|row| row.seed == 1);
    let svg = draw("one-seed", "phase", &sweep, &table);
    // Where seeds disagree the colour is paler: fewer cells have the pure one.
    let alone = pure.map(|color| count(&svg, color));
    let paler = alone.iter().sum::<usize>() - colors.iter().sum::<usize>();
    assert!(
        (1..=disagreeing).contains(&paler),
        "{paler} of {disagreeing}"
    );
    assert_eq!(circles(&svg), 0);
    assert!(!has(&svg, "67 % of seeds agree"));
}

fn circles(svg: &str) -> usize {
    svg.lines()
        .filter(|line| line.starts_with("<circle"))
        .count()
}

#[test]
fn seeds_without_a_majority_are_shown_as_such() {
    let axes = vec![axis(RADIUS, &[0.002, 0.003]), axis(OMEGA, &[0.0, 10.0])];
    let sweep = sweep("Three seeds", axes, &[1, 2, 3]);
    let three = [Label::SETTLED, Label::FLUID, Label::PINNED];
    let mixed = table(&sweep, |values, seed| {
        let at_once = values[0] == 0.002;
        let label = if at_once {
            Label::LARGE_SPOUT
        } else {
            three[seed as usize - 1]
        };
        Some(verdict(label))
    });
    let svg = draw("no-majority", "phase", &sweep, &mixed);
    assert!(has(&svg, "no majority") && has(&svg, "large spout"));
    for label in three {
        assert!(!has(&svg, label.name), "{label:?}");
    }
    let mut two = mixed.clone();
    two.rows.retain(|row| row.seed < 3);
    assert!(has(&draw("tie", "phase", &sweep, &two), "no majority"));
}

#[test]
fn unstable_cells_are_a_pattern_and_not_the_black_of_the_critical_rotation() {
    let axes = vec![axis(RADIUS, &[0.002, 0.003]), axis(OMEGA, &[0.0, 10.0])];
    let sweep = sweep("Unstable", axes, &[1]);
    let table = table(&sweep, |_, _| Some(verdict(Label::UNSTABLE)));
    let svg = draw("unstable", "phase", &sweep, &table);
    assert!(has(&svg, "unstable"));
    assert_eq!(count(&svg, "#000000"), 0);
    let lines = svg
        .lines()
        .filter(|line| line.contains("stroke-opacity=\"0.75\""));
    assert!(lines.count() > 100);
}

#[test]
fn maps_without_values_have_no_colour_bar() {
    let (sweep, mut table) = nine();
    let without = draw("no-values", "settle-time", &sweep, &table);
    assert!(has(&without, "settle time (s): no values"));
    assert!(!has(&without, "settle time (s)") && !has(&without, "no value"));
    set(&mut table.rows[0], "settle_time", 2.0);
    let with = draw("one-value", "settle-time", &sweep, &table);
    assert!(has(&with, "settle time (s)") && has(&with, "no value"));
}

#[test]
fn margins_have_zero_in_the_middle_even_if_all_are_negative() {
    let (sweep, mut table) = nine();
    for (index, row) in table.rows.iter_mut().enumerate() {
        set(row, "spout_margin", -0.5 - 0.5 * (index % 2) as f64);
    }
    let svg = draw("negative-margins", "spout-margin", &sweep, &table);
    for tick in ["−0.8", "0.0", "0.8"] {
        assert!(has(&svg, tick), "{tick} not in {:?}", texts(&svg));
    }
}

#[test]
fn the_full_diagram_with_gaps_and_its_maps() {
    let axes = vec![
        axis(RADIUS, &linear(0.002, 0.006, 41)),
        axis(OMEGA, &linear(0.0, 40.0, 41)),
    ];
    let sweep = sweep(
        "A long title that must not run out of the figure, of a made-up law with all seven states \
         of 256 spheres and a few runs that are missing",
        axes,
        &[1],
    );
    let table = table(&sweep, |values, _| {
        let missing = values[0] > 0.005 && (10.0..14.0).contains(&values[1]);
        (!missing).then(|| made_up(values[0], values[1], 0.0))
    });
    let svg = draw("full", "phase", &sweep, &table);
    for label in TANK.labels() {
        assert!(has(&svg, &label.name.replace('-', " ")));
    }
    assert!(has(&svg, "not run"));
    let svg = draw("full-settle-time", "settle-time", &sweep, &table);
    assert!(has(&svg, "settle time (s)"));
    assert!(has(&svg, "no value"));
    assert!(has(&svg, "critical rotation Ωc"));
    let svg = draw("full-rotation", "paraboloid-rotation", &sweep, &table);
    assert!(has(&svg, "0") && count(&svg, "#f7f7f7") + count(&svg, "#f6f7f7") > 0);
    draw("full-hole", "hole-radius", &sweep, &table);
}

#[test]
fn measures_of_a_tank_have_a_line_for_up_to_four_values() {
    let axes = vec![
        axis(RADIUS, &linear(0.002, 0.006, 5)),
        axis(OMEGA, &linear(0.0, 30.0, 7)),
    ];
    let sweep = sweep("Measures", axes, &[1, 2]);
    let table = table(&sweep, |values, seed| {
        Some(made_up(values[0], values[1], 0.01 * seed as f64))
    });
    let svg = draw("measures", "measures", &sweep, &table);
    for text in ["settle time (s)", "Ω = 0 rad/s", "Ω = 30 rad/s"] {
        assert!(has(&svg, text), "{text} not in {:?}", texts(&svg));
    }
    assert!(has(&svg, "6 of 7 lines are shown."));
    assert!(!has(&svg, "margin of the spout sieve") && !has(&svg, "packing height / R"));
}
