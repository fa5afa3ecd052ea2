//! Formulas and conditions, whose names are indices.

use crate::rule::syntax::{Arithmetic, Comparator, Mathematics, Summary};
use crate::rule::unit::Unit;

/// A number. `Slot` says what depends on the run besides keys.
#[derive(Clone, Debug)]
pub(in crate::rule) enum Formula<Slot> {
    Number(f64),
    /// A key, by its index among those that are needed.
    Key(usize),
    At(Slot),
    Negative(Box<Self>),
    Calculation(Arithmetic, Box<Self>, Box<Self>),
    Power(Box<Self>, f64),
    Function(Mathematics, Vec<Self>),
}

/// A column at the frame that is looked at, by its index among those that are needed.
#[derive(Clone, Copy, Debug)]
pub(in crate::rule) struct ColumnPlace(pub(in crate::rule) usize);

/// One number of all frames of a window.
#[derive(Clone, Debug)]
pub(in crate::rule) enum Reduction {
    Of(Summary, Formula<ColumnPlace>),
    /// The share of frames in which something holds.
    Share(Test<ColumnPlace>),
    /// How much of a number repeats with a period.
    Repeats(Formula<ColumnPlace>, Formula<Nothing>),
}

/// What is never there: the formula depends on keys only.
#[derive(Clone, Copy, Debug)]
pub(in crate::rule) enum Nothing {}

/// A condition.
#[derive(Clone, Debug)]
pub(in crate::rule) enum Test<Slot> {
    Comparison(Comparison<Slot>),
    Not(Box<Self>),
    And(Box<Self>, Box<Self>),
    Or(Box<Self>, Box<Self>),
}

/// A comparison of a value with a threshold.
#[derive(Clone, Debug)]
pub(in crate::rule) struct Comparison<Slot> {
    pub(in crate::rule) order: Comparator,
    pub(in crate::rule) value: Formula<Slot>,
    pub(in crate::rule) threshold: Formula<Slot>,
    pub(in crate::rule) unit: Unit,
    /// Its normal form.
    pub(in crate::rule) text: String,
}

impl<Slot> Formula<Slot> {
    /// Its value, from the values of keys and of what stands in its places.
    pub(in crate::rule) fn value<F: Fn(&Slot) -> f64>(&self, keys: &[f64], at: &F) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Key(index) => keys[*index],
            Self::At(place) => at(place),
            Self::Negative(operand) => -operand.value(keys, at),
            Self::Calculation(arithmetic, left, right) => {
                arithmetic.of(left.value(keys, at), right.value(keys, at))
            }
            Self::Power(base, exponent) => libm::pow(base.value(keys, at), *exponent),
            Self::Function(function, arguments) => match arguments.as_slice() {
                [one] => of_one(*function, one.value(keys, at)),
                [one, other] => of_two(*function, one.value(keys, at), other.value(keys, at)),
                _ => f64::NAN,
            },
        }
    }
}

impl<Slot> Test<Slot> {
    /// Whether it holds.
    pub(in crate::rule) fn holds<F: Fn(&Slot) -> f64>(&self, keys: &[f64], at: &F) -> bool {
        match self {
            Self::Comparison(it) => {
                let (value, threshold) = (it.value.value(keys, at), it.threshold.value(keys, at));
                it.order.holds(value, threshold)
            }
            Self::Not(operand) => !operand.holds(keys, at),
            Self::And(left, right) => left.holds(keys, at) && right.holds(keys, at),
            Self::Or(left, right) => left.holds(keys, at) || right.holds(keys, at),
        }
    }
}

fn of_one(function: Mathematics, value: f64) -> f64 {
    match function {
        Mathematics::Abs => value.abs(),
        Mathematics::Sqrt => libm::sqrt(value),
        Mathematics::Exp => libm::exp(value),
        Mathematics::Log => libm::log(value),
        Mathematics::Sin => libm::sin(value),
        Mathematics::Cos => libm::cos(value),
        Mathematics::Tan => libm::tan(value),
        // Each takes two values, as the parser saw to.
        Mathematics::Lesser | Mathematics::Greater => f64::NAN,
    }
}

/// The lesser or greater of two numbers; not a number if one is not. Which zero is the lesser one
/// must not depend on the machine, as it may for [`f64::min`].
fn of_two(function: Mathematics, one: f64, other: f64) -> f64 {
    let takes_other = match function {
        Mathematics::Lesser => other < one,
        _ => other > one,
    };
    match takes_other {
        _ if one.is_nan() || other.is_nan() => f64::NAN,
        true => other,
        false => one,
    }
}
