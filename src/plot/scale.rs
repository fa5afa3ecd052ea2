//! A scale: from the values of an axis to the canvas, with ticks that fit.

use super::text;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// Most ticks of a scale whose positions are free.
const MOST_TICKS: usize = 9;

/// Most values of an axis that are ticks themselves.
const MOST_VALUES: usize = 12;

/// Direction of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    Horizontal,
    Vertical,
}

/// The room that tick labels have.
#[derive(Clone, Copy, Debug)]
pub(super) struct Room {
    /// Length of the axis (units of the canvas).
    pub(super) length: f64,
    /// Size of the letters (units of the canvas).
    pub(super) size: f64,
    /// Direction of the axis.
    pub(super) direction: Direction,
}

/// A linear or logarithmic scale with its ticks.
#[derive(Clone, Debug)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    logarithmic: bool,
    /// Values and labels of the ticks.
    ticks: Vec<(f64, String)>,
}

impl Scale {
    /// A scale from `low` to `high`. The ticks are `values` if they are few, short and fit; else
    /// round numbers, as many as fit.
    pub(super) fn new(low: f64, high: f64, logarithmic: bool, values: &[f64], room: Room) -> Self {
        let mut scale = Self {
            low,
            high,
            logarithmic,
            ticks: Vec::new(),
        };
        let few = (1..=MOST_VALUES).contains(&values.len());
        let candidates = few.then(|| values.to_vec()).into_iter();
        let candidates = candidates.chain(round_ticks(low, high, logarithmic));
        for (index, values) in candidates.enumerate() {
            let own = few && index == 0;
            let Some(ticks) = labelled(&values, logarithmic) else {
                continue;
            };
            let short = ticks.iter().all(|(_, label)| label.chars().count() <= 5);
            if scale.fit(&ticks, room) && (!own || short || values.len() == 1) {
                scale.ticks = ticks;
                break;
            }
        }
        scale
    }

    /// The scale without the ticks whose labels reach further than `overhang` (units of the canvas)
    /// beyond its ends.
    pub(super) fn with_labels_within(mut self, room: Room, overhang: f64) -> Self {
        let mut ticks = std::mem::take(&mut self.ticks);
        ticks.retain(|(value, label)| {
            let half = 0.5 * text::width(label, room.size);
            let place = self.fraction(*value) * room.length;
            place - half >= -overhang && place + half <= room.length + overhang
        });
        self.ticks = ticks;
        self
    }

