//! Names in messages: lists, and the name that was probably meant.

/// `` `a` `` for a.
pub(crate) fn quoted(name: impl std::fmt::Display) -> String {
    format!("`{name}`")
}

/// A number as one would write it: with an exponent if it is very large or small.
pub(crate) fn number(value: f64) -> String {
    match value.abs() {
        size if size != 0.0 && !(1e-3..1e6).contains(&size) => format!("{value:e}"),
        _ => value.to_string(),
    }
}

/// All names, quoted, with commas between them.
pub(crate) fn one_of<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    let names: Vec<String> = names
        .into_iter()
        .map(|name| quoted(name.as_ref()))
        .collect();
    names.join(", ")
}

/// All names, quoted, with "or" between them.
pub(crate) fn any_of<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    one_of(names).replace("`, `", "` or `")
}

/// The name nearest to `word`, if it is near enough to have been meant.
pub(crate) fn suggest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let enough = (word.chars().count() / 3).max(1);
    let word = word.to_lowercase();
    names
        .into_iter()
        .map(|name| (strsim::osa_distance(&word, &name.to_lowercase()), name))
        .filter(|(distance, _)| *distance <= enough)
        .min()
        .map(|(_, name)| name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let short = [0.0, 0.004, 2.5e-4, 1e8, 256.0, -1e-9].map(number);
        assert_eq!(short, ["0", "0.004", "2.5e-4", "1e8", "256", "-1e-9"]);
    }

    #[test]
    fn finds_slips_of_the_keyboard_and_nothing_far_off() {
        let names = ["radius", "density", "count"];
        assert_eq!(suggest("raduis", names), Some("radius"));
        assert_eq!(suggest("Radius", names), Some("radius"));
        assert_eq!(suggest("densty", names), Some("density"));
        assert_eq!(suggest("colour", names), None);
        assert_eq!(suggest("", names), None);
    }
}
