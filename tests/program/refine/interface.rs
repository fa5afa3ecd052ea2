//! Refining as a user of the library sees it.

use phase::refine::{
    AxisScale, Borders, Code, Finish, Gap, Lattice, LatticeAxis, LatticePlane, ModelKind,
    Observations, Round, Rounds, Settings, Trial, probabilities, widths,
};

/// A quarter disc of label 1 in a field of 3, by the values of the axes.
fn label(values: &[f64]) -> Code {
    let (x, y) = (values[0] / 8.0, values[1] / 8.0);
    if x * x + y * y < 0.5 { 1 } else { 3 }
}

fn square(count: usize) -> Lattice {
    let axis = |name| {
        let values = (0..count).map(|k| 8.0 * k as f64 / (count - 1) as f64);
        LatticeAxis::new(name, values.collect(), AxisScale::Linear).unwrap()
    };
    Lattice::new(vec![axis("x"), axis("y")]).unwrap()
}

/// Makes rounds until none is left, and says why none is.
fn finished(
    lattice: &Lattice,
    settings: &Settings,
    label: impl Fn(&Trial) -> Code,
) -> (Observations, Finish) {
    let mut rounds = Rounds::new(lattice.clone(), settings.clone()).unwrap();
    loop {
        match rounds.next_round().unwrap() {
            Round::Runs(round) => {
                for run in round {
                    let label = label(&run);
                    rounds.learn(run, label).unwrap();
                }
            }
            Round::Finished(finish) => return (rounds.runs().clone(), finish),
        }
    }
}

/// The runs of all rounds.
fn refine(lattice: &Lattice, settings: &Settings, label: impl Fn(&Trial) -> Code) -> Observations {
    finished(lattice, settings, label).0
}

/// The runs of the first round.
fn first_round(lattice: &Lattice, settings: &Settings) -> Vec<Trial> {
    let mut rounds = Rounds::new(lattice.clone(), settings.clone()).unwrap();
    match rounds.next_round().unwrap() {
        Round::Runs(round) => round,
        Round::Finished(finish) => panic!("{finish:?}"),
    }
}

