//! The one sentence of a study: the cheapest setting that is good enough, and what it saves.

use super::evaluate::{Errors, Evaluation, Outcome};
use crate::study::comparison::{BASE, States};
use serde::Serialize;

/// What a study finds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Finding {
    /// Name of the cheapest setting within the tolerance; none if no setting is.
    pub cheapest: Option<String>,
    /// Processor time of it over that of the scene as it is.
    pub time_ratio: Option<f64>,
    /// The same of force evaluations.
    pub work_ratio: Option<f64>,
    /// The sentence.
    pub sentence: String,
}

/// Settings that cost nearly the same are told apart by their error: a ratio of processor times
/// below this is noise of the machine.
const SAME_COST: f64 = 1.03;

impl Finding {
    pub(super) fn of(evaluation: &Evaluation) -> Self {
        let base = &evaluation.outcomes[BASE];
        if evaluation.counted_time.is_none() && !evaluation.times.is_empty() {
            let sentence = format!(
                "The motion is chaotic before {} s: no setting is near the reference there. \
                 Compare earlier times, or labels and order parameters over [seeds].",
                evaluation.times[0]
            );
            return Self {
                sentence,
                ..Self::default()
            };
        }
        if let Some(sentence) = unusable(evaluation) {
            return Self {
                sentence,
                ..Self::default()
            };
        }
        let Some(cheapest) = cheapest(evaluation) else {
            return Self {
                sentence: nothing_is_within(evaluation),
                ..Self::default()
            };
        };
        let ratio = |of: fn(&Outcome) -> f64| {
            let (own, base) = (of(cheapest), of(base));
            (base > 0.0).then(|| own / base)
        };
        let time_ratio = ratio(|it| it.cost.cpu_seconds);
        let work_ratio = ratio(|it| it.cost.force_evaluations);
        Self {
            cheapest: Some(cheapest.name.clone()),
            time_ratio,
            work_ratio,
            sentence: sentence(evaluation, cheapest, time_ratio, work_ratio),
        }
    }
}

/// Why nothing can be compared with the reference, if it is so.
fn unusable(evaluation: &Evaluation) -> Option<String> {
    let reference = evaluation.outcomes.get(evaluation.reference?)?;
    let is_motion = matches!(reference.errors, Errors::Motion(_));
    let all = reference.unstable == reference.runs;
    if reference.missing > 0 || (all || is_motion) && reference.unstable > 0 {
        return Some(format!(
            "Nothing can be compared with {}: {} of its {} runs are unstable, and {} are missing.",
            reference.name,
            reference.unstable,
            reference.runs + reference.missing,
            reference.missing
        ));
    }
    None
}

/// The cheapest setting within the tolerance. The reference is right by definition, and counts if
/// it is a setting of its own.
fn cheapest(evaluation: &Evaluation) -> Option<&Outcome> {
    let outcomes = evaluation.outcomes.iter().enumerate();
    let within = outcomes.filter(|(place, outcome)| {
        let is_right = Some(*place) == evaluation.reference && outcome.missing == 0;
        is_right || outcome.is_within(&evaluation.tolerance, evaluation.counted_time)
    });
    let within: Vec<&Outcome> = within.map(|(_, outcome)| outcome).collect();
    let seconds = |it: &&Outcome| it.cost.cpu_seconds;
    let least = within.iter().map(seconds).fold(f64::INFINITY, f64::min);
    let near = within
        .into_iter()
        .filter(|it| it.cost.cpu_seconds <= SAME_COST * least);
    let error = |it: &Outcome| it.error(evaluation.counted_time).unwrap_or(0.0);
    near.min_by(|one, other| error(one).total_cmp(&error(other)))
}

