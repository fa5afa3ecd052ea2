//! The thesis reproduced: H. E. Rice, Simulation and Phases of Macroscopic Particles in Vortex Flow
//! (University of Mississippi, 2012), against its own numbers and those of an independent
//! implementation of its model.
//!
//! The map, its border and the settle times are read from the published
//! results/theoretical-9x9/labels.csv (three seeds, 1 to 3, per point). That is honest because CI
//! makes that file again and fails when one byte differs.

#![allow(
    clippy::print_stdout,
    reason = "the measured numbers go to those who ask"
)]

use phase::classify::{Label, Sieves, classify};
use phase::classify::{LabelRow, LabelTable};
use phase::record::RunRecord;
use phase::run::run;
use phase::scene::{self, Radii};
use phase::store::read_labels;
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::path::Path;

const TANK_RADIUS: f64 = 0.06;

fn shipped(path: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn published() -> LabelTable {
    read_labels(&shipped("results/theoretical-9x9/labels.csv")).unwrap()
}

/// A run of a shipped scene with another radius (m), Omega (rad/s) and seed.
fn run_of(scene: &str, radius: f64, omega: f64, seed: u64) -> RunRecord {
    let mut scene = scene::Scene::load(&shipped(&format!("sweeps/scenes/{scene}.toml"))).unwrap();
    scene.spheres.radius = Radii::One(radius);
    scene.dem.effects.swirl.as_mut().unwrap().omega = omega;
    scene.seed = seed;
    run(&scene, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// Section 2.5, table after eq. 28: mean speed of the air at the spheres less mean speed of the
/// spheres (m/s) at the end of a realistic run. Radius (mm), Omega (rad/s), the thesis's value, and
/// the mean and range of nine seeds of the independent implementation.
const SPEED_DIFFERENCES: [(f64, f64, f64, f64, [f64; 2]); 6] = [
    (2.0, 30.0, 1.18797, 1.100, [1.065, 1.127]),
    (2.0, 90.0, 4.10134, 4.075, [4.035, 4.095]),
    (2.0, 150.0, 5.90051, 5.861, [5.835, 5.870]),
    (6.0, 30.0, 1.14316, 1.112, [1.063, 1.165]),
    (6.0, 90.0, 3.31572, 3.309, [3.258, 3.347]),
    (6.0, 150.0, 5.88083, 5.744, [5.662, 5.817]),
];

/// Seeds 1 to 5. What another five seeds would do, from the mean and the spread of nine seeds of
/// this program:
///
/// * Five of six within 5 % of the thesis: the gas (2 mm, 30) is at -9 %, so all others must be. At
///   6 mm, 30 the mean of nine is 3.9 % low and that of five scatters by .8 %: a false alarm in
///   about 8 % of sets of seeds. The four others are at least 3 standard deviations inside.
/// * The gas within 15 %: 6 standard deviations inside.
/// * Within one nine-seed range of the independent mean: for two programs of the same normal
///   scatter a false alarm in .08 % of sets of seeds and row (by simulation of five and nine
///   draws), .5 % in all. At 6 mm, 150 the scatter is not normal (one seed of nine is 5 % above
///   the others), which makes it about 2 %.
///
/// These seeds are fixed, so an alarm can only sound when the motion changes.
#[test]
#[ignore = "30 runs, about a minute on two cores"]
fn speed_differences_of_the_realistic_runs() {
    let jobs: Vec<_> = (0..SPEED_DIFFERENCES.len())
        .flat_map(|row| (1..=5).map(move |seed| (row, seed)))
        .collect();
    let differences: Vec<f64> = jobs
        .par_iter()
        .map(|&(row, seed)| {
            let (radius, omega, ..) = SPEED_DIFFERENCES[row];
            let record = run_of("realistic", 1e-3 * radius, omega, seed);
            let observed = &record.observations;
            f64::from(observed.air_speed_mean.last().unwrap() - observed.speed_mean.last().unwrap())
        })
        .collect();
    let mut within_five_percent = 0;
    for (row, seeds) in SPEED_DIFFERENCES.iter().zip(differences.chunks(5)) {
        let &(radius, omega, thesis, independent, [low, high]) = row;
        let mean = seeds.iter().sum::<f64>() / 5.0;
        let error = (mean / thesis - 1.0).abs();
        println!("r = {radius} mm, Omega = {omega}: {mean:.3} of {seeds:.3?}; thesis {thesis:.3}");
        assert!(
            error <= 0.15,
            "{radius} mm, {omega} rad/s: {mean} against {thesis}"
        );
        within_five_percent += usize::from(error <= 0.05);
        assert!(
            (mean - independent).abs() <= high - low,
            "{radius} mm, {omega} rad/s: {mean} against {independent} of the other implementation"
        );
    }
    assert!(
        within_five_percent >= 5,
        "{within_five_percent} of six within 5 %"
    );
}

/// The realistic runs from Omega = 75 on are still spun up when they end (figure 15): kinetic
/// energy of the last half second over that of the half second before, less 1. Points (m, rad/s); 4
/// mm at 75 is left out, where it grows in two runs of three.
const SPINNING_UP: [(f64, f64); 8] = [
    (0.002, 75.0),
    (0.006, 75.0),
    (0.002, 100.0),
    (0.004, 100.0),
    (0.006, 100.0),
    (0.002, 200.0),
    (0.004, 200.0),
    (0.006, 200.0),
];

/// Seeds 1 to 3, of which the median counts. The growth is .17 to .27 with a standard deviation of
/// .03 at most, but .09 with .04 at 4 mm, 100: there one run in a hundred loses energy, two of
/// three in fewer than one of a thousand sets of seeds.
#[test]
#[ignore = "24 runs, about half a minute on two cores"]
fn fast_realistic_runs_still_gain_energy_at_the_end() {
    for (radius, omega) in SPINNING_UP {
        let growth = |seed| {
            let kinetic = run_of("realistic", radius, omega, seed)
                .observations
                .kinetic;
            let sum = |frames: &[f32]| frames.iter().map(|&e| f64::from(e)).sum::<f64>();
            let (earlier, last) = kinetic[kinetic.len() - 1000..].split_at(500);
            sum(last) / sum(earlier) - 1.0
        };
        let growths: Vec<f64> = (1..=3).into_par_iter().map(growth).collect();
        println!("r = {radius} m, Omega = {omega}: kinetic energy grows by {growths:.3?}");
        let median = median(growths);
        assert!(
            median > 0.0,
            "r = {radius} m, Omega = {omega} rad/s: {median}"
        );
    }
}

/// Labels of the independent implementation on the 9 x 9 grid, majority of three seeds, highest
/// Omega first; b stands for settled or fluid.
const MAP: [&str; 9] = [
    "333333333",
    "33333333b",
    "3333333bb",
    "333333bbb",
    "33333bbbb",
    "33354bbbb",
    "3555bbbbb",
    "55bbbbbbb",
    "5bbbbbbbb",
];

/// The majority of a point's three labels, settled and fluid merged; none if all differ.
fn majority(rows: &[LabelRow]) -> Option<char> {
    let merged = |row: &LabelRow| match row.verdict.label {
        Label::SETTLED | Label::FLUID => 'b',
        label => char::from_digit(label.code as u32, 10).unwrap_or('?'),
    };
    let labels: Vec<_> = rows.iter().map(merged).collect();
    let frequent = |label: &&char| labels.iter().filter(|other| other == label).count() >= 2;
    labels.iter().find(frequent).copied()
}

/// Two seeds of one program differ at about 5 % of the points, and majorities of three at fewer:
/// nine or more disagreements of 81 at 5 % are a false alarm of 2 %, at the 3 % of majorities one
/// of a thousand. (The published file is fixed: the alarm can only sound when it is made anew.)
#[test]
fn the_linear_map_agrees() {
    let table = published();
    // Rows: nine radii, for each nine Omega, for each three seeds.
    assert_eq!(table.rows.len(), 9 * 9 * 3);
    let mut disagreements = Vec::new();
    for (point, rows) in table.rows.chunks(3).enumerate() {
        let (column, line) = (point / 9, 8 - point % 9);
        let expected = MAP[line].as_bytes()[column] as char;
        if majority(rows) != Some(expected) {
            disagreements.push((rows[0].values.clone(), majority(rows), expected));
        }
    }
    assert!(disagreements.len() <= 8, "of 81 points: {disagreements:?}");
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The first Omega (rad/s) with a hole of radius 2 r that the pinned sieve accepts, median over
/// seeds, lies in a range: not below it, and at its end there is a hole. Radius (m), and the range
/// of the independent implementation.
const BORDER: [(f64, [f64; 2]); 4] = [
    (0.003, [2.0, 4.0]),
    (0.004, [5.0, 8.0]),
    (0.005, [13.0, 16.0]),
    (0.006, [16.0, 40.0]),
];

/// Seeds 1 to 9: three seeds cannot decide the two close calls. At 3 mm and Omega = 4 six of nine
/// runs have a hole; the median of another nine then fails in 14 % of sets of seeds (that of three
/// would in 26 %, and in the published map does). At 5 mm and Omega = 16 seven of nine have one: 3
/// %. These seeds are fixed, so the alarm can only sound when the motion changes.
#[test]
#[ignore = "72 runs, about a minute on two cores"]
fn the_border_of_the_hole() {
    let sieves = Sieves::default();
    for (radius, [low, high]) in BORDER {
        for (omega, expected) in [(low - 1.0, false), (high, true)] {
            let share = |seed: u64| {
                let record = run_of("theoretical", radius, omega, seed);
                let verdict = classify(&record, &sieves).unwrap();
                verdict.value("pinned_share").unwrap_or(0.0)
            };
            let shares: Vec<f64> = (1..=9_u64).into_par_iter().map(share).collect();
            println!("r = {radius} m, Omega = {omega}: hole in {shares:.2?} of a window");
            let hole = median(shares) >= sieves.pinned.share;
            assert_eq!(hole, expected, "r = {radius} m, Omega = {omega} rad/s");
        }
    }
}

/// The published rows of one radius (m) and Omega (rad/s), one per seed.
fn rows_at(table: &LabelTable, radius: f64, omega: f64) -> impl Iterator<Item = &LabelRow> {
    let here = move |row: &&LabelRow| row.values == [radius, omega];
    table.rows.iter().filter(here)
}

/// For Omega up to 16 large spheres settle faster than small ones; at 40 it reverses. Medians over
/// three seeds, of the four radii below 4 mm and of the four above. They differ by .05 s and more,
/// seeds by .02 s (range of three; .07 s at most), so a false alarm is out of reach.
#[test]
fn settle_times() {
    let table = published();
    let settle = |radii: [f64; 4], omega: f64| {
        let rows = radii.map(|radius| rows_at(&table, radius, omega));
        let times = rows
            .into_iter()
            .flatten()
            .map(|row| row.verdict.value("settle_time"));
        let times: Vec<f64> = times.map(|time| time.unwrap_or(f64::INFINITY)).collect();
        assert_eq!(times.len(), 4 * 3);
        median(times)
    };
    for omega in [0.0, 2.0, 4.0, 6.0, 8.0, 12.0, 16.0, 40.0] {
        let small = settle([0.002, 0.0025, 0.003, 0.0035], omega);
        let large = settle([0.0045, 0.005, 0.0055, 0.006], omega);
        let reversed = omega > 16.0;
        assert_eq!(
            large > small,
            reversed,
            "Omega = {omega}: {large} s for large spheres and {small} s for small ones"
        );
    }
}

/// Spouts occur at small r/R alone (below .07), at and below the critical rotation, and there at
/// every radius. Of the 64 spouts of the 41 x 41 map none is above r/R = .065 and one is above the
/// critical rotation, by 4 %; the first points above it of this grid are 20 % above or more, but
/// for 3.5 mm, where spouts end at .8 of it. So no run of either map, 1924 in all, would be a false
/// alarm here.
#[test]
fn spouts_are_of_small_spheres_below_the_critical_rotation() {
    let table = published();
    let spouts: Vec<_> = table
        .rows
        .iter()
        .filter(|row| matches!(row.verdict.label, Label::SMALL_SPOUT | Label::LARGE_SPOUT))
        .collect();
    for radius in [0.002, 0.0025, 0.003, 0.0035] {
        let mut majorities = table.points().into_iter().filter(|point| {
            let spout = matches!(point.label, Label::SMALL_SPOUT | Label::LARGE_SPOUT);
            spout && point.values[0] == radius
        });
        assert!(majorities.next().is_some(), "no spout of r = {radius} m");
    }
    for row in spouts {
        let [radius, omega] = row.values[..] else {
            panic!("two axes")
        };
        let critical = phase::theory::critical_rotation(256.0, radius, TANK_RADIUS, 9.8);
        assert!(radius / TANK_RADIUS < 0.07, "a spout of r = {radius} m");
        assert!(
            omega <= critical,
            "a spout at {omega} rad/s above {critical} rad/s"
        );
    }
}
