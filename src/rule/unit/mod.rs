//! Units: products of powers of SI units.

mod text;

use serde::{Serialize, Serializer};
use std::fmt::{Display, Formatter, Result};

/// Powers are stored in sixteenths, so that roots of roots are exact.
const PARTS: i32 = 16;

/// Largest power of a base unit, in sixteenths.
const LARGEST: i32 = 1000 * PARTS;

/// A product of powers of kg, m, s and rad.
///
/// The radian counts as 1 in sums and comparisons, and is shown in angles and their rates only.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    /// Powers of the base units, in sixteenths.
    powers: [i32; 4],
}

/// Symbols of the base units, in the order of the powers.
const BASE: [&str; 4] = ["kg", "m", "s", "rad"];

/// Units of one symbol, with whole powers of the base units.
const SYMBOLS: [(&str, [i32; 4]); 10] = [
    ("m", [0, 1, 0, 0]),
    ("s", [0, 0, 1, 0]),
    ("kg", [1, 0, 0, 0]),
    ("rad", [0, 0, 0, 1]),
    ("1", [0, 0, 0, 0]),
    ("Hz", [0, 0, -1, 0]),
    ("N", [1, 1, -2, 0]),
    ("J", [1, 2, -2, 0]),
    ("Pa", [1, -1, -2, 0]),
    ("W", [1, 2, -3, 0]),
];

/// Products of base units that are shown as one symbol.
const SHORT: [&str; 4] = ["N", "J", "Pa", "W"];

impl Unit {
    /// The unit of pure numbers.
    pub const ONE: Self = Self { powers: [0; 4] };

    /// The unit of times.
    pub(in crate::rule) const SECOND: Self = Self {
        powers: [0, 0, PARTS, 0],
    };

    /// The unit of that symbol.
    fn of_symbol(symbol: &str) -> Option<Self> {
        let (_, powers) = SYMBOLS.iter().find(|(name, _)| *name == symbol)?;
        Some(Self {
            powers: powers.map(|power| power * PARTS),
        })
    }

    /// The product; none if a power is too large.
    pub(in crate::rule) fn times(self, other: Self) -> Option<Self> {
        self.each(|place, power| power + other.powers[place])
    }

    /// The quotient; none if a power is too large.
    pub(in crate::rule) fn over(self, other: Self) -> Option<Self> {
        self.each(|place, power| power - other.powers[place])
    }

    /// The power of that exponent; none if a power is too large, or no multiple of 1/16.
    pub(in crate::rule) fn raised(self, exponent: f64) -> Option<Self> {
        let raised = self.powers.map(|power| f64::from(power) * exponent);
        let exact = |power: &f64| power.fract() == 0.0 && power.abs() <= f64::from(LARGEST);
        raised.iter().all(exact).then(|| Self {
            powers: raised.map(|power| power as i32),
        })
    }

    /// The unit whose powers are those that `power` makes of the place of a power and its value;
    /// none if one is too large.
    fn each(self, power: impl Fn(usize, i32) -> i32) -> Option<Self> {
        let mut powers = self.powers;
        for (place, it) in powers.iter_mut().enumerate() {
            *it = power(place, *it);
        }
        let small = powers.iter().all(|power| power.abs() <= LARGEST);
        small.then_some(Self { powers })
    }

    /// Powers of kg, m and s.
    fn dimension(self) -> [i32; 3] {
        let [kilogram, metre, second, _] = self.powers;
        [kilogram, metre, second]
    }
}

/// Units are equal if their quantities can be added.
impl PartialEq for Unit {
    fn eq(&self, other: &Self) -> bool {
        self.dimension() == other.dimension()
    }
}

impl Eq for Unit {}

impl Display for Unit {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        let is_short = |symbol: &&&str| Self::of_symbol(symbol) == Some(*self);
        if let Some(symbol) = SHORT.iter().find(is_short) {
            return formatter.write_str(symbol);
        }
        let mut powers = self.powers;
        if !matches!(powers, [0, 0, _, PARTS]) {
            powers[3] = 0;
        }
        let factors = || BASE.into_iter().zip(powers);
        let above: Vec<_> = factors().filter(|(_, power)| *power > 0).collect();
        let below: Vec<_> = factors().filter(|(_, power)| *power < 0).collect();
        match (above.as_slice(), below.as_slice()) {
            ([], []) => formatter.write_str("1"),
            ([], [factor]) => write!(formatter, "1/{}", symbol_of(factor)),
            (_, [factor]) => write!(formatter, "{}/{}", product(&above), symbol_of(factor)),
            _ => formatter.write_str(&product(&[above, below].concat())),
        }
    }
}

impl Serialize for Unit {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

fn product(factors: &[(&str, i32)]) -> String {
    let written: Vec<_> = factors.iter().map(power_of).collect();
    written.join(" ")
}

/// The factor without the sign of its exponent, for behind a slash.
fn symbol_of(&(symbol, power): &(&str, i32)) -> String {
    power_of(&(symbol, power.abs()))
}

fn power_of(&(symbol, power): &(&str, i32)) -> String {
    match power {
        PARTS => symbol.to_owned(),
        _ => format!("{symbol}^{}", f64::from(power) / f64::from(PARTS)),
    }
}