fn sentence(
    evaluation: &Evaluation,
    cheapest: &Outcome,
    time_ratio: Option<f64>,
    work_ratio: Option<f64>,
) -> String {
    let wanted = wanted(evaluation);
    let how_wrong = how_wrong(evaluation, cheapest);
    let base = &evaluation.outcomes[BASE];
    if cheapest.name == base.name {
        return format!("The cheapest setting {wanted} is the scene as it is: {how_wrong}.");
    }
    let times = |ratio: Option<f64>| ratio.unwrap_or(f64::NAN);
    let cost = match time_ratio {
        Some(ratio) if ratio <= 1.0 => format!(
            "It saves {:.0} % of the processor time of the scene as it is, and {:.0} % of its \
             force evaluations",
            100.0 * (1.0 - ratio),
            100.0 * (1.0 - times(work_ratio))
        ),
        _ => format!(
            "It takes {:.1} times the processor time of the scene as it is and {:.1} times its \
             force evaluations. The scene as it is: {}",
            times(time_ratio),
            times(work_ratio),
            self::how_wrong(evaluation, base)
        ),
    };
    format!(
        "The cheapest setting {wanted} is {}: {how_wrong}. {cost}.",
        cheapest.name
    )
}

/// What is asked for.
fn wanted(evaluation: &Evaluation) -> String {
    let tolerance = &evaluation.tolerance;
    match &evaluation.outcomes[BASE].errors {
        Errors::States(_) => {
            let labels = format!(
                "that changes at most {} of the labels",
                percent(tolerance.labels)
            );
            match tolerance.shift {
                None => labels,
                Some(shift) => format!(
                    "{labels} and shifts order parameters by at most {shift} of their spread"
                ),
            }
        }
        Errors::Motion(_) => {
            let at = evaluation
                .counted_time
                .map_or(0.0, |time| evaluation.times[time]);
            format!(
                "with an error of at most {} at {at} s",
                short(tolerance.error)
            )
        }
        Errors::Case(_) => format!("with errors of at most {}", short(tolerance.error)),
    }
}

/// How wrong a setting is.
fn how_wrong(evaluation: &Evaluation, outcome: &Outcome) -> String {
    match &outcome.errors {
        Errors::States(_) if Some(&outcome.name) == reference(evaluation) => {
            "it is the reference".to_owned()
        }
        Errors::States(states) => {
            let labels = of_labels(states);
            match (evaluation.tolerance.shift, states.most_shift()) {
                (Some(_), Some((quantity, most))) => format!(
                    "{labels}; order parameters shift by at most {most:.2} of their spread \
                     ({})",
                    quantity.replace('_', " ")
                ),
                _ => labels,
            }
        }
        Errors::Motion(_) | Errors::Case(_) => match outcome.error(evaluation.counted_time) {
            Some(0.0) => "it is the reference".to_owned(),
            error => format!("its error is {}", short(error.unwrap_or(f64::NAN))),
        },
    }
}

/// How wrong labels are.
fn of_labels(states: &States) -> String {
    let Some(it) = &states.disagreement else {
        return "nothing is known of its labels".to_owned();
    };
    match it.excess.is_clear() {
        true => format!(
            "it changes {} ({} to {})",
            percent(it.excess.value),
            percent(it.excess.low),
            percent(it.excess.high)
        ),
        false => format!(
            "no effect beyond seed-to-seed variation ({}); an effect of up to {} cannot be \
             excluded",
            percent(it.floor.value),
            percent(it.excess.high)
        ),
    }
}

fn reference(evaluation: &Evaluation) -> Option<&String> {
    Some(&evaluation.outcomes.get(evaluation.reference?)?.name)
}

