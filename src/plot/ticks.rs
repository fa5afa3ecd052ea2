//! Where an axis may have ticks, and their labels.

use super::numbers::{among, decimal, rounded_value, scientific};
use super::spacing::AxisSpacing;

/// Most ticks of a scale whose positions are free.
const MOST_TICKS: usize = 9;

/// Most values of an axis that are ticks themselves.
const MOST_VALUES: usize = 12;

/// Most characters of the label of a value that is a tick itself.
const LONGEST: usize = 5;

/// Digits of labels as long as they are enough, and digits that always are.
const DIGITS: [usize; 2] = [4, 20];

/// Where an axis has ticks.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum Ticks {
    /// At round numbers, as many as fit.
    #[default]
    Round,
    /// At these ascending values if they are few, short and fit; else at round numbers.
    Values(Vec<f64>),
    /// At these values, with these labels.
    Given(Vec<(f64, String)>),
}

/// A tick: its value and its label.
pub(super) type Tick = (f64, String);

/// Sets of ticks for an axis from `low` to `high`, the best first. Each has two ticks or more, but
/// for an axis of a single value; labels are read back as the value of their tick.
pub(super) fn sets(
    wanted: &Ticks,
    (low, high): (f64, f64),
    spacing: &AxisSpacing,
) -> impl Iterator<Item = Vec<Tick>> {
    let values = match wanted {
        Ticks::Values(values) => values.clone(),
        _ => Vec::new(),
    };
    let is_short = |ticks: &Vec<Tick>| {
        let mut labels = ticks.iter().map(|(_, label)| label.chars().count());
        ticks.len() == 1 || labels.all(|length| length <= LONGEST)
    };
    let own = Some(values.clone()).filter(|it| (1..=MOST_VALUES).contains(&it.len()));
    let own = own.and_then(|values| labelled(&values, spacing, DIGITS[0]));
    let sets = match spacing {
        // Round numbers would crowd where values are close.
        AxisSpacing::Equal(_) => thinned(&values),
        _ => round_ticks(low, high, spacing),
    };
    let ends = match &values[..] {
        [first, .., last] => vec![*first, *last],
        _ => Vec::new(),
    };
    let spacing = spacing.clone();
    let wider = DIGITS.into_iter().flat_map(move |digits| {
        let sets = sets.clone().into_iter();
        sets.map(move |set| (set, digits))
    });
    let wider = wider.chain([(ends, DIGITS[1])]);
    let wider = wider.filter(|(set, _)| set.len() > 1);
    let wider = wider.filter_map(move |(set, digits)| labelled(&set, &spacing, digits));
    own.into_iter().filter(is_short).chain(wider)
}

/// Every value, every second one, and so on to the first and one more.
fn thinned(values: &[f64]) -> Vec<Vec<f64>> {
    let every = |step: usize| values.iter().copied().step_by(step).collect();
    let sets = (1..values.len()).map(every);
    let sets = sets.filter(|set: &Vec<f64>| set.len() <= MOST_VALUES);
    sets.collect()
}

