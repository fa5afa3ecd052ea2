//! A scale: from the values of an axis to the canvas, with ticks that fit.

use super::style::SMALL;
use super::text;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// Most ticks of a scale whose positions are free.
const MOST_TICKS: usize = 9;

/// Most values of an axis that are ticks themselves.
const MOST_VALUES: usize = 12;

/// The length of an axis (units of the canvas) and its direction.
#[derive(Clone, Copy, Debug)]
pub(super) enum Room {
    Across(i32),
    Up(i32),
}

/// The range of an axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Span {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) logarithmic: bool,
    pub(super) ticks: Ticks,
    /// Size of the letters of its labels, where it is not that of small ones.
    pub(super) letters: Option<i32>,
}

/// Where an axis has ticks.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum Ticks {
    /// At round numbers, as many as fit.
    #[default]
    Round,
    /// At these values if they are few, short and fit; else at round numbers.
    Values(Vec<f64>),
    /// At these values, with these labels.
    Given(Vec<(f64, String)>),
}

impl Span {
    /// A linear range with ticks at round numbers.
    pub(super) fn linear((low, high): (f64, f64)) -> Self {
        Self {
            low,
            high,
            ..Self::default()
        }
    }
}

/// A linear or logarithmic scale with its ticks.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    logarithmic: bool,
    /// Values and labels of the ticks.
    ticks: Vec<(f64, String)>,
    /// Size of their letters.
    pub(super) letters: i32,
}

impl Scale {
    /// The scale of a range, with the ticks that fit into `room`.
    pub(super) fn new(span: &Span, room: Room) -> Self {
        let (low, high, logarithmic) = (span.low, span.high, span.logarithmic);
        let mut scale = Self {
            low,
            high,
            logarithmic,
            ticks: Vec::new(),
            letters: span.letters.unwrap_or(SMALL),
        };
        let own = match &span.ticks {
            Ticks::Values(values) if (1..=MOST_VALUES).contains(&values.len()) => {
                labelled(values, logarithmic).filter(|ticks| {
                    let short = |(_, label): &(f64, String)| label.chars().count() <= 5;
                    ticks.len() == 1 || ticks.iter().all(short)
                })
            }
            Ticks::Given(ticks) => {
                scale.ticks.clone_from(ticks);
                return scale;
            }
            _ => None,
        };
        let round = round_ticks(low, high, logarithmic).into_iter();
        let round = round.filter_map(|values| labelled(&values, logarithmic));
        let fitting = own
            .into_iter()
            .chain(round)
            .find(|ticks| scale.fit(ticks, room));
        scale.ticks = fitting.unwrap_or_default();
        scale
    }

    /// Position between the ends, 0 to 1.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        if self.logarithmic {
            libm::log(value / self.low) / libm::log(self.high / self.low)
        } else {
            (value - self.low) / (self.high - self.low)
        }
    }

    /// Values and labels of the ticks.
    pub(super) fn ticks(&self) -> &[(f64, String)] {
        &self.ticks
    }

    /// Width of the widest tick label (units of the canvas).
    pub(super) fn label_width(&self) -> i32 {
        let widths = self.ticks.iter().map(|(_, label)| self.width(label));
        widths.fold(0.0, f64::max).ceil() as i32
    }

    /// How far the labels of a horizontal axis of a length reach beyond its ends.
    pub(super) fn overhang(&self, length: i32) -> i32 {
        let beyond = self.ticks.iter().map(|(value, label)| {
            let place = self.fraction(*value);
            0.5 * self.width(label) - place.min(1.0 - place) * f64::from(length)
        });
        beyond.fold(0.0, f64::max).ceil() as i32
    }

    fn width(&self, label: &str) -> f64 {
        text::width(label, f64::from(self.letters))
    }

    /// Whether no two labels touch.
    fn fit(&self, ticks: &[(f64, String)], room: Room) -> bool {
        ticks.windows(2).all(|pair| {
            let [one, next] = [&pair[0], &pair[1]];
            let (length, needed) = match room {
                Room::Up(length) => (length, 1.2 * f64::from(SMALL)),
                Room::Across(length) => {
                    let labels = 0.5 * (self.width(&one.1) + self.width(&next.1));
                    (length, labels + 0.7 * f64::from(SMALL))
                }
            };
            (self.fraction(next.0) - self.fraction(one.0)) * f64::from(length) >= needed
        })
    }
}