fn nothing_is_within(evaluation: &Evaluation) -> String {
    let wanted = wanted(evaluation);
    let outcomes = evaluation.outcomes.iter().enumerate();
    let others = outcomes.filter(|(place, _)| Some(*place) != evaluation.reference);
    let best = others.map(|(_, it)| it).min_by(|one, other| {
        let bound = |it: &Outcome| match &it.errors {
            Errors::States(states) => {
                let known = states.disagreement.as_ref();
                known.map_or(f64::INFINITY, |it| it.excess.high)
            }
            _ => it.error(evaluation.counted_time).unwrap_or(f64::INFINITY),
        };
        bound(one).total_cmp(&bound(other))
    });
    match best {
        Some(best) => format!(
            "There is no setting {wanted}; the nearest is {}: {}.",
            best.name,
            how_wrong(evaluation, best)
        ),
        None => format!("There is no setting {wanted}."),
    }
}

impl Outcome {
    /// Its error in a few words, the motion's at the time of that place.
    pub fn in_words(&self, time: Option<usize>) -> String {
        let unstable = match self.unstable {
            0 => String::new(),
            count => format!(", {count} of {} runs unstable", self.runs),
        };
        let text = match &self.errors {
            Errors::States(States {
                disagreement: Some(it),
                ..
            }) => format!(
                "{} of labels changed ({} to {})",
                percent(it.excess.value),
                percent(it.excess.low),
                percent(it.excess.high)
            ),
            _ => self.error(time).map_or_else(|| "unknown".to_owned(), short),
        };
        text + &unstable
    }
}

