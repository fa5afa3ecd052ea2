//! Numbers for people.

/// Digits of a number that need not be told from others.
const DIGITS: usize = 4;

/// Digits that tell any two numbers apart.
const MOST_DIGITS: usize = 17;

/// A number for people: at most four digits, a power of ten if it is very large or very small.
pub(super) fn number(value: f64) -> String {
    written(value, DIGITS)
}

/// A number among others, with as many digits more as tell it from them: it is read back nearer to
/// its own value than to any other.
pub(super) fn among(value: f64, all: &[f64]) -> String {
    let gaps = all.iter().map(|other| (other - value).abs());
    let gap = gaps.filter(|gap| *gap > 0.0).fold(f64::INFINITY, f64::min);
    let is_told = |digits: &usize| (rounded_value(value, *digits) - value).abs() < 0.25 * gap;
    let digits = (DIGITS..MOST_DIGITS).find(is_told);
    written(value, digits.unwrap_or(MOST_DIGITS))
}

/// A number with so many significant digits, the rest of them zeros.
pub(super) fn rounded(value: f64, digits: usize) -> String {
    number(rounded_value(value, digits))
}

/// A number, rounded to so many significant digits.
pub(super) fn rounded_value(value: f64, digits: usize) -> f64 {
    let written = format!("{value:.*e}", digits.saturating_sub(1));
    written.parse().unwrap_or(value)
}

/// A number of at most so many digits.
fn written(value: f64, digits: usize) -> String {
    let plain = minus(rounded_value(value, digits).to_string());
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) {
        return plain;
    }
    let power = scientific(value, digits);
    // A power of ten is easy to read as long as it has few digits.
    let is_short = digits > DIGITS && plain.chars().count() <= power.chars().count();
    if is_short { plain } else { power }
}

/// A number with a power of ten, of at most so many digits.
pub(super) fn scientific(value: f64, digits: usize) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let written = format!("{:e}", rounded_value(value, digits));
    let (mantissa, exponent) = written.split_once('e').unwrap_or((&written, "0"));
    let power: String = exponent.chars().map(superscript).collect();
    match mantissa {
        "1" => format!("10{power}"),
        "-1" => format!("−10{power}"),
        _ => format!("{}×10{power}", minus(mantissa.to_owned())),
    }
}

/// A number with so many decimals.
pub(super) fn decimal(value: f64, decimals: usize) -> String {
    minus(format!("{value:.decimals$}"))
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
pub(super) mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The value of a label.
    pub(crate) fn parsed(label: &str) -> f64 {
        const SUPERSCRIPTS: &str = "⁰¹²³⁴⁵⁶⁷⁸⁹";
        let digit = |c: char| match SUPERSCRIPTS.chars().position(|it| it == c) {
            Some(digit) => digit.to_string(),
            None => c.to_string().replace('⁻', "-"),
        };
        let plain = label.replace('−', "-");
        let is_power = |c: char| c == '⁻' || SUPERSCRIPTS.contains(c);
        match plain.find(is_power) {
            None => plain.parse().unwrap(),
            Some(at) => {
                let exponent: String = plain[at..].chars().map(digit).collect();
                let mantissa = plain[..at].strip_suffix("10").unwrap();
                let mantissa = mantissa.strip_suffix('×').unwrap_or(mantissa);
                let mantissa = if mantissa.is_empty() { "1" } else { mantissa };
                let mantissa = mantissa.replace('-', if mantissa == "-" { "-1" } else { "-" });
                format!("{mantissa}e{exponent}").parse().unwrap()
            }
        }
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
            assert!((parsed(expected) - value).abs() <= 1e-4 * value.abs());
        }
    }

    /// Symptom: three panels "3750", ticks "10⁵" five times. Cause: four digits, whatever the other
    /// values are.
    #[test]
    fn as_many_digits_as_tell_values_apart() {
        for (values, expected) in [
            (
                &[3750.1, 3750.2, 3750.3][..],
                &["3750.1", "3750.2", "3750.3"][..],
            ),
            (&[100_001.0, 100_002.0], &["100001", "100002"]),
            (&[0.003_000_1 * 1e3, 3.0003], &["3.0001", "3.0003"]),
            (&[1.00001e20, 1.00002e20], &["1.00001×10²⁰", "1.00002×10²⁰"]),
            (
                &[0.3, 0.300_000_000_000_000_04],
                &["0.3", "0.30000000000000004"],
            ),
            (&[1000.0, 2000.0], &["1000", "2000"]),
            (&[1e5, 2e5], &["10⁵", "2×10⁵"]),
        ] {
            let found: Vec<String> = values.iter().map(|it| among(*it, values)).collect();
            assert_eq!(found, expected);
        }
    }

    /// Values that are close together somewhere.
    pub(crate) fn close_values() -> impl Strategy<Value = Vec<f64>> {
        let offset = prop_oneof![Just(0.0), -1.0..1.0_f64];
        let exponents = (-12..12_i32, -14..3_i32);
        let steps = prop::collection::vec(-50..50_i32, 2..9);
        let values = (offset, exponents, steps).prop_map(|(offset, (size, step), steps)| {
            let offset = offset * libm::exp10(f64::from(size));
            let step = libm::exp10(f64::from(size + step));
            let values = steps.iter().map(|count| offset + f64::from(*count) * step);
            let mut values: Vec<f64> = values.collect();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        });
        values.prop_filter("two values at least", |values| values.len() > 1)
    }

    proptest! {
        #[test]
        fn labels_of_different_values_differ_and_are_read_back(values in close_values()) {
            let labels: Vec<String> = values.iter().map(|it| among(*it, &values)).collect();
            for (index, pair) in values.windows(2).enumerate() {
                let half = 0.5 * (pair[1] - pair[0]);
                prop_assert_ne!(&labels[index], &labels[index + 1]);
                for (value, label) in pair.iter().zip(&labels[index..]) {
                    prop_assert!((parsed(label) - value).abs() < half, "{value} {label}");
                }
            }
        }
    }
}
