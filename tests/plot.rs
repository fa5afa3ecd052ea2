//! Figures of synthetic tables: what they show, what their files hold, what they refuse.
//!
//! Every figure drawn here is left in `target/tmp` to look at.

#![allow(clippy::unwrap_used, reason = "a test may panic")]

use phase::classify::{Family, Label, Measures, OrderParameters, Sieves, TankMeasures, Verdict};
use phase::plot::{self, PlotError, Source, Svg};
use phase::record::Program;
use phase::scene::Scene;
use phase::sweep::{Axis, LabelRow, LabelTable, PlotSettings, Sweep};
use serde_json::json;
use std::fs;
use std::path::Path;

/// The 9 x 9 grid of the theoretical tank with linear drag, Omega from 40 down to 0, r from 2 to
/// 6 mm. 2 is fluid or settled, 3 pinned, 4 small spout, 5 large spout.
const NINE: [(f64, &str); 9] = [
    (40.0, "333333333"),
    (24.0, "333333332"),
    (16.0, "333333322"),
    (12.0, "333333222"),
    (8.0, "333332222"),
    (6.0, "333542222"),
    (4.0, "335522222"),
    (2.0, "552222222"),
    (0.0, "522222222"),
];

const RADIUS: (&str, &str) = ("spheres.radius", "radius");
const OMEGA: (&str, &str) = ("swirl.omega", "omega");

fn program() -> Program {
    Program {
        version: "9.8.7".to_owned(),
        commit: "c0ffee123456".to_owned(),
    }
}

fn scene() -> Scene {
    serde_json::from_value(json!({
        "spheres": { "count": 256, "radius": 0.004, "density": 3750.0 },
        "tank": { "radius": 0.06, "floor": -0.2 },
        "start": { "kind": "random", "z_min": -0.1, "z_max": 0.3 },
        "gravity": { "acceleration": 9.8 },
        "drag": { "law": "cross-section", "linear": 100.0 },
        "swirl": { "omega": 10.0 },
        "time": { "dt": 1e-4, "duration": 5.0, "frame_interval": 1e-3 },
    }))
    .unwrap()
}

fn axis((key, name): (&str, &str), values: &[f64]) -> Axis {
    Axis {
        key: key.to_owned(),
        name: name.to_owned(),
        values: values.to_vec(),
    }
}

/// `count` values from `from` to `to`.
fn linear(from: f64, to: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|index| from + (to - from) * index as f64 / (count - 1) as f64)
        .collect()
}

fn sweep(title: &str, axes: Vec<Axis>, seeds: &[u64]) -> Sweep {
    Sweep {
        title: Some(title.to_owned()),
        scene: scene(),
        axes,
        seeds: seeds.to_vec(),
        sieves: Sieves::default(),
        plot: PlotSettings::default(),
    }
}

/// The table of a sweep whose verdicts are given by values and seed.
fn table(sweep: &Sweep, verdict: impl Fn(&[f64], u64) -> Option<Verdict>) -> LabelTable {
    let mut points = vec![Vec::new()];
    for axis in &sweep.axes {
        points = points
            .into_iter()
            .flat_map(|point: Vec<f64>| {
                let extend = move |value: &f64| [point.clone(), vec![*value]].concat();
                axis.values.iter().map(extend).collect::<Vec<_>>()
            })
            .collect();
    }
    let mut rows = Vec::new();
    for values in points {
        for &seed in &sweep.seeds {
            if let Some(verdict) = verdict(&values, seed) {
                rows.push(LabelRow {
                    id: format!("{:016x}", rows.len()),
                    values: values.clone(),
                    seed,
                    verdict,
                });
            }
        }
    }
    LabelTable {
        family: Family::Tank,
        axes: sweep.axes.iter().map(|axis| axis.name.clone()).collect(),
        rows,
    }
}

fn verdict(label: Label) -> Verdict {
    Verdict {
        label,
        measures: Measures::none(Family::Tank),
    }
}

