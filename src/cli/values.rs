//! Values of options, as the command line gives them.

use phase::scene::LARGEST_SEED;
use phase::sweep::Shard;
use std::env;
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

/// Parses a time in seconds, minutes (m), hours (h) or days (d), such as 90, 90s or 1.5h.
pub(super) fn time(text: &str) -> Result<Duration, String> {
    let units = [("s", 1.0), ("m", 60.0), ("h", 3600.0), ("d", 86_400.0)];
    let unit = units.iter().find_map(|(name, unit)| {
        let number = text.strip_suffix(name)?;
        Some((number, *unit))
    });
    let (number, unit) = unit.unwrap_or((text, 1.0));
    let seconds = number.trim().parse().ok().filter(|it: &f64| *it > 0.0);
    let time = seconds.map(|seconds| Duration::try_from_secs_f64(seconds * unit));
    match time {
        Some(Ok(time)) => Ok(time),
        _ => Err("give a time above 0, such as 90s, 20m, 1.5h or 2d".to_owned()),
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

/// Parses a part of the jobs of a sweep: `I/N`, or `auto` for the task of a Slurm array.
pub(super) fn part(text: &str) -> Result<Shard, String> {
    if text != "auto" {
        return match text.parse() {
            Ok(part @ Shard::Part { .. }) => Ok(part),
            _ => Err("give a part and their number, such as 3/64, or auto".to_owned()),
        };
    }
    let number = |name: &str| -> Result<usize, String> {
        let text = env::var(name).map_err(|_| {
            format!("auto needs the task of a Slurm array ({name} is not set); give I/N")
        })?;
        text.parse()
            .map_err(|_| format!("{name} is no number: {text}; give I/N"))
    };
    let (task, first) = (
        number("SLURM_ARRAY_TASK_ID")?,
        number("SLURM_ARRAY_TASK_MIN")?,
    );
    let of = number("SLURM_ARRAY_TASK_COUNT")?;
    match task.checked_sub(first).map(|it| it + 1) {
        Some(number) if number <= of => Ok(Shard::Part { number, of }),
        _ => Err(format!(
            "the {of} tasks of this Slurm array are not numbered one by one (task {task}, from \
             {first}); give I/N"
        )),
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
