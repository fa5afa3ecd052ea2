//! Where figures put what they show: every datum stands at its value, on one axis for all figures.

use super::bench::{
    OMEGA, RADIUS, axis, draw, has, linear, nine, of_table, set, sweep, table, texts, verdict,
};
use phase::classify::Label;

const DENSITY: (&str, &str) = ("spheres.density", "density");

/// The number of an attribute of an element.
fn number(element: &str, name: &str) -> f64 {
    let after = element.split(&format!(" {name}=\"")).nth(1).unwrap();
    after.split('"').next().unwrap().parse().unwrap()
}

/// Heights of the tick labels of a vertical axis, at the middle of their letters, by label.
fn tick_heights(svg: &str) -> Vec<(String, f64)> {
    let labels = svg
        .lines()
        .filter(|line| line.starts_with("<text") && line.contains("text-anchor=\"end\""));
    let labels = labels.map(|line| {
        let middle = number(line, "y") - 0.365 * number(line, "font-size");
        (texts(line)[0].clone(), middle)
    });
    labels.collect()
}

/// Places of the tick labels of a horizontal axis, by label.
fn tick_places(svg: &str) -> Vec<(String, f64)> {
    let labels = svg
        .lines()
        .filter(|line| line.starts_with("<text") && line.contains("text-anchor=\"middle\""));
    let labels = labels.map(|line| (texts(line)[0].clone(), number(line, "x")));
    labels.collect()
}

/// Centres of the circles of a fill and radius.
fn circles(svg: &str, radius: &str) -> Vec<(f64, f64)> {
    let radius = format!(" r=\"{radius}\"");
    let circles = svg.lines().filter(|line| {
        line.starts_with("<circle") && line.contains(&radius) && line.contains("fill=\"#000000\"")
    });
    let circles = circles.map(|line| (number(line, "cx"), number(line, "cy")));
    circles.collect()
}

/// Symptom: of a refined sweep over Ω = 0, 2, 4, 6, 8, 12, 16, 24, 40 rad/s the run at 40 was drawn
/// at 36.5. Cause: a dot stood in the middle of its cell.
#[test]
fn dots_of_runs_stand_at_their_values() {
    let (mut sweep, mut table) = nine();
    table.rows.retain(|row| row.seed == 1);
    sweep.seeds = vec![1];
    sweep.refine_by_default().unwrap();
    let svg = draw("dots", "refined", &sweep, &table);
    let ticks = tick_heights(&svg);
    let dots = circles(&svg, "20");
    for value in ["0", "2", "12", "16", "24", "40"] {
        let (_, height) = ticks.iter().find(|(label, _)| label == value).unwrap();
        let here = dots.iter().filter(|dot| (dot.1 - height).abs() < 8.0);
        assert!(here.count() >= 7, "{value}: {ticks:?} {dots:?}");
    }
}

/// The mark of disagreement is of a run's point as well.
#[test]
fn marks_of_disagreement_stand_at_their_values() {
    let (sweep, table) = nine();
    let svg = draw("discs", "phase", &sweep, &table);
    let ticks = tick_heights(&svg);
    let discs = svg.lines().filter(|line| line.starts_with("<circle"));
    let discs = discs.filter(|line| line.contains("fill=\"#ffffff\""));
    // The last one belongs to the legend.
    let mut heights: Vec<f64> = discs.map(|line| number(line, "cy")).collect();
    heights.pop();
    assert!(heights.len() > 8);
    for height in heights {
        let is_here = |(_, tick): &(String, f64)| (tick - height).abs() < 8.0;
        assert!(ticks.iter().any(is_here), "{height}: {ticks:?}");
    }
}

/// Symptom: points of `measures` over densities of equal ratios crowded at one end, and stood at
/// negative densities. Cause: the figure had an axis of its own, and lines were put aside by
/// differences.
#[test]
fn measures_have_the_axis_of_the_phase_diagram() {
    let densities = [1.0, 10.0, 100.0, 1000.0, 10_000.0];
    let axes = vec![axis(DENSITY, &densities), axis(RADIUS, &[0.003, 0.004])];
    let sweep = sweep("Densities", axes, &[1, 2]);
    let mut table = table(&sweep, |_, _| Some(verdict(Label::SETTLED)));
    for (index, row) in table.rows.iter_mut().enumerate() {
        set(row, "settle_time", 1.0 + index as f64);
    }
    let svg = draw("measures-logarithmic", "measures", &sweep, &table);
    let ticks = tick_places(&svg);
    let place = |value: &str| {
        let mut ticks = ticks.iter();
        let tick = ticks.find(|(label, _)| label == value);
        tick.unwrap_or_else(|| panic!("{value}: {:?}", texts(&svg)))
            .1
    };
    let steps = ["1", "10", "100", "1000"].map(place);
    let [first, second, third] = [0, 1, 2].map(|step| steps[step + 1] - steps[step]);
    assert!(
        (first - second).abs() < 8.0 && (second - third).abs() < 8.0,
        "{ticks:?}"
    );
    let phase = draw("phase-logarithmic", "phase", &sweep, &table);
    let labels = |svg: &str| {
        let ticks = tick_places(svg).into_iter().map(|(label, _)| label);
        let numbers = ticks.filter(|label| label.parse::<f64>().is_ok());
        numbers.take(5).collect::<Vec<_>>()
    };
    assert_eq!(labels(&svg), labels(&phase));
}