/// The measures of a row of a tank, to change them.
fn measures(row: &mut LabelRow) -> &mut TankMeasures {
    match &mut row.verdict.measures {
        Measures::Tank(measures) => measures,
        Measures::Silo(_) => panic!("a row of a silo"),
    }
}

/// A made-up law with every state, in r (m) and Omega (rad/s).
fn made_up(radius: f64, omega: f64, jitter: f64) -> Verdict {
    let critical = phase::theory::critical_rotation(256.0, radius, 0.06, 9.8);
    let ratio = omega / critical + jitter;
    let label = if omega >= 39.0 && radius < 0.0025 {
        Label::Unstable
    } else if omega > 30.0 && radius > 0.0055 {
        Label::Unsettled
    } else if ratio > 1.0 {
        Label::Pinned
    } else if radius < 0.0035 && ratio > 0.5 {
        Label::LargeSpout
    } else if radius < 0.0042 && ratio > 0.3 {
        Label::SmallSpout
    } else if ratio > 0.4 {
        Label::Fluid
    } else {
        Label::Settled
    };
    let settle_time = 0.5 + 20.0 * radius * omega + jitter;
    Verdict {
        label,
        measures: Measures::Tank(TankMeasures {
            settle_time: (label > Label::Unsettled).then_some(settle_time),
            order: OrderParameters {
                hole_radius: Some((ratio - 0.6).clamp(0.0, 0.9)),
                paraboloid_rotation: Some(omega - 0.6 * critical),
                rotation: (omega > 0.0).then_some(1.0 / (1.0 + 0.1 * ratio)),
                ..OrderParameters::default()
            },
            ..TankMeasures::default()
        }),
    }
}

/// A figure of a table alone.
fn of_table(name: &str, sweep: &Sweep, table: &LabelTable) -> Result<Svg, PlotError> {
    let source = Source {
        sweep,
        table,
        record: &|id| panic!("a figure of a table read the record {id}"),
        points: &[],
        program: &program(),
    };
    plot::draw(name, &source)
}

