//! Numbers at equal steps or equal ratios, as clean decimals.

/// Largest number of values of one axis.
pub(crate) const MOST_VALUES: usize = 100_000;

/// Number of steps of `step` from `from` to `to`, if it is whole within rounding.
pub(crate) fn whole_steps(from: f64, to: f64, step: f64) -> Option<f64> {
    let steps = (to - from) / step;
    let whole = libm::round(steps);
    ((steps - whole).abs() <= 1e-6).then_some(whole)
}

/// `from`, `from + step` and so on, `steps` + 1 values: the doubles nearest to the decimals, so
/// that 0.002 + 17 x 0.0001 is 0.0037.
pub(crate) fn steps(from: f64, step: f64, steps: usize) -> Vec<f64> {
    let last = from + steps as f64 * step;
    let scale = from.abs().max(last.abs()).max(step);
    (0..=steps)
        .map(|k| clean(from + k as f64 * step, scale, 15))
        .collect()
}

/// `count` values from `from` to `to` at equal distances.
pub(crate) fn linear(from: f64, to: f64, count: usize) -> Vec<f64> {
    let scale = from.abs().max(to.abs());
    ends(from, to, count, |share| {
        clean(from + (to - from) * share, scale, 15)
    })
}

/// `count` values from `from` to `to`, both positive, at equal ratios.
pub(crate) fn logarithmic(from: f64, to: f64, count: usize) -> Vec<f64> {
    ends(from, to, count, |share| {
        let value = from * libm::pow(to / from, share);
        clean(value, value, 12)
    })
}

/// Values at shares from 0 to 1, the ends exact.
fn ends(from: f64, to: f64, count: usize, at: impl Fn(f64) -> f64) -> Vec<f64> {
    let last = count - 1;
    (0..count)
        .map(|k| match k {
            0 => from,
            k if k == last => to,
            k => at(k as f64 / last as f64),
        })
        .collect()
}

/// `value`, rounded to the decimals that `scale` has with this number of significant digits.
pub(crate) fn clean(value: f64, scale: f64, digits: i32) -> f64 {
    let scientific = format!("{scale:e}");
    let exponent = scientific
        .split('e')
        .nth(1)
        .and_then(|text| text.parse::<i32>().ok());
    let decimals = (digits - 1 - exponent.unwrap_or(0)).max(0);
    let clean: f64 = format!("{value:.*}", decimals as usize)
        .parse()
        .unwrap_or(value);
    // Minus zero is a zero too.
    clean + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn steps_are_the_decimals_one_would_write() {
        let values = steps(0.002, 0.0001, 40);
        assert_eq!(values.len(), 41);
        for (k, value) in values.iter().enumerate() {
            let written: f64 = format!("{}e-4", 20 + k).parse().unwrap();
            assert_eq!(value.to_bits(), written.to_bits());
        }
        assert_eq!(steps(-0.3, 0.1, 6)[3].to_bits(), 0.0_f64.to_bits());
        assert_eq!(steps(0.0, 1e20, 3), [0.0, 1e20, 2e20, 3e20]);
    }

    #[test]
    fn equal_ratios_are_clean_too() {
        assert_eq!(logarithmic(1e-3, 10.0, 5), [1e-3, 1e-2, 0.1, 1.0, 10.0]);
        assert_eq!(linear(0.0, 1.0, 11)[3], 0.3);
    }

    proptest! {
        #[test]
        fn steps_rise_end_where_they_should_and_are_unique(
            from in -1000_i32..1000,
            step in 1_i32..500,
            count in 1_usize..200,
            exponent in -9_i32..9,
        ) {
            let number = |digits: i32| format!("{digits}e{exponent}").parse::<f64>().unwrap();
            let to = number(from + step * count as i32);
            let whole = whole_steps(number(from), to, number(step)).unwrap();
            prop_assert_eq!(whole as usize, count);
            let values = steps(number(from), number(step), count);
            prop_assert_eq!(values.len(), count + 1);
            prop_assert_eq!(values[0], number(from));
            prop_assert_eq!(values[count], to);
            prop_assert!(values.windows(2).all(|pair| pair[0] < pair[1]));
        }

        #[test]
        fn spacings_rise_and_keep_their_ends(
            from in 1e-6..1e3_f64, ratio in 1.01..1e6_f64, count in 2_usize..300,
        ) {
            let to = from * ratio;
            for values in [linear(from, to, count), logarithmic(from, to, count)] {
                prop_assert_eq!(values.len(), count);
                prop_assert_eq!((values[0], values[count - 1]), (from, to));
                prop_assert!(values.windows(2).all(|pair| pair[0] < pair[1]));
            }
        }
    }
}
