//! How much of a series repeats with a period.

use super::summary::variance;

/// By how much rounding may shorten a window of two periods, relative to its length.
const ROUNDING: f64 = 1e-9;

/// 1 - ⟨(x(t) - x(t - T))²⟩ / (2 variance), where x(t - T) lies on a straight line between
/// neighbouring frames: 1 if x has the period T, about 0 for noise, -1 if x has the period 2 T and
/// changes its sign after T. None if the window is shorter than 2 T or x is constant.
pub(super) fn value(series: &[f64], times: &[f64], period: f64) -> Option<f64> {
    let length = times.last()? - times.first()?;
    if !(period > 0.0 && length * (1.0 + ROUNDING) >= 2.0 * period) {
        return None;
    }
    let variance = variance(series).filter(|variance| *variance > 0.0)?;
    let (mut squares, mut count) = (0.0, 0);
    let mut before = 0;
    for (x, t) in series.iter().zip(times) {
        let past = t - period;
        if past < times[0] {
            continue;
        }
        // Times increase, so that the interval in which the past lies moves on. It stays in the
        // window even if a time is so large that nothing is left of the period.
        while before + 2 < times.len() && times[before + 1] <= past {
            before += 1;
        }
        let change = x - between(series, times, before, past);
        squares += change * change;
        count += 1;
    }
    (count > 0).then(|| 1.0 - squares / f64::from(count) / (2.0 * variance))
}

/// The value at time `at` on the straight line from frame `before` to the next one.
fn between(series: &[f64], times: &[f64], before: usize, at: f64) -> f64 {
    let part = (at - times[before]) / (times[before + 1] - times[before]);
    series[before] + part * (series[before + 1] - series[before])
}