/// Draws a figure twice, checks that its bytes are equal, and leaves its files in target/tmp.
fn draw(file: &str, name: &str, sweep: &Sweep, table: &LabelTable) -> String {
    let svg = of_table(name, sweep, table).unwrap();
    let again = of_table(name, sweep, table).unwrap();
    let bytes = svg.to_svg_bytes();
    assert_eq!(bytes, again.to_svg_bytes());
    let png = png(&svg);
    assert!(png.len() < 150_000, "{file}: {} bytes", png.len());
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(file);
    fs::write(path.with_extension("png"), &png).unwrap();
    fs::write(path.with_extension("svg"), &bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn png(svg: &Svg) -> Vec<u8> {
    svg.to_png_bytes().unwrap()
}

/// The fills of cells and keys: rectangles of the SVG, by colour.
fn count(svg: &str, color: &str) -> usize {
    let fill = format!("fill=\"{color}\"");
    svg.lines()
        .filter(|line| line.starts_with("<rect") && line.contains(&fill))
        .count()
}

/// The texts of the SVG, without tags.
fn texts(svg: &str) -> Vec<String> {
    svg.lines()
        .filter(|line| line.starts_with("<text"))
        .map(|line| {
            let mut inside = false;
            line.chars()
                .filter(|character| match character {
                    '<' => {
                        inside = true;
                        false
                    }
                    '>' => {
                        inside = false;
                        false
                    }
                    _ => !inside,
                })
                .collect()
        })
        .collect()
}

fn has(svg: &str, text: &str) -> bool {
    texts(svg).iter().any(|found| found == text)
}

fn nine() -> (Sweep, LabelTable) {
    let omega: Vec<f64> = NINE.iter().rev().map(|row| row.0).collect();
    let axes = vec![axis(RADIUS, &linear(0.002, 0.006, 9)), axis(OMEGA, &omega)];
    let sweep = sweep("Theoretical tank, linear drag", axes, &[1, 2, 3]);
    let radii = sweep.axes[0].values.clone();
    let table = table(&sweep, |values, seed| {
        let column = radii.iter().position(|radius| *radius == values[0])?;
        let (omega, row) = NINE.iter().find(|row| row.0 == values[1])?;
        let label = match &row[column..=column] {
            "2" if *omega <= 2.0 => Label::Settled,
            "2" => Label::Fluid,
            "3" => Label::Pinned,
            "4" => Label::SmallSpout,
            _ => Label::LargeSpout,
        };
        // One seed of three disagrees next to the border.
        let odd =
            seed == 3 && column + 1 < 9 && row[column..=column] != row[column + 1..column + 2];
        Some(verdict(if odd { Label::Fluid } else { label }))
    });
    (sweep, table)
}

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
    let three = [Label::Settled, Label::Fluid, Label::Pinned];
    let mixed = table(&sweep, |values, seed| {
        let at_once = values[0] == 0.002;
        let label = if at_once {
            Label::LargeSpout
        } else {
            three[seed as usize - 1]
        };
        Some(verdict(label))
    });
    let svg = draw("no-majority", "phase", &sweep, &mixed);
    assert!(has(&svg, "no majority") && has(&svg, "large spout"));
    for label in three {
        assert!(!has(&svg, label.name()), "{label:?}");
    }
    let mut two = mixed.clone();
    two.rows.retain(|row| row.seed < 3);
    assert!(has(&draw("tie", "phase", &sweep, &two), "no majority"));
}

#[test]
fn unstable_cells_are_a_pattern_and_not_the_black_of_the_critical_rotation() {
    let axes = vec![axis(RADIUS, &[0.002, 0.003]), axis(OMEGA, &[0.0, 10.0])];
    let sweep = sweep("Unstable", axes, &[1]);
    let table = table(&sweep, |_, _| Some(verdict(Label::Unstable)));
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
    measures(&mut table.rows[0]).settle_time = Some(2.0);
    let with = draw("one-value", "settle-time", &sweep, &table);
    assert!(has(&with, "settle time (s)") && has(&with, "no value"));
}

#[test]
fn margins_have_zero_in_the_middle_even_if_all_are_negative() {
    let (sweep, mut table) = nine();
    for (index, row) in table.rows.iter_mut().enumerate() {
        measures(row).evidence.spout_margin = Some(-0.5 - 0.5 * (index % 2) as f64);
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
    for &label in Family::Tank.labels() {
        assert!(has(&svg, &label.name().replace('-', " ")));
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
            Label::Unstable
        } else {
            Label::Settled
        };
        Some(verdict(label))
    });
    let svg = draw("logarithmic", "phase", &sweep, &table);
    assert!(has(&svg, "10⁻⁵") && has(&svg, "Δt (s)") && has(&svg, "μ"));
    assert!(!has(&svg, "critical rotation Ωc"));
}

#[test]
fn metadata_names_program_commit_and_seeds() {
    let (mut sweep, table) = nine();
    sweep.title = Some("Ω < Ω & \"r\"".to_owned());
    let svg = of_table("phase", &sweep, &table).unwrap();
    let text = String::from_utf8(svg.to_svg_bytes()).unwrap();
    let metadata = text.split("metadata>").nth(1).unwrap();
    for line in [
        "Title: Ω &lt; Ω &amp; &quot;r&quot;",
        "Software: phase 9.8.7",
        "Commit: c0ffee123456",
        "Figure: phase",
        "Seeds: 1-3",
    ] {
        assert!(metadata.contains(line), "{line} not in {metadata}");
    }

    let bytes = png(&svg);
    let reader = png::Decoder::new(std::io::Cursor::new(&bytes))
        .read_info()
        .unwrap();
    let info = reader.info();
    assert_eq!(info.width, 1800);
    assert!(info.pixel_dims.is_some());
    let chunks: Vec<(&str, &str)> = info
        .uncompressed_latin1_text
        .iter()
        .map(|chunk| (chunk.keyword.as_str(), chunk.text.as_str()))
        .collect();
    for chunk in [
        ("Software", "phase 9.8.7"),
        ("Commit", "c0ffee123456"),
        ("Figure", "phase"),
        ("Seeds", "1-3"),
    ] {
        assert!(chunks.contains(&chunk), "{chunk:?} not in {chunks:?}");
    }
    let title = &info.utf8_text[0];
    assert_eq!(title.keyword, "Title");
    assert_eq!(title.get_text().unwrap(), "Ω < Ω & \"r\"");
}

