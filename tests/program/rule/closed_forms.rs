//! Reductions of series whose values are known.

use super::run::{Noise, Run, number};
use std::f64::consts::PI;

fn near(value: f64, expected: f64, tolerance: f64) {
    let distance = (value - expected).abs();
    assert!(
        distance <= tolerance,
        "{value} is not {expected} ± {tolerance}"
    );
}

/// A sine of angular velocity 2, which the key `swirl.omega` is, plus noise.
fn sine(frames: usize, interval: f64, noise: f64, seed: u64) -> Run {
    let mut random = Noise(seed);
    let time: Vec<f64> = (0..frames).map(|frame| frame as f64 * interval).collect();
    let x: Vec<f64> = time
        .iter()
        .map(|time| libm::sin(2.0 * time) + noise * random.number())
        .collect();
    Run::at(time, &x)
}

#[test]
fn the_trend_of_a_line_is_its_slope() {
    let times = [0.0, 0.5, 0.7, 2.0, 3.5];
    let line = times.map(|time| 3.0 - 2.0 * time);
    near(
        Run::at(times.to_vec(), &line).value("trend(x)"),
        -2.0,
        1e-14,
    );
}

/// Of equidistant times from 0 to L, the slope of t² is L.
#[test]
fn the_trend_of_a_parabola_is_the_slope_of_its_chord() {
    let times: Vec<f64> = (0..=40).map(|frame| f64::from(frame) / 10.0).collect();
    let parabola: Vec<f64> = times.iter().map(|time| time * time).collect();
    near(Run::at(times, &parabola).value("trend(x)"), 4.0, 1e-13);
}

/// The variance of 1 to n is n (n + 1) / 12, divided by n - 1.
#[test]
fn the_deviation_of_a_count_is_known() {
    let count: Vec<f64> = (1..=9).map(f64::from).collect();
    near(Run::of(&count).value("deviation(x)^2"), 7.5, 1e-14);
    assert_eq!(
        Run::of(&[2.0, 4.0]).value("deviation(x)^2"),
        2.0000000000000004
    );
}

/// The mean square of sin(ωt) - sin(ωt - φ) is 1 - cos φ, twice the variance 1 minus cos φ: what
/// repeats with period φ/ω is cos φ.
#[test]
fn what_a_sine_repeats_is_a_cosine() {
    // 20 periods of π s, of 100 frames each.
    let run = sine(2001, PI / 100.0, 0.0, 0);
    near(run.value("repeats(x, 3.141592653589793)"), 1.0, 1e-6);
    near(
        run.value("repeats(x, 2 * 3.141592653589793 / swirl.omega)"),
        1.0,
        1e-6,
    );
    near(run.value("repeats(x, 1.5707963267948966)"), -1.0, 1e-2);
    near(run.value("repeats(x, 0.7853981633974483[s])"), 0.0, 1e-2);
    for phase in [0.4, 1.3, 2.9, 7.1] {
        let text = format!("repeats(x, {phase} / swirl.omega)");
        // The mean runs over no whole number of periods, of about 19.
        near(run.value(&text), libm::cos(phase), 2e-2);
    }
}

/// With noise of variance s² over a sine of variance 1/2, and T a whole number of frames, repeats
/// is (1/2) / (1/2 + s²); 40 000 frames leave a standard error below 0.01. Seed 1.
#[test]
fn noise_lowers_what_a_sine_repeats() {
    for (noise, expected) in [(0.5, 2.0 / 3.0), (1.0, 1.0 / 3.0)] {
        let run = sine(40_001, PI / 100.0, noise, 1);
        near(run.value("repeats(x, 3.141592653589793)"), expected, 0.03);
    }
}

/// Noise alone repeats nothing, if T is a whole number of frames; 40 000 frames leave a standard
/// error of about 0.005. Seed 2.
#[test]
fn noise_repeats_nothing() {
    let mut random = Noise(2);
    let noise: Vec<f64> = (0..40_000).map(|_| random.number()).collect();
    let time = (0..noise.len()).map(|frame| frame as f64).collect();
    let run = Run::at(time, &noise);
    near(run.value("repeats(x, 7)"), 0.0, 0.03);
    // Between frames, the straight line halves the variance of the noise: 1 - (1 + 1/2) / 2.
    near(run.value("repeats(x, 7.5)"), 0.25, 0.03);
}

#[test]
fn repeats_needs_two_periods_and_change() {
    let run = Run::at(vec![0.0, 1.0, 2.0, 3.0, 4.0], &[1.0, 2.0, 1.0, 2.0, 1.0]);
    near(run.value("repeats(x, 2)"), 1.0, 1e-15);
    for period in ["2.001", "100", "0", "-2", "1e308 * 10", "0 / 0"] {
        assert!(
            run.value(&format!("repeats(x, {period})")).is_nan(),
            "{period}"
        );
    }
    assert!(run.value("repeats(0 * x, 2)").is_nan());
    assert!(run.value("repeats(3, 2)").is_nan());
    assert!(number("repeats(x, 1)").evaluate(&run, 1..3).is_nan());
    assert!(!number("repeats(x, 1)").evaluate(&run, 1..4).is_nan());
    // Changes 1 and 0 after 1 s, over twice a variance of 1/3.
    let run = Run::at(vec![0.0, 1.0, 2.0], &[0.0, 1.0, 1.0]);
    near(run.value("repeats(x, 1)"), 0.25, 1e-15);
    let run = Run::at(vec![0.0, 1.0, 1e300], &[0.0, 1.0, 1.0]);
    assert!(!run.value("repeats(x, 1)").is_infinite());
    // Ten intervals of 0.1 s from 3.3 s on are shorter than 1 s by rounding.
    let time: Vec<f64> = (33..=43).map(|frame| f64::from(frame) * 0.1).collect();
    assert!(time[10] - time[0] < 1.0);
    assert!(
        !Run::at(time.clone(), &time)
            .value("repeats(x, 0.5)")
            .is_nan()
    );
}
