//! Reductions against plain loops.

use super::run::{Run, number};
use phase::rule::Values;
use proptest::prelude::*;
use std::borrow::Cow;
use std::ops::Range;

/// A value of every reduction, by a plain loop; none where it is not a number.
fn plain(name: &str, times: &[f64], x: &[f64]) -> Option<f64> {
    let count = x.len() as f64;
    if name == "share(x > 0.5)" {
        let hits = x.iter().filter(|value| **value > 0.5).count();
        return (!x.is_empty()).then(|| hits as f64 / count);
    }
    // Infinite values have an order but no mean.
    let is_of_order = ["min(x)", "max(x)", "first(x)", "last(x)"].contains(&name);
    let is_good = |value: &f64| value.is_finite() || (is_of_order && !value.is_nan());
    if x.is_empty() || !x.iter().all(is_good) {
        return None;
    }
    let mut sum = 0.0;
    for value in x {
        sum += value;
    }
    let mean = sum / count;
    let mut sorted = x.to_vec();
    sorted.sort_by(f64::total_cmp);
    match name {
        "mean(x)" => Some(mean),
        "min(x)" => sorted.first().copied(),
        "max(x)" => sorted.last().copied(),
        "first(x)" => Some(x[0]),
        "last(x)" => Some(x[x.len() - 1]),
        "deviation(x)" => {
            let mut squares = 0.0;
            for value in x {
                squares += (value - mean) * (value - mean);
            }
            (x.len() > 1).then(|| (squares / (count - 1.0)).sqrt())
        }
        "trend(x)" => {
            // The slope as the mean over all pairs of frames, weighted by their distances squared.
            let (mut above, mut below) = (0.0, 0.0);
            for i in 0..x.len() {
                for j in 0..i {
                    above += (x[i] - x[j]) * (times[i] - times[j]);
                    below += (times[i] - times[j]) * (times[i] - times[j]);
                }
            }
            (x.len() > 1).then(|| above / below)
        }
        "repeats(x, 0.3)" => plain_repeats(times, x, 0.3),
        _ => panic!("{name}"),
    }
}

fn plain_repeats(times: &[f64], x: &[f64], period: f64) -> Option<f64> {
    let variance = plain("deviation(x)", times, x)?;
    let variance = variance * variance;
    if !(times[times.len() - 1] - times[0] * (1.0 + 1e-9) >= 2.0 * period && variance > 0.0) {
        return None;
    }
    let mut squares = Vec::new();
    for i in 0..x.len() {
        let past = times[i] - period;
        let left = (0..x.len() - 1).rev().find(|left| times[*left] <= past);
        if let Some(left) = left {
            let part = (past - times[left]) / (times[left + 1] - times[left]);
            let old = x[left] * (1.0 - part) + x[left + 1] * part;
            squares.push((x[i] - old) * (x[i] - old));
        }
    }
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    Some(1.0 - mean / (2.0 * variance))
}

/// A run whose column `x` has single precision, as in records.
struct Narrow {
    time: Vec<f64>,
    x: Vec<f32>,
}

impl Values for Narrow {
    fn time(&self) -> &[f64] {
        &self.time
    }

    fn column(&self, _: &str) -> Cow<'_, [f64]> {
        self.x.iter().copied().map(f64::from).collect()
    }

    fn key(&self, _: &str) -> f64 {
        f64::NAN
    }
}

const REDUCTIONS: [&str; 9] = [
    "mean(x)",
    "min(x)",
    "max(x)",
    "first(x)",
    "last(x)",
    "deviation(x)",
    "trend(x)",
    "share(x > 0.5)",
    "repeats(x, 0.3)",
];

fn value() -> impl Strategy<Value = f64> {
    prop_oneof![
        40 => -1e3..1e3_f64,
        20 => (-2..3_i32).prop_map(f64::from),
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
    ]
}

