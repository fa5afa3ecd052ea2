//! A map that is in no project: a formula with regions, borders that move with the seed, and false
//! labels.

use super::maps::PublishedMap;
use super::replay::{Oracle, replay};
use super::score::score;
use phase::refine::{AxisScale, Borders, Code, Lattice, LatticeAxis, Rounds, Settings, Trial};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

/// Spread of the borders from seed to seed, as a share of the axis.
const SPREAD: f64 = 0.015;

/// Share of the runs that show a label at random.
const FALSE: f64 = 0.005;

fn axes(count: usize) -> Lattice {
    let values = |from: f64, ratio: f64| {
        let step = |k: usize| from * libm::pow(ratio, k as f64 / (count - 1) as f64);
        (0..count).map(step).collect()
    };
    let linear = (0..count)
        .map(|k| 5.0 * k as f64 / (count - 1) as f64)
        .collect();
    Lattice::new(vec![
        LatticeAxis::new("load", linear, AxisScale::Linear).unwrap(),
        LatticeAxis::new("rate", values(0.1, 100.0), AxisScale::Log).unwrap(),
    ])
    .unwrap()
}

/// Height of the border above which the label is 3, on the unit square.
fn upper(x: f64) -> f64 {
    0.55 + 0.25 * libm::sin(4.0 * x)
}

/// The label at a place of the unit square: below the wavy border a disc of 7 in a field of 1, and
/// a wedge of 5 on the right.
fn label_at(x: f64, y: f64) -> Code {
    let (dx, dy) = (x - 0.3, y - 0.25);
    if y > upper(x) {
        3
    } else if dx * dx + dy * dy < 0.16 * 0.16 {
        7
    } else if x + 0.6 * y > 0.85 {
        5
    } else {
        1
    }
}

struct Blind {
    lattice: Lattice,
    is_noisy: bool,
}

impl Oracle for Blind {
    fn lattice(&self) -> &Lattice {
        &self.lattice
    }

    fn label(&self, run: &Trial) -> Code {
        let unit = self.lattice.unit_of(&run.values).unwrap();
        if !self.is_noisy {
            return label_at(unit[0], unit[1]);
        }
        let place = libm::round(1e4 * unit[0]) as u64 * 20_000 + libm::round(1e4 * unit[1]) as u64;
        let mut random = Pcg64::seed_from_u64(place.wrapping_mul(1000).wrapping_add(run.seed));
        if random.random::<f64>() < FALSE {
            return [1, 3, 5, 7][random.random_range(0..4)];
        }
        let mut normal = || (0..12).map(|_| random.random::<f64>()).sum::<f64>() - 6.0;
        label_at(unit[0] + SPREAD * normal(), unit[1] + SPREAD * normal())
    }
}

fn truth(lattice: &Lattice) -> PublishedMap {
    let axes = lattice.clone();
    PublishedMap::from_formula(lattice.clone(), 1..=1, move |values, _| {
        let unit = axes.unit_of(values).unwrap();
        label_at(unit[0], unit[1])
    })
}

fn replayed(oracle: &Blind, settings: &Settings) -> Rounds {
    replay(oracle, settings, |_| Ok(())).unwrap()
}

#[test]
fn a_twelfth_of_the_runs_gives_the_labels_of_a_map_with_noise() {
    let lattice = axes(33);
    let oracle = Blind {
        lattice: lattice.clone(),
        is_noisy: true,
    };
    let mut settings = Settings::with_budget(90);
    settings.replicates = 2;
    let mut rounds = replayed(&oracle, &settings);
    let found = score(&truth(&lattice), &mut rounds, 1).unwrap();
    assert!(found.right > 0.955, "{found:?}");
    assert!(found.covered[1] > 0.95 && found.held[1] > 0.95, "{found:?}");
    assert!(found.area[1] < 0.5, "{found:?}");
}

#[test]
fn without_noise_labels_are_better_and_bands_are_narrower() {
    let lattice = axes(33);
    let scores = [true, false].map(|is_noisy| {
        let oracle = Blind {
            lattice: lattice.clone(),
            is_noisy,
        };
        let settings = Settings::with_budget(108);
        score(&truth(&lattice), &mut replayed(&oracle, &settings), 1).unwrap()
    });
    let [noisy, plain] = scores;
    assert!(plain.right > 0.98, "{plain:?}");
    assert!(plain.covered[1] > 0.95, "{plain:?}");
    assert!(plain.width < noisy.width, "{noisy:?} {plain:?}");
}

#[test]
fn intervals_hold_the_border_of_the_formula() {
    let lattice = axes(33);
    let oracle = Blind {
        lattice: lattice.clone(),
        is_noisy: true,
    };
    let settings = Settings::with_budget(108);
    let mut rounds = replayed(&oracle, &settings);
    let map = rounds.map().unwrap();
    let borders = Borders::new(&lattice, map, 1).unwrap();
    let [load, rate] = [0, 1].map(|axis| &lattice.axes()[axis]);
    let (mut held, mut columns) = (0, 0);
    for value in load.values() {
        let wanted = rate.value(upper(load.unit(*value)));
        let mut here = borders.crossings.iter();
        columns += 1;
        held += usize::from(here.any(|crossing| {
            let [low, high] = crossing.band95;
            crossing.values[0] == *value
                && crossing.labels[1] == 3
                && low <= wanted
                && wanted <= high
        }));
    }
    assert!(held * 100 >= columns * 93, "{held} of {columns}");
}

#[test]
fn probabilities_are_calibrated() {
    // Where the map promises p on average, new seeds show the label with about that probability.
    let lattice = axes(33);
    let oracle = Blind {
        lattice: lattice.clone(),
        is_noisy: true,
    };
    let settings = Settings::with_budget(108);
    let mut rounds = replayed(&oracle, &settings);
    let map = rounds.map().unwrap();
    for (low, high) in [(0.3, 0.7), (0.7, 0.9), (0.9, 0.975), (0.975, 1.0)] {
        let within = |place: &usize| (low..high).contains(&map.certainty(*place));
        let places: Vec<usize> = (0..lattice.places()).filter(within).collect();
        let shown = |place: &usize| {
            let seeds = (100..120).map(|seed| Trial {
                values: lattice.values(*place),
                seed,
            });
            seeds
                .filter(|run| oracle.label(run) == map.label(*place))
                .count() as f64
                / 20.0
        };
        let promised = places
            .iter()
            .map(|place| map.certainty(*place))
            .sum::<f64>();
        let kept = places.iter().map(shown).sum::<f64>();
        let count = places.len() as f64;
        let (promised, kept) = (promised / count, kept / count);
        assert!(
            kept > promised - 0.1,
            "{low} to {high}: {kept} of {promised}, {count}"
        );
        assert!(
            kept < promised + 0.25,
            "{low} to {high}: {kept} of {promised}, {count}"
        );
    }
}