#[test]
fn every_figure_can_be_drawn_of_a_table_without_values() {
    let axes = vec![axis(RADIUS, &[0.002, 0.003]), axis(OMEGA, &[0.0, 10.0])];
    let mut sweep = sweep("", axes, &[1]);
    sweep.title = None;
    let table = table(&sweep, |_, _| Some(verdict(Label::Unsettled)));
    let figures = plot::figures();
    assert_eq!(figures[0].name, "phase");
    for figure in figures {
        assert!(!figure.description.is_empty());
        if figure.default_runs.is_none()
            && figure.applies_to(Family::Tank)
            && !["critical-rotation", "net-force", "measures"].contains(&figure.name)
        {
            of_table(figure.name, &sweep, &table).unwrap();
        }
    }
    // A panel per measure that a run has: of none there is nothing to draw.
    let nothing = of_table("measures", &sweep, &table);
    assert!(matches!(nothing, Err(PlotError::NoMeasures)));
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
    assert!(has(&svg, "4 of 7 lines are shown."));
    assert!(!has(&svg, "margin of the spout sieve") && !has(&svg, "packing height / R"));
}

#[test]
fn png_shows_the_colours_of_the_cells() {
    let axes = vec![axis(RADIUS, &[0.002, 0.003]), axis(OMEGA, &[0.0, 10.0])];
    let sweep = sweep("Fluid", axes, &[1]);
    let table = table(&sweep, |_, _| Some(verdict(Label::Fluid)));
    let bytes = png(&of_table("phase", &sweep, &table).unwrap());
    let mut reader = png::Decoder::new(std::io::Cursor::new(&bytes))
        .read_info()
        .unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut pixels).unwrap();
    let share = |color: [u8; 3]| {
        let found = pixels
            .chunks_exact(3)
            .filter(|pixel| **pixel == color)
            .count();
        found as f64 / (pixels.len() / 3) as f64
    };
    let (fluid, white) = (share([0x58, 0xa6, 0xe0]), share([255, 255, 255]));
    assert!(fluid > 0.4, "{fluid}");
    assert!(white > 0.15 && fluid + white > 0.95, "{white}");
}

#[test]
fn refusals_name_what_there_is() {
    let message = |result: Result<Svg, PlotError>| result.unwrap_err().to_string();
    let (sweep, table) = nine();

    let text = message(of_table("phases", &sweep, &table));
    assert!(text.starts_with("there is no figure `phases`; the figures are phase, states, speeds"));

    let mut other = sweep.clone();
    other.plot.x = Some("density".to_owned());
    assert_eq!(
        message(of_table("phase", &other, &table)),
        "[plot] names the axis `density`, but the axes of this sweep are radius, omega"
    );
    other.plot.x = Some("omega".to_owned());
    other.plot.panels = Some("omega".to_owned());
    assert!(message(of_table("phase", &other, &table)).contains("`omega` twice"));

    let mut empty = table.clone();
    empty.rows.clear();
    assert!(message(of_table("phase", &sweep, &empty)).contains("is empty"));

    let mut foreign = table.clone();
    foreign.axes[0] = "density".to_owned();
    assert!(message(of_table("phase", &sweep, &foreign)).contains("density, omega"));

    let mut damaged = table.clone();
    damaged.rows[7].values[1] = f64::NAN;
    assert!(message(of_table("phase", &sweep, &damaged)).contains("run 0000000000000007"));

    let mut bare = sweep.clone();
    bare.axes.clear();
    let mut single = table.clone();
    single.axes.clear();
    single.rows.truncate(1);
    single.rows[0].values.clear();
    assert!(message(of_table("phase", &bare, &single)).contains("no axis"));
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
