//! Numbers as people read them.

/// A time: `0.42 s`, `12 s`, `3 min 05 s`, `2 h 07 min`, `3 d 04 h`.
pub(crate) fn duration(seconds: f64) -> String {
    if seconds < 9.995 {
        return format!("{seconds:.2} s");
    }
    let whole = seconds.round() as u64;
    let (minutes, hours, days) = (whole / 60, whole / 3600, whole / 86400);
    match whole {
        0..60 => format!("{whole} s"),
        60..3600 => format!("{minutes} min {:02} s", whole % 60),
        3600..86400 => format!("{hours} h {:02} min", minutes % 60),
        _ => format!("{days} d {:02} h", hours % 24),
    }
}

/// A time that may be short: `3.1 µs`, `42 ms`, and from a second on as any [duration].
pub(crate) fn short_duration(seconds: f64) -> String {
    match seconds {
        seconds if seconds >= 1.0 || seconds <= 0.0 => duration(seconds),
        seconds if seconds >= 1e-3 => format!("{} ms", two_digits(1e3 * seconds)),
        seconds => format!("{} µs", two_digits(1e6 * seconds)),
    }
}

fn two_digits(value: f64) -> String {
    let decimals = usize::from(value < 9.95);
    format!("{value:.decimals$}")
}

/// A simulated time (s), without the last digits that rounding gave it.
pub(crate) fn time(seconds: f64) -> String {
    let rounded: f64 = format!("{seconds:.9}").parse().unwrap_or(seconds);
    format!("{rounded} s")
}

/// A size: `1.05 MB`.
pub(crate) fn bytes(value: f64) -> String {
    with_prefix(value, "B")
}

/// An amount of work in the unit of a model: `1.05 G sphere-steps`.
pub(crate) fn work(value: f64, unit: &str) -> String {
    with_prefix(value, &format!(" {unit}"))
}

/// A rate of work: `1.05 M sphere-steps/s`.
pub(crate) fn rate(value: f64, unit: &str) -> String {
    with_prefix(value, &format!(" {unit}/s"))
}

/// A number to three digits, with a decimal prefix before the unit.
pub(crate) fn with_prefix(value: f64, unit: &str) -> String {
    let prefixes = [(1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k")];
    let Some((scale, prefix)) = prefixes.into_iter().find(|(scale, _)| value >= *scale) else {
        // Whole things have no fraction.
        let decimals = usize::from(value < 9.95 && value.fract() != 0.0);
        return format!("{value:.decimals$} {}", unit.trim_start());
    };
    let scaled = value / scale;
    let decimals = match scaled {
        scaled if scaled < 9.995 => 2,
        scaled if scaled < 99.95 => 1,
        _ => 0,
    };
    format!("{scaled:.decimals$} {prefix}{unit}")
}

/// A share in percent.
pub(crate) fn percent(part: usize, whole: usize) -> String {
    format!("{:.0} %", 100.0 * part as f64 / whole.max(1) as f64)
}

/// Processor time (s) in core-hours, with the digits that count.
pub(crate) fn core_hours(seconds: f64) -> String {
    match seconds / 3600.0 {
        hours if hours >= 9.95 => format!("{hours:.0} core-hours"),
        hours if hours >= 0.1 => format!("{hours:.1} core-hours"),
        hours => format!("{hours:.3} core-hours"),
    }
}

/// A word as a shell needs it.
pub(crate) fn word_of_shell(text: &str) -> String {
    let is_plain = |it: char| it.is_ascii_alphanumeric() || "/._-=:,+%@".contains(it);
    match !text.is_empty() && text.chars().all(is_plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', r"'\''")),
    }
}

/// A number of things: `1 job`, `2 jobs`.
pub(crate) fn count(number: usize, thing: &str) -> String {
    let plural = match number {
        1 => "",
        _ if thing.ends_with('s') => "es",
        _ => "s",
    };
    format!("{number} {thing}{plural}")
}

/// A text as a shell takes it for one word that is no option.
pub(crate) fn shell_word(text: &str) -> String {
    let is_plain = |letter: char| letter.is_ascii_alphanumeric() || "/._-+=:,@".contains(letter);
    match !text.is_empty() && !text.starts_with('-') && text.chars().all(is_plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_keep_two_units() {
        for (seconds, text) in [
            (0.0, "0.00 s"),
            (9.999, "10 s"),
            (42.4, "42 s"),
            (59.7, "1 min 00 s"),
            (185.0, "3 min 05 s"),
            (7620.0, "2 h 07 min"),
            (273_600.0, "3 d 04 h"),
        ] {
            assert_eq!(duration(seconds), text);
        }
    }

    #[test]
    fn short_durations_keep_two_digits() {
        let short = [3.14e-6, 4.2e-2, 0.9, 12.0].map(short_duration);
        assert_eq!(short, ["3.1 µs", "42 ms", "900 ms", "12 s"]);
    }

    #[test]
    fn numbers_keep_three_digits() {
        for (value, text) in [
            (0.0, "0 B"),
            (850.0, "850 B"),
            (1049.0, "1.05 kB"),
            (12_345.0, "12.3 kB"),
            (999_000_000.0, "999 MB"),
            (2.4e9, "2.40 GB"),
        ] {
            assert_eq!(bytes(value), text);
        }
        assert_eq!(work(960_000.0, "sphere-steps"), "960 k sphere-steps");
        assert_eq!(rate(7.0, "spot-moves"), "7 spot-moves/s");
        assert_eq!(rate(0.42, "runs"), "0.4 runs/s");
    }

    #[test]
    fn words_of_a_shell_are_quoted_where_needed() {
        for (text, word) in [
            ("results/quick", "results/quick"),
            ("my results", "'my results'"),
            ("it's", "'it'\\''s'"),
            ("-x", "'-x'"),
            ("", "''"),
            ("$HOME", "'$HOME'"),
        ] {
            assert_eq!(shell_word(text), word);
        }
    }
}
