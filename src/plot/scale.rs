//! A scale: from the values of an axis to the canvas, with ticks that fit.

use super::numbers::number;
use super::spacing::AxisSpacing;
use super::style::SMALL;
use super::text;
use super::ticks::{self, Tick, Ticks};
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// The length of an axis (units of the canvas) and its direction.
#[derive(Clone, Copy, Debug)]
pub(super) enum AxisRoom {
    Across(i32),
    Up(i32),
}

impl AxisRoom {
    fn length(self) -> f64 {
        let (Self::Across(length) | Self::Up(length)) = self;
        f64::from(length)
    }
}

/// The range of an axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct AxisSpan {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) spacing: AxisSpacing,
    pub(super) ticks: Ticks,
    /// Size of the letters of its labels, if not the usual small one.
    pub(super) letters: Option<i32>,
}

impl AxisSpan {
    /// A linear range with ticks at round numbers.
    pub(super) fn linear((low, high): (f64, f64)) -> Self {
        Self {
            low,
            high,
            ..Self::default()
        }
    }
}

/// A scale with its ticks.
#[derive(Clone, Debug)]
pub(super) struct AxisScale {
    low: f64,
    high: f64,
    spacing: AxisSpacing,
    /// Values and labels of the ticks.
    ticks: Vec<(f64, String)>,
    /// Size of their letters.
    pub(super) letters: i32,
}

impl AxisScale {
    /// The scale of a range, with the ticks that fit into `room`.
    pub(super) fn new(span: &AxisSpan, room: AxisRoom) -> Self {
        let mut scale = Self {
            low: span.low,
            high: span.high,
            spacing: span.spacing.clone(),
            ticks: Vec::new(),
            letters: span.letters.unwrap_or(SMALL),
        };
        if let Ticks::Given(ticks) = &span.ticks {
            scale.ticks.clone_from(ticks);
            return scale;
        }
        let sets = || ticks::sets(&span.ticks, (span.low, span.high), &span.spacing);
        let fitting = sets().find(|ticks| scale.least_length(ticks, room) <= room.length());
        // Where none fits, the ends of the set that needs least: the page makes room for it.
        let pair = |mut ticks: Vec<Tick>| {
            ticks.drain(1..ticks.len().saturating_sub(1).max(1));
            ticks
        };
        let shortest = || {
            let pairs = sets().map(pair);
            pairs.min_by(|one, other| {
                let [one, other] = [one, other].map(|ticks| scale.least_length(ticks, room));
                one.total_cmp(&other)
            })
        };
        scale.ticks = fitting.or_else(shortest).unwrap_or_default();
        scale
    }

    /// Position between the ends, 0 to 1.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        self.spacing.fraction(value, self.low, self.high)
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
    pub(super) fn overhangs(&self, length: i32) -> [i32; 2] {
        let beyond = |from_end: fn(f64) -> f64| {
            let beyond = self.ticks.iter().map(|(value, label)| {
                let place = from_end(self.fraction(*value));
                0.5 * self.width(label) - place * f64::from(length)
            });
            beyond.fold(0.0, f64::max).ceil() as i32
        };
        [beyond(|place| place), beyond(|place| 1.0 - place)]
    }

    fn width(&self, label: &str) -> f64 {
        text::width(label, f64::from(self.letters))
    }

    /// Length of an axis on which no two of these labels touch.
    fn least_length(&self, ticks: &[Tick], room: AxisRoom) -> f64 {
        let pairs = ticks.windows(2).map(|pair| {
            let [one, next] = [&pair[0], &pair[1]];
            let needed = match room {
                AxisRoom::Up(_) => 1.2 * f64::from(SMALL),
                AxisRoom::Across(_) => {
                    let labels = 0.5 * (self.width(&one.1) + self.width(&next.1));
                    labels + 0.7 * f64::from(SMALL)
                }
            };
            needed / (self.fraction(next.0) - self.fraction(one.0))
        });
        pairs.fold(0.0, f64::max)
    }

    /// Length of an axis that its labels need (units of the canvas).
    pub(super) fn needed_length(&self, room: AxisRoom) -> i32 {
        self.least_length(&self.ticks, room).ceil() as i32
    }
}

