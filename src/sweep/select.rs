//! Choosing points of a sweep by the values of its axes.

use super::Sweep;
use crate::grid::{Axis, VARIANT};
use crate::scene::LARGEST_SEED;
use std::fmt::{self, Display};

/// What names a seed in a point.
const SEED: &str = "seed";

/// Most values that are all named where none of them is meant.
const FEW: usize = 12;

/// Points of a sweep, such as `radius=0.003,omega=6,seed=2`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Values, each with the name of its axis or the path of its key.
    pub values: Vec<(String, f64)>,
    /// The name of the variant, if one is meant.
    pub variant: Option<String>,
    /// The seed, if one is meant.
    pub seed: Option<u64>,
}

/// Why no point could be chosen.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SelectError {
    /// The text is no list of `name=value`.
    #[error("`{0}` is not of the form `name=value`, such as `radius=0.003,omega=6`")]
    Syntax(String),
    /// The text says something else than a seed.
    #[error("`seed={0}`: a seed is a whole number from 0 to {LARGEST_SEED}")]
    Seed(String),
    /// Two values of one axis, or two seeds.
    #[error("the point gives `{0}` twice; give each value once, and each point by itself")]
    Repeated(String),
    /// The sweep has no such axis.
    #[error("the sweep has no axis `{name}`; it has {known}")]
    Axis {
        /// What was asked for.
        name: String,
        /// The sweep's axes.
        known: String,
    },
    /// The axis has no such value.
    #[error("`{name}` is never {value}; {values}")]
    Value {
        /// Name of the axis.
        name: String,
        /// What was asked for.
        value: String,
        /// The values of the axis: a part of a sentence.
        values: String,
    },
}

crate::refusal::always!(true: SelectError);

/// Reads the values of a point, such as `radius=0.003,omega=6`, and its seed, if it has one.
///
/// # Errors
/// [`SelectError::Syntax`] or [`SelectError::Seed`] with the part that is at fault, or
/// [`SelectError::Repeated`].
pub fn parse_point(text: &str) -> Result<Selection, SelectError> {
    let mut selection = Selection::default();
    for part in text.split(',') {
        let syntax = || SelectError::Syntax(part.trim().to_owned());
        let (name, value) = part.split_once('=').ok_or_else(syntax)?;
        let (name, value) = (name.trim(), value.trim());
        let is_known = |(known, _): &(String, f64)| known == name;
        let is_repeated = match name {
            SEED => selection.seed.is_some(),
            VARIANT => selection.variant.is_some(),
            _ => selection.values.iter().any(is_known),
        };
        if is_repeated {
            return Err(SelectError::Repeated(name.to_owned()));
        }
        if name == SEED {
            let seed = value.parse().ok().filter(|seed| *seed <= LARGEST_SEED);
            let seed = seed.ok_or_else(|| SelectError::Seed(value.to_owned()))?;
            selection.seed = Some(seed);
        } else if name == VARIANT && !value.is_empty() {
            selection.variant = Some(value.to_owned());
        } else {
            let value = value.parse().ok().filter(|value: &f64| value.is_finite());
            let value = value.ok_or_else(syntax)?;
            selection.values.push((name.to_owned(), value));
        }
    }
    Ok(selection)
}

impl Display for Selection {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values = self.values.iter();
        let values = values.map(|(name, value)| format!("{name} = {value}"));
        let seed = self.seed.map(|seed| format!("{SEED} = {seed}"));
        let variant = self
            .variant
            .iter()
            .map(|name| format!("{VARIANT} = {name}"));
        let parts: Vec<String> = values.chain(variant).chain(seed).collect();
        formatter.write_str(&parts.join(", "))
    }
}

impl Sweep {
    /// This sweep with only the named values left on the named axes, and only the seed that is
    /// named. A value is one of its axis with all its digits: a neighbour is another run.
    ///
    /// # Errors
    /// [`SelectError::Axis`], [`SelectError::Value`] or [`SelectError::Repeated`].
    pub fn select(&self, point: &Selection) -> Result<Self, SelectError> {
        let mut chosen = self.clone();
        let mut named = Vec::new();
        for (name, value) in &point.values {
            let is_named = |axis: &Axis| axis.name == *name || axis.key == *name;
            let Some(place) = self.axes.iter().position(is_named) else {
                return Err(no_axis(&self.axes, name));
            };
            if named.contains(&place) {
                return Err(SelectError::Repeated(name.clone()));
            }
            named.push(place);
            let values = &self.axes[place].values;
            // Not by bits: zero has two signs.
            let Some(known) = values.iter().find(|known| **known == *value) else {
                return Err(never(name, *value, values));
            };
            chosen.axes[place].values = vec![*known];
        }
        if let Some(name) = &point.variant {
            let axis = chosen.axes.iter_mut().find(|axis| axis.is_of_variants());
            let axis = axis.ok_or_else(|| no_axis(&self.axes, VARIANT))?;
            let place = axis.place_of(name).filter(|it| axis.values.contains(it));
            let Some(place) = place else {
                return Err(SelectError::Value {
                    name: VARIANT.to_owned(),
                    value: name.clone(),
                    values: format!("it takes {}", axis.words().join(", ")),
                });
            };
            axis.values = vec![place];
        }
        if let Some(seed) = point.seed {
            chosen.seeds.retain(|known| *known == seed);
            if chosen.seeds.is_empty() {
                return Err(never(SEED, seed, &self.seeds));
            }
        }
        Ok(chosen)
    }
}