#[test]
fn a_table_with_a_budget_alone_has_defaults() {
    let settings: Settings = serde_json::from_str(r#"{ "budget": 60 }"#).unwrap();
    assert_eq!(settings, Settings::with_budget(60));
    assert_eq!(
        (settings.round, settings.start.as_slice()),
        (8, [6].as_slice())
    );
    assert_eq!(settings.model, ModelKind::Propagation);
    let text = serde_json::to_string(&settings).unwrap();
    assert_eq!(serde_json::from_str::<Settings>(&text).unwrap(), settings);
}

#[test]
fn tables_name_models_and_refuse_other_keys() {
    let text = r#"{ "budget": 9, "model": "regression", "width": 0.05 }"#;
    let settings: Settings = serde_json::from_str(text).unwrap();
    assert_eq!(settings.model, ModelKind::Regression);
    for kind in ModelKind::ALL {
        let name = serde_json::to_string(&kind).unwrap();
        assert_eq!(name, format!("\"{}\"", kind.name()));
    }
    let error = serde_json::from_str::<Settings>(r#"{ "budget": 9, "rounds": 4 }"#).unwrap_err();
    assert!(
        error.to_string().contains("unknown field `rounds`"),
        "{error}"
    );
}

#[test]
fn settings_out_of_range_are_refused() {
    let lattice = square(9);
    let refused = |change: fn(&mut Settings)| {
        let mut settings = Settings::with_budget(20);
        change(&mut settings);
        let error = Rounds::new(lattice.clone(), settings).unwrap_err();
        error.to_string()
    };
    assert_eq!(
        refused(|it| it.budget = 0),
        "`refine.budget` must be 1 or more"
    );
    assert_eq!(
        refused(|it| it.exploring = 1.5),
        "`refine.exploring` must be from 0 to 1"
    );
    assert_eq!(
        refused(|it| it.start = vec![2, 2, 2]),
        "`refine.start` must have one number, or one for each axis"
    );
    assert_eq!(
        refused(|it| it.width = Some(f64::NAN)),
        "`refine.width` must be from 0 to 1"
    );
}

#[test]
fn axes_that_cannot_be_are_refused() {
    let axis = |values: &[f64], scale| {
        let axis = LatticeAxis::new("rate", values.to_vec(), scale);
        axis.err().map(|error| error.to_string())
    };
    let refusal = |reason| Some(format!("axis `rate`: {reason}"));
    assert_eq!(axis(&[], AxisScale::Linear), refusal("it has no values"));
    assert_eq!(
        axis(&[1.0, 1.0], AxisScale::Rank),
        refusal("the values do not ascend")
    );
    assert_eq!(
        axis(&[0.0, 1.0], AxisScale::Log),
        refusal("a logarithmic axis needs values above 0")
    );
    assert_eq!(
        axis(&[1.0, f64::NAN], AxisScale::Linear),
        refusal("a value is not finite")
    );
    assert!(Lattice::new(Vec::new()).is_err());
}

#[test]
fn the_start_is_a_coarse_grid_with_the_corners() {
    let mut settings = Settings::with_budget(100);
    settings.start = vec![3, 2];
    let round = first_round(&square(9), &settings);
    let values: Vec<&[f64]> = round.iter().map(|run| run.values.as_slice()).collect();
    let expected = [
        [0.0, 0.0],
        [0.0, 8.0],
        [4.0, 0.0],
        [4.0, 8.0],
        [8.0, 0.0],
        [8.0, 8.0],
    ];
    assert_eq!(values, expected);
    assert!(round.iter().all(|run| run.seed == 1));
}

#[test]
fn the_budget_is_spent_and_no_run_is_made_twice() {
    let lattice = square(17);
    let settings = Settings::with_budget(61);
    let (runs, finish) = finished(&lattice, &settings, |run| label(&run.values));
    assert_eq!(runs.len(), 61);
    assert_eq!(finish, Finish::Budget);
    let map = probabilities(&lattice, &runs, &settings).unwrap();
    let is_right = |place: &usize| map.label(*place) == label(&lattice.values(*place));
    let right = (0..lattice.places()).filter(is_right).count();
    assert!(right >= 286, "{right} of 289");
}

#[test]
fn refining_ends_when_borders_are_narrow() {
    let lattice = square(17);
    let mut settings = Settings::with_budget(289);
    settings.width = Some(0.08);
    let (runs, finish) = finished(&lattice, &settings, |run| label(&run.values));
    assert!(runs.len() < 120, "{}", runs.len());
    assert_eq!(finish, Finish::Width);
    let map = probabilities(&lattice, &runs, &settings).unwrap();
    let widths = widths(&lattice, &map);
    assert_eq!(widths.len(), 1);
    assert_eq!(widths[0].labels, [1, 3]);
    assert!(widths[0].mean <= 0.08 && widths[0].mean <= widths[0].widest);
}

#[test]
fn a_small_lattice_is_run_completely() {
    let lattice = square(4);
    let mut settings = Settings::with_budget(1000);
    settings.replicates = 1;
    let (runs, finish) = finished(&lattice, &settings, |run| label(&run.values));
    assert_eq!(runs.len(), 16);
    assert_eq!(finish, Finish::Complete);
    assert_eq!(Gap::new(&lattice, &runs).unwrap().radius, 0.0);
}

#[test]
fn replicates_have_further_seeds() {
    let lattice = square(4);
    let mut settings = Settings::with_budget(1000);
    settings.first_seed = 5;
    let runs = refine(&lattice, &settings, |run| label(&run.values));
    assert_eq!(runs.len(), 48);
    for seed in 5..=7 {
        assert_eq!(runs.iter().filter(|(run, _)| run.seed == seed).count(), 16);
    }
}

#[test]
fn one_label_everywhere_has_no_borders() {
    let lattice = square(9);
    let settings = Settings::with_budget(50);
    for model in ModelKind::ALL {
        let settings = Settings {
            model,
            ..settings.clone()
        };
        let runs = refine(&lattice, &settings, |_| -1);
        let map = probabilities(&lattice, &runs, &settings).unwrap();
        assert_eq!((map.codes(), map.certainty(40)), ([-1].as_slice(), 1.0));
        assert_eq!(widths(&lattice, &map), []);
    }
}

#[test]
fn crossings_and_curves_lie_on_the_border() {
    let lattice = square(17);
    let settings = Settings::with_budget(80);
    let runs = refine(&lattice, &settings, |run| label(&run.values));
    let map = probabilities(&lattice, &runs, &settings).unwrap();
    let radius = 8.0 * 0.5_f64.sqrt();
    let borders = Borders::new(&lattice, &map, 1).unwrap();
    assert!(borders.crossings.len() >= 11);
    for crossing in &borders.crossings {
        let (x, y) = (crossing.values[0], crossing.values[1]);
        assert_eq!(crossing.labels, [1, 3]);
        // Columns where the border is steep tell little.
        if x < 4.5 {
            assert!(
                ((x * x + y * y).sqrt() - radius).abs() < 0.35,
                "{crossing:?}"
            );
        }
        let ([a, b], [c, d]) = (crossing.band68, crossing.band95);
        assert!(c <= a && a <= y && y <= b && b <= d, "{crossing:?}");
    }
    assert!(Borders::new(&lattice, &map, 2).is_err());
    let panel = LatticePlane {
        lattice: &lattice,
        map: &map,
        x: 0,
        y: 1,
        place: 0,
    };
    let curves = panel.border(1, 3);
    assert_eq!(curves.len(), 1);
    for [x, y] in &curves[0] {
        assert!(((x * x + y * y).sqrt() - radius).abs() < 0.45, "{x} {y}");
    }
    let [first, last] = [curves[0][0], curves[0][curves[0].len() - 1]];
    assert!(first[0] == 0.0 || first[1] == 0.0);
    assert!(last[0] == 0.0 || last[1] == 0.0);
    // The band lies on both sides.
    let [inner, outer] = [0.975, 0.025].map(|level| panel.level(1, level));
    let mean = |curves: &[Vec<[f64; 2]>]| {
        let points: Vec<f64> = curves
            .iter()
            .flatten()
            .map(|[x, y]| (x * x + y * y).sqrt())
            .collect();
        points.iter().sum::<f64>() / points.len() as f64
    };
    assert!(mean(&inner) < radius && radius < mean(&outer));
    assert!(panel.border(1, 7).is_empty());
}

#[test]
fn three_axes_share_what_is_learnt() {
    let axis = |name, count: usize| {
        let values = (0..count).map(|k| k as f64).collect();
        LatticeAxis::new(name, values, AxisScale::Rank).unwrap()
    };
    let lattice = Lattice::new(vec![axis("x", 9), axis("y", 9), axis("z", 5)]).unwrap();
    let label = |run: &Trial| {
        if run.values[1] + run.values[2] > 5.5 {
            2
        } else {
            0
        }
    };
    let mut settings = Settings::with_budget(60);
    settings.start = vec![3];
    let runs = refine(&lattice, &settings, label);
    let map = probabilities(&lattice, &runs, &settings).unwrap();
    let wanted = |place: usize| {
        let values = lattice.values(place);
        label(&Trial { values, seed: 1 })
    };
    let right = (0..405)
        .filter(|place| map.label(*place) == wanted(*place))
        .count();
    assert!(right >= 397, "{right} of 405");
}

#[test]
fn places_off_the_grid_keep_those_of_the_grid() {
    let axis = LatticeAxis::new("rate", vec![1.0, 10.0, 100.0], AxisScale::Log)
        .unwrap()
        .finer(2);
    assert_eq!(axis.values().len(), 5);
    assert!((axis.values()[1] - 10.0_f64.sqrt()).abs() < 1e-12);
    assert_eq!(axis.values()[2], 10.0);
    let rank = LatticeAxis::new("rate", vec![0.0, 1.0, 8.0], AxisScale::Rank).unwrap();
    assert_eq!(rank.finer(2).values(), [0.0, 0.5, 1.0, 4.5, 8.0]);
    for axis in [axis, rank] {
        for unit in [0.0, 0.2, 0.5, 0.9, 1.0] {
            assert!((axis.unit(axis.value(unit)) - unit).abs() < 1e-12);
        }
    }
}

#[test]
fn runs_that_contradict_each_other_are_refused() {
    let run = Trial {
        values: vec![1.0, 2.0],
        seed: 1,
    };
    let mut runs = Observations::new();
    runs.add(run.clone(), 3).unwrap();
    runs.add(run.clone(), 3).unwrap();
    assert_eq!(runs.len(), 1);
    let error = runs.add(run, 1).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the run at [1.0, 2.0] with seed 1 has the labels 3 and 1"
    );
    runs.add(
        Trial {
            values: vec![1.0],
            seed: 1,
        },
        3,
    )
    .unwrap();
    let error = probabilities(&square(9), &runs, &Settings::with_budget(9)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "the place [1.0] does not lie on the 2 axes"
    );
}

#[test]
fn a_gap_tells_what_may_be_missed() {
    let lattice = square(9);
    let mut runs = Observations::new();
    let error = Gap::new(&lattice, &runs).err().unwrap().to_string();
    assert!(error.starts_with("there are no runs to learn from"));
    for values in [vec![0.0, 0.0], vec![8.0, 8.0]] {
        runs.add(Trial { values, seed: 1 }, 1).unwrap();
    }
    let gap = Gap::new(&lattice, &runs).unwrap();
    assert_eq!((gap.values, gap.radius), (vec![0.0, 8.0], 1.0));
}
