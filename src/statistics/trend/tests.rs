#![expect(clippy::print_stdout, reason = "the rates that are measured")]

use super::*;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

const FRAMES: usize = 2000;
const CONFIDENCE: f64 = 0.95;
const SERIES: u64 = 2000;

/// Correlated noise of mean 0 and scatter 1, with an integrated correlation time of `time` frames.
fn noise(time: f64, seed: u64) -> Vec<f64> {
    let mut random = Pcg64::seed_from_u64(seed);
    let mut normal = || {
        let [one, other]: [f64; 2] = [1.0 - random.random::<f64>(), random.random()];
        (-2.0 * libm::log(one)).sqrt() * libm::cos(2.0 * std::f64::consts::PI * other)
    };
    let hold = (time - 1.0) / (time + 1.0);
    let mut value = normal();
    let mut next = || {
        let present = value;
        value = hold * value + (1.0 - hold * hold).sqrt() * normal();
        present
    };
    (0..FRAMES).map(|_| next()).collect()
}

/// Noise on a line that changes by `change`.
fn drifting(change: f64, time: f64, seed: u64) -> Vec<f64> {
    let slope = change / (FRAMES - 1) as f64;
    let noise = noise(time, seed).into_iter().enumerate();
    noise
        .map(|(frame, value)| value + slope * frame as f64)
        .collect()
}

fn trend(values: &[f64]) -> Trend {
    Trend::of(values, CONFIDENCE).unwrap()
}

/// Share of series, by their seeds, for which a condition holds.
fn share(of: impl Fn(u64) -> bool) -> f64 {
    (0..SERIES).filter(|seed| of(*seed)).count() as f64 / SERIES as f64
}

/// How often the true change lies above or below its interval, which should be 5 % each, and how
/// often a trend that just matters passes. Three binomial errors of 5 % of 2000 are 1.5 %.
#[test]
fn a_trend_that_matters_passes_as_rarely_as_it_should() {
    for (samples, most) in [(24.0, 0.09), (50.0, 0.08), (100.0, 0.07), (400.0, 0.065)] {
        let time = FRAMES as f64 / samples;
        // Four standard errors of a change that is fitted to all values.
        let change = 4.0 * (12.0_f64 / samples).sqrt();
        let trends: Vec<Trend> = (0..SERIES)
            .map(|seed| trend(&drifting(change, time, seed)))
            .collect();
        let share = |is: &dyn Fn(&Trend) -> bool| {
            trends.iter().filter(|it| is(it)).count() as f64 / trends.len() as f64
        };
        let below = share(&|it| it.change + it.error < change);
        let above = share(&|it| it.change - it.error > change);
        let passed = share(&|it| it.is_within(change));
        let refused = share(&|it| it.samples < LEAST_SAMPLES);
        println!(
            "{samples} samples: {below} below, {above} above, {passed} passed, {refused} refused"
        );
        assert!(below < most && above < most, "{samples}: {below}, {above}");
        assert!(passed < most, "{samples}: {passed}");
        // Twice as large a trend hardly ever passes.
        let larger = share(&|it| it.is_within(0.5 * change));
        assert!(larger < 0.01, "{samples}: {larger}");
    }
}

/// How often a steady series passes, by the resolution of its length: the least change over the
/// scatter, times the root of the number of samples. At a resolution of ten two thirds pass, at
/// fifteen nearly all.
#[test]
fn a_steady_series_passes_where_its_length_resolves_enough() {
    for (samples, least, expected) in [
        (100.0, 0.5, 0.0..0.1),
        (100.0, 1.0, 0.6..0.8),
        (400.0, 0.5, 0.6..0.8),
        (100.0, 1.5, 0.95..1.0),
        (400.0, 0.75, 0.95..1.0),
    ] {
        let time = FRAMES as f64 / samples;
        let passed = share(|seed| trend(&noise(time, seed)).is_within(least));
        println!("{samples} samples, {least} of the scatter: {passed} passed");
        assert!(expected.contains(&passed), "{samples}, {least}: {passed}");
    }
}

/// Too short series are not decided: four correlation times often look like a trend.
#[test]
fn a_few_correlation_times_decide_nothing() {
    let passed = share(|seed| trend(&noise(500.0, seed)).is_within(1.5));
    println!("4 samples: {passed} passed");
    assert!(passed < 0.02, "{passed}");
}

#[test]
fn samples_are_counted_by_the_correlation_time() {
    for samples in [50.0, 100.0] {
        let time = FRAMES as f64 / samples;
        let counts = (0..200).map(|seed| trend(&noise(time, seed)).samples);
        let mean = counts.sum::<f64>() / 200.0;
        println!("{samples} samples: {mean} counted");
        assert!((mean / samples - 1.0).abs() < 0.25, "{samples}: {mean}");
    }
    // There are no more than bins.
    let white = trend(&noise(1.0, 1)).samples;
    assert!(white > 300.0 && white <= MOST_BINS as f64, "{white}");
}

/// The change itself is not noise: the correlation is taken about the line.
#[test]
fn a_change_does_not_widen_its_own_interval() {
    let [still, moving] = [0.0, 100.0].map(|change| trend(&drifting(change, 10.0, 7)));
    assert!((moving.change - still.change - 100.0).abs() < 1e-9);
    assert!((moving.error / still.error - 1.0).abs() < 1e-9);
    assert!((moving.samples / still.samples - 1.0).abs() < 1e-6);
}

#[test]
fn a_constant_series_has_no_trend_and_a_jump_is_one() {
    let still = trend(&[3.0; 100]);
    assert_eq!((still.change, still.error, still.range), (0.0, 0.0, 0.0));
    assert!(still.is_within(0.0));

    let jump: Vec<f64> = (0..100).map(|it| f64::from(u8::from(it >= 80))).collect();
    let trend = trend(&jump);
    assert!(trend.change > 0.5 && !trend.is_within(0.5), "{trend:?}");
}

/// The last e-folds of a relaxation are one correlation time, but its end does not matter.
#[test]
fn a_relaxation_passes_when_all_that_is_left_of_it_is_small() {
    let tail = |height: f64| -> Vec<f64> {
        let decay = |frame| height * libm::exp(-f64::from(frame) / 500.0);
        (0..FRAMES as i32).map(decay).collect()
    };
    assert!(trend(&tail(1.0)).samples < LEAST_SAMPLES);
    assert!(!trend(&tail(1.0)).is_within(0.5));
    assert!(trend(&tail(0.4)).is_within(0.5));
}

#[test]
fn what_has_no_blocks_or_is_no_number_has_no_trend() {
    assert_eq!(Trend::of(&[1.0; 2 * BLOCKS - 1], CONFIDENCE), None);
    assert!(Trend::of(&[1.0; 2 * BLOCKS], CONFIDENCE).is_some());
    let mut values = [1.0; 100];
    values[50] = f64::NAN;
    assert_eq!(Trend::of(&values, CONFIDENCE), None);
}
