//! Numbers that messages suggest: short, and accepted by the check.

use super::number;

/// Decimals of the first try: six significant digits.
const DECIMALS: usize = 5;

/// Decimals with which a number is written exactly.
const ALL_DECIMALS: usize = 16;

/// The shortest number next to `value` that the check accepts, to six significant digits or more.
/// `None` if the check refuses `value` itself.
pub(crate) fn accepted(value: f64, accepts: impl Fn(f64) -> bool) -> Option<String> {
    shortest(value, accepts).map(number)
}

/// `value`, rounded up if necessary: accepted where `value` is the minimum.
pub(crate) fn at_least(value: f64) -> String {
    number(rounded_up(value))
}

/// `value`, rounded down if necessary: accepted where `value` is the maximum.
pub(crate) fn at_most(value: f64) -> String {
    number(rounded_down(value))
}

/// The number that [`at_least`] writes.
pub(crate) fn rounded_up(value: f64) -> f64 {
    shortest(value, |candidate| candidate >= value).unwrap_or(value)
}

/// The number that [`at_most`] writes.
pub(crate) fn rounded_down(value: f64) -> f64 {
    shortest(value, |candidate| candidate <= value).unwrap_or(value)
}

fn shortest(value: f64, accepts: impl Fn(f64) -> bool) -> Option<f64> {
    (DECIMALS..=ALL_DECIMALS)
        .flat_map(|decimals| neighbours(value, decimals))
        .find(|candidate| accepts(*candidate))
}

/// The number with `decimals` decimals nearest to `value`, and the next ones above and below.
fn neighbours(value: f64, decimals: usize) -> [f64; 3] {
    let round = |value: f64| format!("{value:.decimals$e}");
    let nearest = round(value);
    let exponent = nearest.split('e').nth(1).and_then(|it| it.parse().ok());
    let last_place = exponent.map_or(0, |exponent: i32| exponent - decimals as i32);
    let parse = |text: &str| text.parse().unwrap_or(value);
    let (unit, nearest) = (parse(&format!("1e{last_place}")), parse(&nearest));
    [nearest, nearest + unit, nearest - unit].map(|it| parse(&round(it)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn numbers_are_as_short_as_the_check_allows() {
        assert_eq!(at_least(0.1 + 0.2), "0.300001");
        assert_eq!(at_most(0.1 + 0.2), "0.3");
        assert_eq!(at_most(2.0 / 3.0), "0.666666");
        assert_eq!(at_least(-2.0 / 3.0), "-0.666666");
        assert_eq!(at_least(0.0), "0");
        let whole = |candidate: f64| (candidate * 3.0 - 2e5).abs() < 5e-4;
        assert_eq!(accepted(2e5 / 3.0, whole).as_deref(), Some("66666.6667"));
        assert_eq!(accepted(1.0, |_| false), None);
    }

    proptest! {
        #[test]
        fn limits_are_kept(digits in -1e6..1e6_f64, exponent in -30_i32..30) {
            let value = digits * libm::pow(10.0, f64::from(exponent));
            let (least, most) = (at_least(value), at_most(value));
            let read = |text: &str| text.parse::<f64>().unwrap();
            prop_assert!(read(&least) >= value && read(&most) <= value);
            let near = 2e-5 * value.abs();
            prop_assert!(read(&least) - value <= near && value - read(&most) <= near);
        }
    }
}