/// Symptom: a phase diagram over 0, 0.01, 0.1, ... 100 had cells without width, and said nothing.
/// Right: a warning that names the key which draws them at equal distances.
#[test]
fn cells_without_width_are_warned_of_or_drawn_at_equal_distances() {
    let values = [0.0, 0.01, 0.1, 1.0, 10.0, 100.0];
    let axes = vec![axis(OMEGA, &values), axis(RADIUS, &linear(0.002, 0.006, 5))];
    let mut sweep = sweep("Uneven", axes, &[1]);
    let table = table(&sweep, |values, _| {
        let label = if values[0] > 0.5 {
            Label::FLUID
        } else {
            Label::SETTLED
        };
        Some(verdict(label))
    });
    let uneven = of_table("phase", &sweep, &table).unwrap();
    let warning = uneven.warnings().join("\n");
    assert!(warning.contains("the axis `omega`"), "{warning}");
    assert!(warning.contains("equal_steps = [\"omega\"]"), "{warning}");

    sweep.plot.equal_steps = vec!["omega".to_owned()];
    let even = of_table("phase", &sweep, &table).unwrap();
    assert!(even.warnings().is_empty(), "{:?}", even.warnings());
    let svg = draw("equal-steps", "phase", &sweep, &table);
    let ticks = tick_places(&svg);
    let place = |value: &str| ticks.iter().find(|(label, _)| label == value).unwrap().1;
    let steps = ["0", "0.01", "0.1", "1", "10", "100"].map(place);
    let length = steps[1] - steps[0];
    for pair in steps.windows(2) {
        assert!((pair[1] - pair[0] - length).abs() < 2.0, "{ticks:?}");
    }
}

/// Symptom: three panels "ρ = 3750 kg/m³". Cause: four digits, whatever the other values are.
#[test]
fn panels_of_different_values_have_different_heads() {
    let axes = vec![
        axis(RADIUS, &linear(0.002, 0.006, 3)),
        axis(OMEGA, &linear(0.0, 40.0, 3)),
        axis(DENSITY, &[3750.1, 3750.2, 3750.3]),
    ];
    let sweep = sweep("Densities", axes, &[1]);
    let table = table(&sweep, |_, _| Some(verdict(Label::SETTLED)));
    let svg = draw("close-panels", "phase", &sweep, &table);
    for head in ["ρ = 3750.1 kg/m³", "ρ = 3750.2 kg/m³", "ρ = 3750.3 kg/m³"] {
        assert!(has(&svg, head), "{head}: {:?}", texts(&svg));
    }
}

/// Symptom: five ticks "10⁵", and an axis without a tick. Cause: the same, and labels of too many
/// digits were left out.
#[test]
fn ticks_of_different_values_have_different_labels() {
    let densities = [1.0, 2.0, 3.0, 4.0, 5.0].map(|step| 1e5 + step);
    let radii = [0.003, 0.003_000_01, 0.003_000_02];
    let axes = vec![axis(DENSITY, &densities), axis(RADIUS, &radii)];
    let sweep = sweep("Close", axes, &[1]);
    let table = table(&sweep, |_, _| Some(verdict(Label::SETTLED)));
    let svg = draw("close-ticks", "phase", &sweep, &table);
    let across = tick_places(&svg).into_iter().map(|(label, _)| label);
    let mut across: Vec<String> = across.filter(|it| it.starts_with("1000")).collect();
    assert_eq!(across, ["100001", "100002", "100003", "100004", "100005"]);
    across.dedup();
    let up = tick_heights(&svg);
    assert!(up.len() >= 2, "{up:?}");
    assert!(up.windows(2).all(|pair| pair[0].0 != pair[1].0), "{up:?}");
}

/// Symptom: a title without spaces was cut at both ends, and Chinese letters were boxes without a
/// word.
#[test]
fn letters_that_the_font_lacks_are_named() {
    let (mut sweep, table) = nine();
    sweep.title = Some("漏斗の中の粒子".repeat(12));
    let figure = of_table("phase", &sweep, &table).unwrap();
    let [warning] = figure.warnings() else {
        panic!("{:?}", figure.warnings());
    };
    assert!(warning.contains("key `title`"), "{warning}");
    for letter in ["`漏`", "`斗`", "`子`"] {
        assert!(warning.contains(letter), "{warning}");
    }
    let svg = draw("long-title", "phase", &sweep, &table);
    let lines = texts(&svg)
        .into_iter()
        .filter(|line| line.contains('漏') || line.contains('斗'));
    assert!(lines.count() > 1);
    sweep.title = Some("Größe der Kugeln, Ω".to_owned());
    let figure = of_table("phase", &sweep, &table).unwrap();
    assert!(figure.warnings().is_empty());
}