/// Sets of round numbers between `low` and `high`, from many to few.
fn round_ticks(low: f64, high: f64, spacing: &AxisSpacing) -> Vec<Vec<f64>> {
    let mut sets = Vec::new();
    if spacing.is_logarithmic() {
        let decades = libm::log10(low).floor() as i32..=libm::log10(high).ceil() as i32;
        let powers = |mantissas: &[f64], every: usize| -> Vec<f64> {
            let powers = decades.clone().step_by(every);
            powers
                .flat_map(|decade| {
                    mantissas
                        .iter()
                        .map(move |mantissa| mantissa * libm::exp10(f64::from(decade)))
                })
                .filter(|value| (low..=high).contains(value))
                .collect()
        };
        sets.push(powers(&[1.0, 2.0, 5.0], 1));
        let most = (decades.clone().count() / 2).max(6);
        sets.extend((1..=most).map(|every| powers(&[1.0], every)));
        sets.retain(|set| set.len() >= 2 && set.len() <= 2 * MOST_TICKS);
    }
    let span = high - low;
    let smallest = libm::log10(span / MOST_TICKS as f64).floor() as i32;
    for decade in smallest..smallest + 3 {
        for mantissa in [1.0, 2.0, 5.0] {
            let step = mantissa * libm::exp10(f64::from(decade));
            let slack = 1e-9 * span;
            let first = ((low - slack) / step).ceil() as i64;
            let last = ((high + slack) / step).floor() as i64;
            if (2..=MOST_TICKS as i64).contains(&last.saturating_sub(first).saturating_add(1)) {
                sets.push((first..=last).map(|index| index as f64 * step).collect());
            }
        }
    }
    // Where numbers are as far apart as numbers can be, steps are lost.
    sets.retain(|set| set.windows(2).all(|pair| pair[0] < pair[1]));
    sets
}

/// The ticks with their labels, of equal style; `None` if they need more digits.
fn labelled(ticks: &[f64], spacing: &AxisSpacing, digits: usize) -> Option<Vec<Tick>> {
    let sizes = || {
        let sizes = ticks.iter().map(|tick| tick.abs());
        sizes.filter(|size| *size > 0.0)
    };
    let (least, most) = (
        sizes().fold(f64::INFINITY, f64::min),
        sizes().fold(0.0, f64::max),
    );
    let with = |label: &dyn Fn(f64) -> String| -> Vec<Tick> {
        let ticks = ticks.iter();
        ticks.map(|&tick| (tick, label(tick))).collect()
    };
    let is_logarithmic = spacing.is_logarithmic();
    // Labels of linear axes have the same decimals; of others each has its own.
    let is_uneven = *spacing != AxisSpacing::Linear;
    let decisive = if is_uneven { least } else { most };
    let is_plain = most == 0.0 || (decisive >= 1e-3 && most < 1e5);
    if is_plain && is_uneven {
        return Some(with(&|tick| among(tick, ticks)));
    }
    let tolerance = tolerance(ticks, most, is_logarithmic);
    let are_told = |rounded: &dyn Fn(f64) -> f64| {
        let mut ticks = ticks.iter();
        ticks.all(|&tick| (rounded(tick) - tick).abs() <= tolerance)
    };
    let decimals = (0..=digits).find(|&decimals| {
        are_told(&|tick| format!("{tick:.decimals$}").parse().unwrap_or(f64::NAN))
    });
    let plain = decimals.map(|decimals| with(&|tick| decimal(tick, decimals)));
    if is_plain {
        return plain;
    }
    // Few digits and a power of ten are short enough.
    let digits = (4..=digits).find(|&digits| are_told(&|tick| rounded_value(tick, digits)))?;
    let powers = with(&|tick| scientific(tick, digits));
    let longest = |ticks: &Vec<Tick>| {
        let lengths = ticks.iter().map(|(_, label)| label.chars().count());
        lengths.max().unwrap_or(0)
    };
    match plain {
        Some(plain) if digits > DIGITS[0] && longest(&plain) <= longest(&powers) => Some(plain),
        _ => Some(powers),
    }
}

/// How far a label may be from its tick: not to be seen, and nearer than to any other.
fn tolerance(ticks: &[f64], most: f64, is_logarithmic: bool) -> f64 {
    let gaps = ticks.windows(2).map(|pair| pair[1] - pair[0]);
    let gap = gaps.fold(f64::INFINITY, f64::min);
    let span = match ticks {
        [first, .., last] => last - first,
        _ => most,
    };
    // By ratios, the least counts as much as the largest.
    let seen = match is_logarithmic {
        true => 1e-3 * ticks.first().copied().unwrap_or(most),
        false => 1e-6 * span,
    };
    seen.min(0.25 * gap)
}
