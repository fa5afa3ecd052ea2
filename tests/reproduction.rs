//! The thesis reproduced: H. E. Rice, Simulation and Phases of Macroscopic Particles in Vortex Flow
//! (University of Mississippi, 2012), against its own numbers and those of an independent
//! implementation of its model.
//!
//! The map, its border and the settle times are read from the published
//! results/theoretical-9x9/labels.csv (three seeds, 1 to 3, per point). That is honest because CI
//! makes that file again and fails when one byte differs.

#![allow(clippy::unwrap_used, reason = "a test may panic")]
#![allow(
    clippy::print_stdout,
    reason = "the measured numbers go to those who ask"
)]

use phase::classify::{Label, Sieves, classify};
use phase::run::run;
use phase::scene::{self, Radii};
use phase::store::read_labels;
use phase::sweep::{LabelRow, LabelTable};
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

/// Seeds 1 to 5. One seed scatters by about a third of the nine-seed range, the mean of five by a
/// seventh of it (about 1 % of the value), so that 5 % and 15 % leave false alarms below 1e-3. The
/// mean of five differs from that of nine by .25 of the range in one standard deviation: four of
/// them, a whole range, is a false alarm in fewer than one of a thousand runs of this test.
#[test]
#[ignore = "30 runs, about a minute on two cores"]
fn speed_differences_of_the_realistic_runs() {
    let base = scene::load(&shipped("sweeps/scenes/realistic.toml")).unwrap();
    let jobs: Vec<_> = (0..SPEED_DIFFERENCES.len())
        .flat_map(|row| (1..=5).map(move |seed| (row, seed)))
        .collect();
    let differences: Vec<f64> = jobs
        .par_iter()
        .map(|&(row, seed)| {
            let (radius, omega, ..) = SPEED_DIFFERENCES[row];
            let mut scene = base.clone();
            scene.spheres.radius = Radii::One(1e-3 * radius);
            scene.swirl.as_mut().unwrap().omega = omega;
            scene.seed = seed;
            let record = run(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
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
        Label::Settled | Label::Fluid => 'b',
        label => char::from_digit(label.code() as u32, 10).unwrap_or('?'),
    };
    let labels: Vec<_> = rows.iter().map(merged).collect();
    let frequent = |label: &&char| labels.iter().filter(|other| other == label).count() >= 2;
    labels.iter().find(frequent).copied()
}

/// Two seeds of one program differ at about 5 % of the points, and majorities of three at fewer:
/// nine or more disagreements of 81 at 5 % are a false alarm of 2 %, at the 3 % of majorities one of
/// a thousand. (The published file is fixed: the alarm can only sound when it is made anew.)
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

/// Of the rows of one radius (m) and Omega (rad/s), the median over seeds of a value.
fn median_at(table: &LabelTable, radius: f64, omega: f64, value: impl Fn(&LabelRow) -> f64) -> f64 {
    let rows = table
        .rows
        .iter()
        .filter(|row| row.values == [radius, omega]);
    median(rows.map(value).collect())
}

const OMEGAS: [f64; 9] = [0.0, 2.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 40.0];

/// The first Omega (rad/s) with a hole of radius 2 r that the pinned sieve accepts, median over
/// seeds, lies in a range: not below it, and at its end there is a hole. Radius (m), and the range
/// of the independent implementation.
const BORDER: [(f64, [f64; 2]); 4] = [
    (0.003, [2.0, 4.0]),
    (0.004, [5.0, 8.0]),
    (0.005, [13.0, 16.0]),
    (0.006, [16.0, 40.0]),
];

/// Seeds 1 to 9. At the one close call, r = 3 mm and Omega = 4, seven of ten seeds have a hole: the
/// median of nine then fails in one of ten sets of seeds. These seeds are fixed, so the alarm can
/// only sound when the motion changes.
#[test]
#[ignore = "72 runs, about a minute on two cores"]
fn the_border_of_the_hole() {
    let base = scene::load(&shipped("sweeps/scenes/theoretical.toml")).unwrap();
    let sieves = Sieves::default();
    for (radius, [low, high]) in BORDER {
        for (omega, expected) in [(low - 1.0, false), (high, true)] {
            let share = |seed: u64| {
                let mut scene = base.clone();
                scene.spheres.radius = Radii::One(radius);
                scene.swirl.as_mut().unwrap().omega = omega;
                scene.seed = seed;
                let record = run(&scene, &mut |_| ControlFlow::Continue(())).unwrap();
                classify(&record, &sieves)
                    .unwrap()
                    .evidence
                    .pinned_share
                    .unwrap_or(0.0)
            };
            let shares: Vec<f64> = (1..=9_u64).into_par_iter().map(share).collect();
            println!("r = {radius} m, Omega = {omega}: hole in {shares:.2?} of a window");
            let hole = median(shares) >= sieves.pinned.share;
            assert_eq!(hole, expected, "r = {radius} m, Omega = {omega} rad/s");
        }
    }
}

/// For Omega up to 16 large spheres settle faster than small ones; at 40 it reverses.
#[test]
fn settle_times() {
    let table = published();
    let settle = |radius: f64, omega: f64| {
        median_at(&table, radius, omega, |row| {
            row.verdict.settle_time.unwrap_or(f64::INFINITY)
        })
    };
    for omega in OMEGAS {
        let (small, large) = (settle(0.002, omega), settle(0.006, omega));
        match omega {
            ..=16.0 => assert!(large < small, "Omega = {omega}: {large} s and {small} s"),
            40.0.. => assert!(large > small, "Omega = {omega}: {large} s and {small} s"),
            _ => {}
        }
    }
}

/// Spouts occur at small r/R alone, at and below the critical rotation.
#[test]
fn spouts_are_of_small_spheres_below_the_critical_rotation() {
    let table = published();
    let spouts: Vec<_> = table
        .rows
        .iter()
        .filter(|row| matches!(row.verdict.label, Label::SmallSpout | Label::LargeSpout))
        .collect();
    assert!(spouts.len() >= 15, "{} spouts", spouts.len());
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
