//! A run to judge, and random numbers.

use phase::rule::{Condition, Evidence, Expression, Names, Number, Unit, Values};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;

/// Columns and keys with their units.
pub(crate) const COLUMNS: [(&str, &str); 7] = [
    ("height_mean", "m"),
    ("height_max", "m"),
    ("wall_share", "1"),
    ("speed_mean", "m/s"),
    ("rotation", "rad/s"),
    ("kinetic", "J"),
    ("x", ""),
];

pub(crate) const KEYS: [(&str, &str, f64); 8] = [
    ("spheres.radius", "m", 0.004),
    ("spheres.density", "kg/m³", 2500.0),
    ("spheres.count", "", 100.0),
    ("swirl.omega", "rad/s", 2.0),
    ("gravity.acceleration", "m/s²", 9.81),
    ("axis[0]", "", 0.5),
    ("kinds[1].share", "", 0.25),
    ("seed", "", 7.0),
];

/// The names of all runs here.
pub(crate) struct TestNames;

impl Names for TestNames {
    fn column(&self, name: &str) -> Option<Unit> {
        let (_, unit) = COLUMNS.iter().find(|(known, _)| *known == name)?;
        Some(unit_of(unit))
    }

    fn key(&self, path: &str) -> Option<Unit> {
        let (_, unit, _) = KEYS.iter().find(|(known, _, _)| *known == path)?;
        Some(unit_of(unit))
    }

    fn suggestions(&self) -> Vec<String> {
        let columns = COLUMNS.iter().map(|(name, _)| *name);
        let keys = KEYS.iter().map(|(name, _, _)| *name);
        columns.chain(keys).map(str::to_owned).collect()
    }
}

pub(crate) fn unit_of(text: &str) -> Unit {
    Unit::parse(text).unwrap_or_else(|error| panic!("{}", error.render(text)))
}

/// A run with given columns; columns that it lacks are empty.
#[derive(Clone, Default)]
pub(crate) struct Run {
    pub(crate) time: Vec<f64>,
    pub(crate) columns: BTreeMap<&'static str, Vec<f64>>,
}

impl Run {
    /// A run with the column `x` and a frame every 0.1 s.
    pub(crate) fn of(x: &[f64]) -> Self {
        Self::at((0..x.len()).map(|frame| frame as f64 / 10.0).collect(), x)
    }

    /// A run with the column `x` at given times.
    pub(crate) fn at(time: Vec<f64>, x: &[f64]) -> Self {
        Self {
            time,
            columns: BTreeMap::from([("x", x.to_vec())]),
        }
    }

    /// All frames.
    pub(crate) fn all(&self) -> Range<usize> {
        0..self.time.len()
    }

    /// The value of a number over all frames.
    pub(crate) fn value(&self, text: &str) -> f64 {
        number(text).evaluate(self, self.all())
    }

    /// The evidence of a condition over all frames.
    pub(crate) fn evidence(&self, text: &str) -> Evidence {
        condition(text).evaluate(self, self.all())
    }
}

impl Values for Run {
    fn time(&self) -> &[f64] {
        &self.time
    }

    fn column(&self, name: &str) -> Cow<'_, [f64]> {
        Cow::Borrowed(self.columns.get(name).map_or(&[], Vec::as_slice))
    }

    fn key(&self, path: &str) -> f64 {
        let key = KEYS.iter().find(|(known, _, _)| *known == path);
        key.map_or(f64::NAN, |(_, _, value)| *value)
    }
}

pub(crate) fn parse(text: &str) -> Expression {
    Expression::parse(text).unwrap_or_else(|error| panic!("{}", error.render(text)))
}

pub(crate) fn number(text: &str) -> Number {
    let number = parse(text).number(&TestNames);
    number.unwrap_or_else(|error| panic!("{}", error.render(text)))
}

pub(crate) fn condition(text: &str) -> Condition {
    let condition = parse(text).condition(&TestNames);
    condition.unwrap_or_else(|error| panic!("{}", error.render(text)))
}

/// Random numbers of a seed (SplitMix64).
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number of mean 0 and variance 1: a uniform one.
    pub(crate) fn number(&mut self) -> f64 {
        let uniform = (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        (uniform - 0.5) * 12_f64.sqrt()
    }
}
