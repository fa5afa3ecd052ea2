//! Properties that hold for all maps.

use phase::refine::{
    AxisScale, Borders, Code, Finish, Lattice, LatticeAxis, ModelKind, Observations, Round, Rounds,
    Settings, Trial, probabilities,
};
use proptest::prelude::*;

fn square(count: usize) -> Lattice {
    let axis = |name| {
        // Distances are exact, so that mirrored places have the same.
        let values = (0..=count).map(|k| k as f64 / count as f64);
        LatticeAxis::new(name, values.collect(), AxisScale::Linear).unwrap()
    };
    Lattice::new(vec![axis("x"), axis("y")]).unwrap()
}

/// Two lines part three labels.
fn label(values: &[f64], tilt: f64, height: f64) -> Code {
    let (x, y) = (values[0], values[1]);
    if y > height + tilt * (x - 0.5) {
        3
    } else if x > 0.4 {
        2
    } else {
        1
    }
}

fn observed(lattice: &Lattice, places: &[usize], tilt: f64, height: f64) -> Observations {
    let mut runs = Observations::new();
    for place in places {
        let values = lattice.values(*place);
        let label = label(&values, tilt, height);
        runs.add(Trial { values, seed: 1 }, label).unwrap();
    }
    runs
}

/// Rounds that have learnt these runs.
fn after(lattice: &Lattice, runs: &Observations, settings: &Settings) -> Rounds {
    let mut rounds = Rounds::new(lattice.clone(), settings.clone()).unwrap();
    for (run, label) in runs.iter() {
        rounds.learn(run.clone(), label).unwrap();
    }
    rounds
}

/// The runs of the round after these runs; none if it was the last.
fn next(lattice: &Lattice, runs: &Observations, settings: &Settings) -> Vec<Trial> {
    match after(lattice, runs, settings).next_round().unwrap() {
        Round::Runs(round) => round,
        Round::Finished(_) => Vec::new(),
    }
}

/// All runs of a replay of so many runs, from those given.
fn replayed(lattice: &Lattice, runs: &Observations, settings: &Settings) -> Observations {
    let mut rounds = after(lattice, runs, settings);
    while let Round::Runs(round) = rounds.next_round().unwrap() {
        // Workers end in any order.
        for run in round.into_iter().rev() {
            let label = label(&run.values, 0.3, 0.6);
            rounds.learn(run, label).unwrap();
        }
    }
    rounds.runs().clone()
}

