//! Values of options, as the command line gives them.

use phase::scene::LARGEST_SEED;
use std::time::Duration;

/// More threads than any machine has use for.
const MOST_THREADS: usize = 256;

/// Parses a time in seconds.
pub(super) fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().ok().map(Duration::try_from_secs_f64);
    match seconds {
        Some(Ok(time)) => Ok(time),
        _ => Err("must be a time in seconds, 0 or more".to_owned()),
    }
}

/// Parses a number of workers.
pub(super) fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(number) if number > 0 => Ok(number),
        _ => Err("must be a whole number from 1".to_owned()),
    }
}

/// Parses a seed.
pub(super) fn seed(text: &str) -> Result<u64, String> {
    match text.parse() {
        Ok(seed) if seed <= LARGEST_SEED => Ok(seed),
        _ => Err(format!("must be a whole number from 0 to {LARGEST_SEED}")),
    }
}

/// Parses two times (s), the earlier first.
pub(super) fn times(text: &str) -> Result<[f64; 2], String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|it| it.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some(&[from, to]) if 0.0 <= from && from < to && to.is_finite() => Ok([from, to]),
        _ => Err("give two times in seconds, the earlier first, such as 40,200".to_owned()),
    }
}

/// Parses a number of threads.
pub(super) fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(threads @ 1..=MOST_THREADS) => Ok(threads),
        _ => Err(format!("give a number from 1 to {MOST_THREADS}")),
    }
}

/// Parses a setting as far as it needs an equals sign.
pub(super) fn setting(text: &str) -> Result<String, String> {
    match text.split_once('=') {
        Some((key, value)) if !key.trim().is_empty() && !value.trim().is_empty() => {
            Ok(text.to_owned())
        }
        _ => Err("give a key and its value, such as `time.duration=10`".to_owned()),
    }
}

/// Parses a number.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok();
    let finite = number.filter(|number: &f64| number.is_finite());
    finite.ok_or_else(|| "give a number".to_owned())
}

/// Parses a number of seeds from which noise can be told.
pub(super) fn three_or_more(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(number) if (3..=10_000).contains(&number) => Ok(number),
        _ => Err(
            "must be a whole number from 3 to 10000: fewer seeds tell nothing from noise".into(),
        ),
    }
}

/// Parses a word of the name of an effect.
pub(super) fn word(text: &str) -> Result<String, String> {
    match text.trim() {
        "" => Err("give words of the names of effects, or leave out `=` for all of them".into()),
        word => Ok(word.to_owned()),
    }
}
