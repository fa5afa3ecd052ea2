//! Runs against labels right, with published maps as oracles:
//!
//! ```text
//! cargo run --release --example oracle -- results [MAP ...]
//! ```
//!
//! Each map is replayed with each model. Maps of one seed are replayed as they are, and with noise
//! that makes seeds agree as often as those of the small map beside them; the default model is then
//! replayed with up to three seeds a place too. Large maps are replayed with other shares of
//! exploring runs as well. One line each 1 % of the runs of a large map, in the columns
//!
//! - model, and share of exploring runs (per cent);
//! - most seeds of one place; share of the map's runs (per cent), runs, and places among them;
//! - labels right (per cent), with `settled` and `fluid` apart and merged;
//! - borders of merged labels in the bands of 68 and 95 % (per cent), and the area of the bands;
//! - borders along an axis (Ω, the opening of silos) in the intervals of 68 and 95 % (per cent),
//!   and the mean length of the latter (per cent of the axis);
//! - mean time of a round (milliseconds): a fit, the map and the choice.
#![allow(clippy::print_stdout, reason = "the example prints a table")]

mod maps;
mod noise;
mod replay;
mod score;

use maps::PublishedMap;
use noise::{NoisyMap, agreement};
use phase::refine::{Code, ModelKind, RefineError, Rounds, Settings};
use replay::{Oracle, replay};
use score::{merged, score};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A published map and how it is replayed.
#[derive(Clone, Copy)]
struct Case {
    name: &'static str,
    /// The map with more seeds that tells its noise.
    sample: Option<&'static str>,
    /// Coarse grid.
    start: &'static [usize],
    /// Most runs, and runs between two lines, in per cent of the places.
    most: f64,
    step: f64,
    /// Axis of the intervals.
    axis: usize,
}

/// A map of 41 x 41 places with one seed.
const fn large(name: &'static str, sample: &'static str) -> Case {
    Case {
        name,
        sample: Some(sample),
        start: &[6],
        most: 10.0,
        step: 1.0,
        axis: 1,
    }
}

/// A map with few places.
const fn small(name: &'static str, start: &'static [usize]) -> Case {
    Case {
        name,
        sample: None,
        start,
        most: 90.0,
        step: 15.0,
        axis: 1,
    }
}

const CASES: [Case; 6] = [
    large("theoretical", "theoretical-9x9"),
    large("theoretical-quadratic", "theoretical-quadratic-9x9"),
    small("theoretical-9x9", &[4]),
    small("theoretical-quadratic-9x9", &[4]),
    Case {
        axis: 0,
        ..small("silo", &[4, 3])
    },
    small("density-friction", &[2]),
];

const HEADER: &str = "model        exploring    seeds runs%  runs places | right merged \
                      | in 68 in 95  area 68 95 | in 68 in 95 width | ms";

/// Shares of exploring runs beside the default of 12.5 (per cent).
const EXPLORING: [f64; 3] = [10.0, 15.0, 100.0 / 6.0];

/// Seeds that the majority labels of a noisy map come from.
const SEEDS: u64 = 25;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let root = PathBuf::from(arguments.next().unwrap_or_else(|| "results".to_owned()));
    let only: Vec<String> = arguments.collect();
    let read = |name: &str| PublishedMap::read(&root.join(name).join(Path::new("labels.csv")));
    for case in CASES {
        let Case { name, sample, .. } = case;
        if !only.is_empty() && !only.iter().any(|it| it == name) {
            continue;
        }
        let map = read(name)?;
        println!("# {name}: {} places", map.lattice().places());
        if map.at(0).len() > 1 {
            agreements(&map);
        }
        compare(&map, &map, case)?;
        if let Some(sample) = sample {
            let noisy = NoisyMap::calibrated(map, &read(sample)?);
            println!("# {name} with noise: spread of {:.2} steps", noisy.spread());
            let truth = noisy.with_seeds(SEEDS);
            agreements(&truth);
            compare(&noisy, &truth, case)?;
        }
    }
    Ok(())
}

/// Prints how often seeds agree with each other, and with the majority.
fn agreements(map: &PublishedMap) {
    let with_majority = |code_of: fn(Code) -> Code| {
        let places = map.lattice().places();
        let shares = (0..places).map(|place| {
            let label = code_of(map.label(place));
            let same = map
                .at(place)
                .iter()
                .filter(|(_, code)| code_of(*code) == label);
            same.count() as f64 / map.at(place).len() as f64
        });
        100.0 * shares.sum::<f64>() / places as f64
    };
    println!(
        "# two seeds agree in {:.1} %, one with the majority in {:.1} % (merged {:.1} %)",
        100.0 * agreement(map),
        with_majority(|code| code),
        with_majority(merged)
    );
}

fn compare(oracle: &dyn Oracle, truth: &PublishedMap, case: Case) -> Result<(), RefineError> {
    println!("{HEADER}");
    let places = truth.lattice().places();
    let budget = libm::round(case.most / 100.0 * places as f64) as usize;
    let defaults = Settings {
        start: case.start.to_vec(),
        replicates: 1,
        ..Settings::with_budget(budget)
    };
    let print = |settings: &Settings| table(oracle, truth, case, settings);
    // Published labels have no margins.
    for model in [ModelKind::Regression, ModelKind::Propagation] {
        print(&Settings {
            model,
            ..defaults.clone()
        })?;
    }
    if case.sample.is_some() && truth.at(0).len() == 1 {
        for percent in EXPLORING {
            print(&Settings {
                exploring: percent / 100.0,
                ..defaults.clone()
            })?;
        }
    }
    if truth.at(0).len() > 1 {
        print(&Settings {
            replicates: 3,
            ..defaults
        })?;
    }
    Ok(())
}

fn table(
    oracle: &dyn Oracle,
    truth: &PublishedMap,
    case: Case,
    settings: &Settings,
) -> Result<(), RefineError> {
    let places = truth.lattice().places();
    let (model, replicates, budget) = (settings.model, settings.replicates, settings.budget);
    let mut next = 0.0;
    let mut rounds = 0;
    let mut clock = Instant::now();
    replay(oracle, settings, |found: &mut Rounds| {
        rounds += 1;
        let runs = found.runs();
        let share = 100.0 * runs.len() as f64 / places as f64;
        if share < next && runs.len() < budget {
            return Ok(());
        }
        // Rounds that end a little before a line count.
        next = case.step * libm::floor(share / case.step + 1.15) - 0.11;
        let mut at: Vec<&[f64]> = runs.iter().map(|(run, _)| run.values.as_slice()).collect();
        at.dedup();
        let (runs, at) = (runs.len(), at.len());
        let score = score(truth, found, case.axis)?;
        let time = clock.elapsed().as_secs_f64() / f64::from(rounds);
        println!(
            "{:12} {:9.1} {replicates:8} {share:5.1} {runs:5} {at:6} | {:5.1} {:6.1} | {:5.1} \
             {:5.1} {:5.1} {:5.1} | {:5.1} {:5.1} {:5.1} | {:.0}",
            model.name(),
            100.0 * settings.exploring,
            100.0 * score.right,
            100.0 * score.right_merged,
            100.0 * score.covered[0],
            100.0 * score.covered[1],
            100.0 * score.area[0],
            100.0 * score.area[1],
            100.0 * score.held[0],
            100.0 * score.held[1],
            100.0 * score.width,
            1e3 * time
        );
        (clock, rounds) = (Instant::now(), 0);
        Ok(())
    })?;
    Ok(())
}