impl Ranged for AxisScale {
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

impl ValueFormatter<f64> for AxisScale {
    fn format_ext(&self, value: &f64) -> String {
        let tick = self.ticks.iter().find(|(tick, _)| tick == value);
        tick.map_or_else(|| number(*value), |(_, label)| label.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::super::numbers::tests::{close_values, parsed};
    use super::*;
    use proptest::prelude::*;

    fn span(low: f64, high: f64, spacing: AxisSpacing, values: &[f64]) -> AxisSpan {
        let ticks = Ticks::Values(values.to_vec());
        AxisSpan {
            low,
            high,
            spacing,
            ticks,
            letters: None,
        }
    }

    fn labels(scale: &AxisScale) -> Vec<&str> {
        scale
            .ticks
            .iter()
            .map(|(_, label)| label.as_str())
            .collect()
    }

    #[test]
    fn few_short_values_are_the_ticks() {
        let omega = [0.0, 2.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 40.0];
        let scale = AxisScale::new(
            &span(-1.0, 48.0, AxisSpacing::Linear, &omega),
            AxisRoom::Up(4000),
        );
        assert_eq!(
            labels(&scale),
            ["0", "2", "4", "6", "8", "12", "16", "24", "40"]
        );
        let scale = AxisScale::new(
            &span(-1.0, 48.0, AxisSpacing::Linear, &omega),
            AxisRoom::Up(1000),
        );
        assert_eq!(labels(&scale), ["0", "10", "20", "30", "40"]);
    }

    #[test]
    fn values_of_many_digits_give_way_to_round_numbers() {
        let ratios: Vec<f64> = (4..=12).map(|r| f64::from(r) * 5e-4 / 0.06).collect();
        let scale = AxisScale::new(
            &span(0.029, 0.104, AxisSpacing::Linear, &ratios),
            AxisRoom::Across(5000),
        );
        assert_eq!(
            labels(&scale),
            [
                "0.03", "0.04", "0.05", "0.06", "0.07", "0.08", "0.09", "0.10"
            ]
        );
    }

    #[test]
    fn close_values_have_the_digits_that_tell_them_apart() {
        for (values, expected) in [
            (
                [1e5 + 1.0, 1e5 + 3.0, 1e5 + 5.0],
                ["100001", "100002", "100003", "100004", "100005"],
            ),
            (
                [1e-5, 1.5e-5, 1.8e-5],
                ["10⁻⁵", "1.2×10⁻⁵", "1.4×10⁻⁵", "1.6×10⁻⁵", "1.8×10⁻⁵"],
            ),
            (
                [-3.00004, -3.00002, -3.0],
                ["−3.00004", "−3.00003", "−3.00002", "−3.00001", "−3.00000"],
            ),
        ] {
            let spacing = AxisSpacing::Linear;
            let scale = AxisScale::new(
                &span(values[0], values[2], spacing, &values),
                AxisRoom::Up(800),
            );
            assert_eq!(labels(&scale), expected);
        }
        let values = [0.0, 0.01, 0.1, 1.0, 100.0];
        let spacing = AxisSpacing::equal(values.to_vec());
        let scale = AxisScale::new(&span(0.0, 100.0, spacing, &values), AxisRoom::Across(4000));
        assert_eq!(labels(&scale), ["0", "0.01", "0.1", "1", "100"]);
    }

    #[test]
    fn logarithmic_ticks() {
        let scale = AxisScale::new(
            &span(8e-7, 2e-2, AxisSpacing::Logarithmic, &[]),
            AxisRoom::Across(4000),
        );
        assert_eq!(labels(&scale), ["10⁻⁶", "10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²"]);
        let scale = AxisScale::new(
            &span(0.9, 110.0, AxisSpacing::Logarithmic, &[]),
            AxisRoom::Across(4000),
        );
        assert_eq!(labels(&scale), ["1", "2", "5", "10", "20", "50", "100"]);
    }

    proptest! {
        /// Symptom: five ticks "10⁵", an axis without a tick. Cause: labels had at most four
        /// digits or decimals.
        #[test]
        fn labels_differ_are_read_back_and_are_two_at_least(
            values in close_values(),
            kind in 0..3,
            length in 900..6000_i32,
            vertical: bool,
        ) {
            let room = if vertical { AxisRoom::Up(length) } else { AxisRoom::Across(length) };
            let (low, most) = (values[0], values[values.len() - 1] - values[0]);
            let values: Vec<f64> = match kind {
                1 => values.iter().map(|value| value - low + 1e-3 * most).collect(),
                _ => values,
            };
            let (first, last) = (values[0], values[values.len() - 1]);
            let spacing = match kind {
                0 => AxisSpacing::Linear,
                1 => AxisSpacing::Logarithmic,
                _ => AxisSpacing::equal(values.clone()),
            };
            let scale = AxisScale::new(&span(first, last, spacing, &values), room);
            prop_assert!(scale.ticks.len() >= 2, "{values:?}");
            for pair in scale.ticks.windows(2) {
                let half = 0.5 * (pair[1].0 - pair[0].0);
                prop_assert_ne!(&pair[0].1, &pair[1].1);
                for (value, label) in pair {
                    prop_assert!((parsed(label) - value).abs() < half, "{value} {label}");
                }
            }
        }

        #[test]
        fn ticks_lie_inside_and_never_touch(
            low in -1e3..1e3_f64,
            span in prop_oneof![1e-6..1e-2_f64, 1e-2..1e6],
            length in 300..6000_i32,
            vertical: bool,
        ) {
            let room = if vertical { AxisRoom::Up(length) } else { AxisRoom::Across(length) };
            let scale = AxisScale::new(&AxisSpan::linear((low, low + span)), room);
            let slack = 1e-6 * span;
            for (tick, _) in &scale.ticks {
                prop_assert!((low - slack..=low + span + slack).contains(tick));
            }
            prop_assert!(scale.ticks.len() >= 2);
            // Two labels may need more room than there is; the page makes it.
            let needed = scale.needed_length(room);
            if scale.ticks.len() > 2 || vertical {
                prop_assert!(f64::from(needed) <= room.length());
            }
            let there = if vertical { AxisRoom::Up(needed) } else { AxisRoom::Across(needed) };
            prop_assert!(scale.least_length(&scale.ticks, there) <= f64::from(needed));
        }
    }
}