impl Ranged for Scale {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        start + (self.fraction(*value) * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.ticks.iter().map(|(value, _)| *value).collect()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Scale {
    fn format_ext(&self, value: &f64) -> String {
        let tick = self.ticks.iter().find(|(tick, _)| tick == value);
        tick.map_or_else(|| number(*value), |(_, label)| label.clone())
    }
}

/// Sets of round numbers between `low` and `high`, from many to few.
fn round_ticks(low: f64, high: f64, logarithmic: bool) -> Vec<Vec<f64>> {
    let mut sets = Vec::new();
    if logarithmic {
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
        sets.extend((1..=6).map(|every| powers(&[1.0], every)));
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
            if (1..=MOST_TICKS as i64).contains(&(last - first + 1)) {
                sets.push((first..=last).map(|index| index as f64 * step).collect());
            }
        }
    }
    sets
}

/// The ticks with their labels, of equal style; `None` if they have too many digits.
fn labelled(ticks: &[f64], logarithmic: bool) -> Option<Vec<(f64, String)>> {
    let sizes = || {
        ticks
            .iter()
            .map(|tick| tick.abs())
            .filter(|size| *size > 0.0)
    };
    let (least, most) = (
        sizes().fold(f64::INFINITY, f64::min),
        sizes().fold(0.0, f64::max),
    );
    let decisive = if logarithmic { least } else { most };
    let plain = most == 0.0 || (decisive >= 1e-3 && most < 1e5);
    let with = |label: &dyn Fn(f64) -> String| {
        let ticks = ticks.iter();
        Some(ticks.map(|&tick| (tick, label(tick))).collect())
    };
    if !plain {
        return with(&scientific);
    }
    if logarithmic {
        return with(&number);
    }
    let span = ticks.last()? - ticks.first()?;
    let tolerance = 1e-6 * if span > 0.0 { span } else { most };
    let decimals = (0..=4).find(|&decimals| {
        ticks.iter().all(|&tick| {
            let written = format!("{tick:.decimals$}").parse::<f64>();
            written.is_ok_and(|written| (written - tick).abs() <= tolerance)
        })
    })?;
    with(&|tick| minus(format!("{tick:.decimals$}")))
}

/// A number for people: at most four digits, a power of ten if it is very large or very small.
pub(super) fn number(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        return scientific(value);
    }
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    minus(rounded.to_string())
}

/// A number with so many significant digits, the rest of them zeros.
pub(super) fn rounded(value: f64, digits: usize) -> String {
    let rounded = format!("{value:.*e}", digits.saturating_sub(1)).parse();
    number(rounded.unwrap_or(value))
}

fn scientific(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    let written = format!("{rounded:e}");
    let (mantissa, exponent) = written.split_once('e').unwrap_or((&written, "0"));
    let power: String = exponent.chars().map(superscript).collect();
    match mantissa {
        "1" => format!("10{power}"),
        "-1" => format!("−10{power}"),
        _ => format!("{}×10{power}", minus(mantissa.to_owned())),
    }
}

fn superscript(digit: char) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digit = digit.to_digit(10);
    digit.map_or('⁻', |digit| DIGITS[digit as usize])
}

/// A typographic minus sign instead of a hyphen; no minus zero.
fn minus(number: String) -> String {
    match number.strip_prefix('-') {
        Some(digits) if digits.chars().all(|digit| matches!(digit, '0' | '.')) => digits.to_owned(),
        Some(digits) => format!("−{digits}"),
        None => number,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn span(low: f64, high: f64, logarithmic: bool, values: &[f64]) -> Span {
        let ticks = Ticks::Values(values.to_vec());
        Span {
            low,
            high,
            logarithmic,
            ticks,
            letters: None,
        }
    }

    fn labels(scale: &Scale) -> Vec<&str> {
        scale
            .ticks
            .iter()
            .map(|(_, label)| label.as_str())
            .collect()
    }

    #[test]
    fn few_short_values_are_the_ticks() {
        let omega = [0.0, 2.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 40.0];
        let scale = Scale::new(&span(-1.0, 48.0, false, &omega), Room::Up(4000));
        assert_eq!(
            labels(&scale),
            ["0", "2", "4", "6", "8", "12", "16", "24", "40"]
        );
        let scale = Scale::new(&span(-1.0, 48.0, false, &omega), Room::Up(1000));
        assert_eq!(labels(&scale), ["0", "10", "20", "30", "40"]);
    }

    #[test]
    fn values_of_many_digits_give_way_to_round_numbers() {
        let ratios: Vec<f64> = (4..=12).map(|r| f64::from(r) * 5e-4 / 0.06).collect();
        let scale = Scale::new(&span(0.029, 0.104, false, &ratios), Room::Across(5000));
        assert_eq!(
            labels(&scale),
            [
                "0.03", "0.04", "0.05", "0.06", "0.07", "0.08", "0.09", "0.10"
            ]
        );
    }

    #[test]
    fn logarithmic_ticks() {
        let scale = Scale::new(&span(8e-7, 2e-2, true, &[]), Room::Across(4000));
        assert_eq!(labels(&scale), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²"]);
        let scale = Scale::new(&span(0.9, 110.0, true, &[]), Room::Across(4000));
        assert_eq!(labels(&scale), ["1", "2", "5", "10", "20", "50", "100"]);
    }

    #[test]
    fn numbers_for_people() {
        for (value, expected) in [
            (0.0, "0"),
            (-0.0, "0"),
            (2500.0, "2500"),
            (-0.25, "−0.25"),
            (1.0 / 3.0, "0.3333"),
            (5.657e5, "5.657×10⁵"),
            (1e-4, "10⁻⁴"),
            (-1e10, "−10¹⁰"),
            (0.1 + 0.2, "0.3"),
        ] {
            assert_eq!(number(value), expected);
        }
    }

    proptest! {
        #[test]
        fn ticks_lie_inside_and_never_touch(
            low in -1e3..1e3_f64,
            span in prop_oneof![1e-6..1e-2_f64, 1e-2..1e6],
            length in 300..6000_i32,
            vertical: bool,
        ) {
            let room = if vertical { Room::Up(length) } else { Room::Across(length) };
            let scale = Scale::new(&Span::linear((low, low + span)), room);
            let slack = 1e-6 * span;
            for (tick, _) in &scale.ticks {
                prop_assert!((low - slack..=low + span + slack).contains(tick));
            }
            prop_assert!(scale.fit(&scale.ticks, room));
        }
    }
}
