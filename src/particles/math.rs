//! Mathematics with the same bits on every machine.

/// Exponential function, within 2 units in the last place for -708 < x < 709; below that range it
/// returns exp(-708), which is indistinguishable from zero in any force. Without branches, so that
/// a loop over it is vectorised. Cody and Waite (1980) reduction, then the Taylor series on |r| <
/// ln(2)/2.
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    const LOG2_E: f64 = std::f64::consts::LOG2_E;
    // ln 2 in two parts; the first has 21 trailing zero bits, so that k times it is exact.
    const LN2_HIGH: f64 = 6.931_471_803_691_238e-1;
    const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    // Adding this rounds to an integer, in the low bits of the sum.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const LOWEST: f64 = -708.0;
    const HIGHEST: f64 = 709.0;

    let bounded = if x < LOWEST { LOWEST } else { x };
    let shifted = bounded * LOG2_E + ROUND;
    let k = shifted - ROUND;
    let r = (bounded - k * LN2_HIGH) - k * LN2_LOW;
    let series = series(r);
    let power_of_two = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
    if x > HIGHEST {
        f64::INFINITY
    } else {
        series * power_of_two
    }
}

/// 1 / sqrt(x), within 2 units in the last place for 1e-290 < x < 1e290; for x = 0 a large number,
/// whose product with zero is zero.
///
/// Four steps of Newton's method from a guess that halves the exponent (Lomont (2003), for double
/// precision). A processor computes roots and quotients one by one, but multiplies many numbers at
/// once: this makes a loop over contacts faster.
#[inline(always)]
pub fn inverse_square_root(x: f64) -> f64 {
    const GUESS: u64 = 0x5fe6_eb50_c7b5_37a9;
    let half = 0.5 * x;
    let mut root = f64::from_bits(GUESS.wrapping_sub(x.to_bits() >> 1));
    let mut step = 0;
    while step < 4 {
        root *= 1.5 - half * root * root;
        step += 1;
    }
    root
}

/// The series up to r^13, in pairs of pairs (Estrin (1960)): Horner's method would wait for every
/// term.
#[inline(always)]
fn series(r: f64) -> f64 {
    const C: [f64; 14] = INVERSE_FACTORIALS;
    let r2 = r * r;
    let r4 = r2 * r2;
    let r8 = r4 * r4;
    let pair = |k: usize| C[k] + C[k + 1] * r;
    let four = |k: usize| pair(k) + pair(k + 2) * r2;
    let low = four(0) + four(4) * r4;
    let high = four(8) + pair(12) * r4;
    low + high * r8
}

const INVERSE_FACTORIALS: [f64; 14] = [
    1.0,
    1.0,
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

#[cfg(test)]
mod tests {
    use super::{exp, inverse_square_root};
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn exponential_agrees_with_libm(x in -700.0..700.0) {
            let reference = libm::exp(x);
            let ulp = reference * f64::EPSILON;
            prop_assert!((exp(x) - reference).abs() <= 2.0 * ulp, "exp({x})");
        }
    }

    proptest! {
        #[test]
        fn inverse_roots_agree_with_the_processor(exponent in -280.0..280.0, share in 1.0..10.0) {
            let x: f64 = share * libm::pow(10.0, exponent);
            let reference = 1.0 / x.sqrt();
            let ulp = reference * f64::EPSILON;
            prop_assert!((inverse_square_root(x) - reference).abs() <= 2.0 * ulp, "of {x}");
        }
    }

    #[test]
    fn inverse_roots_at_the_ends() {
        assert_eq!(0.0 * inverse_square_root(0.0), 0.0);
        assert!(inverse_square_root(f64::NAN).is_nan());
    }

    #[test]
    fn exponential_at_the_ends() {
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(exp(1e4), f64::INFINITY);
        assert!(exp(-1e4) < 1e-300);
        assert!(exp(f64::NAN).is_nan());
    }
}
