//! Results that another build of the program made.

use super::console::Console;
use super::format;
use phase::record::Program;
use std::collections::BTreeMap;

/// Warns of results that are taken over, each a `thing`, but that another build made, or one that
/// was not noted: the present one might give other bits.
pub(super) fn tell_of_others<'a>(
    thing: &str,
    makers: impl Iterator<Item = Option<&'a Program>>,
    console: &Console,
) {
    let mut counts = BTreeMap::<String, usize>::new();
    for maker in makers.filter(|maker| *maker != Some(&Program::current())) {
        let name = match maker {
            Some(Program { version, commit }) => format!("version {version} (commit {commit})"),
            None => "a version that was not noted".to_owned(),
        };
        *counts.entry(name).or_default() += 1;
    }
    for (maker, number) in counts {
        let (results, were, them) = match number {
            1 => (format::count(1, thing), "was", "it"),
            _ => (format::count(number, thing), "were", "them"),
        };
        console.warning(format_args!(
            "{results} {were} made by {maker}; --force makes {them} anew"
        ));
    }
}