fn series() -> impl Strategy<Value = (Vec<f64>, Vec<f64>, Range<usize>)> {
    let frames = prop::collection::vec((0.01..0.3_f64, value()), 0..40);
    (frames, 0..45_usize, 0..45_usize).prop_map(|(frames, start, end)| {
        let mut now = 0.0;
        let times = frames.iter().map(|(step, _)| {
            now += step;
            now
        });
        (
            times.collect(),
            frames.iter().map(|(_, value)| *value).collect(),
            start..end,
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn reductions_are_plain_loops((times, x, window) in series()) {
        let run = Run::at(times.clone(), &x);
        let end = window.end.min(x.len());
        let inside = window.start.min(end)..end;
        for reduction in REDUCTIONS {
            let found = number(reduction).evaluate(&run, window.clone());
            let expected = plain(reduction, &times[inside.clone()], &x[inside.clone()]);
            match expected {
                None => prop_assert!(found.is_nan(), "{reduction}: {found}"),
                Some(expected) if expected.is_infinite() => prop_assert_eq!(found, expected),
                Some(expected) => {
                    let near = 1e-9 * expected.abs().max(1.0);
                    prop_assert!(
                        (found - expected).abs() <= near,
                        "{reduction}: {found}, not {expected}"
                    );
                }
            }
        }
    }

    /// Columns of single precision are widened by the caller, and evaluation repeats every bit.
    #[test]
    fn bits_do_not_change(values in prop::collection::vec(any::<f32>(), 0..40)) {
        let widened: Vec<f64> = values.iter().map(|value| f64::from(*value)).collect();
        let narrow = Narrow { time: Run::of(&widened).time, x: values.clone() };
        let texts = REDUCTIONS.into_iter().chain([
            "mean(sin(x) * exp(-abs(x)))",
            "max(lesser(x, 0 * x)) - min(greater(x, 0 * x))",
            "mean(x^3) / deviation(x)^0.5",
            "log(0 - abs(mean(x)))",
        ]);
        for text in texts {
            let number = number(text);
            let first = number.evaluate(&Run::of(&widened), 0..values.len());
            let again = number.evaluate(&narrow, 0..values.len());
            prop_assert_eq!(first.to_bits(), again.to_bits(), "{}", text);
            prop_assert!(!first.is_nan() || first.to_bits() == f64::NAN.to_bits(), "{}", text);
        }
    }
}

#[test]
fn formulas_mix_columns_keys_and_numbers_in_every_frame() {
    let run = Run::of(&[1.0, 2.0, 4.0]);
    assert_eq!(
        run.value("mean(x * swirl.omega + 7)"),
        (9.0 + 11.0 + 15.0) / 3.0
    );
    assert_eq!(run.value("max(x) - min(x) * 2"), 2.0);
    assert_eq!(run.value("max(greater(x, 3))"), 4.0);
    assert_eq!(run.value("min(lesser(x, 0.5))"), 0.5);
    assert_eq!(run.value("last(time)"), 0.2);
    assert_eq!(
        run.value("share(x >= 2 and not x > 3 or axis[0] > 1)"),
        1.0 / 3.0
    );
    assert_eq!(run.value("share(time < 0.15)"), 2.0 / 3.0);
    assert_eq!(run.value("kinds[1].share + axis[0]"), 0.75);
    assert_eq!(
        run.value("abs(0 - 3) + sqrt(16) + exp(0) + log(1) + sin(0) + cos(0) + tan(0)"),
        9.0
    );
    assert!(run.value("lesser(1, 0 / 0)").is_nan() && run.value("lesser(0 / 0, 1)").is_nan());
    assert!(run.value("greater(1, 0 / 0)").is_nan() && run.value("greater(0 / 0, 1)").is_nan());
    assert_eq!(run.value("-2^2"), -4.0);
    assert_eq!(run.value("2^3^2"), 512.0);
    assert_eq!(run.value("2^-1"), 0.5);
    assert_eq!(run.value("2^(1/2)"), 2_f64.sqrt());
    assert_eq!(run.value("8 / 4 / 2 - 1 - 1"), -1.0);
}

#[test]
fn frames_that_are_not_finite_leave_only_shares() {
    let run = Run::of(&[1.0, f64::NAN, 3.0, f64::INFINITY]);
    for reduction in REDUCTIONS
        .into_iter()
        .filter(|text| !text.starts_with("share"))
    {
        assert!(run.value(reduction).is_nan(), "{reduction}");
        assert!(
            number(reduction).evaluate(&run, 0..0).is_nan(),
            "{reduction}"
        );
    }
    assert_eq!(run.value("share(x > 2)"), 0.5);
    assert_eq!(run.value("share(x != 1)"), 0.5);
    assert_eq!(run.value("share(not x > 2)"), 0.5);
    assert!(number("share(x > 2)").evaluate(&run, 4..9).is_nan());
    assert_eq!(number("mean(x)").evaluate(&run, 2..3), 3.0);
    assert!(number("deviation(x)").evaluate(&run, 2..3).is_nan());
    assert!(number("trend(x)").evaluate(&run, 2..3).is_nan());
}

/// A column that is shorter than the run, and a window that lies behind it or backwards.
#[test]
fn missing_frames_are_not_numbers() {
    let mut run = Run::of(&[1.0, 2.0]);
    run.time.push(0.2);
    assert!(run.value("mean(x)").is_nan());
    assert_eq!(run.value("share(x > 0)"), 2.0 / 3.0);
    assert_eq!(number("mean(x)").evaluate(&run, 0..2), 1.5);
    #[expect(clippy::reversed_empty_ranges, reason = "it must not panic")]
    let backwards = 2..1;
    assert!(number("mean(x)").evaluate(&run, backwards).is_nan());
    assert!(
        number("mean(x)")
            .evaluate(&run, usize::MAX..usize::MAX)
            .is_nan()
    );
}