fn models() -> impl Strategy<Value = ModelKind> {
    prop::sample::select(ModelKind::ALL.to_vec())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn probabilities_are_probabilities(
        places in prop::collection::vec(0..289_usize, 2..40),
        model in models(),
        tilt in -1.0..1.0_f64,
    ) {
        let lattice = square(16);
        let runs = observed(&lattice, &places, tilt, 0.5);
        let settings = Settings { model, ..Settings::with_budget(100) };
        let map = probabilities(&lattice, &runs, &settings).unwrap();
        for place in 0..map.places() {
            let at = map.at(place);
            prop_assert!(at.iter().all(|p| (0.0..=1.0).contains(p)));
            prop_assert!((at.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_order_in_which_runs_end_does_not_matter(
        places in prop::collection::vec(0..289_usize, 20..40),
        model in models(),
    ) {
        let lattice = square(16);
        let mut settings = Settings { model, ..Settings::with_budget(100) };
        settings.start = vec![1];
        let runs = observed(&lattice, &places, 0.3, 0.5);
        let reversed: Vec<usize> = places.into_iter().rev().collect();
        let other = observed(&lattice, &reversed, 0.3, 0.5);
        prop_assert_eq!(
            next(&lattice, &runs, &settings),
            next(&lattice, &other, &settings)
        );
    }

    #[test]
    fn a_mirrored_map_is_chosen_in_the_mirror(
        places in prop::collection::vec(0..289_usize, 25..40),
        model in models(),
        tilt in 0.1..1.0_f64,
    ) {
        let lattice = square(16);
        let mut settings = Settings { model, ..Settings::with_budget(100) };
        settings.exploring = 0.0;
        settings.start = vec![1];
        settings.round = 1;
        let runs = observed(&lattice, &places, tilt, 0.45);
        let mut mirrored = Observations::new();
        let flip = |run: &Trial| Trial {
            values: vec![1.0 - run.values[0], run.values[1]],
            seed: run.seed,
        };
        for (run, label) in runs.iter() {
            mirrored.add(flip(run), label).unwrap();
        }
        // Rounding differs in the mirror, so that the choice may fall on another place of nearly
        // equal margin.
        let [map, other] = [&runs, &mirrored].map(|runs| {
            probabilities(&lattice, runs, &settings).unwrap()
        });
        for place in 0..lattice.places() {
            let indices = lattice.indices(place);
            let twin = lattice.place(&[16 - indices[0], indices[1]]);
            for (one, two) in map.at(place).iter().zip(other.at(twin)) {
                prop_assert!((one - two).abs() < 1e-6, "{one} {two}");
            }
        }
        let margin = |run: &Trial| {
            let indices: Vec<usize> = run.values.iter().map(|it| (it * 16.0) as usize).collect();
            let mut at = map.at(lattice.place(&indices)).to_vec();
            at.sort_by(f64::total_cmp);
            at[at.len() - 1] - if at.len() > 1 { at[at.len() - 2] } else { 0.0 }
        };
        let round = next(&lattice, &runs, &settings);
        let twins = next(&lattice, &mirrored, &settings);
        if round[0].values[0] != 0.5 && round[0].values[0] != 0.0 {
            prop_assert!((margin(&round[0]) - margin(&flip(&twins[0]))).abs() < 1e-5);
        }
    }
}

#[test]
fn a_replay_that_goes_on_from_some_runs_is_the_same() {
    let lattice = square(20);
    let none = Observations::new();
    let mut settings = Settings::with_budget(68);
    let all = replayed(&lattice, &none, &settings);
    assert_eq!(all, replayed(&lattice, &none, &settings));
    // Stopped after two rounds, and in the middle of the start.
    for budget in [52, 20] {
        settings.budget = budget;
        let some = replayed(&lattice, &none, &settings);
        assert_eq!(some.len(), budget);
        settings.budget = 68;
        assert_eq!(replayed(&lattice, &some, &settings), all, "{budget}");
    }
}

/// The runs that are missing when the same rounds are chosen again from the labels that are known:
/// those of the first round that is not complete.
fn missing(lattice: &Lattice, known: &Observations, settings: &Settings) -> Vec<Trial> {
    let mut rounds = Rounds::new(lattice.clone(), settings.clone()).unwrap();
    loop {
        let round = match rounds.next_round().unwrap() {
            Round::Runs(round) => round,
            Round::Finished(finish) => {
                assert_eq!(finish, Finish::Budget);
                return Vec::new();
            }
        };
        let mut missing = Vec::new();
        for run in round {
            match known.label(&run) {
                Some(label) => rounds.learn(run, label).unwrap(),
                None => missing.push(run),
            }
        }
        if !missing.is_empty() {
            return missing;
        }
    }
}

#[test]
fn a_stop_inside_a_round_changes_nothing() {
    let lattice = square(20);
    let settings = Settings::with_budget(68);
    let all = replayed(&lattice, &Observations::new(), &settings);
    assert_eq!(missing(&lattice, &all, &settings), []);
    let at = |run: &Trial| label(&run.values, 0.3, 0.6);
    // Every third run of the round that is open was made, and the stop is at several rounds.
    for budget in [0, 36, 52, 60] {
        let mut known = Observations::new();
        if budget > 0 {
            let settings = Settings::with_budget(budget);
            known = replayed(&lattice, &known, &settings);
        }
        let round = next(&lattice, &known, &settings);
        for run in round.iter().step_by(3) {
            known.add(run.clone(), at(run)).unwrap();
        }
        let missing = missing(&lattice, &known, &settings);
        assert_eq!(missing.len(), round.len() - round.len().div_ceil(3));
        for run in missing {
            let label = at(&run);
            known.add(run, label).unwrap();
        }
        assert_eq!(replayed(&lattice, &known, &settings), all, "{budget}");
    }
}

#[test]
fn more_runs_make_bands_narrower() {
    let lattice = square(24);
    let width = |budget| {
        let settings = Settings::with_budget(budget);
        let runs = replayed(&lattice, &Observations::new(), &settings);
        let map = probabilities(&lattice, &runs, &settings).unwrap();
        let borders = Borders::new(&lattice, &map, 1).unwrap();
        let widths = borders.widths();
        let of_all: f64 = widths.iter().map(|it| it.mean * it.crossings as f64).sum();
        of_all / borders.crossings.len() as f64
    };
    let widths = [36, 80, 140].map(width);
    // The narrowest take 95 % of a step of the grid.
    let step = 1.0 / 23.0;
    assert!(
        widths[0] > 1.2 * widths[1] && widths[1] > 1.1 * widths[2] && widths[2] < step,
        "{widths:?}"
    );
}

#[test]
fn replicates_go_where_seeds_disagree() {
    // Below 0.5 the label is certain, above it changes with the seed.
    let lattice = square(10);
    let mut settings = Settings::with_budget(200);
    settings.replicates = 3;
    settings.exploring = 0.0;
    let mut rounds = Rounds::new(lattice, settings).unwrap();
    while let Round::Runs(round) = rounds.next_round().unwrap() {
        for run in round {
            let parity = (run.values[0] * 37.0 + run.values[1] * 23.0) as u64 + run.seed;
            let label = if run.values[1] < 0.5 {
                1
            } else {
                2 + (parity % 2) as Code
            };
            rounds.learn(run, label).unwrap();
        }
    }
    let again = |is_low: bool| {
        let extra = rounds
            .runs()
            .iter()
            .filter(|(run, _)| run.seed > 1 && (run.values[1] < 0.45) == is_low);
        extra.count()
    };
    assert!(
        again(false) > 4 * again(true),
        "{} {}",
        again(false),
        again(true)
    );
}