/// The error of an axis that the sweep does not have.
fn no_axis(axes: &[Axis], name: &str) -> SelectError {
    let known = axes.iter().map(|axis| axis.name.as_str());
    SelectError::Axis {
        name: name.to_owned(),
        known: known.collect::<Vec<_>>().join(", "),
    }
}

/// The error of a value that its axis does not have: it names these, or the nearest ones if
/// there are many.
fn never<T: Copy + PartialOrd + Display>(name: &str, value: T, known: &[T]) -> SelectError {
    let values = if known.len() <= FEW {
        let known: Vec<String> = known.iter().map(T::to_string).collect();
        format!("it takes {}", known.join(", "))
    } else {
        let larger = |one: T, other: T| if other > one { other } else { one };
        let smaller = |one: T, other: T| if other < one { other } else { one };
        let below = known.iter().copied().filter(|known| *known < value);
        let above = known.iter().copied().filter(|known| *known > value);
        let nearest = [below.reduce(larger), above.reduce(smaller)];
        let nearest: Vec<String> = nearest.iter().flatten().map(T::to_string).collect();
        let count = known.len();
        format!("the nearest of its {count} values: {}", nearest.join(", "))
    };
    SelectError::Value {
        name: name.to_owned(),
        value: value.to_string(),
        values,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn sweep(values: Vec<f64>, seeds: Vec<u64>) -> Sweep {
        let axis = Axis::of_numbers("gravity.acceleration", "gravity", values);
        Sweep {
            axes: vec![axis],
            seeds,
            ..Sweep::of_falling_sphere()
        }
    }

    /// Symptom: `seed=9007199254740993` chose the seed ...992, and .3 the value
    /// .30000000000000004 as well. Cause: a seed was read as a floating point number, and values
    /// were compared within a tolerance.
    #[test]
    fn neighbours_are_other_points() {
        let large = (1_u64 << 53) + 1;
        let sweep = sweep(vec![0.1 + 0.2, 0.3, 0.0], vec![large - 1, large]);
        let chosen = |text: &str| sweep.select(&parse_point(text).unwrap());
        let one = chosen(&format!("gravity=.3,seed={large}")).unwrap();
        assert_eq!(
            (&one.axes[0].values[..], &one.seeds[..]),
            (&[0.3][..], &[large][..])
        );
        let other = chosen("gravity.acceleration=.30000000000000004").unwrap();
        assert_eq!(other.axes[0].values, [0.1 + 0.2]);
        assert_eq!(chosen("gravity=-0").unwrap().axes[0].values, [0.0]);
        let message = chosen("gravity=.30000000000000001").unwrap().axes[0].values[0];
        assert_eq!(message.to_bits(), 0.3_f64.to_bits());
        let message = chosen("gravity=.3000000001").unwrap_err().to_string();
        assert_eq!(
            message,
            "`gravity` is never 0.3000000001; it takes 0.30000000000000004, 0.3, 0"
        );
        let message = chosen("seed=9007199254740994").unwrap_err().to_string();
        assert!(
            message.contains("9007199254740992, 9007199254740993"),
            "{message}"
        );
    }

    #[test]
    fn the_nearest_of_many_values_are_named() {
        let sweep = sweep((0..41).map(f64::from).collect(), vec![1]);
        let never = |text: &str| sweep.select(&parse_point(text).unwrap()).unwrap_err();
        let message = never("gravity=7.5").to_string();
        assert_eq!(
            message,
            "`gravity` is never 7.5; the nearest of its 41 values: 7, 8"
        );
        assert!(never("gravity=50").to_string().ends_with("values: 40"));
    }

    /// Symptom: `radius=.003,radius=.002` said that the radius is never .002, and takes .003.
    #[test]
    fn an_axis_has_one_value_in_a_point() {
        let repeated = |name: &str| SelectError::Repeated(name.to_owned());
        assert_eq!(parse_point("gravity=1,gravity=2"), Err(repeated("gravity")));
        assert_eq!(parse_point("seed=1, seed=1"), Err(repeated("seed")));
        let point = parse_point("gravity=1,gravity.acceleration=1").unwrap();
        let sweep = sweep(vec![1.0], vec![1]);
        assert_eq!(sweep.select(&point), Err(repeated("gravity.acceleration")));
        for text in ["seed=1.5", "seed=-1", "seed=9223372036854775808"] {
            assert!(matches!(parse_point(text), Err(SelectError::Seed(_))));
        }
    }

    proptest! {
        /// What is printed of a point chooses it, and no neighbour of it.
        #[test]
        fn a_point_is_found_by_what_is_printed_of_it(
            value in prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL,
            seed in 0..LARGEST_SEED,
        ) {
            let sweep = sweep(vec![value, value.next_up()], vec![seed, seed + 1]);
            for (at, value) in sweep.axes[0].values.iter().enumerate() {
                let text = format!("gravity={value},seed={}", sweep.seeds[at]);
                let point = parse_point(&text).unwrap();
                let chosen = sweep.select(&point).unwrap();
                prop_assert_eq!(chosen.axes[0].values.len(), 1);
                prop_assert_eq!(chosen.axes[0].values[0].to_bits(), value.to_bits());
                prop_assert_eq!(chosen.seeds, vec![sweep.seeds[at]]);
                let read = parse_point(&point.to_string().replace(' ', ""));
                prop_assert_eq!(read, Ok(point));
            }
            let absent = Selection { seed: Some(seed + 1), ..Selection::default() };
            let one = Sweep { seeds: vec![seed], ..sweep.clone() };
            prop_assert!(one.select(&absent).is_err());
        }
    }
}
