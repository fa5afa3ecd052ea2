//! Gaussian process regression of the margins of rules.

use super::regression::Regressed;
use super::{Fitted, LabelModel, Propagation};
use crate::refine::Code;
use crate::refine::normal;
use crate::refine::observations::Training;

/// Regression of how clearly the rule of each label holds, where labels are those of the first rule
/// that holds. A label is seen on one side of a border or on the other; a margin also says how far
/// away the border is, so that fewer runs find it.
///
/// - The margin of each rule is a Gaussian process with Gaussian noise (Rasmussen and Williams,
///   Gaussian Processes for Machine Learning, 2006, section 2.2). Its spread is multiplied by the
///   root mean square of the leave-one-out residuals over their spreads (equation 5.12), if that
///   is above 1.
/// - A rule holds with the probability of a margin above 0, independently of other rules.
/// - Runs without margins, such as those that failed, are told apart from the others by
///   [`Propagation`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Margins;

/// Fewest margins that are learnt from.
const FEWEST: usize = 3;

struct FittedMargins {
    codes: Vec<Code>,
    /// The rules in the order in which they decide, each with its place among the codes.
    rules: Vec<(usize, RuleMargin)>,
    /// The codes of runs of which no rule holds.
    otherwise: Vec<usize>,
    /// The probabilities of runs with margins and of those without, by codes of the latter.
    without: Option<(Box<dyn Fitted>, Vec<usize>)>,
}

/// The margin of one rule.
enum RuleMargin {
    /// Learnt from runs.
    Learnt {
        regression: Box<Regressed>,
        mean: f64,
        /// By what the spread is multiplied.
        inflation: f64,
    },
    /// The same in all runs, or known of too few: the share of runs in which the rule holds.
    Level(f64),
}

impl LabelModel for Margins {
    fn codes(&self, runs: &Training) -> Vec<Code> {
        let rules = runs.margins(0..runs.runs()).flatten();
        let mut codes: Vec<Code> = rules.map(|(code, _)| *code).collect();
        codes.extend(runs.codes());
        codes.sort_unstable();
        codes.dedup();
        codes
    }

    fn fit(&self, runs: &Training) -> Box<dyn Fitted> {
        let codes = self.codes(runs);
        let place = |code: Code| codes.partition_point(|other| *other < code);
        let rules: Vec<Code> = runs
            .margins(0..runs.runs())
            .map(|margins| margins.iter().map(|(code, _)| *code).collect())
            .max_by_key(|codes: &Vec<Code>| codes.len())
            .unwrap_or_default();
        let is_without = |run: usize| runs.margins(run..run + 1).all(<[_]>::is_empty);
        let own = |run: usize| runs.codes()[runs.label(run)];
        let of_runs = |without: bool| {
            let runs = (0..runs.runs()).filter(|run| is_without(*run) == without);
            let mut places: Vec<usize> = runs.map(|run| place(own(run))).collect();
            places.sort_unstable();
            places.dedup();
            places
        };
        let labels_without = of_runs(true);
        let mut otherwise = of_runs(false);
        otherwise.retain(|label| !rules.contains(&codes[*label]));
        let without = (!labels_without.is_empty()).then(|| {
            let relabelled = runs.relabelled(|run| match is_without(run) {
                true => own(run),
                // Of all runs with margins together.
                false => Code::MAX,
            });
            (Propagation.fit(&relabelled), labels_without)
        });
        let margin = |rule: usize| RuleMargin::new(runs, rule, rules[rule]);
        Box::new(FittedMargins {
            rules: (0..rules.len())
                .map(|rule| (place(rules[rule]), margin(rule)))
                .collect(),
            codes,
            otherwise,
            without,
        })
    }
}

impl RuleMargin {
    /// Learns from the runs in which the margin is a number; the rule gives this label.
    fn new(runs: &Training, rule: usize, label: Code) -> Self {
        let value = |run: usize| {
            let mut margins = runs.margins(run..run + 1);
            let margin = margins.next()?.get(rule)?.1;
            margin.is_finite().then_some(margin)
        };
        let known: Vec<usize> = (0..runs.runs()).filter(|it| value(*it).is_some()).collect();
        let values: Vec<f64> = known.iter().filter_map(|run| value(*run)).collect();
        // On the border itself only a run with the label tells.
        let holds = |run: &&usize| {
            let is_label = runs.codes()[runs.label(**run)] == label;
            value(**run).is_some_and(|margin| margin > 0.0 || (margin == 0.0 && is_label))
        };
        let share = known.iter().filter(holds).count() as f64 / known.len().max(1) as f64;
        if known.len() < FEWEST || values.iter().all(|margin| *margin == values[0]) {
            return Self::Level(share);
        }
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let targets: Vec<f64> = values.iter().map(|value| value - mean).collect();
        let regression = Regressed::best(&runs.only(&known), std::slice::from_ref(&targets));
        let inflation = regression.left_out_residual(&targets).max(1.0);
        Self::Learnt {
            regression: Box::new(regression),
            mean,
            inflation,
        }
    }

    /// Probability that the rule holds at a place.
    fn holds(&self, unit: &[f64]) -> f64 {
        match self {
            Self::Learnt {
                regression,
                mean,
                inflation,
            } => {
                let (means, spread) = regression.latent(unit);
                normal::below((mean + means[0]) / (inflation * spread))
            }
            Self::Level(share) => *share,
        }
    }
}

impl Fitted for FittedMargins {
    fn predict(&self, units: &[&[f64]]) -> Vec<Vec<f64>> {
        let without = self.without.as_ref();
        let without = without.map(|(fitted, labels)| (fitted.predict(units), labels));
        let places = units.iter().enumerate();
        let at = |(place, unit): (usize, &&[f64])| {
            let mut probabilities = vec![0.0; self.codes.len()];
            let mut rest = 1.0;
            if let Some((predicted, labels)) = &without {
                for (label, probability) in labels.iter().zip(&predicted[place]) {
                    probabilities[*label] = *probability;
                    rest -= probability;
                }
            }
            for (label, margin) in &self.rules {
                let holds = margin.holds(unit);
                probabilities[*label] += rest * holds;
                rest *= 1.0 - holds;
            }
            // One label at most is without a rule.
            match self.otherwise.first() {
                Some(label) => probabilities[*label] += rest,
                None if probabilities.iter().sum::<f64>() > 0.0 => {
                    return super::normalised(probabilities);
                }
                None => probabilities.fill(1.0 / self.codes.len() as f64),
            }
            probabilities
        };
        places.map(at).collect()
    }
}
