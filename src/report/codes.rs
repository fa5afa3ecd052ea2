//! Numbers as codes of one or two bytes: small in a page, and exact enough to look at.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use miniz_oxide::deflate::compress_to_vec_zlib;

/// Level of compression.
const LEVEL: u8 = 9;

/// Codes of columns of numbers, of so many bytes each.
pub(super) struct Codes {
    width: u32,
    bytes: Vec<u8>,
}

impl Codes {
    pub(super) fn new(width: u32) -> Self {
        Self {
            width,
            bytes: Vec::new(),
        }
    }

    /// Adds numbers between two ends: the differences of neighbouring codes, their low bytes first.
    /// A number that is not finite has the largest code.
    pub(super) fn add(&mut self, values: &[f64], [low, high]: [f64; 2]) {
        let none = (1_i64 << (8 * self.width)) - 1;
        let span = if high > low { high - low } else { 1.0 };
        let code = |value: &f64| match value.is_finite() {
            true => {
                let share = ((value - low) / span).clamp(0.0, 1.0);
                libm::rint(share * (none - 1) as f64) as i64
            }
            false => none,
        };
        let codes: Vec<i64> = values.iter().map(code).collect();
        let before = [0].iter().chain(&codes);
        let steps = codes.iter().zip(before).map(|(code, before)| code - before);
        let steps: Vec<i64> = steps.map(|it| it.rem_euclid(none + 1)).collect();
        for byte in 0..self.width {
            self.bytes
                .extend(steps.iter().map(|it| (it >> (8 * byte)) as u8));
        }
    }

    /// All of them as text.
    pub(super) fn text(&self) -> String {
        STANDARD.encode(compress_to_vec_zlib(&self.bytes, LEVEL))
    }
}

/// The least and the largest of the numbers that are finite; 0 and 1 without any.
pub(super) fn ends(values: &[f64]) -> [f64; 2] {
    let finite = || values.iter().copied().filter(|it| it.is_finite());
    match finite().reduce(f64::min).zip(finite().reduce(f64::max)) {
        Some((low, high)) => [rounded(low), rounded(high)],
        None => [0.0, 1.0],
    }
}

/// A number with six digits.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use miniz_oxide::inflate::decompress_to_vec_zlib;
    use proptest::prelude::*;

    /// The numbers that a page reads.
    fn read(codes: &Codes, count: usize, [low, high]: [f64; 2]) -> Vec<f64> {
        let packed = STANDARD.decode(codes.text()).unwrap();
        let bytes = decompress_to_vec_zlib(&packed).unwrap();
        let none = (1_i64 << (8 * codes.width)) - 1;
        let mut code = 0;
        (0..count)
            .map(|place| {
                let step = (0..codes.width as usize)
                    .map(|byte| i64::from(bytes[byte * count + place]) << (8 * byte))
                    .sum::<i64>();
                code = (code + step) % (none + 1);
                match code == none {
                    true => f64::NAN,
                    false => low + (high - low) * code as f64 / (none - 1) as f64,
                }
            })
            .collect()
    }

    proptest! {
        #[test]
        fn numbers_come_back_to_a_part_of_their_range(
            values in prop::collection::vec(prop_oneof![-1e6..1e6_f64, Just(f64::NAN)], 1..50),
            width in 1..=2_u32,
        ) {
            let ends = ends(&values);
            let mut codes = Codes::new(width);
            codes.add(&values, ends);
            let found = read(&codes, values.len(), ends);
            let part = (ends[1] - ends[0]) / ((1_u64 << (8 * width)) as f64 - 2.0);
            for (value, found) in values.iter().zip(found) {
                prop_assert_eq!(value.is_nan(), found.is_nan());
                let rounding = 1e-5 * value.abs();
                prop_assert!(value.is_nan() || (value - found).abs() <= 0.51 * part + rounding);
            }
        }
    }
}