/// A share in percent.
fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// A number to two digits.
fn short(value: f64) -> String {
    match value.abs() {
        size if size != 0.0 && !(0.01..100.0).contains(&size) => format!("{value:.1e}"),
        _ => format!("{value:.3}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::accuracy::{MotionError, Tolerance};
    use crate::study::comparison::{Cost, Disagreement, Interval, Shift, ShiftOf};
    use std::collections::BTreeMap;

    fn outcome(name: &str, seconds: f64, errors: Errors) -> Outcome {
        Outcome {
            name: name.to_owned(),
            method: name.to_owned(),
            rung: None,
            note: None,
            runs: 10,
            unstable: 0,
            missing: 0,
            cost: Cost {
                cpu_seconds: seconds,
                sphere_steps: 1e6 * seconds,
                force_evaluations: 1e6 * seconds,
            },
            errors,
        }
    }

    fn labels(name: &str, seconds: f64, value: f64, half: f64) -> Outcome {
        let interval = |value: f64, half: f64| Interval {
            value,
            low: value - half,
            high: value + half,
        };
        let disagreement = Disagreement {
            chance: interval(0.1 + value, half),
            floor: interval(0.1, 0.02),
            excess: interval(value, half),
            points: Vec::new(),
        };
        let states = States {
            disagreement: Some(disagreement),
            shifts: Vec::new(),
        };
        outcome(name, seconds, Errors::States(states))
    }

    fn motion(name: &str, seconds: f64, error: f64) -> Outcome {
        let error = MotionError {
            times: vec![Some(error)],
            quantities: Vec::new(),
        };
        outcome(name, seconds, Errors::Motion(error))
    }

    fn case(name: &str, seconds: f64, error: f64) -> Outcome {
        let errors = BTreeMap::from([("restitution".to_owned(), error)]);
        outcome(name, seconds, Errors::Case(errors))
    }

    /// The finding of these outcomes, the first of which is the scene as it is.
    fn finding(outcomes: Vec<Outcome>, reference: Option<usize>, time: Option<f64>) -> Finding {
        Finding::of(&evaluation(outcomes, reference, time))
    }

    fn evaluation(
        outcomes: Vec<Outcome>,
        reference: Option<usize>,
        time: Option<f64>,
    ) -> Evaluation {
        Evaluation {
            outcomes,
            reference,
            times: time.into_iter().collect(),
            counted_time: time.map(|_| 0),
            chaotic_from: None,
            orders: Vec::new(),
            majorities: Vec::new(),
            tolerance: Tolerance {
                labels: 0.05,
                shift: None,
                error: 1e-2,
            },
            finding: Finding::default(),
        }
    }

    #[test]
    fn of_labels_the_upper_end_of_the_interval_decides() {
        let outcomes = || {
            vec![
                labels("as it is", 4.0, 0.0, 0.01),
                labels("unsure", 1.0, 0.03, 0.04),
                labels("sure", 2.0, 0.01, 0.03),
                labels("wrong", 0.5, 0.2, 0.05),
            ]
        };
        let found = finding(outcomes(), Some(0), None);
        assert_eq!(found.cheapest.as_deref(), Some("sure"));
        assert_eq!(
            found.sentence,
            "The cheapest setting that changes at most 5.0 % of the labels is sure: no effect \
             beyond seed-to-seed variation (10.0 %); an effect of up to 4.0 % cannot be excluded. \
             It saves 50 % of the processor time of the scene as it is, and 50 % of its force \
             evaluations."
        );
        let mut all_unstable = outcomes();
        all_unstable[0].unstable = 10;
        let found = finding(all_unstable, Some(0), None);
        assert_eq!(found.cheapest, None);
        assert!(
            found.sentence.starts_with("Nothing can be compared"),
            "{found:?}"
        );
    }

    /// The sentence of a study that bounds shifts spoke of labels alone.
    #[test]
    fn of_order_parameters_the_sentence_says_how_far_they_may_shift() {
        let mut as_it_is = labels("as it is", 4.0, 0.0, 0.01);
        let Errors::States(states) = &mut as_it_is.errors else {
            panic!("labels have states");
        };
        let interval = Interval {
            value: 0.1,
            low: -0.2,
            high: 0.4,
        };
        states.shifts = vec![ShiftOf {
            quantity: "packing_height".to_owned(),
            shift: Some(Shift {
                spread: 1e-3,
                mean: interval,
                root_mean_square: interval,
            }),
        }];
        let sentence = |shift: Option<f64>| {
            let mut evaluation = evaluation(vec![as_it_is.clone()], None, None);
            evaluation.tolerance.shift = shift;
            Finding::of(&evaluation).sentence
        };
        assert!(!sentence(None).contains("order parameters"));
        assert_eq!(
            sentence(Some(0.5)),
            "The cheapest setting that changes at most 5.0 % of the labels and shifts order \
             parameters by at most 0.5 of their spread is the scene as it is: no effect beyond \
             seed-to-seed variation (10.0 %); an effect of up to 1.0 % cannot be excluded; order \
             parameters shift by at most 0.40 of their spread (packing height)."
        );
        assert!(sentence(Some(0.3)).starts_with("There is no setting"));
    }

    #[test]
    fn of_motions_the_error_decides() {
        let outcomes = vec![
            motion("as it is", 1.0, 0.1),
            motion("reference", 50.0, 0.0),
            motion("fine", 2.0, 0.004),
            motion("finer", 4.0, 0.001),
        ];
        let found = finding(outcomes, Some(1), Some(0.5));
        assert_eq!(
            found.sentence,
            "The cheapest setting with an error of at most 0.010 at 0.5 s is fine: its error is \
             4.0e-3. It takes 2.0 times the processor time of the scene as it is and 2.0 times its \
             force evaluations. The scene as it is: its error is 0.100."
        );
    }

    #[test]
    fn of_cases_the_largest_error_decides() {
        let good = || case("as it is", 1.0, 0.002);
        let found = finding(vec![good(), case("coarse", 0.2, 0.05)], None, None);
        assert_eq!(found.cheapest.as_deref(), Some("as it is"));
        assert_eq!((found.time_ratio, found.work_ratio), (Some(1.0), Some(1.0)));
        let found = finding(
            vec![case("as it is", 1.0, 0.5), case("coarse", 0.2, 2.0)],
            None,
            None,
        );
        assert_eq!(found.cheapest, None);
        assert_eq!(
            found.sentence,
            "There is no setting with errors of at most 0.010; the nearest is as it is: its error \
             is 0.500."
        );
    }
}