    /// A linear scale without ticks.
    pub(super) fn bare(low: f64, high: f64) -> Self {
        Self {
            low,
            high,
            logarithmic: false,
            ticks: Vec::new(),
        }
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

    /// Width of the widest tick label, in the unit of `size`.
    pub(super) fn label_width(&self, size: f64) -> f64 {
        let widths = self.ticks.iter().map(|(_, label)| text::width(label, size));
        widths.fold(0.0, f64::max)
    }

    /// Whether no two labels touch.
    fn fit(&self, ticks: &[(f64, String)], room: Room) -> bool {
        ticks.windows(2).all(|pair| {
            let position = |tick: &(f64, String)| self.fraction(tick.0) * room.length;
            let needed = match room.direction {
                Direction::Vertical => 1.2 * room.size,
                Direction::Horizontal => {
                    let width = |tick: &(f64, String)| text::width(&tick.1, room.size);
                    0.5 * (width(&pair[0]) + width(&pair[1])) + 0.7 * room.size
                }
            };
            position(&pair[1]) - position(&pair[0]) >= needed
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
    let largest = ticks
        .iter()
        .fold(0.0_f64, |most, tick| most.max(tick.abs()));
    let plain = (1e-3..1e5).contains(&largest) || largest == 0.0;
    let label: Box<dyn Fn(f64) -> String> = if logarithmic {
        let smallest = ticks
            .iter()
            .fold(f64::INFINITY, |least, tick| least.min(*tick));
        if plain && smallest >= 1e-3 {
            Box::new(number)
        } else {
            Box::new(scientific)
        }
    } else if plain {
        let span = ticks.last()? - ticks.first()?;
        let tolerance = 1e-6 * if span > 0.0 { span } else { largest };
        let decimals = (0..=4).find(|&decimals| {
            ticks.iter().all(|&tick| {
                let written = format!("{tick:.decimals$}").parse::<f64>();
                written.is_ok_and(|written| (written - tick).abs() <= tolerance)
            })
        })?;
        Box::new(move |tick| minus(format!("{tick:.decimals$}")))
    } else {
        Box::new(scientific)
    };
    Some(ticks.iter().map(|&tick| (tick, label(tick))).collect())
}

/// A number for people: at most four digits, a power of ten if it is very large or very small.
pub(super) fn number(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        return scientific(value);
    }
    let rounded: f64 = format!("{value:.3e}").parse().unwrap_or(value);
    minus(rounded.to_string())
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
    match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4'..='9' => char::from_u32('⁴' as u32 + digit as u32 - '4' as u32).unwrap_or(digit),
        '0' => '⁰',
        other => other,
    }
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

    fn room(length: f64, direction: Direction) -> Room {
        Room {
            length,
            size: 110.0,
            direction,
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
        let scale = Scale::new(-1.0, 48.0, false, &omega, room(4000.0, Direction::Vertical));
        assert_eq!(
            labels(&scale),
            ["0", "2", "4", "6", "8", "12", "16", "24", "40"]
        );
        let scale = Scale::new(-1.0, 48.0, false, &omega, room(1000.0, Direction::Vertical));
        assert_eq!(labels(&scale), ["0", "10", "20", "30", "40"]);
    }

    #[test]
    fn values_of_many_digits_give_way_to_round_numbers() {
        let ratios: Vec<f64> = (4..=12).map(|r| f64::from(r) * 5e-4 / 0.06).collect();
        let wide = room(5000.0, Direction::Horizontal);
        let scale = Scale::new(0.029, 0.104, false, &ratios, wide);
        assert_eq!(
            labels(&scale),
            [
                "0.03", "0.04", "0.05", "0.06", "0.07", "0.08", "0.09", "0.10"
            ]
        );
    }

    #[test]
    fn logarithmic_ticks() {
        let scale = Scale::new(8e-7, 2e-2, true, &[], room(4000.0, Direction::Horizontal));
        assert_eq!(labels(&scale), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²"]);
        let scale = Scale::new(0.9, 110.0, true, &[], room(4000.0, Direction::Horizontal));
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

    /// Labels of powers of ten at both ends ran into those of the next panel, and off the sheet.
    #[test]
    fn labels_stay_within_their_panel() {
        let room = room(2000.0, Direction::Horizontal);
        let scale = Scale::new(8.9e-6, 1.12e-2, true, &[], room);
        assert_eq!(labels(&scale), ["10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²"]);
        let cut = |overhang| scale.clone().with_labels_within(room, overhang);
        assert_eq!(labels(&cut(50.0)), ["10⁻⁴", "10⁻³"]);
        assert_eq!(labels(&cut(500.0)), labels(&scale));
    }

    proptest! {
        #[test]
        fn ticks_lie_inside_and_never_touch(
            low in -1e3..1e3_f64,
            span in prop_oneof![1e-6..1e-2_f64, 1e-2..1e6],
            length in 300.0..6000.0_f64,
            vertical: bool,
        ) {
            let direction = if vertical { Direction::Vertical } else { Direction::Horizontal };
            let room = room(length, direction);
            let scale = Scale::new(low, low + span, false, &[], room);
            let slack = 1e-6 * span;
            for (tick, _) in &scale.ticks {
                prop_assert!((low - slack..=low + span + slack).contains(tick));
            }
            prop_assert!(scale.fit(&scale.ticks, room));
        }
    }
}
