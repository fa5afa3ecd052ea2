//! Names in messages: lists of them, and the one that was probably meant.

/// `` `a` `` for a.
pub(crate) fn quoted(name: impl std::fmt::Display) -> String {
    format!("`{name}`")
}

/// All names, quoted, with commas between them.
pub(crate) fn one_of<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> String {
    let names: Vec<String> = names
        .into_iter()
        .map(|name| quoted(name.as_ref()))
        .collect();
    names.join(", ")
}

/// The name that is nearest to `word`, if one is near enough to have been meant.
pub(crate) fn suggest<'a>(word: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let enough = (word.chars().count() / 3).max(1);
    names
        .into_iter()
        .map(|name| (distance(word, name), name))
        .filter(|(distance, _)| *distance <= enough)
        .min()
        .map(|(_, name)| name)
}

/// Number of characters to insert, delete, replace or swap with their neighbour to get from one
/// word to the other (optimal string alignment).
fn distance(from: &str, to: &str) -> usize {
    let from: Vec<char> = from.to_lowercase().chars().collect();
    let to: Vec<char> = to.to_lowercase().chars().collect();
    let mut rows = vec![(0..=to.len()).collect::<Vec<usize>>()];
    for i in 1..=from.len() {
        let mut row = vec![i];
        for j in 1..=to.len() {
            let changed = usize::from(from[i - 1] != to[j - 1]);
            let mut least = (rows[i - 1][j] + 1)
                .min(row[j - 1] + 1)
                .min(rows[i - 1][j - 1] + changed);
            if i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[from.len()][to.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

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
